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
import sys

from campaign import simulate_and_verify


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
        ended = simulate_and_verify(asked.tool, fixture, min(own, asked.duration), asked.limit, name)
        status = 1 if 1 in (status, ended) else max(status, ended)
    return status


if __name__ == "__main__":
    sys.exit(main())
