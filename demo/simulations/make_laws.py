#!/usr/bin/env python3
"""Writes four scenes in which contacts go with their bodies: what rolls, spins, turns and stands.

    make_laws.py FOLDER

FOLDER gets cart.json with cart.urdf, spinning_top.json, turntable.json and arch.json: each is simulated by
`firstcontact simulate SCENE --html PAGE`.
"""

import json
import math
import pathlib
import sys


def body(name, shape, position=(0, 0, 0), quaternion=(1, 0, 0, 0), **more):
    return {"name": name, "shape": shape,
            "pose": {"position": list(position), "quaternion_wxyz": list(quaternion)}, **more}


def box(*size):
    return {"box": {"size": list(size)}}


def scene(bodies, robots=(), **simulation):
    return {"firstcontact": 1, "bodies": list(bodies), **({"robots": list(robots)} if robots else {}),
            "simulation": simulation}


def tilted(angle, axis):
    half = 0.5 * angle
    return [math.cos(half)] + [math.sin(half) * x for x in axis]


# A cart on four cylinders that coasts down a ramp and on along the level.

def wheel(name, x, y):
    roll = math.pi / 2
    inertia = '<inertia ixx="2e-4" ixy="0" ixz="0" iyy="3e-4" iyz="0" izz="2e-4"/>'
    return (f'<link name="{name}"><inertial><mass value="0.2"/>{inertia}</inertial><collision>'
            f'<origin rpy="{roll} 0 0"/><geometry><cylinder radius="0.05" length="0.03"/></geometry></collision></link>'
            f'<joint name="axle_{name}" type="continuous"><parent link="bed"/><child link="{name}"/>'
            f'<origin xyz="{x} {y} 0"/><axis xyz="0 1 0"/></joint>')


def cart_urdf():
    bed = ('<link name="bed"><inertial><origin xyz="0 0 0.04"/><mass value="2"/><inertia ixx="0.01" ixy="0" ixz="0" '
           'iyy="0.03" iyz="0" izz="0.03"/></inertial><collision><origin xyz="0 0 0.04"/><geometry>'
           '<box size="0.4 0.2 0.04"/></geometry></collision></link>')
    wheels = [wheel(f"{side}_{end}", x, y) for end, x in (("front", 0.13), ("back", -0.13))
              for side, y in (("left", 0.13), ("right", -0.13))]
    return '<robot name="cart">' + bed + "".join(wheels) + "</robot>"


def cart():
    slope = 0.15
    length = 2.0
    middle = [-0.5 * length * math.cos(slope), 0, 0.5 * length * math.sin(slope)]
    normal = [math.sin(slope), 0, math.cos(slope)]
    ramp = body("ramp", box(length, 1, 0.02), [m - 0.01 * n for m, n in zip(middle, normal)],
                tilted(slope, [0, 1, 0]), surface={"friction": 0.9})
    floor = body("floor", box(4, 1, 0.02), [2, 0, -0.01], surface={"friction": 0.9})
    start = [-1.5 * math.cos(slope) + 0.0501 * normal[0], 0, 1.5 * math.sin(slope) + 0.0501 * normal[2]]
    robot = {"name": "cart", "urdf": "cart.urdf", "base": {"position": start, "quaternion_wxyz": tilted(slope, [0, 1, 0])},
             "state": {f"axle_{side}_{end}": 0 for side in ("left", "right") for end in ("front", "back")},
             "dynamics": {"base": "free", "friction": 0.9}}
    return scene([ramp, floor], [robot], duration=3, step=0.005, contact_distance=5e-5)


# A top of 0.3 kg that spins on its tip and precesses.

def revolved(profile, around):
    """A closed mesh; the profile has radii and heights, and begins and ends on the axis."""
    vertices = [[0, 0, profile[0][1]]]
    for radius, height in profile[1:-1]:
        vertices += [[radius * math.cos(2 * math.pi * k / around), radius * math.sin(2 * math.pi * k / around), height]
                     for k in range(around)]
    vertices.append([0, 0, profile[-1][1]])
    rows = len(profile) - 2
    triangles = []
    for k in range(around):
        n = (k + 1) % around
        triangles.append([0, 1 + n, 1 + k])
        for row in range(rows - 1):
            a, b = 1 + row * around, 1 + (row + 1) * around
            triangles += [[a + k, a + n, b + n], [a + k, b + n, b + k]]
        last = 1 + (rows - 1) * around
        triangles.append([last + k, last + n, len(vertices) - 1])
    return {"vertices": vertices, "triangles": triangles}


def spinning_top():
    shape = revolved([(0, 0), (0.008, 0.02), (0.04, 0.04), (0.04, 0.05), (0.006, 0.06), (0.006, 0.09), (0, 0.09)], 32)
    tilt = 0.3
    floor = body("floor", box(1, 1, 0.02), [0, 0, -0.01])
    axis = [math.sin(tilt), 0, math.cos(tilt)]
    top = body("top", shape, [0, 0, 1e-4], tilted(tilt, [0, 1, 0]),
               dynamics={"density": 1500, "angular_velocity": [150 * a for a in axis], "friction": 0.6})
    return scene([floor, top], duration=4, step=0.002, friction=0.6)


# Blocks on a turntable that gets faster: the outer ones leave it first.

def turntable():
    times = [0.1 * k for k in range(81)]
    poses = []
    for t in times:
        angle = 0.25 * t * t  # 4 rad/s in the end.
        poses.append({"position": [0, 0, -0.05], "quaternion_wxyz": tilted(angle, [0, 0, 1])})
    table = body("table", {"cylinder": {"radius": 1.0, "length": 0.1}}, surface={"friction": 0.5},
                 motion={"type": "waypoints", "times": times, "poses": poses})
    del table["pose"]
    floor = body("floor", box(5, 5, 0.02), [0, 0, -0.5])
    blocks = []
    for ring, radius in enumerate((0.3, 0.6, 0.9)):
        for k in range(6):
            angle = math.pi * k / 3 + 0.3 * ring
            blocks.append(body(f"block {ring}{k}", box(0.1, 0.1, 0.05),
                               [radius * math.cos(angle), radius * math.sin(angle), 0.0251],
                               tilted(angle, [0, 0, 1]), dynamics={"density": 700}))
    return scene([floor, table, *blocks], duration=8, step=0.01, friction=0.5, contact_distance=1e-4)


# A half circle of 101 stones, as thick as 0.15 of its radius.

def arch(stones=101, radius=1.0, thickness=0.15, depth=0.3, gap=5e-5):
    bodies = [body("floor", box(4, 2, 0.1), [0, 0, -0.05 - gap])]
    step = math.pi / stones
    inner, outer = radius - 0.5 * thickness, radius + 0.5 * thickness
    for k in range(stones):
        corners = []
        for y in (-0.5 * depth, 0.5 * depth):
            for angle, way in ((k * step, gap), ((k + 1) * step, -gap)):
                for r in (inner, outer):
                    # Half of the gap off each side of a stone.
                    x, z = r * math.cos(angle), r * math.sin(angle)
                    corners.append([x - 0.5 * way * math.sin(angle), y, z + 0.5 * way * math.cos(angle)])
        stone = body(f"stone {k}", {"convex_hull": {"vertices": corners}}, dynamics={"density": 2000})
        bodies.append(stone)
    return scene(bodies, duration=2, step=0.01, friction=0.7, contact_distance=gap)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "cart.urdf").write_text(cart_urdf() + "\n", encoding="utf-8")
    for name, make in (("cart", cart), ("spinning_top", spinning_top), ("turntable", turntable), ("arch", arch)):
        (folder / f"{name}.json").write_text(json.dumps(make(), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
