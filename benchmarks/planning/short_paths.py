#!/usr/bin/env python3
"""Compares the lengths of paths of the two planners in twelve problems of MotionBenchMaker.

    short_paths.py TOOL DATA [--time SECONDS] [--seed N]

TOOL is the program firstcontact; DATA the folder of data sets (FIRSTCONTACT_DATA_DIR). For each
problem `firstcontact plan` runs with both planners, in turns. Lengths are in rad; times are the wall
clock of the plan in ms, without the reading of files.
"""

import argparse
import json
import pathlib
import subprocess
import tempfile

FAMILIES = {"bookshelf": "bookshelf_small_panda", "box": "box_panda", "cage": "cage_panda",
            "table": "table_pick_panda"}
PROBLEMS = [1, 34, 67]
PLANNERS = ["rrt_connect", "lazy_prm_star"]


def planned(arguments, family, problem, planner):
    """The length of a path and the time that it took, as a cell of the table."""
    panda = arguments.data / "robots/moveit_resources_panda_description"
    folder = arguments.data / "planning_mbm/panda" / FAMILIES[family]
    with tempfile.TemporaryDirectory() as made:
        path = pathlib.Path(made) / "path.json"
        done = subprocess.run(
            [arguments.tool, "plan", "--robot", panda / "urdf/panda.urdf", "--srdf", panda / "srdf/panda.srdf",
             "--package-root", arguments.data / "robots", "--environment", folder / f"scene{problem:04}.yaml",
             "--request", folder / f"request{problem:04}.yaml", "--planner", planner,
             "--time", str(arguments.time), "--seed", str(arguments.seed), "-o", path],
            capture_output=True, text=True)
        if done.returncode == 1:
            return f"none in {1e3 * arguments.time:.0f}"
        if done.returncode != 0:
            raise SystemExit(done.stderr)
        found = json.loads(path.read_text(encoding="utf-8"))
    return f"{found['cost']:.2f} in {1e3 * found['statistics']['seconds']:.0f}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--time", type=float, default=5.0)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    print("| problem |" + "".join(f" `{planner}` |" for planner in PLANNERS))
    print("|---|" + "---:|" * len(PLANNERS))
    for family in FAMILIES:
        for problem in PROBLEMS:
            cells = [planned(arguments, family, problem, planner) for planner in PLANNERS]
            print(f"| {family} {problem} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
