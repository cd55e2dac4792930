#!/usr/bin/env python3
"""Random piles of solids that are not convex, simulated and verified: by command, as it takes long.

    pile_campaign.py TOOL [--steps 10000] [--seed 0] [--bodies 12] [--limit SECONDS]

Each pile falls into a box for 250 steps of 10 ms: rings, chain links, brackets, crosses and stars,
of random sizes, densities and motions, with friction and restitution of its own. Exit status 1 where
any run is refuted or not proven, 3 where one lost time or did not end within --limit seconds.
"""

import argparse
import json
import math
import pathlib
import random
import sys
import tempfile

from campaign import simulate_and_verify

DATA = pathlib.Path(__file__).resolve().parents[2] / "data"
STEPS = 250
STEP = 0.01  # [s]
SPACING = 0.45  # [m]  Of the lattice from which bodies fall; none is larger.


def prism(outline: list, height: float) -> dict:
    """A closed mesh over a polygon that all of its corners see from the origin."""
    count = len(outline)
    vertices = [[x, y, z] for z in (-height / 2, height / 2) for x, y in [(0, 0), *outline]]
    triangles = []
    for k in range(count):
        a, b = 1 + k, 1 + (k + 1) % count
        top = count + 1
        triangles += [[0, b, a], [top, top + a, top + b], [a, b, top + b], [a, top + b, top + a]]
    return {"vertices": vertices, "triangles": triangles}


def star(rng: random.Random) -> dict:
    spikes = rng.randint(3, 7)
    outer = rng.uniform(0.1, 0.2)
    inner = outer * rng.uniform(0.3, 0.7)
    radii = [outer, inner] * spikes
    return prism([[r * math.cos(math.pi * k / spikes), r * math.sin(math.pi * k / spikes)]
                  for k, r in enumerate(radii)], rng.uniform(0.02, 0.15))


def bracket(rng: random.Random) -> dict:
    a, t = rng.uniform(0.2, 0.3), rng.uniform(0.03, 0.08)
    corner = [-t / 2, -t / 2]
    return prism([corner, [a - t, -t / 2], [a - t, t / 2], [t / 2, t / 2], [t / 2, a - t],
                  [-t / 2, a - t]], rng.uniform(0.05, 0.2))


def cross(rng: random.Random) -> dict:
    a, t = rng.uniform(0.1, 0.2), rng.uniform(0.02, 0.05)
    arm = [[a, -t], [a, t], [t, t]]
    outline = []
    for quarter in range(4):
        c, s = round(math.cos(quarter * math.pi / 2)), round(math.sin(quarter * math.pi / 2))
        outline += [[c * x - s * y, s * x + c * y] for x, y in arm]
    return prism(outline, rng.uniform(0.03, 0.15))


def from_file(name: str, size: float):
    return lambda rng: {"mesh": str(DATA / name), "scale": rng.uniform(0.5, 1.0) * size}


SHAPES = [star, bracket, cross,
          from_file("rigid_ipc/torus.obj", 0.4), from_file("rigid_ipc/link.obj", 0.3)]


def pile(seed: int, bodies: int) -> dict:
    rng = random.Random(seed)
    wall, high, side = 0.05, 1.5, 0.8
    walls = [([0, 0, -wall], [2, 2, 2 * wall])]
    for x, y in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        size = [2 * wall, 2, high] if x else [2, 2 * wall, high]
        walls.append(([x * side, y * side, high / 2], size))
    parts = [{"name": f"wall {k}", "shape": {"box": {"size": size}}, "pose": {"position": at}}
             for k, (at, size) in enumerate(walls)]
    places = [[SPACING * (i - 1), SPACING * (j - 1), 0.4 + SPACING * k]
              for k in range(100) for i in range(3) for j in range(3)][:bodies]
    for k, place in enumerate(places):
        q = [rng.gauss(0, 1) for _ in range(4)]
        length = math.sqrt(sum(x * x for x in q))
        parts.append({
            "name": f"body {k}", "shape": rng.choice(SHAPES)(rng),
            "pose": {"position": place, "quaternion_wxyz": [x / length for x in q]},
            "dynamics": {"density": rng.choice([500, 2700, 7850]),
                         "linear_velocity": [rng.gauss(0, 1) for _ in range(3)],
                         "angular_velocity": [rng.gauss(0, 5) for _ in range(3)]}})
    return {"firstcontact": 1, "bodies": parts,
            "simulation": {"step": STEP, "friction": rng.choice([0, 0.1, 0.3, 0.8]),
                           "restitution": rng.choice([0, 0, 0.3, 0.9])}}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    parser.add_argument("--steps", type=int, default=10000, help="of all piles together")
    parser.add_argument("--seed", type=int, default=0, help="of the first pile")
    parser.add_argument("--bodies", type=int, default=12)
    parser.add_argument("--limit", type=float, default=600.0)
    asked = parser.parse_args()
    status = 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(asked.seed, asked.seed + math.ceil(asked.steps / STEPS)):
            scene = pathlib.Path(folder) / "pile.json"
            scene.write_text(json.dumps(pile(seed, asked.bodies)), encoding="utf-8")
            ended = simulate_and_verify(asked.tool, scene, STEPS * STEP, asked.limit,
                                        f"pile {seed}")
            status = 1 if 1 in (status, ended) else max(status, ended)
    return status


if __name__ == "__main__":
    sys.exit(main())
