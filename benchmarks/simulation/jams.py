#!/usr/bin/env python3
"""How long steps take where bodies or robots jam, beside the median step of the same scene.

    benchmarks/simulation/jams.py [--only WORDS]

Needs the Python package (`./dev wheel`). Each scene runs on one thread. A row has the processor times of its steps in
ms, the time that was lost, the greatest gain of energy in a step where nothing drives, and the verdict of `verify_run`.
The exit status is 1 where a run is not proven.
"""

import argparse
import math
import pathlib
import statistics
import sys
import tempfile
import time

import firstcontact as fc


def ring(around, section, radius=0.05, thick=0.01):
    """A mesh of a ring about z."""
    vertices, triangles = [], []
    for i in range(around):
        for j in range(section):
            a, b = 2 * math.pi * i / around, 2 * math.pi * j / section
            r = radius + thick * math.cos(b)
            vertices.append([r * math.cos(a), r * math.sin(a), thick * math.sin(b)])

            def at(k, l):
                return (k % around) * section + l % section
            triangles += [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    return {"vertices": vertices, "triangles": triangles}


def chain(rings, pull, pitch=0.07):
    """Rings in each other along x, every other one turned; a script pulls the last one that far, or nothing does."""
    half = math.sqrt(0.5)
    bodies = []
    for k in range(rings):
        pose = {"position": [k * pitch, 0, 0],
                "quaternion_wxyz": [1, 0, 0, 0] if k % 2 == 0 else [half, half, 0, 0]}
        body = {"name": f"ring {k}", "shape": ring(24, 10)}
        if k == rings - 1 and pull:
            body["motion"] = {"type": "constant_velocity", "from": pose, "translation": [pull, 0, 0]}
        else:
            body["pose"] = pose
            if k > 0:
                body["dynamics"] = {"density": 7800}
        bodies.append(body)
    return bodies


def box(*size):
    return {"box": {"size": list(size)}}


def press():
    """A press that goes down to 0.08 m over a block of 0.08 m, and up again."""
    poses = [{"position": [0, 0, z]} for z in (0.2, 0.08, 0.08, 0.2)]
    return [{"name": "floor", "shape": box(1, 1, 0.1), "pose": {"position": [0, 0, -0.05]}},
            {"name": "press", "shape": box(0.24, 0.24, 0.04),
             "motion": {"type": "waypoints", "times": [0, 0.8, 1.2, 2], "poses": poses}},
            {"name": "block", "shape": box(0.08, 0.08, 0.08), "pose": {"position": [0, 0, 0.0401]},
             "dynamics": {"density": 7800}}]


def between_presses():
    """A box between two presses that close past it."""
    return [{"name": "box", "shape": box(0.1, 0.1, 0.1), "pose": {"position": [0.02, 0, 0]}, "dynamics": {}}] + [
        {"name": name, "shape": box(0.1, 0.3, 0.3), "motion": {
            "type": "constant_velocity", "from": {"position": [0.2 * side, 0, 0]}, "translation": [-0.2 * side, 0, 0]}}
        for name, side in (("left", -1), ("right", 1))]


def link(name, mass, moment, shape="", middle=(0, 0, 0)):
    x, y, z = middle
    collision = f'<collision><origin xyz="{x} {y} {z}"/><geometry>{shape}</geometry></collision>' if shape else ""
    return (f'<link name="{name}"><inertial><origin xyz="{x} {y} {z}"/><mass value="{mass}"/><inertia ixx="{moment}" '
            f'iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/></inertial>{collision}</link>')


def joint(name, kind, parent, child, axis, at=(0, 0, 0)):
    x, y, z = at
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{x} {y} '
            f'{z}"/><axis xyz="{axis}"/><limit lower="-1" upper="1" effort="0" velocity="0"/></joint>')


CUBE = '<box size="0.2 0.2 0.2"/>'
SLIDER = ('<robot name="r">' + link("base", 2, 0.02, CUBE) + link("a", 1, 0.01, middle=(0.3, 0, 0))
          + link("b", 1, 0.01, CUBE, (0.4, 0, 0)) + joint("j1", "prismatic", "base", "a", "1 0 0")
          + joint("j2", "prismatic", "a", "b", "1 0 0") + "</robot>")
FINGER = '<box size="0.02 0.04 0.04"/>'
GRIPPER = ('<robot name="r">' + link("base", 2, 0.02) + link("f0", 0.1, 1e-4, FINGER) + link("f1", 0.1, 1e-4, FINGER)
           + joint("j0", "prismatic", "base", "f0", "1 0 0", (-0.011, 0, 0))
           + joint("j1", "prismatic", "base", "f1", "-1 0 0", (0.011, 0, 0)) + "</robot>")
SCREW = ('<robot name="r">' + link("base", 2, 0.02) + link("nut", 0.5, 1e-3, '<cylinder radius="0.05" length="0.04"/>')
         + '<joint name="j" type="screw" pitch="0.002"><parent link="base"/><child link="nut"/><origin xyz="0 0 0.2"/>'
         '<axis xyz="0 0 1"/></joint></robot>')
PLATE = {"name": "plate", "shape": box(1e-4, 0.1, 0.1), "pose": {"position": [2e-4, 0, 0]},
         "dynamics": {"density": 7800, "friction": 0.8}}
STOP = {"name": "stop", "shape": box(1, 1, 0.1), "pose": {"position": [0, 0, 0.12]}}


def arch(stones, thick=0.15, gap=1e-5):
    """Half a ring of stones of radius 1 m on the floor."""
    bodies = [{"name": "floor", "shape": box(9, 9, 1), "pose": {"position": [0, 0, -0.5]}}]
    for k in range(stones):
        corners = []
        for end in (0, 1):
            angle = math.pi * (k + end) / stones
            for radius in (1 - 0.5 * thick, 1 + 0.5 * thick):
                shift = (0.5 if end == 0 else -0.5) * gap
                x = radius * math.cos(angle) - shift * math.sin(angle)
                z = radius * math.sin(angle) + shift * math.cos(angle)
                corners += [[x, y, z] for y in (-0.05, 0.05)]
        bodies.append({"name": f"stone {k}", "shape": {"convex_hull": {"vertices": corners}},
                       "pose": {"position": [0, 0, 0.5 * gap]}, "dynamics": {"density": 2500}})
    return bodies


def scenes(folder):
    """Name, bodies, robots, settings, and whether a script or a motor drives."""
    def robot(urdf, motors, **dynamics):
        path = folder / f"{abs(hash(urdf))}.urdf"
        path.write_text(urdf, encoding="utf-8")
        return [{"name": "r", "urdf": str(path), "dynamics": {"motors": motors, **dynamics}}]
    rings = {"friction": 0.3, "contact_distance": 6e-5}
    still = {"gravity": [0, 0, 0]}
    yield "chain of 4 rings, pulled taut at 1 cm/s", chain(4, 0.02, 0.075), [], {**rings, **still, "duration": 2}, True
    yield "chain of 4 rings, pulled taut at 20 cm/s", chain(4, 0.4), [], {**rings, **still, "duration": 2}, True
    yield "chain of 8 rings, pulled taut at 20 cm/s", chain(8, 0.4), [], {**rings, **still, "duration": 2}, True
    yield "chain of 17 rings falls taut", chain(17, 0), [], {**rings, "duration": 2}, False
    yield "chain of 65 rings falls taut", chain(65, 0), [], {**rings, "duration": 2}, False
    yield "press on a block", press(), [], {"duration": 2}, True
    yield "the same, the press waits", press(), [], {"duration": 2, "jams": "wait"}, True
    yield ("presses close past a box", between_presses(), [], {"duration": 2, "friction": 0.3, **still}, True)
    yield ("fingers without bound hold a plate", [PLATE], robot(GRIPPER, {"*": {"velocity": 0.2}}, friction=0.8),
           {"duration": 2, "contact_distance": 1e-5}, True)
    yield "screw on its stop", [STOP], robot(SCREW, {"j": {"velocity": -20}}), {"duration": 2}, True
    yield ("floating robot presses on itself", [], robot(
        SLIDER, {"j1": {"position": 0}, "j2": {"velocity": -0.5}}, base="free", linear_velocity=[1, 0, 0],
        angular_velocity=[0, 0, 1]), {"duration": 2, **still}, True)
    yield "arch of 101 stones", arch(101), [], {"duration": 2, "friction": 0.9, "contact_distance": 1e-5}, False


def energy(step):
    return step.kinetic_energy + step.potential_energy


def measure(scene, record):
    simulator = fc.Simulator(scene, threads=1)
    times, steps = [], []
    with open(record, "w", encoding="utf-8") as lines:
        lines.write(simulator.header_json + "\n")
        for _ in range(simulator.steps_of_duration):
            begin = time.process_time()
            steps.append(simulator.step())
            times.append(1e3 * (time.process_time() - begin))
            lines.write(steps[-1].to_json().rstrip("\n") + "\n")
    return times, steps


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", default="", help="scenes whose names have these words")
    only = parser.parse_args().only
    print("| scene | median | p99 | p99 / median | most | lost (s) | gain (J) | verdict |\n|---|--:|--:|--:|--:|--:|--:|---|",
          flush=True)
    all_proven = True
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for title, bodies, robots, settings, is_driven in scenes(folder):
            if only not in title:
                continue
            scene = {"firstcontact": 1, "bodies": bodies, "robots": robots, "simulation": {"step": 0.01, **settings}}
            times, steps = measure(scene, folder / "run.jsonl")
            verdict = fc.verify_run(folder / "run.jsonl", threads=1).verdict
            all_proven = all_proven and verdict == fc.ProofVerdict.proven
            median = statistics.median(times)
            p99 = sorted(times)[math.ceil(0.99 * len(times)) - 1]
            gain = "–" if is_driven else f"{max(energy(b) - energy(a) for a, b in zip(steps, steps[1:])):.1e}"
            print(f"| {title} | {median:.2g} | {p99:.2g} | {p99 / median:.1f} | {max(times):.2g} | "
                  f"{sum(s.time_lost for s in steps):.2g} | {gain} | {verdict} |", flush=True)
    sys.exit(0 if all_proven else 1)


if __name__ == "__main__":
    main()
