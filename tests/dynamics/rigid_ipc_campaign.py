#!/usr/bin/env python3
"""Simulates scenes of Rigid IPC and verifies every run: by command, as it takes long.

    rigid_ipc_campaign.py TOOL FIXTURES [--duration 5] [--limit SECONDS] [NAME ...]

Every .json below FIXTURES whose path contains a NAME (all without one) is simulated for its own
duration, at most --duration seconds, and verified. Exit status 1 where any run is refuted or not
proven, 3 where a simulation lost time or did not end within --limit seconds of the wall clock.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile


def run(*command: str, limit: float) -> tuple:
    """Exit status and text; a command that takes too long is interrupted, and ends by itself."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        text, _ = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        process.send_signal(2)
        text, _ = process.communicate()
    return process.returncode, text


def fact(text: str, label: str) -> str:
    found = re.search(rf"^  {label} +(.*)$", text, re.MULTILINE)
    return found[1] if found else "?"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("tool")
    parser.add_argument("fixtures", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--duration", type=float, default=5.0)
    parser.add_argument("--limit", type=float, default=600.0)
    asked = parser.parse_args()
    status = 0
    for fixture in sorted(asked.fixtures.rglob("*.json")):
        name = str(fixture.relative_to(asked.fixtures).with_suffix(""))
        if asked.names and not any(part in name for part in asked.names):
            continue
        own = json.loads(fixture.read_text(encoding="utf-8")).get("max_time", asked.duration)
        with tempfile.TemporaryDirectory() as folder:
            record = str(pathlib.Path(folder) / "run.jsonl")
            simulated, text = run(asked.tool, "simulate", str(fixture), "--duration",
                                  str(min(own, asked.duration)), "-o", record, limit=asked.limit)
            verified, proof = run(asked.tool, "verify", record, limit=asked.limit)
        print(f"{name:55} {['whole', '', 'error', 'early'][simulated]:6} "
              f"{['proven', 'REFUTED', 'BROKEN', 'not proven'][verified]:11} steps {fact(text, 'steps')}; "
              f"lost {fact(text, 'time lost')}; {fact(text, 'took')}; least {fact(proof, 'least')}", flush=True)
        status = 1 if verified or status == 1 else max(status, simulated)
    return status


if __name__ == "__main__":
    sys.exit(main())
