"""Which path leads out of a bug trap? Plans a proven path, prints its clearance, and checks it as a motion."""

import json
import pathlib
import sys

import firstcontact as fc
import numpy as np

FILE = pathlib.Path(__file__).resolve().parents[1] / "scenes/bug_trap.json"

answer = fc.plan(FILE)
print(f"{answer.verdict}: {len(answer.waypoints) - 1} edges, "
      f"{1e3 * answer.clearance.min():.3f} mm apart or more")
for first, second, times in answer.blocked[:3]:
    print(f"  {first} and {second} were in the way of {times} edges")

# The path as a motion of a scene. Its times are about proportional to the path of its corners.
scene = json.loads(FILE.read_text())
places = answer.waypoints
turns = 2 * np.arccos(np.clip(np.abs((places[1:, 3:] * places[:-1, 3:]).sum(axis=1)), 0, 1))
ways = np.linalg.norm(np.diff(places[:, :3], axis=0), axis=1) + 0.15 * turns
times = np.concatenate([[0], np.cumsum(ways)])
del scene["plan"]
bug = scene["bodies"][-1]
del bug["pose"]
bug["motion"] = {"type": "waypoints", "times": times.tolist(),
                 "poses": [{"position": place[:3].tolist(), "quaternion_wxyz": place[3:].tolist()}
                           for place in places]}
walls = [body["name"] for body in scene["bodies"][:-1]]
scene["pairs"] = {"groups": {"trap": walls}, "ignore": [["trap", "trap"]]}  # The walls touch each other.
result = fc.check(scene, closest=True)
print(f"as a motion: {result.verdict}, closest {1e3 * result.closest.distance:.3f} mm "
      f"from {' and '.join(result.closest.pair)}")
if len(sys.argv) > 1:
    result.save_html(sys.argv[1])
