#!/usr/bin/env python3
"""Processor time for each step of scenes of Rigid IPC, beside what Rigid IPC took.

    benchmarks/dynamics/rigid_ipc.py [TOOL]

TOOL is build/release/apps/firstcontact by default; FIRSTCONTACT_DATA_DIR has the fixtures. Each scene is
simulated for its own duration, at most MOST_STEPS steps, without a file; times are those of the processor.
"""

import json
import os
import pathlib
import resource
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MOST_STEPS = 500

# Milliseconds a step of Rigid IPC on a machine of this kind, and how many times faster we aim to be.
SCENES = {
    "unit-tests/tunneling": (18.0, 20),
    "unit-tests/tunnel/2-walls": (2.3, 5),
    "unit-tests/5-cubes": (2.4, 5),
    "mechanisms/bolt": (3400.0, 100),
    "unit-tests/bat": (8500.0, 100),
}


def processor_seconds(tool: str, fixture: pathlib.Path, duration: float) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([tool, "simulate", str(fixture), "--duration", repr(duration)],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"error: {fixture}: {done.stderr or done.stdout}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def milliseconds_a_step(tool: str, fixture: pathlib.Path) -> float:
    """What one step takes of the rest of them: loading the scene is not of interest."""
    scene = json.loads(fixture.read_text(encoding="utf-8"))
    step = scene["timestep"]
    steps = min(round(scene.get("max_time", 5.0) / step), MOST_STEPS)
    loading = min(processor_seconds(tool, fixture, step) for _ in range(3))
    return 1e3 * (processor_seconds(tool, fixture, steps * step) - loading) / (steps - 1)


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
