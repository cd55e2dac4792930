#!/usr/bin/env python3
"""Processor time for each step of scenes of Rigid IPC, beside what Rigid IPC took.

    benchmarks/dynamics/rigid_ipc.py [TOOL]

TOOL is build/release/apps/firstcontact by default; FIRSTCONTACT_DATA_DIR has the fixtures. Each scene is
simulated for its own duration, at most MOST_STEPS steps, without a file; times are the tool's own.
"""

import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MOST_STEPS = 500
UNITS = {"s": 1e3, "ms": 1.0, "µs": 1e-3, "ns": 1e-6}

# Milliseconds a step of Rigid IPC on a machine of this kind, and how many times faster we aim to be.
SCENES = {
    "unit-tests/tunneling": (18.0, 20),
    "unit-tests/tunnel/2-walls": (2.3, 5),
    "unit-tests/5-cubes": (2.4, 5),
    "mechanisms/bolt": (3400.0, 100),
    "unit-tests/bat": (8500.0, 100),
}


def milliseconds_a_step(tool: str, fixture: pathlib.Path) -> float:
    scene = json.loads(fixture.read_text(encoding="utf-8"))
    duration = min(scene.get("max_time", 5.0), MOST_STEPS * scene["timestep"])
    done = subprocess.run([tool, "simulate", str(fixture), "--duration", str(duration)],
                          capture_output=True, text=True, check=False)
    match = re.search(r"took +\S+ \S+, (\S+) (\S+) a step", done.stdout)
    if match is None or done.returncode != 0:
        sys.exit(f"error: {fixture}: {done.stderr or done.stdout}")
    return float(match[1]) * UNITS[match[2]]


def main() -> None:
    tool = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/apps/firstcontact")
    data = os.environ.get("FIRSTCONTACT_DATA_DIR") or str(ROOT.parent / "shared/data")
    fixtures = pathlib.Path(data) / "sim_rigid_ipc/fixtures/3D"
    print(f"{'scene':28} {'Rigid IPC':>12} {'firstcontact':>13} {'ratio':>8} {'target':>7}")
    for name, (peer, target) in SCENES.items():
        ours = milliseconds_a_step(tool, fixtures / f"{name}.json")
        print(f"{name:28} {peer:9.4g} ms {ours:10.4g} ms {peer / ours:8.0f} {target:7}", flush=True)


if __name__ == "__main__":
    main()
