#!/usr/bin/env python3
"""Processor time for each step of many bodies that do not meet each other: it grows with their number.

    benchmarks/dynamics/many_bodies.py [TOOL]

TOOL is build/release/apps/firstcontact by default. Boxes fall apart from each other while they tumble, or
rest apart from each other on one floor. Loading the scene is left out.
"""

import json
import math
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NUMBERS = (100, 1000, 10000)
STEPS = 10
STEP = 0.01


def scene(count: int, rests: bool) -> dict:
    side = math.ceil(math.sqrt(count))
    box = {"box": {"size": [1, 1, 1]}}
    bodies = []
    for k in range(count):
        place = [2 * (k % side) - side, 2 * (k // side) - side, 0.5001 if rests else 9]
        dynamics = {} if rests else {"angular_velocity": [1, 2, 3]}
        bodies.append({"name": f"box{k}", "shape": box, "pose": {"position": place}, "dynamics": dynamics})
    if rests:
        bodies.append({"name": "floor", "shape": {"box": {"size": [2 * side + 4, 2 * side + 4, 1]}},
                       "pose": {"position": [0, 0, -0.5]}})
    return {"firstcontact": 1, "bodies": bodies, "simulation": {"step": STEP}}


def processor_seconds(tool: str, file: pathlib.Path, steps: int) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([tool, "simulate", str(file), "--duration", repr(steps * STEP)], check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main() -> None:
    tool = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/apps/firstcontact")
    print(f"{'bodies':>8} {'fall apart':>22} {'rest apart':>22}")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "scene.json"
        for count in NUMBERS:
            print(f"{count:8}", end="")
            for rests in (False, True):
                file.write_text(json.dumps(scene(count, rests)), encoding="utf-8")
                loading = processor_seconds(tool, file, 1)
                a_step = (processor_seconds(tool, file, 1 + STEPS) - loading) / STEPS
                print(f" {1e3 * a_step:8.4g} ms {1e6 * a_step / count:5.3g} us each", end="", flush=True)
            print()


if __name__ == "__main__":
    main()
