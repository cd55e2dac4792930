#!/usr/bin/env python3
"""Retimes curves that are divided into more and more waypoints.

    divided_paths.py TOOL

TOOL is the program firstcontact. A tool on two slides, x and z, with 1 m/s and 2 m/s^2, follows a line
of 2 m, a circle with a radius of 0.5 m, and a sine of 2 m by 0.6 m with 1.6 periods. For each number of
waypoints `firstcontact retime` runs in each mode. Durations are in s; the last line has the wall clock
of the retimings in the table.
"""

import argparse
import math
import pathlib
import subprocess
import tempfile
import time

SLIDES = """<robot name="gantry">
  <link name="base"/><link name="slide"/>
  <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="z" type="prismatic"><parent link="slide"/><child link="tool"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
</robot>
"""
CURVES = {"line": lambda s: (2 * s - 1, 0.0),
          "circle": lambda s: (0.5 * math.cos(math.tau * s), 0.5 * math.sin(math.tau * s)),
          "sine": lambda s: (2 * s - 1, 0.3 * math.sin(1.6 * math.tau * s))}
COLUMNS = [("line", "blend"), ("circle", "blend"), ("circle", "time_optimal"), ("sine", "blend"),
           ("sine", "time_optimal")]
WAYPOINTS = [30, 100, 300, 1000, 3000]


def duration(tool, folder, curve, count, mode):
    """[s]  The duration of the retimed curve."""
    points = [CURVES[curve](k / (count - 1)) for k in range(count)]
    rows = "".join(f"{k},{x!r},{z!r}\n" for k, (x, z) in enumerate(points))
    (folder / "curve.csv").write_text("time,x,z\n" + rows, encoding="utf-8")
    made = folder / "retimed.csv"
    done = subprocess.run([tool, "retime", "--robot", folder / "slides.urdf", "--trajectory", folder / "curve.csv",
                           "--max-acceleration", "2", "--mode", mode, "-o", made], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stdout + done.stderr)
    return float(made.read_text(encoding="utf-8").splitlines()[-1].split(",")[0])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    tool = parser.parse_args().tool
    print("| waypoints |" + "".join(f" {curve}, `{mode}` |" for curve, mode in COLUMNS))
    print("|---|" + "---:|" * len(COLUMNS))
    times = []
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        (folder / "slides.urdf").write_text(SLIDES, encoding="utf-8")
        for count in WAYPOINTS:
            cells = []
            for curve, mode in COLUMNS:
                begin = time.perf_counter()
                cells.append(f"{duration(tool, folder, curve, count, mode):.2f}")
                times.append(time.perf_counter() - begin)
            print(f"| {count} | " + " | ".join(cells) + " |", flush=True)
        rests = ", ".join(f"{curve} {duration(tool, folder, curve, 1000, 'stop'):.0f}" for curve in CURVES)
    print(f"with rest at each of 1000 waypoints: {rests}")
    print(f"a retiming took {min(times):.2f} to {max(times):.2f} s")


if __name__ == "__main__":
    main()
