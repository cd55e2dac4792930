"""Pages of `firstcontact plan` and of path files: the path as lines, the trees, and searches without a path.

    plan_page_test.py TOOL SOURCE_DIR [unittest arguments]
"""

import base64
import json
import math
import pathlib
import re
import signal
import struct
import sys
import time
import unittest

import plan_test
import tool_test

WALL = {"name": "wall", "shape": {"box": {"size": [0.01, 1, 1]}}}
PEG = {"name": "peg", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}}
CORK = {"name": "cork", "shape": {"box": {"size": [0.01, 100, 100]}}}
QUESTION = {"body": "peg", "goal": {"position": [0.5, 0, 0]}, "box": [[-1, -1, -1], [1, 1, 1]]}

ARM = """<robot name="arm"><link name="base"/>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.1 0.1"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="2" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/>
    <origin xyz="1 0 0"/><limit lower="-3" upper="3" velocity="2" effort="1"/></joint>
  <joint name="weld" type="fixed"><parent link="lower"/><child link="tip"/><origin xyz="0.5 0 0"/></joint></robot>"""
BALL = {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0.75, 1.0, 0]}}


def numbers(kind, text):
    data = base64.b64decode(text)
    return struct.unpack(f"<{len(data) // 4}{kind}", data)


def lines(traced):
    """The lines of a page, one for each edge."""
    flat = numbers("f", traced["points"])
    points = [[flat[k + i] + traced["origin"][i] for i in range(3)] for k in range(0, len(flat), 3)]
    until = numbers("I", traced["until"])
    return [points[begin:end] for begin, end in zip((0, *until), until)]


class PlanPage(tool_test.ToolTest):
    def setUp(self):
        super().setUp()
        self.viewer = pathlib.Path(tool_test.TOOL).resolve().parent.parent / "share/firstcontact/viewer.html"
        if not self.viewer.exists():
            self.skipTest("built without the viewer's page")

    def view_of(self, page):
        text = (self.folder / page).read_text(encoding="utf-8")
        return json.loads(re.search(r'type="application/json">(.*?)</script>', text, re.DOTALL)[1])["view"]

    def plan(self, question, bodies, *more, **scene):
        self.file("scene.json", plan_test.scene(question, bodies, **scene))
        return self.run_tool("plan", "scene.json", "--html", "page.html", *more)

    def assert_near(self, one, other):
        self.assertLess(math.dist(one, other), 1e-5, (one, other))

    def test_draws_the_path_of_a_body(self):
        result = self.plan(QUESTION, [WALL, PEG], "-o", "path.json")
        self.assertEqual(result.returncode, 0, result)
        path = json.loads((self.folder / "path.json").read_text())
        shown = self.view_of("page.html")["path"]
        self.assertEqual(shown["verdict"], "proven")
        self.assertEqual([edge["clearance"] for edge in shown["edges"]],
                         [edge["clearance"] for edge in path["edges"]])
        self.assertEqual([shown["edges"][0]["t"][0], shown["edges"][-1]["t"][1]], [0, 1])
        self.assertEqual([mover["name"] for mover in shown["movers"]], ["peg"])
        drawn = lines(shown["movers"][0])
        self.assertEqual(len(drawn), len(path["edges"]))
        for line, begin, end in zip(drawn, path["waypoints"], path["waypoints"][1:]):
            self.assert_near(line[0], begin[:3])
            self.assert_near(line[-1], end[:3])

    def test_traces_the_middle_of_a_body(self):
        far = {"vertices": [[2, 0, 0], [2.1, 0, 0], [2, 0.1, 0], [2, 0, 0.1]],
               "triangles": [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]}
        turned = {"position": [0, 0, 0], "rpy": [0, 0, 1.5]}
        result = self.plan({"body": "peg", "goal": turned}, [{"name": "peg", "shape": far}])
        self.assertEqual(result.returncode, 0, result)
        (line,) = lines(self.view_of("page.html")["path"]["movers"][0])
        self.assertGreater(len(line), 10)  # An arc.
        for point in line:
            self.assertAlmostEqual(math.hypot(point[0], point[1]), math.hypot(2.05, 0.05), 5)
            self.assertAlmostEqual(point[2], 0.05, 6)

    def test_traces_the_last_link_of_a_robot_that_has_geometry(self):
        self.file("arm.urdf", ARM)
        result = self.plan({"goal": {"shoulder": 2.5, "elbow": 1.0}}, [BALL], "-o", "path.json",
                           robots=[{"name": "arm", "urdf": "arm.urdf"}])
        self.assertEqual(result.returncode, 0, result)
        path = json.loads((self.folder / "path.json").read_text())
        shown = self.view_of("page.html")["path"]
        self.assertEqual(shown["movers"][0]["name"], "arm/lower")
        column = path["moves"]["joints"].index("shoulder")
        drawn = lines(shown["movers"][0])
        for line, begin, end in zip(drawn, path["waypoints"], path["waypoints"][1:]):
            for point, q in ((line[0], begin), (line[-1], end)):
                self.assert_near(point, [math.cos(q[column]), math.sin(q[column]), 0])
            for point in line:  # The elbow stays on its circle.
                self.assertAlmostEqual(math.hypot(*point), 1, 5)

    def test_draws_several_robots(self):
        self.file("arm.urdf", ARM)
        result = self.plan({"robots": ["one", "other"], "goal": {"one/shoulder": 1.0, "other/elbow": 1.0}}, [],
                           robots=[{"name": "one", "urdf": "arm.urdf"},
                                   {"name": "other", "urdf": "arm.urdf", "base": {"position": [5, 0, 0]}}])
        self.assertEqual(result.returncode, 0, result)
        movers = self.view_of("page.html")["path"]["movers"]
        # Of the first one the elbow rests: the upper arm takes the lower one with it.
        self.assertEqual([mover["name"] for mover in movers], ["one/lower", "other/lower"])
        self.assert_near(lines(movers[0])[-1][-1], [math.cos(1), math.sin(1), 0])
        self.assert_near(lines(movers[1])[-1][-1], [6, 0, 0])

    def test_has_the_trees(self):
        result = self.plan(QUESTION, [WALL, PEG])
        nodes = int(re.search(r"(\d+) configurations? in trees", result.stdout)[1])
        trees = self.view_of("page.html")["path"]["trees"]
        self.assertEqual([tree["kind"] for tree in trees], ["start", "goals"])
        self.assertEqual(sum(tree["places"] for tree in trees), nodes)
        for tree, root in zip(trees, ([-0.5, 0, 0], [0.5, 0, 0])):
            self.assertEqual(tree["edges"], tree["places"] - 1)
            drawn = lines(tree["movers"][0])
            self.assertEqual(len(drawn), tree["edges"])
            if drawn:
                self.assert_near(drawn[0][0], root)
        self.assertEqual(self.plan(QUESTION, [WALL, PEG], "--planner", "lazy_prm_star").returncode, 0)
        self.assertEqual([tree["kind"] for tree in self.view_of("page.html")["path"]["trees"]], ["roadmap"])

    def test_shows_a_search_without_a_path(self):
        result = self.plan(QUESTION, [CORK, PEG], "--time", "0.3", "-o", "path.json")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("  page       page.html\n", result.stdout)
        self.assertFalse((self.folder / "path.json").exists())
        shown = self.view_of("page.html")["path"]
        self.assertEqual((shown["verdict"], shown["edges"]), ("none", []))
        self.assertEqual(shown["blocked"][0]["pair"], ["cork", "peg"])
        count = re.search(r"cork and peg \((\d+) times\)", result.stdout)[1]
        self.assertEqual(shown["blocked"][0]["count"], int(count))
        self.assertEqual([one["body"] for one in shown["goal"]], [1])
        self.assertEqual(shown["goal"][0]["position"], [0.5, 0, 0])
        self.assertGreater(min(tree["places"] for tree in shown["trees"]), 1)
        # No tree gets past the cork.
        for tree, side in zip(shown["trees"], (-1, 1)):
            self.assertTrue(all(side * point[0] > 0 for line in lines(tree["movers"][0]) for point in line))

    def test_shows_a_robot_at_its_goal_where_there_is_no_path(self):
        self.file("arm.urdf", ARM)
        fence = {"name": "fence", "shape": {"box": {"size": [0.02, 9, 9]}},
                 "pose": {"position": [0.5, 5, 0]}}
        result = self.plan({"goal": {"shoulder": 2.5}}, [fence], "--time", "0.2",
                           robots=[{"name": "arm", "urdf": "arm.urdf"}])
        self.assertEqual(result.returncode, 1, result)
        goal = {one["body"]: one for one in self.view_of("page.html")["path"]["goal"]}
        self.assertEqual(sorted(goal), [2, 3, 4])  # Bodies come first, then links; the base rests.
        self.assert_near(goal[3]["position"], [math.cos(2.5), math.sin(2.5), 0])

    def test_shows_a_search_that_was_interrupted(self):
        self.file("scene.json", plan_test.scene({**QUESTION, "time": 100}, [CORK, PEG]))
        process = self.start("plan", "scene.json", "--html", "page.html")
        time.sleep(1)
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        if process.returncode == -signal.SIGINT:
            self.skipTest("the tool was not ready for the signal")
        self.assertEqual(process.returncode, 1)
        self.assertIn("when it was stopped", out)
        self.assertIn("  page       page.html\n", out)
        self.assertEqual(self.view_of("page.html")["path"]["verdict"], "none")

    def test_draws_a_path_that_ends_before_its_goal(self):
        result = self.plan(QUESTION, [CORK, PEG], "--time", "0.3", "--approximate", "-o", "path.json")
        self.assertEqual(result.returncode, 3, result)
        self.assertIn("  page       page.html\n", result.stdout)
        path = json.loads((self.folder / "path.json").read_text())
        shown = self.view_of("page.html")["path"]
        self.assertEqual((shown["verdict"], shown["goal"]), ("approximate", []))
        self.assert_near(lines(shown["movers"][0])[-1][-1], path["waypoints"][-1][:3])

    def test_views_a_path_file(self):
        self.assertEqual(self.plan(QUESTION, [WALL, PEG], "-o", "path.json").returncode, 0)
        result = self.run_tool("view", "path.json", "--no-open")
        self.assertEqual((result.returncode, result.stdout), (0, "path.html\n"), result)
        planned, viewed = self.view_of("page.html"), self.view_of("path.html")
        self.assertEqual(viewed["path"]["trees"], [])
        self.assertEqual({**planned["path"], "trees": []}, viewed["path"])
        self.assertEqual(planned["gap"], viewed["gap"])
        self.assertEqual(planned["meshes"], viewed["meshes"])

    def test_views_no_path_whose_files_have_changed(self):
        self.file("peg.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
        peg = {**PEG, "shape": {"mesh": "peg.obj"}}
        self.assertEqual(self.plan(QUESTION, [WALL, peg], "-o", "path.json").returncode, 0)
        self.assertEqual(self.run_tool("view", "path.json", "--no-open").returncode, 0)
        self.file("peg.obj", "v 0 0 0\nv 0.2 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n")
        self.assert_refused_with(self.run_tool("view", "path.json", "--no-open", "-o", "new.html"), "path.json")
        self.assertFalse((self.folder / "new.html").exists())

    def test_views_no_path_over_itself(self):
        self.assertEqual(self.plan(QUESTION, [WALL, PEG], "-o", "path.json").returncode, 0)
        self.assert_refused_with(self.run_tool("view", "path.json", "--no-open", "-o", "path.json"), "path.json")


if __name__ == "__main__":
    tool_test.TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    plan_test.SOURCE = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
