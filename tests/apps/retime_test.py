"""`firstcontact retime` as a user meets it: what it writes, what it refuses, and its exit status.

    retime_test.py TOOL SOURCE_DIR [unittest arguments]
"""

import csv
import json
import pathlib
import sys
import unittest

import tool_test

SOURCE = pathlib.Path()

URDF = """<robot name="arm"><link name="base"/>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.1 0.1"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="2" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/>
    <origin xyz="1 0 0"/><limit lower="-3" upper="3" velocity="2" effort="1"/></joint></robot>"""
# On the upper arm's way to 1.5 rad.
BALL = """world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}],
  primitive_poses: [{position: [0.07, 0.9, 0]}]}]}"""
LIMITS = """joint_limits:
  shoulder: {has_velocity_limits: true, max_velocity: 1.5, has_acceleration_limits: true, max_acceleration: 5.0,
             has_jerk_limits: true, max_jerk: 100.0}
  elbow: {has_velocity_limits: false, has_acceleration_limits: true, max_acceleration: 8.0,
          has_jerk_limits: true, max_jerk: 200.0}
"""


class Retime(tool_test.ToolTest):
    def setUp(self):
        super().setUp()
        self.robot = self.file("arm.urdf", URDF)
        self.ball = self.file("ball.yaml", BALL)
        self.limits = self.file("limits.yaml", LIMITS)
        self.way = self.file("way.csv", "time,shoulder,elbow\n0,0,0\n1,1,0\n2,1,1\n3,0,0.5\n")

    def retime(self, *more: str, out: str = "out.yaml"):
        return self.run_tool("retime", "--robot", self.robot, "--limits", self.limits, "-o", out, *more)

    def lines(self, stdout: str) -> dict:
        return {line[2:15].strip(): line[15:] for line in stdout.splitlines()[1:]}

    def test_writes_what_check_finds_free(self):
        durations = []
        for mode in ["stop", "blend", "time_optimal"]:
            for ending in ["yaml", "json", "csv"]:
                out = f"{mode}.{ending}"
                result = self.retime("--trajectory", self.way, "--environment", self.ball, "--mode", mode, out=out)
                self.assertEqual(result.returncode, 0, result)
                self.assertIn(f"{self.way}: proven", result.stdout)
                self.assertEqual(self.lines(result.stdout)["written"], out)
                self.assertTrue(self.lines(result.stdout)["mode"].startswith(mode), result.stdout)
                check = self.run_tool("check", "--robot", self.robot, "--trajectory", out, "--environment", self.ball,
                                      "--strict")
                self.assertEqual(check.returncode, 0, check)
            message = json.loads((self.folder / f"{mode}.json").read_text())
            self.assertEqual(message["joint_names"], ["shoulder", "elbow"])
            self.assertEqual(message["points"][0]["positions"], [0, 0])
            self.assertEqual(message["points"][-1]["positions"], [0, 0.5])
            self.assertEqual(message["points"][-1]["velocities"], [0, 0])
            times = [p["time_from_start"]["sec"] * 10**9 + p["time_from_start"]["nanosec"] for p in message["points"]]
            self.assertEqual(times, sorted(set(times)))
            durations.append(times[-1])
        self.assertLess(durations[1], durations[0])
        self.assertLessEqual(durations[2], durations[1])

    def test_names_the_turns_of_continuous_joints(self):
        """The shoulder goes the short way to 7 rad, which is 0.72 rad."""
        robot = self.file("turning.urdf", URDF.replace('"shoulder" type="revolute"', '"shoulder" type="continuous"')
                          .replace('lower="-3" upper="3" velocity="2" effort="1"/></joint>\n  <joint name="elbow"',
                                   'velocity="2" effort="1"/></joint>\n  <joint name="elbow"'))
        for end, turns in (("7", "shoulder ends at 0.716815 rad, 1 turn from the 7 rad of the path"), ("0.7", None)):
            way = self.file("turn.csv", f"time,shoulder,elbow\n0,0,0\n1,{end},0.5\n")
            for mode in ("stop", "time_optimal"):
                result = self.run_tool("retime", "--robot", robot, "--limits", self.limits, "--trajectory", way,
                                       "--mode", mode, "-o", "turned.csv", "--turning", "short")
                self.assertEqual(result.returncode, 0, result)
                self.assertEqual(self.lines(result.stdout).get("turns"), turns)

    def test_leaves_out_waypoints_on_straight_edges(self):
        rows = "".join(f"{k},{k / 300},{-k / 600}\n" for k in range(301))
        way = self.file("fine.csv", "time,shoulder,elbow\n" + rows)
        for mode in ["blend", "time_optimal"]:
            result = self.retime("--trajectory", way, "--mode", mode)
            self.assertEqual(result.returncode, 0, result)
            self.assertIn("passes 0 of 299 waypoints on blends, 0 made shorter to be free; 299 on straight edges",
                          self.lines(result.stdout)["mode"])

    def test_blend_deviation(self):
        durations = []
        for deviation in ["0.001", "0.1"]:
            result = self.retime("--trajectory", self.way, "--mode", "blend", "--blend-deviation", deviation,
                                 out="out.csv")
            self.assertEqual(result.returncode, 0, result)
            durations.append(float((self.folder / "out.csv").read_text().splitlines()[-1].split(",")[0]))
        self.assertLess(durations[1], durations[0])
        self.assertEqual(self.retime("--trajectory", self.way, "--blend-deviation", "0").returncode, 2)

    def test_names_pair_and_time_where_there_is_none(self):
        way = self.file("blocked.csv", "time,shoulder,elbow\n0,0,0\n1,1.5,0\n")
        result = self.retime("--trajectory", way, "--environment", self.ball, "--mode", "blend")
        self.assertEqual(result.returncode, 1, result)
        self.assertRegex(result.stdout, r"contact +at [\d.]+ \w+ of [\d.]+ s: ball and arm/upper")
        self.assertFalse((self.folder / "out.yaml").exists())

    def test_tracking_error_counts(self):
        arguments = ["--trajectory", self.way, "--environment", self.ball]
        self.assertEqual(self.retime(*arguments, "--tracking-error", "0.01").returncode, 0)
        self.assertEqual(self.retime(*arguments, "--tracking-error", "0.5").returncode, 1)

    def test_without_jerk_limits_it_writes_cubics(self):
        result = self.run_tool("retime", "--robot", self.robot, "--trajectory", self.way, "--max-acceleration", "4",
                               "-o", "out.json")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("with cubics between them", result.stdout)
        self.assertNotIn("accelerations", json.loads((self.folder / "out.json").read_text())["points"][0])

    def path_file(self) -> str:
        """The path that `plan` finds in a scene of the arm and the ball."""
        self.file("scene.json", json.dumps({
            "firstcontact": 1,
            "bodies": [{"name": "ball", "shape": {"sphere": {"radius": 0.1}},
                        "motion": {"type": "fixed", "pose": {"position": [0.07, 0.9, 0]}}}],
            "robots": [{"name": "arm", "urdf": self.robot, "state": {"shoulder": 0, "elbow": 0}}],
            "plan": {"robot": "arm", "joints": ["elbow", "shoulder"], "goal": {"elbow": 1, "shoulder": 1}}}))
        plan = self.run_tool("plan", "scene.json", "-o", "path.json")
        self.assertEqual(plan.returncode, 0, plan)
        return "path.json"

    def test_takes_a_path(self):
        path = self.path_file()
        result = self.run_tool("retime", path, "--limits", self.limits, "--mode", "blend", "-o", "out.csv")
        self.assertEqual(result.returncode, 0, result)
        header = (self.folder / "out.csv").read_text().splitlines()[0]
        self.assertTrue(header.startswith("time,elbow,shoulder,elbow.velocity"), header)
        self.file("arm.urdf", URDF.replace("1 0.1 0.1", "1 0.2 0.1"))
        self.assert_refused(
            self.run_tool("retime", path, "--limits", self.limits, "-o", "out.csv"),
            f"{path}: arm.urdf is not what it was when the path was planned; restore the file, or plan again")

    def test_refuses_a_path_that_is_not_one_of_its_scene(self):
        path = self.path_file()
        arguments = ("--limits", self.limits, "-o", "out.csv")
        scene = (self.folder / "scene.json").read_text()
        self.file("scene.json", scene.replace("0.07", "0.08"))
        self.assert_refused(
            self.run_tool("retime", path, *arguments),
            f"{path}: scene.json is not what it was when the path was planned; restore the file, or plan again")
        # A missing scene file is a warning, as in verify.
        (self.folder / "scene.json").unlink()
        result = self.run_tool("retime", path, *arguments)
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("scene.json is not found", result.stdout)
        planned = json.loads((self.folder / path).read_text())
        planned["waypoints"][0] = [0.125, 0]
        self.file("moved.json", planned)
        for command in (("verify", "moved.json"), ("retime", "moved.json", *arguments)):
            result = self.run_tool(*command)
            self.assertNotEqual(result.returncode, 0, result)
            self.assertIn('does not begin where its scene has joint "elbow"', (result.stdout + result.stderr))
        self.assertEqual(self.run_tool("retime", "moved.json", *arguments).returncode, 2)

    def test_proves_what_plan_has_proven_with_tracking_errors(self):
        """The windows of time of the trajectory are others than those of the edges."""
        links = "".join(f'<link name="l{k}"><collision><origin xyz="0.15 0 0"/><geometry><sphere radius="0.04"/>'
                        "</geometry></collision></link>" for k in range(1, 6))
        joints = "".join(
            f'<joint name="j{k}" type="revolute"><parent link="{"b" if k == 0 else f"l{k - 1}"}"/>'
            f'<child link="l{k}"/><origin xyz="{0.2 if k else 0} 0 0"/><axis xyz="{"0 1 0" if k % 2 else "0 0 1"}"/>'
            '<limit lower="-3" upper="3" velocity="1" effort="1"/></joint>' for k in range(6))
        self.file("six.urdf", f'<robot name="six"><link name="b"/><link name="l0"/>{links}{joints}</robot>')
        start = dict(zip(["j0", "j1", "j2", "j3", "j4", "j5"], [-1, 0.1, 0.2, 0, 0.3, 0]))
        goal = dict(zip(start, [1, 0, -0.2, 0.3, 0, 0.2]))
        for seed in (2, 7, 11):
            for error in (0.002, 0.005, 0.02):
                self.file("scene.json", {
                    "firstcontact": 1,
                    "bodies": [{"name": "ball", "shape": {"sphere": {"radius": 0.3}}, "pose": {"position": [0.8, 0, 0]}}],
                    "robots": [{"name": "g", "urdf": "six.urdf", "state": start, "tracking_error": error}],
                    "plan": {"goal": goal, "seed": seed}})
                for command in (("plan", "scene.json", "-o", "path.json"), ("verify", "path.json"),
                                ("retime", "path.json", "--max-acceleration", "3", "-o", "out.csv")):
                    result = self.run_tool(*command)
                    self.assertEqual(result.returncode, 0, (seed, error, result))

    def test_says_what_is_wrong(self):
        def way(text: str) -> str:
            return self.file("w.csv", "time,shoulder,elbow\n" + text)

        def limits(old: str, new: str) -> str:
            return self.file("l.yaml", LIMITS.replace(old, new))

        one, repeated = way("0,0,0\n"), "time,shoulder,elbow\n0,0,0\n1,1,1\n2,1,1\n"
        self.assert_refused(self.retime("--trajectory", one),
                            "w.csv: expected a path of two waypoints or more, got 1")
        self.assert_refused(self.retime("--trajectory", self.file("r.csv", repeated)),
                            "r.csv: waypoint 3: it repeats the waypoint before it; leave one of them out")
        plain = ["retime", "--robot", self.robot, "--trajectory", self.way, "-o", "out.yaml"]
        self.assert_refused(self.run_tool(*plain),
                            f'{self.way}: joint "shoulder": expected a limit of the acceleration, got none')
        for old, new, place in [("max_velocity: 1.5", "max_velocity: 0", "joint_limits.shoulder.max_velocity"),
                                ("max_jerk: 200.0", "max_jerk: -1", "joint_limits.elbow.max_jerk"),
                                ("max_acceleration: 5.0", "max_acceleration: .nan",
                                 "joint_limits.shoulder.max_acceleration"),
                                ("shoulder:", "shoulde:", "joint_limits.shoulde")]:
            result = self.run_tool(*plain, "--limits", limits(old, new))
            self.assertEqual(result.returncode, 2, result)
            self.assertIn(place, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1)
        for option in ["--max-velocity", "--max-acceleration", "--max-jerk"]:
            for bad in ["0", "-1", "nan"]:
                self.assertEqual(self.run_tool(*plain, option, bad).returncode, 2)
        self.assertEqual(self.retime("--trajectory", self.way, out="out.txt").returncode, 2)
        self.assertEqual(self.retime("--trajectory", self.way, "--mode", "fast").returncode, 2)
        self.assertEqual(self.run_tool("retime", "-o", "out.yaml").returncode, 2)
        self.assertFalse((self.folder / "out.yaml").exists())


    def test_keeps_the_factors_of_a_request(self):
        request = {"start_state": {"joint_state": {"name": ["shoulder", "elbow"], "position": [0, 0]}},
                   "goal_constraints": [{"joint_constraints": [{"joint_name": "shoulder", "position": 1}]}]}
        durations = {}
        for velocity, acceleration in ((1, 1), (0, 0), (0.1, 1), (1, 0.1)):
            file = self.file("request.json", {**request, "max_velocity_scaling_factor": velocity,
                                              "max_acceleration_scaling_factor": acceleration})
            result = self.retime("--request", file, out="out.json")
            self.assertEqual(result.returncode, 0, result)
            last = json.loads((self.folder / "out.json").read_text())["points"][-1]["time_from_start"]
            durations[velocity, acceleration] = last["sec"] + 1e-9 * last["nanosec"]
        self.assertEqual(durations[0, 0], durations[1, 1])  # 0 is unset.
        self.assertGreater(durations[0.1, 1], 1 / 0.15)
        self.assertGreater(durations[1, 0.1], 2 * (1 / 0.5) ** 0.5)
        ends = []
        for velocity in (1, 0.1):  # Checked motions are as slow.
            file = self.file("request.json", {**request, "max_velocity_scaling_factor": velocity})
            checked = json.loads(self.run_tool("check", "--robot", self.robot, "--request", file, "--json").stdout)
            ends.append(checked["scene"]["robots"][0]["trajectory"]["points"][-1]["time"])
        self.assertAlmostEqual(ends[1], 10 * ends[0])
        for key, value in (("max_velocity_scaling_factor", 1.5), ("max_acceleration_scaling_factor", -1),
                           ("max_cartesian_speed", 0.2)):
            file = self.file("request.json", {**request, key: value})
            self.assert_refused_with(self.retime("--request", file), "request.json", key)

    def test_keeps_the_positions_of_the_limits(self):
        def retime(elbow: str) -> object:
            limits = self.file("l.yaml", LIMITS.replace("  elbow: {", "  elbow: {" + elbow))
            return self.run_tool("retime", "--robot", self.robot, "--trajectory", self.way, "--limits", limits,
                                 "-o", "out.yaml")

        self.assertEqual(retime("has_position_limits: true, min_position: 0, max_position: 1, ").returncode, 0)
        (self.folder / "out.yaml").unlink()
        result = retime("has_position_limits: true, min_position: 0, max_position: 0.5, ")
        self.assertEqual(result.returncode, 1, result)
        self.assertRegex(result.stdout, "limit +.*elbow.*0.5")
        self.assertFalse((self.folder / "out.yaml").exists())
        self.assertEqual(retime("has_position_limits: false, max_position: 0.5, ").returncode, 0)

    def test_knows_before_its_work_that_a_file_cannot_be_written(self):
        self.assert_refused_with(self.retime("--trajectory", self.way, out="nowhere/out.yaml"), "nowhere/out.yaml")

    def test_names_a_joint_that_a_table_cannot_have(self):
        self.robot = self.file("arm.urdf", URDF.replace('"elbow"', '"time"'))
        limits = self.file("limits.yaml", LIMITS.replace("elbow:", "time:"))
        way = self.file("way.json", {"joint_names": ["shoulder", "time"], "points": [
            {"positions": [0, 0], "time_from_start": {"sec": 0, "nanosec": 0}},
            {"positions": [1, 1], "time_from_start": {"sec": 1, "nanosec": 0}}]})
        retime = ["retime", "--robot", self.robot, "--limits", limits, "--trajectory", way, "-o"]
        self.assert_refused_with(self.run_tool(*retime, "out.csv"), 'joint "time"', ".csv", "another format")
        self.assertEqual(self.run_tool(*retime, "out.yaml").returncode, 0)


class RetimeSeveralRobots(tool_test.ToolTest):
    """Two Pandas that change sides around a post: one motion of 14 coordinates."""

    ACCELERATIONS = [3.75, 1.875, 2.5, 3.125, 3.75, 5, 5]  # [rad/s^2]
    NAMES = [f"{robot}/panda_joint{k}" for robot in ("left", "right") for k in range(1, 8)]

    def setUp(self):
        super().setUp()
        self.scene = json.loads((SOURCE / "demo/plans/two_pandas.json").read_text())
        folder = SOURCE / "demo/plans"
        self.scene["package_roots"] = [str(folder / root) for root in self.scene["package_roots"]]
        for robot in self.scene["robots"]:
            robot.update({key: str(folder / robot[key]) for key in ("urdf", "srdf")})
        self.file("scene.json", self.scene)
        plan = self.run_tool("plan", "scene.json", "-o", "path.json")
        self.assertEqual(plan.returncode, 0, plan)
        self.limits = self.file("limits.yaml", self.limits_of(self.NAMES))

    def limits_of(self, names: list) -> str:
        lines = [f"  {name}: {{max_acceleration: {most}, max_jerk: {100 * most}}}"
                 for name, most in zip(names, 2 * self.ACCELERATIONS)]
        return "\n".join(["joint_limits:", *lines, ""])

    def retime(self, *more: str, out: str = "out.csv"):
        return self.run_tool("retime", "path.json", "-o", out, *more)

    def verdict_of_parts(self, table: str, late: dict) -> int:
        """The exit status of `check` for the trajectory of each robot alone, `late` by seconds."""
        rows = list(csv.reader((self.folder / table).read_text().splitlines()))
        for robot in self.scene["robots"]:
            begin = robot["name"] + "/"
            columns = [0] + [k for k, name in enumerate(rows[0]) if name.startswith(begin)]
            part = [[row[k] for k in columns] for row in rows]
            part[0] = [name.removeprefix(begin) for name in part[0]]
            for row in part[1:]:
                row[0] = str(float(row[0]) + late.get(robot["name"], 0))
            robot["trajectory"] = self.file(robot["name"] + ".csv", "\n".join(map(",".join, part)))
            robot["state"] = {"panda_finger_joint1": 0}
        self.file("parts.json", {key: value for key, value in self.scene.items() if key != "plan"})
        return self.run_tool("check", "parts.json").returncode

    def test_writes_one_motion_that_is_free(self):
        durations = []
        for mode in ["stop", "blend", "time_optimal"]:
            for ending in ["yaml", "json", "csv"]:
                out = f"{mode}.{ending}"
                result = self.retime("--limits", self.limits, "--mode", mode, out=out)
                self.assertEqual(result.returncode, 0, result)
                self.assertIn("path.json: proven", result.stdout)
            message = json.loads((self.folder / f"{mode}.json").read_text())
            self.assertEqual(message["joint_names"], self.NAMES)
            self.assertEqual(message["points"][0]["positions"][:2], [0.6, 0.1])
            last = message["points"][-1]["time_from_start"]
            durations.append(last["sec"] + 1e-9 * last["nanosec"])
            self.assertEqual(self.verdict_of_parts(f"{mode}.csv", {}), 0)
        self.assertLess(durations[1], durations[0])
        self.assertLessEqual(durations[2], durations[1])
        # The arms go out of each other's way: alone late, one is in it.
        self.assertEqual(self.verdict_of_parts("blend.csv", {"left": 1}), 1)

    def test_tracking_error_is_of_all_robots(self):
        self.assertEqual(self.retime("--limits", self.limits, "--tracking-error", "0.0001").returncode, 0)
        (self.folder / "out.csv").unlink()
        result = self.retime("--limits", self.limits, "--tracking-error", "0.05", "--mode", "blend")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("contact", result.stdout)
        self.assertFalse((self.folder / "out.csv").exists())

    def test_says_what_is_wrong(self):
        self.assert_refused(self.retime(),
                            'path.json: joint "left/panda_joint1": expected a limit of the acceleration, got none')
        bare = self.file("bare.yaml", self.limits_of([name.split("/")[1] for name in self.NAMES[:7]]))
        self.assert_refused(self.retime("--limits", bare),
                            'bare.yaml:2: joint_limits.panda_joint1: expected a joint of the robot, '
                            'got "panda_joint1"; did you mean "left/panda_joint1"?')
        of_one = self.file("left.yaml", self.limits_of(self.NAMES[:7]))
        self.assert_refused(self.retime("--limits", of_one),
                            'path.json: joint "right/panda_joint1": expected a limit of the acceleration, got none')
        self.assert_refused(self.retime("--limits", self.limits, "--which", "left"),
                            'path.json: expected a path of robot "left" alone, got one that moves "left", "right"; '
                            "plan that robot alone, or time them together without its name")
        self.assertFalse((self.folder / "out.csv").exists())


if __name__ == "__main__":
    tool_test.TOOL = str(pathlib.Path(sys.argv[1]).resolve())
    SOURCE = pathlib.Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
