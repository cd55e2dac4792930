#!/usr/bin/env python3
"""Makes a haptic scene of two bumpy bodies of 200,000 triangles each, by subdivision of the bunny.

    benchmarks/haptics/dense_pair.py FOLDER [TRIANGLES]

FOLDER gets dense.obj and dense_pair.json. The longest edge of the mesh is cut in half until there are TRIANGLES of
them. Then all vertices move along their normals by waves of 4 mm and 0.15 mm amplitude: the Armadillo has such a
shell, and it makes many places where two bodies nearly touch.
"""

import heapq
import json
import math
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WAVE = 2.0 * math.pi / 0.004  # [1/m]
HEIGHT = 0.00015  # [m]


def read(path: pathlib.Path):
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            triangles.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:4]))
    return vertices, triangles


def subdivide(vertices, triangles, count: int):
    """Cuts the longest edge of all, with the triangles beside it, until there are so many triangles."""
    beside: dict[tuple[int, int], set[int]] = {}
    heap: list[tuple[float, int, int]] = []

    def edges(triangle):
        return [tuple(sorted((triangle[k], triangle[(k + 1) % 3]))) for k in range(3)]

    def add(number: int):
        for edge in edges(triangles[number]):
            if edge not in beside:
                beside[edge] = set()
                heapq.heappush(heap, (-math.dist(vertices[edge[0]], vertices[edge[1]]), *edge))
            beside[edge].add(number)

    for number in range(len(triangles)):
        add(number)
    while len(triangles) < count:
        _, a, b = heapq.heappop(heap)
        middle = len(vertices)
        vertices.append(tuple(0.5 * (x + y) for x, y in zip(vertices[a], vertices[b])))
        for number in beside.pop((a, b)):
            triangle = triangles[number]
            for edge in edges(triangle):
                if edge != (a, b):
                    beside[edge].discard(number)
            triangles[number] = tuple(middle if corner == b else corner for corner in triangle)
            triangles.append(tuple(middle if corner == a else corner for corner in triangle))
            add(number)
            add(len(triangles) - 1)


def bump(vertices, triangles):
    normals = [[0.0, 0.0, 0.0] for _ in vertices]
    for corners in triangles:
        a, b, c = (vertices[corner] for corner in corners)
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for corner in corners:
            for k in range(3):
                normals[corner][k] += cross[k]
    for number, (vertex, normal) in enumerate(zip(vertices, normals)):
        length = math.hypot(*normal)
        if length > 0.0:
            height = HEIGHT * math.prod(math.sin(WAVE * x) for x in vertex) / length
            vertices[number] = tuple(x + height * n for x, n in zip(vertex, normal))


def main() -> int:
    if len(sys.argv) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    vertices, triangles = read(ROOT / "data/stanford/stanford-bunny.obj")
    subdivide(vertices, triangles, int(sys.argv[2]) if len(sys.argv) > 2 else 200_000)
    bump(vertices, triangles)
    with open(folder / "dense.obj", "w", encoding="utf-8") as file:
        file.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices)
        file.writelines(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
    body = {"shape": {"mesh": "dense.obj"}}
    scene = {"firstcontact": 1, "id": "Two bumpy bodies of 200,000 triangles, one in the hand",
             "bodies": [{"name": "still", **body}, {"name": "held", **body, "pose": {"position": [0.02, 0.16, 0]}}],
             "haptics": {"tools": [{"body": "held"}]}}
    (folder / "dense_pair.json").write_text(json.dumps(scene, indent=2) + "\n", encoding="utf-8")
    print(f"{folder / 'dense_pair.json'}: {len(triangles)} triangles, {len(vertices)} vertices, twice")
    return 0


if __name__ == "__main__":
    sys.exit(main())
