#!/usr/bin/env python3
"""Writes a scene with a wrecking ball: a ball on a chain falls against a wall.

    make_wrecking_ball.py SCENE ROWS COLUMNS

SCENE is written, and beside it ball_with_eye.obj: a ball joined with the ring it hangs from.
"""

import json
import math
import os
import pathlib
import sys

DATA = pathlib.Path(__file__).resolve().parent.parent.parent / "data" / "rigid_ipc"
SCALE = 0.4                      # Of links and of the ball's eye.
PITCH = 0.98 * (1.5 - 2 * 0.19) * SCALE  # [m]  Of the chain: links are 1.5 long and 0.19 thick.
HOOK = 3.2                       # [m]  Its height.
RADIUS = 0.35                    # [m]  Of the ball.
BRICK = (0.25, 0.5, 0.25)        # [m]
GAP = 1e-3                       # [m]
ALONG_X = (math.sqrt(0.5), 0, 0, math.sqrt(0.5))  # Quaternions, w first: the long axis is y.
TURNED = (0.5, 0.5, -0.5, 0.5)


def ball(centre, slices=16, stacks=10):
    """Vertices and faces of a closed sphere."""
    vertices = [(centre, 0, -RADIUS), (centre, 0, RADIUS)]
    for i in range(1, stacks):
        polar = math.pi * i / stacks - math.pi / 2
        for k in range(slices):
            turn = 2 * math.pi * k / slices
            vertices.append((centre + RADIUS * math.cos(polar) * math.cos(turn),
                             RADIUS * math.cos(polar) * math.sin(turn), RADIUS * math.sin(polar)))
    at = lambda i, k: 2 + (i - 1) * slices + k % slices
    faces = []
    for k in range(slices):
        faces.append((0, at(1, k + 1), at(1, k)))
        faces.append((1, at(stacks - 1, k), at(stacks - 1, k + 1)))
        for i in range(1, stacks - 1):
            faces.append((at(i, k), at(i, k + 1), at(i + 1, k + 1)))
            faces.append((at(i, k), at(i + 1, k + 1), at(i + 1, k)))
    return vertices, faces


def write_ball_with_eye(path):
    """The eye lies in the plane of x and y around the origin; the ball beside it, at -x."""
    lines = [line.split() for line in (DATA / "torus.obj").read_text().splitlines() if line.strip()]
    vertices = [tuple(SCALE * float(c) for c in line[1:4]) for line in lines if line[0] == "v"]
    corner = lambda word: int(word.split("/")[0]) - 1
    faces = [tuple(corner(word) for word in line[1:]) for line in lines if line[0] == "f"]
    more, others = ball(-(RADIUS + 0.45 * SCALE))
    faces += [tuple(len(vertices) + k for k in face) for face in others]
    vertices += more
    path.write_text("".join("v %.9g %.9g %.9g\n" % v for v in vertices) +
                    "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces))


def main(scene, rows, columns):
    link = {"mesh": os.path.relpath(DATA / "link.obj", scene.parent), "scale": SCALE}
    bodies = [
        {"name": "floor", "shape": {"box": {"size": [12, 12, 0.2]}}, "pose": {"position": [0, 0, -0.1]}},
        {"name": "hook", "shape": link, "pose": {"position": [0, 0, HOOK], "quaternion_wxyz": ALONG_X}},
    ]
    for k in range(1, 5):
        bodies.append({"name": f"link {k}", "shape": link,
                       "pose": {"position": [-k * PITCH, 0, HOOK], "quaternion_wxyz": TURNED if k % 2 else ALONG_X},
                       "dynamics": {"density": 7850}})
    # The eye is a ring of 1 in place of a link of 1.5.
    eye = -4.5 * PITCH - 0.45 * (1.0 - 2 * 0.19) * SCALE
    write_ball_with_eye(scene.parent / "ball_with_eye.obj")
    bodies.append({"name": "ball", "shape": {"mesh": "ball_with_eye.obj"},
                   "pose": {"position": [eye, 0, HOOK], "rpy": [math.pi / 2, 0, 0]},
                   "dynamics": {"density": 7850}})
    for row in range(rows):
        for column in range(columns):
            y = (column - (columns - 1) / 2 + (row % 2) / 2 - 0.25) * (BRICK[1] + GAP)
            z = BRICK[2] / 2 + GAP + row * (BRICK[2] + GAP)
            bodies.append({"name": f"brick {row + 1}/{column + 1}", "shape": {"box": {"size": BRICK}},
                           "pose": {"position": [0.5, y, z]}, "dynamics": {"density": 1800}})
    scene.write_text('{\n  "firstcontact": 1,\n  "id": "a wrecking ball",\n  "bodies": [\n    ' +
                     ",\n    ".join(json.dumps(body) for body in bodies) +
                     '\n  ],\n  "simulation": {"duration": 2, "step": 0.01, "friction": 0.4}\n}\n')


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]), int(sys.argv[3]))
