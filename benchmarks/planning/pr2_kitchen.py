#!/usr/bin/env python3
"""Writes the scene of hpp_benchmark's PR2 in the kitchen, for planning_benchmark --scene.

    pr2_kitchen.py DATA FOLDER

DATA is the folder of data sets (FIRSTCONTACT_DATA_DIR), with planning_hpp and the PR2. The robot
gets a planar joint below its base, bounded as in the benchmark; all its joints are planned. The
kitchen is a robot that rests. FOLDER gets pr2.urdf and pr2_kitchen.json.
"""

import argparse
import json
import pathlib
from xml.etree import ElementTree

PLANAR = """  <link name="floor"/>
  <joint name="base" type="planar">
    <parent link="floor"/>
    <child link="base_footprint"/>
    <axis xyz="0 0 1"/>
  </joint>
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    arguments = parser.parse_args()
    data = arguments.data.resolve()
    model = data / "robots/example-robot-data/robots/pr2_description"
    urdf = (model / "urdf/pr2.urdf").read_text(encoding="utf-8")
    (arguments.folder / "pr2.urdf").write_text(urdf.replace("</robot>", PLANAR + "</robot>"), encoding="utf-8")
    moving = [joint.get("name") for joint in ElementTree.fromstring(urdf).iter("joint")
              if joint.get("type") in ("revolute", "prismatic", "continuous") and joint.find("mimic") is None]
    place = {"base/x": -3.2, "base/y": -4.0}
    goal = {**place, "torso_lift_joint": 0.0, "l_shoulder_lift_joint": 0.5, "r_shoulder_lift_joint": 0.5,
            "l_elbow_flex_joint": -0.5, "r_elbow_flex_joint": -0.5}
    scene = {
        "firstcontact": 1, "id": "PR2 in the kitchen", "package_roots": [str(data / "robots")],
        "robots": [
            {"name": "pr2", "urdf": "pr2.urdf", "srdf": str(model / "srdf/pr2.srdf")},
            {"name": "kitchen", "urdf": str(data / "planning_hpp/hpp_tutorial/urdf/kitchen_area.urdf")}],
        "plan": {"robot": "pr2", "joints": ["base/x", "base/y", "base/theta", *moving],
                 "start": {**place, "torso_lift_joint": 0.2}, "goal": goal,
                 "bounds": {"base/x": [-4, -3], "base/y": [-5, -3]}}}
    (arguments.folder / "pr2_kitchen.json").write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
