#!/usr/bin/env python3
"""Processor time for each step of scenes of Rigid IPC, beside what Rigid IPC took.

    benchmarks/simulation/rigid_ipc.py [TOOL] [NAME]

TOOL is build/release/apps/firstcontact by default; FIRSTCONTACT_DATA_DIR has the fixtures. Each scene, or
those whose names contain NAME, is simulated for its own duration, at most MOST_STEPS steps and MOST_TIME
seconds; times are those of the processor.
"""

import json
import os
import pathlib
import resource
import signal
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MOST_STEPS = 500
MOST_TIME = 60  # [s]

# Milliseconds a step of Rigid IPC on a machine of this kind, and how many times faster we aim to be.
SCENES = {
    "unit-tests/tunneling": (18.0, 20),
    "unit-tests/tunnel/2-walls": (2.3, 5),
    "unit-tests/5-cubes": (2.4, 5),
    "mechanisms/bolt": (3400.0, 100),
    "unit-tests/bat": (8500.0, 100),
    "chain of five links": (783.0, 100),
    "wrecking ball and 575 bricks": (880.0, 100),
}


def chain(fixtures: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """The fixture of ten links, cut after the fifth that is free."""
    scene = json.loads((fixtures / "chain/10-links.json").read_text(encoding="utf-8"))
    bodies = scene["rigid_body_problem"]["rigid_bodies"][:6]
    for body in bodies:
        body["mesh"] = str(fixtures.parent.parent / "meshes" / body["mesh"])
    scene["rigid_body_problem"]["rigid_bodies"] = bodies
    path = folder / "chain.json"
    path.write_text(json.dumps(scene), encoding="utf-8")
    return path


def wrecking_ball(folder: pathlib.Path) -> pathlib.Path:
    path = folder / "wrecking_ball.json"
    subprocess.run([sys.executable, ROOT / "demo/simulations/make_wrecking_ball.py", path, "25", "23"],
                   check=True)
    return path


def scene_of(name: str, fixtures: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    if name.startswith("chain"):
        return chain(fixtures, folder)
    if name.startswith("wrecking"):
        return wrecking_ball(folder)
    return fixtures / f"{name}.json"


def step_and_duration(path: pathlib.Path) -> tuple[float, float]:
    """[s]"""
    scene = json.loads(path.read_text(encoding="utf-8"))
    if "simulation" in scene:
        return scene["simulation"]["step"], scene["simulation"]["duration"]
    return scene["timestep"], scene.get("max_time", 5.0)


def simulate(tool: str, scene: pathlib.Path, duration: float, run: pathlib.Path) -> tuple[float, int]:
    """The processor time [s] that it took, and the steps that were reached within MOST_TIME."""
    run.unlink(missing_ok=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([tool, "simulate", str(scene), "--duration", repr(duration), "-o", str(run)],
                          capture_output=True, text=True, check=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (MOST_TIME, MOST_TIME)))
    if done.returncode not in (0, -signal.SIGXCPU, -signal.SIGKILL):
        sys.exit(f"error: {scene}: {done.stderr or done.stdout}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    with run.open("rb") as lines:
        steps = sum(line.endswith(b"\n") for line in lines) - 1
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, steps


def milliseconds_a_step(tool: str, scene: pathlib.Path, folder: pathlib.Path) -> tuple[float, int]:
    """What one step takes of the rest of them: loading the scene is not of interest."""
    step, duration = step_and_duration(scene)
    count = min(round(duration / step), MOST_STEPS)
    run = folder / "run.jsonl"
    loading = min(simulate(tool, scene, step, run)[0] for _ in range(3))
    seconds, steps = simulate(tool, scene, count * step, run)
    return 1e3 * (seconds - loading) / max(1, steps - 1), steps


def main() -> None:
    tool = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/apps/firstcontact")
    only = sys.argv[2] if len(sys.argv) > 2 else ""
    data = os.environ.get("FIRSTCONTACT_DATA_DIR") or str(ROOT.parent / "shared/data")
    fixtures = pathlib.Path(data) / "sim_rigid_ipc/fixtures/3D"
    if not fixtures.is_dir():
        sys.exit(f"error: {fixtures}: no such folder; set FIRSTCONTACT_DATA_DIR")
    print(f"{'scene':28} {'Rigid IPC':>12} {'firstcontact':>13} {'steps':>6} {'ratio':>8} {'target':>7}")
    for name, (peer, target) in SCENES.items():
        if only not in name:
            continue
        with tempfile.TemporaryDirectory() as folder:
            scene = scene_of(name, fixtures, pathlib.Path(folder))
            ours, steps = milliseconds_a_step(tool, scene, pathlib.Path(folder))
        print(f"{name:28} {peer:9.4g} ms {ours:10.4g} ms {steps:6} {peer / ours:8.3g} {target:7}", flush=True)


if __name__ == "__main__":
    main()
