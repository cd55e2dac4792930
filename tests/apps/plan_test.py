"""`firstcontact plan` as a user meets it: paths, exit status, errors that name what is wrong.

    plan_test.py TOOL SOURCE_DIR [unittest arguments]
"""

import hashlib
import json
import pathlib
import re
import signal
import sys
import time
import unittest

import tool_test

SOURCE = pathlib.Path()

WALL = {"name": "wall", "shape": {"box": {"size": [1e-5, 1, 1]}}}
CLOSED = {"name": "closed", "shape": {"box": {"size": [1e-5, 100, 100]}}}
PEG = {"name": "peg", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}}
GOAL = {"position": [0.5, 0.1, 0.25]}

URDF = """<robot name="gantry">
  <link name="base"/><link name="slide"/>
  <link name="tool"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="x" type="prismatic"><parent link="base"/><child link="slide"/>
    <axis xyz="1 0 0"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
  <joint name="z" type="prismatic"><parent link="slide"/><child link="tool"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
</robot>"""


def scene(plan, bodies=(WALL, PEG), **more):
    found = {"firstcontact": 1, "bodies": list(bodies), **more}
    if plan is not None:
        found["plan"] = plan
    return found


class Plan(tool_test.ToolTest):
    def plan(self, *arguments):
        return self.run_tool("plan", *arguments)

    def assert_writes_nothing(self, result, *words):
        self.assert_refused_with(result, *words)
        self.assertFalse((self.folder / "path.json").exists())

    def assert_schemas(self, path):
        """A path, its scene and the scene of which it was asked are as their schemas say."""
        try:
            import jsonschema
        except ImportError:
            return
        schemas = SOURCE / "src/firstcontact/scene_files/schema"
        for schema, value in [("path", path), ("scene", path["scene"]),
                              ("scene", json.loads((self.folder / "scene.json").read_text()))]:
            jsonschema.Draft202012Validator(json.loads((schemas / f"{schema}.json").read_text())).validate(value)

    def test_finds_a_path_and_writes_it(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "margin": 0.01}))
        result = self.plan("scene.json", "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("proven edge by edge", result.stdout)
        self.assertIn("in the way", result.stdout)
        self.assertIn("wall and peg", result.stdout)
        path = json.loads((self.folder / "path.json").read_text())
        self.assertEqual(path["verdict"], "proven")
        self.assertEqual(path["moves"], {"body": "peg"})
        self.assertEqual(path["waypoints"][0], [-0.5, 0, 0, 1, 0, 0, 0])
        self.assertEqual(path["waypoints"][-1], [0.5, 0.1, 0.25, 1, 0, 0, 0])
        self.assertEqual(len(path["edges"]), len(path["waypoints"]) - 1)
        self.assertTrue(all(edge["clearance"] >= 0.01 for edge in path["edges"]))
        self.assertNotIn("plan", path["scene"])
        self.assert_schemas(path)

    def test_plans_in_time_among_what_moves(self):
        door = {"name": "door", "shape": {"box": {"size": [0.02, 3, 3]}},
                "motion": {"type": "waypoints", "times": [0, 3, 6, 8],
                           "poses": [{"position": [0, y, 0]} for y in (0, 4, 0, 0)]}}
        question = {"body": "peg", "goal": {"position": [0.5, 0, 0]}, "speeds": {"linear": 1, "angular": 1},
                    "box": [[-1, -0.1, -0.1], [1, 0.1, 0.1]]}
        self.file("scene.json", scene(question, (door, PEG)))
        result = self.plan("scene.json", "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("and rests until 8 s", result.stdout)
        path = json.loads((self.folder / "path.json").read_text())
        self.assertEqual((path["times"][0], path["times"][-1]), (0, 8))
        verified = self.run_tool("verify", "path.json")
        self.assertEqual(verified.returncode, 0, verified)
        # The same places, but before the door is open.
        path["times"] = [0, *(0.1 * k for k in range(1, len(path["times"]) - 1)), 8]
        self.file("early.json", path)
        verified = self.run_tool("verify", "early.json")
        self.assertEqual(verified.returncode, 1, verified)
        (self.folder / "path.json").unlink()
        del question["speeds"]
        self.file("scene.json", scene(question, (door, PEG)))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "speeds")

    def test_plans_robots_that_change_places(self):
        self.file("gantry.urdf", URDF)
        robots = [{"name": name, "urdf": "gantry.urdf", "state": {"x": x}} for name, x in (("a", -0.5), ("b", 0.5))]
        question = {"robots": ["a", "b"], "goal": {"a/x": 0.5, "b/x": -0.5, "b/z": 0}}
        self.file("scene.json", {**scene(question, ()), "robots": robots})
        result = self.plan("scene.json", "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        path = json.loads((self.folder / "path.json").read_text())
        self.assert_schemas(path)
        self.assertEqual(path["moves"]["robots"], ["a", "b"])
        self.assertEqual(path["moves"]["joints"], ["a/x", "b/x", "b/z"])
        self.assertEqual(self.run_tool("verify", "path.json").returncode, 0)
        # One after the other they would meet.
        path["waypoints"] = [[-0.5, 0.5, 0], [0.5, 0.5, 0], [0.5, -0.5, 0]]
        path["edges"] = [{"verdict": "proven", "clearance": 0}] * 2
        path["clearance"] = 0
        self.file("false.json", path)
        self.assertEqual(self.run_tool("verify", "false.json").returncode, 1)
        # With times it is proven no more than without.
        retimed = self.run_tool("retime", "false.json", "--max-velocity", "1", "--max-acceleration", "1",
                                "-o", "motion.csv")
        self.assertEqual(retimed.returncode, 1, retimed)
        self.assertFalse((self.folder / "motion.csv").exists())

    def test_makes_a_page_that_plays_the_path(self):
        if not (pathlib.Path(tool_test.TOOL).parent.parent / "share/firstcontact/viewer.html").exists():
            self.skipTest("built without the viewer")
        self.file("scene.json", scene({"body": "peg", "goal": GOAL}))
        result = self.plan("scene.json", "--html", "page.html")
        self.assertEqual(result.returncode, 0, result)
        page = (self.folder / "page.html").read_text(encoding="utf-8")
        self.assertIn('"verdict": "free"', page.replace('"verdict":"free"', '"verdict": "free"'))
        self.assert_writes_nothing(self.plan("scene.json", "--html", "scene.json"), "scene.json")

    def test_is_the_same_for_a_seed_and_any_number_of_threads(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL}))
        paths = [json.loads(self.plan("scene.json", "--json", "--seed", "5", "--threads", threads).stdout)
                 for threads in ("1", "2")]
        for path in paths:
            del path["statistics"]["seconds"], path["statistics"]["first_path_seconds"]
        self.assertEqual(paths[0], paths[1])

    def test_plans_lazily(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "planner": "lazy_prm_star"}))
        path = json.loads(self.plan("scene.json", "--json").stdout)
        self.assertEqual((path["verdict"], path["planner"]["name"]), ("proven", "lazy_prm_star"))

    def test_moves_in_contact(self):
        for name in ("square_peg", "bug_trap"):
            question = SOURCE / "examples/scenes" / f"{name}.json"
            result = self.plan(str(question), "-o", "path.json")
            self.assertEqual(result.returncode, 0, result)
            self.assertIn("ends in contact", result.stdout)
            path = json.loads((self.folder / "path.json").read_text())
            self.assertEqual(path["planner"]["contacts"], "both")
            proof = self.run_tool("verify", "path.json")
            self.assertEqual(proof.returncode, 0, proof)
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "planner": "lazy_prm_star"}))
        (self.folder / "path.json").unlink()
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json", "--contacts", "slide"), "contacts",
                            "rrt_connect")
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "contacts": "roll"}))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "contacts", '"slide"')
        path = json.loads(self.plan("scene.json", "--json", "--contacts", "slide").stdout or "{}")
        self.assertEqual(path, {})

    def test_plans_a_robot_between_states(self):
        self.file("gantry.urdf", URDF)
        self.file("room.json", scene(None, [WALL]))
        result = self.plan("--robot", "gantry.urdf", "--environment", "room.json", "--start", "x=-1", "--goal",
                           "x=1", "--goal", "z=0.2", "--json")
        self.assertEqual(result.returncode, 0, result)
        path = json.loads(result.stdout)
        self.assertEqual(path["moves"], {"robot": "gantry", "joints": ["x", "z"], "turning": ["long", "long"]})
        self.assertEqual(path["waypoints"][0], [-1, 0])
        self.assertEqual(path["waypoints"][-1], [1, 0.2])

    def test_says_that_there_is_none(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "box": [[-1, -1, -1], [1, 1, 1]]}, [CLOSED, PEG]))
        result = self.plan("scene.json", "-o", "path.json", "--time", "0.2")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("no path was found", result.stdout)
        self.assertIn("closed and peg", result.stdout)
        self.assertFalse((self.folder / "path.json").exists())
        result = self.plan("scene.json", "-o", "path.json", "--time", "0.2", "--approximate")
        self.assertEqual(result.returncode, 3, result)
        path = json.loads((self.folder / "path.json").read_text())
        self.assertEqual((path["verdict"], path["goal"]), ("approximate", None))
        self.assertGreater(path["distance_to_goal"], 0)

    def test_refuses_a_start_that_is_the_goal(self):
        for key, goal, named in (("goal", PEG["pose"], "plan.goal:"), ("goals", [GOAL, PEG["pose"]], "plan.goals[1]:")):
            self.file("scene.json", scene({"body": "peg", key: goal}))
            self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), named, "the start itself")
        # Where a door moves, the peg may have to leave its place and come back.
        door = {"name": "door", "shape": {"box": {"size": [0.2, 0.2, 0.2]}}, "motion": {
            "type": "waypoints", "times": [0, 4], "poses": [{"position": [-0.5, y, 0]} for y in (3, -3)]}}
        question = {"body": "peg", "goal": PEG["pose"], "speeds": {"linear": 2, "angular": 2}, "box": [[-2, -2, -2], [2, 2, 2]]}
        self.file("scene.json", scene(question, (door, PEG)))
        self.assertEqual(self.plan("scene.json", "-o", "path.json").returncode, 0)

    def test_names_what_is_wrong(self):
        self.file("gantry.urdf", URDF)
        of_robot = {"robots": [{"name": "g", "urdf": "gantry.urdf", "state": {"x": -1}}]}
        cases = [
            (scene({"body": "peg", "goal": {"position": [0, 0, 0]}}), ["the goal", '"wall"', '"peg"', "deep"]),
            (scene({"body": "peg", "start": {"position": [0.02, 0, 0]}, "goal": GOAL}),
             ["the start", '"wall"', '"peg"', "nearest free configuration"]),
            (scene({"body": "nut", "goal": GOAL}), ['"nut"']),
            (scene({"body": "peg", "goal": GOAL, "time": 0}), ["time", "> 0"]),
            (scene(None), ['"plan"']),
            (scene({"goal": GOAL}), ["what moves"]),
            (scene({"goal": {"y": 1}}, [WALL], **of_robot), ['"y"']),
            (scene({"goal": {"x": 2.5}}, [WALL], **of_robot), ['"x"', "2.5", "limits"]),
            (scene({"start": {"x": -3}, "goal": {"x": 1}}, [WALL], **of_robot), ["plan.start", '"x"']),
            (scene({"body": "peg", "goal": GOAL}, [PEG, {**WALL, "motion": {
                "type": "constant_velocity", "from": {}, "translation": [0, 0, 1]}}]), ['"wall"', "moves"]),
        ]
        for content, words in cases:
            self.file("scene.json", content)
            with self.subTest(words=words):
                self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), *words)
        self.file("scene.json", json.dumps(scene({"body": "peg", "goal": GOAL})).replace("0.25", "NaN"))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "scene.json")
        self.assert_writes_nothing(self.plan("scene.json", "--time", "0"), "--time")
        self.assert_writes_nothing(self.plan(), "expected a SCENE, or --robot")
        self.assert_writes_nothing(self.plan("--robot", "gantry.urdf", "--start", "x=1", "--goal", "w=1"), '"w"')

    def test_takes_a_box_off_a_table(self):
        table = {"name": "table", "shape": {"box": {"size": [4, 4, 1]}}, "pose": {"position": [0, 0, -0.5]}}
        box = {"name": "box", "shape": {"box": {"size": [0.2, 0.2, 0.2]}}, "pose": {"position": [0, 0, 0.101]}}
        question = {"body": "box", "margin": 0.01, "goal": {"position": [1, 0, 0.5]}}
        self.file("scene.json", scene(question, (table, box)))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "the start is not free", '"table"',
                                   '"box"', "0.01 m", "nearest free configuration")
        question["contact_pairs"] = [{"pair": ["box", "table"], "policy": "must_open"}]
        self.file("scene.json", scene(question, (table, box)))
        result = self.plan("scene.json", "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("table and box at the start (must_open): apart by", result.stdout)
        path = json.loads((self.folder / "path.json").read_text())
        claim = path["contact_pairs"][0]
        self.assertEqual((claim["pair"], claim["policy"], claim["at"]), (["table", "box"], "must_open", "start"))
        self.assertAlmostEqual(claim["distance"], 0.001 * 15 / 16, places=6)
        verified = self.run_tool("verify", "path.json")
        self.assertEqual(verified.returncode, 0, verified)
        self.assertIn("must_open", verified.stdout)
        # A claim that holds less, and one that is left out: its edge has no other pair.
        self.file("edited.json", {**path, "contact_pairs": [{**claim, "distance": 0.5 * claim["distance"]}]})
        verified = self.run_tool("verify", "edited.json")
        self.assertEqual(verified.returncode, 1, verified)
        self.assertIn("less than its policy allows", verified.stdout)
        path.pop("contact_pairs")
        self.file("edited.json", path)
        self.assert_refused_with(self.run_tool("verify", "edited.json"), "Edge 0 has no clearance")
        claim["distance"] = 0
        self.file("edited.json", {**path, "contact_pairs": [claim]})
        self.assert_refused_with(self.run_tool("verify", "edited.json"), "edited.json", "> 0")

    def plan_off_a_part(self, policy, padding=0.0):
        """The path of a tool that starts 0.5 mm over a part, within its margin."""
        self.file("gantry.urdf", URDF)
        part = {"name": "part", "shape": {"box": {"size": [0.2, 0.2, 0.2]}}, "pose": {"position": [0, 0, -0.2005]}}
        fence = {"name": "fence", "shape": {"box": {"size": [0.01, 1, 0.3]}}, "pose": {"position": [0.5, 0, 0]}}
        robot = {"name": "g", "urdf": "gantry.urdf", "padding": {"tool": padding}}
        self.file("scene.json", scene({"goal": {"x": 1, "z": 0}, "margin": 0.001, "contact_pairs": [
            {"pair": ["g/tool", "part"], "policy": policy}]}, [part, fence], robots=[robot]))
        result = self.plan("scene.json", "-o", "path.json", *(["--html", "page.html"] if self.has_viewer() else []))
        self.assertEqual(result.returncode, 0, result)
        return json.loads((self.folder / "path.json").read_text())

    def has_viewer(self):
        return (pathlib.Path(tool_test.TOOL).parent.parent / "share/firstcontact/viewer.html").exists()

    def result_of_page(self, page):
        text = (self.folder / page).read_text(encoding="utf-8")
        data = re.findall(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', text, re.DOTALL)
        return json.loads(data[0])["result"]

    def test_retimes_what_is_in_contact(self):
        retime = ["retime", "path.json", "--max-acceleration", "2", "--max-jerk", "50", "-o", "way.json"]
        for policy, gap in (("may_stay", "250 µm"), ("not_deeper", "46[89][.0-9]* µm"), ("must_open", "46[89][.0-9]* µm")):
            path = self.plan_off_a_part(policy, padding=0.01)
            for mode in ("stop", "blend", "time_optimal"):
                result = self.run_tool(*retime, "--mode", mode)
                self.assertEqual(result.returncode, 0, result)
                until = " until .* m?s" if policy == "must_open" and len(path["waypoints"]) > 2 else ""
                self.assertRegex(result.stdout, rf"held +part and g/tool: more than {gap} apart{until}\n")
            # Held to more than it has, it is no longer proven, and nothing is written.
            (self.folder / "way.json").unlink()
            path["contact_pairs"][0]["distance"] = 0.000501
            self.file("path.json", path)
            result = self.run_tool(*retime)
            self.assertEqual(result.returncode, 1, result)
            self.assertIn("part and g/tool", result.stdout)
            self.assertFalse((self.folder / "way.json").exists())

    def test_page_holds_contact_pairs_in_place_of_paddings(self):
        if not self.has_viewer():
            self.skipTest("built without the viewer")
        path = self.plan_off_a_part("may_stay", padding=0.01)
        self.run_tool("retime", "path.json", "--max-acceleration", "2", "-o", "way.json", "--html", "way.html")
        for page in ("page.html", "way.html"):
            result = self.result_of_page(page)
            self.assertEqual(result["verdict"], "free")
            self.assertAlmostEqual(result["closest"]["distance"], 0.0005, places=8)
            self.assertGreater(result["clearance"], 0.0002)
            self.assertIn({"pair": ["part", "g/tool"], "margin": path["contact_pairs"][0]["distance"]},
                          [{key: pair[key] for key in ("pair", "margin")} for pair in result["pairs"]])

    def test_plans_a_body_among_robots(self):
        self.file("gantry.urdf", URDF)
        lifts = {"joint_names": ["x", "z"], "points": [
            {"time": t, "positions": [0, z]} for t, z in ((0, 0), (3, 1), (6, 0), (8, 0))]}
        resting = {"name": "g", "urdf": "gantry.urdf", "padding": {"tool": 0.02}, "state": {"x": 0, "z": 0}}
        moving = {"name": "g", "urdf": "gantry.urdf", "padding": {"tool": 0.02}, "trajectory": lifts}
        timed = {"speeds": {"linear": 1, "angular": 2}, "box": [[-1, -0.01, -0.01], [1, 0.01, 0.01]]}
        question = {"body": "peg", "goal": {"position": [0.5, 0, 0]}, "margin": 0.001}
        for robot, more in ((resting, {}), (moving, timed)):
            self.file("scene.json", scene({**question, **more}, [PEG], robots=[robot]))
            result = self.plan("scene.json", "-o", "path.json", *(["--html", "page.html"] if self.has_viewer() else []))
            self.assertEqual(result.returncode, 0, result)
            self.assertIn("peg and g/tool", result.stdout)
            verified = self.run_tool("verify", "path.json")
            self.assertEqual(verified.returncode, 0, verified)
            if self.has_viewer():
                self.assertEqual(self.result_of_page("page.html")["verdict"], "free")
            path = json.loads((self.folder / "path.json").read_text())
            self.assertEqual(path["moves"], {"body": "peg"})
            # Straight through where the tool is: no longer proven.
            path["waypoints"] = [path["waypoints"][0], path["waypoints"][-1]]
            if more:  # Before it is lifted high enough.
                path["waypoints"].append(path["waypoints"][-1])
                path["times"] = [0, 1, 8]
            path["edges"] = [{"verdict": "proven", "clearance": 0}] * (len(path["waypoints"]) - 1)
            path["clearance"] = 0
            self.file("straight.json", path)
            verified = self.run_tool("verify", "straight.json")
            self.assertEqual(verified.returncode, 1, verified)
            self.assertIn("peg", verified.stdout)
        # Beside a robot that moves the body needs speeds.
        (self.folder / "path.json").unlink()
        self.file("scene.json", scene(question, [PEG], robots=[moving]))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "speeds", '"g"')

    def test_plans_a_body_and_a_robot_at_once(self):
        self.file("gantry.urdf", URDF)
        robots = [{"name": "g", "urdf": "gantry.urdf", "state": {"x": 0.5, "z": 0}}]
        question = {"robot": "g", "body": "peg", "goal": {"g/x": -0.5, "peg": GOAL}, "box": [[-1, -1, -1], [1, 1, 1]]}
        self.file("scene.json", scene(question, [PEG], robots=robots))
        result = self.plan("scene.json", "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        self.assertEqual(self.run_tool("verify", "path.json").returncode, 0)
        path = json.loads((self.folder / "path.json").read_text(encoding="utf-8"))
        last = dict(zip(path["moves"]["joints"], path["waypoints"][-1]))
        self.assertAlmostEqual(last["g/x"], -0.5)
        self.assertEqual([last[f"peg/trans_{k}"] for k in "xyz"], GOAL["position"])
        (self.folder / "path.json").unlink()
        self.file("scene.json", scene({**question, "goal": GOAL}, [PEG], robots=robots))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "plan.goal.position", "ROBOT/NAME")

    def test_knows_before_it_plans_that_a_file_cannot_be_written(self):
        # No path would be found: then there would be nothing to write either.
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "time": 100}, [CLOSED, PEG]))
        self.assert_refused_with(self.plan("scene.json", "-o", "nowhere/path.json"), "nowhere/path.json")
        if self.has_viewer():
            self.assert_refused_with(self.plan("scene.json", "--html", "nowhere/path.html"), "nowhere/path.html")
        self.assert_refused_with(self.plan("scene.json", "-o", "."), ".")

    def test_says_where_a_scene_has_its_start_and_goal(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL}))
        for option, key in (("--start", "plan.start"), ("--goal", "plan.goal")):
            self.assert_refused_with(self.plan("scene.json", option, "x=1"), f"in a scene, say it in {key}")

    def test_moves_the_joints_of_a_requests_group(self):
        self.file("gantry.urdf", URDF)
        self.file("gantry.srdf", """<robot name="gantry"><group name="lift"><joint name="z"/></group>
            <group name="both"><chain base_link="base" tip_link="tool"/></group></robot>""")
        request = {"group_name": "lift", "goal_constraints": [{"position_constraints": [{
            "link_name": "tool", "constraint_region": {
                "primitives": [{"type": 2, "dimensions": [0.01]}], "primitive_poses": [{"position": [0, 0, 0.5]}]}}]}]}
        robot = ["--robot", "gantry.urdf", "--request", "request.json"]
        for group, joints in (("lift", ["z"]), ("both", ["x", "z"])):
            self.file("request.json", {**request, "group_name": group})
            result = self.plan(*robot, "--srdf", "gantry.srdf", "--json")
            self.assertEqual(result.returncode, 0, result)
            self.assertEqual(json.loads(result.stdout)["moves"]["joints"], joints)
        self.assert_refused_with(self.plan(*robot), "group_name", "SRDF")
        # A goal of joints moves the whole group, too.
        of_joints = {"group_name": "both", "goal_constraints": [{"joint_constraints": [
            {"joint_name": "x", "position": 0.5}]}]}
        self.file("request.json", of_joints)
        found = json.loads(self.plan(*robot, "--srdf", "gantry.srdf", "--json").stdout)
        self.assertEqual(found["moves"]["joints"], ["x", "z"])
        self.assertEqual(found["goals"], [[0.5, 0]])
        # Any of several goals will do: joints, poses of links, or both.
        def joints_at(x):
            return {"joint_constraints": [{"joint_name": "x", "position": x}]}
        self.file("request.json", {"group_name": "both", "goal_constraints": [joints_at(1.5), joints_at(0.5)]})
        found = json.loads(self.plan(*robot, "--srdf", "gantry.srdf", "--json", "-o", "path.json").stdout)
        self.assertEqual((found["verdict"], found["goals"]), ("proven", [[1.5, 0], [0.5, 0]]))
        self.assertEqual(found["waypoints"][-1], found["goals"][found["goal"]])
        self.assertEqual(self.run_tool("verify", "path.json").returncode, 0)
        self.file("request.json", {**request, "goal_constraints": [joints_at(1.5), *request["goal_constraints"]],
                                   "group_name": "both"})
        found = json.loads(self.plan(*robot, "--srdf", "gantry.srdf", "--json").stdout)
        self.assertEqual((found["verdict"], found["moves"]["joints"]), ("proven", ["x", "z"]))
        self.assertEqual(found["goals"][0], [1.5, 0])
        self.assertGreater(len(found["goals"]), 1)
        self.assertTrue(all(abs(x) <= 0.01 and abs(z - 0.5) <= 0.01 for x, z in found["goals"][1:]), found["goals"])
        # A goal out of reach is left out with a warning where another one is left.
        unreachable = {"position_constraints": [{**request["goal_constraints"][0]["position_constraints"][0],
            "constraint_region": {"primitives": [{"type": 2, "dimensions": [0.01]}],
                                  "primitive_poses": [{"position": [0, 5, 0]}]}}]}
        self.file("request.json", {"group_name": "both", "goal_constraints": [unreachable, joints_at(0.5)],
                                   "allowed_planning_time": 1})
        result = self.plan(*robot, "--srdf", "gantry.srdf", "--time", "1")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("link \"tool\"", result.stdout)
        # Goals without a group move the joints that they name.
        self.file("request.json", {"goal_constraints": [joints_at(0.5), {"joint_constraints": [
            {"joint_name": "z", "position": 0.25}]}]})
        found = json.loads(self.plan(*robot, "--json").stdout)
        self.assertEqual((found["moves"]["joints"], found["goals"]), (["x", "z"], [[0.5, 0], [0, 0.25]]))
        self.assert_refused_with(self.run_tool("check", *robot), "request.json", "expected one goal, got 2", "firstcontact plan")
        self.file("request.json", {"goal_constraints": []})
        self.assert_refused_with(self.plan(*robot), "goal_constraints", "expected a goal, got none")
        self.file("request.json", {**request, "group_name": "left"})
        self.assert_refused_with(self.plan(*robot, "--srdf", "gantry.srdf"), "group_name", "lift, both", '"left"')

    def test_takes_the_time_of_a_request(self):
        self.file("gantry.urdf", URDF)
        goal = {"goal_constraints": [{"joint_constraints": [{"joint_name": "x", "position": 0.5}]}]}
        robot = ["--robot", "gantry.urdf", "--request", "request.json", "--json"]

        def time_of(*options, **request):
            self.file("request.json", {**goal, **request})
            result = self.plan(*robot, *options)
            self.assertEqual(result.returncode, 0, result)
            return json.loads(result.stdout)["planner"]["time"]
        self.assertEqual(time_of(), 10)
        self.assertEqual(time_of(allowed_planning_time=60.5), 60.5)
        self.assertEqual(time_of("--time", "20", allowed_planning_time=60.5), 20)
        self.assertEqual(time_of(allowed_planning_time=0), 10)  # As a message has it unset.
        for wrong in (-1, "long", None):
            self.file("request.json", {**goal, "allowed_planning_time": wrong})
            self.assert_refused_with(self.plan(*robot), "request.json", "allowed_planning_time")
        for wrong in (".nan", ".inf", "1e999"):
            self.file("request.json", "allowed_planning_time: " + wrong + "\ngoal_constraints: "
                      "[{joint_constraints: [{joint_name: x, position: 0.5}]}]")
            self.assert_refused_with(self.plan(*robot), "request.json")

    def test_names_the_key_of_a_goal_beyond_a_limit(self):
        self.file("gantry.urdf", URDF)
        robots = [{"name": "g", "urdf": "gantry.urdf", "state": {"x": -1, "z": 0}}]
        for plan, key in (({"goal": {"x": 2.5}}, "scene.json: plan.goal: joint \"x\" is at 2.5"),
                          ({"goals": [{"x": 1}, {"x": 2.5}]}, "scene.json: plan.goals[1]: joint \"x\" is at 2.5"),
                          ({"goals": [{"x": 2.5}]}, "scene.json: plan.goals[0]: joint \"x\" is at 2.5"),
                          ({"start": {"x": -3}, "goal": {"x": 1}},
                           "scene.json: plan.start, or what it does not name: joint \"x\" is at -3")):
            self.file("scene.json", scene(plan, [WALL], robots=robots))
            self.assert_refused_with(self.plan("scene.json"), key, "outside of its limits -2 to 2")

    def test_says_that_a_scene_has_no_robots(self):
        self.file("scene.json", scene({"robot": "g", "goal": {"x": 1}}))
        self.assert_refused_with(self.plan("scene.json"), "plan.robot", '"g"', "the scene has no robots")

    def test_plans_retimes_and_verifies_with_a_load_that_touches_links(self):
        self.file("hand.urdf", URDF.replace("</robot>", """<link name="finger"><collision><geometry>
            <box size="0.02 0.1 0.1"/></geometry></collision></link><joint name="f" type="fixed"><parent link="tool"/>
            <child link="finger"/><origin xyz="0.115 0 -0.16"/></joint></robot>"""))
        load = {"name": "load", "shape": {"box": {"size": [0.22, 0.1, 0.1]}}}
        post = {"name": "post", "shape": {"box": {"size": [0.02, 1, 0.6]}}}
        held = {"body": "load", "link": "tool", "pose": {"position": [0, 0, -0.15]}}
        robot = {"name": "g", "urdf": "hand.urdf", "state": {"x": -0.6, "z": 0}}
        question = {"goal": {"x": 0.6, "z": 0}, "time": 60}
        self.file("scene.json", scene(question, [load, post], robots=[{**robot, "attached": [held]}]))
        self.assert_writes_nothing(self.plan("scene.json", "-o", "path.json"), "finger", "load")
        self.file("scene.json", scene(question, [load, post],
                                      robots=[{**robot, "attached": [{**held, "touch_links": ["finger"]}]}]))
        result = self.plan("scene.json", "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        path = json.loads((self.folder / "path.json").read_text())
        # The load is as low as 0.2 m below the tool, and the post 0.3 m high.
        self.assertGreater(max(z for _, z in path["waypoints"]), 0.5)
        self.assertEqual(self.run_tool("verify", "path.json", "--scene", "scene.json").returncode, 0)
        result = self.run_tool("retime", "path.json", "--max-acceleration", "3", "-o", "motion.csv")
        self.assertEqual(result.returncode, 0, result)
        self.assertTrue((self.folder / "motion.csv").exists())

    def test_its_path_is_refused_where_a_file_of_its_scene_has_changed(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL}))
        self.assertEqual(self.plan("scene.json", "-o", "a.json").returncode, 0)
        self.file("gantry.urdf", URDF)
        self.file("room.yaml", "world: {collision_objects: [{id: post, header: {frame_id: base}, primitives: "
                               "[{type: 1, dimensions: [0.1, 0.1, 0.1]}], primitive_poses: [{position: [9, 0, 0]}]}]}")
        self.file("ask.yaml", "goal_constraints: [{joint_constraints: [{joint_name: x, position: 0.5}]}]")
        asked = ("--robot", "gantry.urdf", "--environment", "room.yaml", "--request", "ask.yaml")
        self.assertEqual(self.plan(*asked, "-o", "b.json").returncode, 0)
        for path, names in (("a.json", ["scene.json"]), ("b.json", ["ask.yaml", "gantry.urdf", "room.yaml"])):
            sources = json.loads((self.folder / path).read_text())["sources"]
            self.assertEqual(sorted(source["file"] for source in sources), names)
            for name in names:
                if name == "gantry.urdf":
                    continue  # Without it the scene cannot be loaded.
                text = (self.folder / name).read_text()
                self.file(name, text + " ")
                result = self.run_tool("verify", path)
                self.assertEqual(result.returncode, 2, result)
                self.assertIn(f"{name} is not what it was", result.stderr)
                (self.folder / name).unlink()
                result = self.run_tool("verify", path)
                self.assertEqual(result.returncode, 0, result)
                self.assertIn(f"{name} is not found", result.stdout)
                self.file(name, text)
                self.assertEqual(self.run_tool("verify", path).returncode, 0)

    def test_files_of_its_path_are_found_from_any_folder(self):
        """As robots are: from the current folder, then from the folder of the path and those above it."""
        (self.folder / "in").mkdir()
        (self.folder / "else").mkdir()
        self.file("in/gantry.urdf", URDF)
        question = {"robots": [{"name": "g", "urdf": "gantry.urdf", "state": {"x": -1, "z": 0}}]}
        asked = scene({"goal": {"x": 1, "z": 0}}, [WALL], **question)
        wall = {"bodies": [{**WALL, "pose": {"position": [0, 0, 0.1]}}]}
        self.file("in/scene.json", asked)
        self.assertEqual(self.plan("in/scene.json", "-o", "in/path.json").returncode, 0)
        places = [(".", "in/path.json"), ("in", "path.json"), ("else", "../in/path.json")]
        for folder, path in places:
            result = self.run_tool_in(folder, "verify", path)
            self.assertEqual(result.returncode, 0, result)
            self.assertNotIn("is not found", result.stdout)
        self.file("in/scene.json", {**asked, **wall})
        for folder, path in places:
            for command in (("verify", path), ("retime", path, "--max-acceleration", "3", "-o", "out.csv")):
                result = self.run_tool_in(folder, *command)
                self.assertEqual(result.returncode, 2, (folder, result))
                self.assertIn("in/scene.json is not what it was", result.stderr)
        # A missing scene file is named; of the robot, whose file was compared, there is no word.
        (self.folder / "in/scene.json").unlink()
        for folder, path in places:
            result = self.run_tool_in(folder, "verify", path)
            self.assertEqual(result.returncode, 0, result)
            self.assertIn("in/scene.json is not found", result.stdout)
            self.assertNotIn("gantry.urdf is not found", result.stdout)

    def test_its_path_is_compared_with_its_scene(self):
        tetrahedron = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 {}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
        self.file("peg.obj", tetrahedron.format(0.1))
        peg = {"name": "peg", "shape": {"mesh": "peg.obj"}, "pose": {"position": [-0.5, 0, 0]}}
        question = {"body": "peg", "goal": GOAL, "margin": 0.01, "seed": 3}
        self.file("scene.json", scene(question, [WALL, peg]))
        self.assertEqual(self.plan("scene.json", "-o", "path.json").returncode, 0)
        compare = ("verify", "path.json", "--scene", "scene.json")
        self.assertEqual(self.run_tool(*compare).returncode, 0)
        # The scene file changes: the first key that differs is named, with both values.
        moved = {**WALL, "pose": {"position": [0, 0, 0.125]}}
        for changed, words in (
                (scene(question, [moved, peg]), ["scene.bodies[0].", "position[2] is 0", "0.125 by that file"]),
                (scene(question, [WALL]), []),
                (scene({**question, "goal": {"position": [0.5, 0.1, 0.5]}}, [WALL, peg]), ["goals[0][2] is 0.25", "0.5"]),
                (scene({**question, "start": {"position": [-0.4, 0, 0]}}, [WALL, peg]), ["-0.5", "-0.4"]),
                (scene({**question, "seed": 4}, [WALL, peg]), ["text has changed", "seed"]),
                (scene(None, [WALL, peg]), ['"plan"'])):
            self.file("scene.json", changed)
            self.assert_refused_with(self.run_tool(*compare), *words)
        self.file("scene.json", scene(question, [WALL, peg]))
        self.assertEqual(self.run_tool(*compare).returncode, 0)
        # The scene in the path is edited, with its digest: alone the path is proven, but not as one of the file.
        path = json.loads((self.folder / "path.json").read_text())
        text = (self.folder / "path.json").read_text()
        edited = text.replace('"size":[1e-05,1,1]', '"size":[1e-05,0.5,1]')
        self.assertNotEqual(edited, text)
        begin = edited.index('"scene":') + len('"scene":')
        _, end = json.JSONDecoder().raw_decode(edited, begin)
        digest = hashlib.sha256(edited[begin:end].encode()).hexdigest()
        self.file("path.json", edited.replace(path["resolved_digest"], digest))
        self.assertEqual(self.run_tool("verify", "path.json").returncode, 0)
        self.assert_refused_with(self.run_tool(*compare), "path.json: ", "scene.bodies[0].shape.", "size[1] is 0.5", "1 by that")
        self.file("path.json", text)
        # A mesh changes: its file is named.
        self.file("peg.obj", tetrahedron.format(0.05))
        self.assert_refused_with(self.run_tool(*compare), "peg.obj is not what it was")

    def test_compares_a_path_with_the_margin_of_its_scene(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "margin": 0.01}))
        self.assertEqual(self.plan("scene.json", "--margin", "0.002", "-o", "path.json").returncode, 0)
        result = self.run_tool("verify", "path.json", "--scene", "scene.json")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("margin of the path is 0.002 m, that of scene.json is 0.01 m", result.stdout)

    def test_compares_a_path_to_a_pose_of_a_link_with_its_scene(self):
        self.file("gantry.urdf", URDF)
        question = {"goal": {"link": "tool", "pose": {"position": [0.5, 0, 0.5]}}}
        robots = [{"name": "gantry", "urdf": "gantry.urdf"}]
        far = {**WALL, "pose": {"position": [5, 0, 0]}}
        self.file("scene.json", scene(question, [far], robots=robots))
        self.assertEqual(self.plan("scene.json", "-o", "path.json").returncode, 0)
        compared = self.run_tool("verify", "path.json", "--scene", "scene.json")
        self.assertEqual(compared.returncode, 0, compared)
        self.file("gantry.urdf", URDF.replace("0.2 0.2 0.2", "0.3 0.2 0.2"))
        self.assert_refused_with(self.run_tool("verify", "path.json", "--scene", "scene.json"), "gantry.urdf is not what it was")

    def test_prints_json_without_a_path_too(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "time": 0.2, "box": [[-1, -1, -1], [1, 1, 1]]}, [CLOSED, PEG]))
        result = self.plan("scene.json", "--json")
        self.assertEqual(result.returncode, 1, result)
        found = json.loads(result.stdout)
        self.assertEqual((found["firstcontact_plan"], found["verdict"]), (1, "none"))
        self.assertEqual(found["blocked"][0]["pair"], ["closed", "peg"])
        self.assertGreater(found["blocked"][0]["count"], 0)
        self.assertGreater(found["statistics"]["nodes"], 0)

    def test_never_writes_over_its_question(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL}))
        before = (self.folder / "scene.json").read_text()
        self.assertEqual(self.plan("scene.json", "-o", "scene.json").returncode, 2)
        self.assertEqual((self.folder / "scene.json").read_text(), before)

    def test_ends_when_it_is_interrupted(self):
        self.file("scene.json", scene({"body": "peg", "goal": GOAL, "time": 100}, [CLOSED, PEG]))
        process = self.start("plan", "scene.json", "-o", "path.json")
        process.send_signal(signal.SIGINT)  # Before the tool is ready for it, the signal ends it at once.
        process.communicate(timeout=60)
        self.assertIn(process.returncode, (1, -signal.SIGINT))
        self.assertFalse((self.folder / "path.json").exists())

    def test_keeps_the_best_path_when_it_is_interrupted(self):
        # Many links among many balls: edges take long, so that the search for shorter paths does.
        ball = "<collision><geometry><sphere radius=\"0.04\"/></geometry></collision>"
        links = ['<link name="l0"/>', *(f'<link name="l{k}">{ball}</link>' for k in range(1, 21))]
        joints = [f"""<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>
            <origin xyz="0.1 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""
                  for k in range(20)]
        self.file("chain.urdf", "".join(['<robot name="chain">', *links, *joints, "</robot>"]))
        # One is in the way, and the others are above and below.
        balls = [{"name": f"b{k}", "shape": {"sphere": {"radius": 0.05}},
                  "pose": {"position": [0.1 * k, 0.2, 0 if k == 14 else 0.15 * (-1) ** k]}} for k in range(20)]
        plan = {"goal": {"j0": 0.4, **{f"j{k}": 0 for k in range(1, 20)}}, "planner": "lazy_prm_star", "time": 1000}
        self.file("scene.json", scene(plan, balls, robots=[{"name": "c", "urdf": "chain.urdf"}]))
        # The signal has to come behind the first path, and before the search ends by itself.
        wait = 0.5
        for _ in range(40):
            process = self.start("plan", "scene.json", "-o", "path.json")
            time.sleep(wait)
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=120)
            if "when it was stopped" in out and process.returncode == 0:
                break
            wait = wait / 1.5 if process.returncode == 0 else wait * 1.3
        self.assertEqual(process.returncode, 0, out)
        self.assertIn("proven edge by edge", out)
        self.assertIn("when it was stopped", out)
        self.assertEqual(self.run_tool("verify", "path.json", "--scene", "scene.json").returncode, 0)

    def test_ends_when_it_is_interrupted_while_it_looks_for_places_of_a_pose(self):
        links = [f'<link name="l{k}"/>' for k in range(39)]
        links.append('<link name="l39"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>')
        joints = [f"""<joint name="j{k}" type="revolute"><parent link="l{k}"/><child link="l{k + 1}"/>
            <origin xyz="0.1 0 0"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>"""
                  for k in range(39)]
        self.file("chain.urdf", "".join(['<robot name="chain">', *links, *joints, "</robot>"]))
        # Out of reach: all tries, which take half a minute.
        plan = {"goal": {"link": "l39", "pose": {"position": [3.8, 0.5, 0]}}, "time": 300}
        self.file("scene.json", scene(plan, [], robots=[{"name": "c", "urdf": "chain.urdf"}]))
        process = self.start("plan", "scene.json", "-o", "path.json")
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        begin = time.monotonic()
        process.communicate(timeout=60)
        self.assertLess(time.monotonic() - begin, 5)
        self.assertIn(process.returncode, (1, -signal.SIGINT))
        self.assertFalse((self.folder / "path.json").exists())


if __name__ == "__main__":
    tool_test.TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
