#!/usr/bin/env python3
"""Records sessions of a simulated hand, and proves each of them as written.

    benchmarks/haptics/haptics_logs.py [TOOL] [SECONDS] [SCENE ...]

TOOL is build/release/apps/firstcontact by default. The scenes take SECONDS of haptic time together, an hour by
default: a needle at up to 5 m/s through a plate of 0.1 mm, pegs in their holes, a ball on a cylinder, a
nut on its bolt. With names of scenes, as in SESSIONS, only these run, with their shares of SECONDS. The nut is
slow: a proof of 0.1 s takes half a minute. Runs are removed once they are proven. Exit status 1 where one is not.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = ROOT / "benchmarks/haptics/scenes"

# Scene, seconds of a session, speed [m/s], radius [m] or None, share of the whole time.
SESSIONS = [
    ("thin_plate", 20, 5.0, 0.15, 0.5),
    ("ball_on_cylinder", 20, 1.0, 0.08, 0.2),
    ("cube_on_plate", 20, 1.0, 0.08, 0.25),
    ("peg_0_1", 10, 0.5, None, 0.04),
    ("peg_0_02", 10, 0.5, None, 0.01),
    ("nut_on_bolt", 0.1, 0.2, 0.01, 0.0003),
]


def prove(tool: str, scene: str, seconds: float, speed: float, radius: float | None, seed: int, run: pathlib.Path):
    """Seconds that were proven, the verdict, and the least distance [m]."""
    command = [tool, "haptics", str(SCENES / f"{scene}.json"), "--device", "simulated", "-o", str(run), "--force",
               "--duration", str(seconds), "--speed", str(speed), "--seed", str(seed)]
    if radius is not None:
        command += ["--radius", str(radius)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    proof = subprocess.run([tool, "verify", str(run), "--json"], stdout=subprocess.PIPE, check=False)
    answer = json.loads(proof.stdout)
    return answer["verdict"], answer["time"], answer.get("least_distance")


def main() -> int:
    tool = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/apps/firstcontact")
    whole = float(sys.argv[2]) if len(sys.argv) > 2 else 3600.0
    named = sys.argv[3:]
    if unknown := set(named) - {session[0] for session in SESSIONS}:
        print(f"no such scene: {', '.join(sorted(unknown))}", file=sys.stderr)
        return 2
    print(f"{'scene':18}{'sessions':>9}{'proven':>10}{'least gap':>12}{'took':>9}")
    status = 0
    with tempfile.TemporaryDirectory() as folder:
        run = pathlib.Path(folder) / "run.jsonl"
        for scene, seconds, speed, radius, share in SESSIONS:
            if named and scene not in named:
                continue
            begin = time.monotonic()
            proven, least = 0.0, float("inf")
            sessions = max(1, round(share * whole / seconds))
            for seed in range(1, sessions + 1):
                verdict, lasted, distance = prove(tool, scene, seconds, speed, radius, seed, run)
                if verdict != "proven":
                    print(f"{scene}, seed {seed}: {verdict}")
                    status = 1
                    continue
                proven += lasted
                least = min(least, distance if distance is not None else least)
            print(f"{scene:18}{sessions:>9}{proven:>8.4g} s{least * 1e6:>9.3g} um{time.monotonic() - begin:>7.0f} s", flush=True)
    return status


if __name__ == "__main__":
    sys.exit(main())
