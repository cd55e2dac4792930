"""The tool as a user meets it: exit status, errors, files, signals.

    tool_test.py TOOL [unittest arguments]
"""

import base64
import json
import math
import os
import pathlib
import pty
import re
import signal
import stat
import struct
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

import scenes

TOOL = ""

# Then the tool is slow.
SANITIZED = os.environ.get("FIRSTCONTACT_SANITIZED") == "1"

# For what runs the tool in a bounded address space.
NEEDS_BOUNDED_MEMORY = unittest.skipIf(SANITIZED, "sanitizers take address space of their own")


class ToolTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name: str, content) -> str:
        """Writes bytes, a text or else JSON; returns the file's name, relative to where the tool runs."""
        if not isinstance(content, (bytes, str)):
            content = json.dumps(content)
        path = self.folder / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def run_tool(self, *arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run([TOOL, *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=120, check=False)

    def run_tool_in(self, folder: str, *arguments: str) -> subprocess.CompletedProcess:
        """In a folder below that of the test."""
        return subprocess.run([TOOL, *arguments], cwd=self.folder / folder, capture_output=True, text=True,
                              timeout=120, check=False)

    def run_in_shell(self, command: str) -> subprocess.CompletedProcess:
        """With redirections, which a shell does."""
        return subprocess.run(["sh", "-c", f'"$0" {command}', TOOL], cwd=self.folder, capture_output=True, text=True,
                              timeout=120, check=False)

    def start(self, *arguments: str, **more) -> subprocess.Popen:
        process = subprocess.Popen([TOOL, *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                   **{"stderr": subprocess.PIPE, **more})
        self.addCleanup(process.kill)
        return process

    def assert_refused(self, result: subprocess.CompletedProcess, message: str):
        """Status 2, nothing on stdout, and one line that says it all."""
        self.assertEqual(result.returncode, 2, result)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr, f"firstcontact: {message}\n")

    def assert_refused_with(self, result: subprocess.CompletedProcess, *words: str):
        """Status 2, nothing on stdout, and one line that has these words."""
        self.assertEqual(result.returncode, 2, result)
        self.assertEqual(result.stdout, "")
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)


class CommandLine(ToolTest):
    def test_says_its_version(self):
        result = self.run_tool("--version")
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stdout, r"^firstcontact \d+\.\d+\.\d+\n$")

    def test_helps(self):
        for arguments in (["--help"], ["check", "--help"], ["batch", "--help"], ["info", "--help"],
                          ["verify", "--help"]):
            result = self.run_tool(*arguments)
            self.assertEqual(result.returncode, 0)
            self.assertIn("Usage: firstcontact", result.stdout)
            self.assertEqual(result.stderr, "")

    def test_help_offers_what_the_command_takes(self):
        helps = {command: self.run_tool(command, "--help").stdout for command in ("check", "plan", "retime")}
        self.assertIn("--trajectory FILE", helps["check"])
        self.assertIn("URDF: checks this robot", helps["check"])
        for option in ("--trajectory", "--unwrap", "--turning"):
            self.assertNotIn(f"  {option} ", helps["plan"])
        self.assertIn("URDF: plans for this robot", helps["plan"])
        self.assertIn("URDF: times the motion of this robot", helps["retime"])
        self.assertIn("its times are not used", helps["retime"])
        # What excludes another option says so in its text.
        self.assertNotIn("Excludes", helps["check"])
        self.assertRegex(helps["check"], r"--visual +Uses the visual geometry of links in place of their collision geometry; "
                                         r"not with --visual-where-missing\n")

    def test_names_what_it_writes(self):
        scene = self.file("s.json", scenes.FREE)
        text = self.run_tool("check", scene, "--svg", "a.svg", "--gap", "a.csv").stdout
        self.assertRegex(text, r"\n  plot       a.svg\n  table      a.csv\n$")

    def test_refuses_what_it_does_not_know(self):
        scene = self.file("scene.json", scenes.FREE)
        for arguments, message in [
                ([], "A subcommand is required"),
                (["chekc"], 'unknown command "chekc"; did you mean "check"?'),
                (["spin"], 'unknown command "spin"'),
                (["check", scene, "--fast"], "The following argument was not expected: --fast"),
                (["check", scene, "--maring", "1"],
                 "The following argument was not expected: --maring; did you mean --margin?"),
                (["check", scene, "--tolrance=1"],
                 "The following argument was not expected: --tolrance=1; did you mean --tolerance?"),
                (["check", scene, "--tolerance", "-1"], '--tolerance: expected a number > 0, got "-1"'),
                (["check", scene, "--tolerance", "nan"], '--tolerance: expected a number > 0, got "nan"'),
                (["check", scene, "--margin", "0,5"], '--margin: expected a number >= 0, got "0,5"'),
                (["check", scene, "--deadline", "inf"], '--deadline: expected a number > 0, got "inf"'),
                (["check", scene, "--contacts", "0"],
                 '--contacts: expected none, first, all or a whole number > 0, got "0"'),
                (["check", scene, "--contacts", "most"],
                 '--contacts: expected none, first, all or a whole number > 0, got "most"')]:
            command = "check " if "check" in arguments else ""
            self.assert_refused(self.run_tool(*arguments), f"{message} (see firstcontact {command}--help)")

    def test_options_replace_those_of_the_scene(self):
        # 5 m above the floor, falling 4 m: a margin of 2 m is reached after 3 m.
        result = self.run_tool("check", "--json", "--margin", "2", "--tolerance", "1e-3",
                               self.file("s.json", scenes.FREE))
        self.assertEqual(result.returncode, 1)
        answer = json.loads(result.stdout)
        self.assertLessEqual(answer["t"], 0.75)
        self.assertGreater(answer["t"], 0.749)
        self.assertEqual(answer["scene"]["options"]["tolerance"], 1e-3)

    def test_says_in_words_what_it_says_in_json(self):
        result = self.run_tool("check", "--closest", "--all-pairs", "--sample-rate", "2",
                               self.file("s.json", scenes.CONTACT))
        self.assertEqual(result.returncode, 1)
        for words in ("contact: contact at t = 0.2", "floor and stone", "triangle 0", "normal", "closing at",
                      "closest", "sampling misses this contact"):
            self.assertIn(words, result.stdout)


class Contacts(ToolTest):
    """Of two plates with a margin, within which are very many pairs of features."""

    def check(self, *arguments: str, cells: int = 6) -> subprocess.CompletedProcess:
        return self.run_tool("check", *arguments, self.file("plates.json", scenes.plates(cells)))

    def answer(self, *arguments: str, cells: int = 6) -> dict:
        return json.loads(self.check("--json", *arguments, cells=cells).stdout)

    def test_are_a_thousand_at_most_and_counted(self):
        found = self.answer(cells=10)
        self.assertEqual(len(found["contacts"]), 1000)
        self.assertGreater(found["contact_count"], 1000)
        self.assertNotIn("contact_count_is_least", found)
        self.assertEqual(found["scene"]["options"]["contacts"], 1000)

    def test_are_those_that_the_option_asks_for(self):
        everything = self.answer("--contacts", "all")
        self.assertEqual(len(everything["contacts"]), everything["contact_count"])
        self.assertEqual(everything["scene"]["options"]["contacts"], "all")
        some = self.answer("--contacts", "20", "--all-pairs")
        self.assertEqual(len(some["contacts"]), 20)
        self.assertEqual(some["contact_count"], everything["contact_count"])
        self.assertEqual(some["pairs"][0]["contact_count"], everything["contact_count"])
        self.assertTrue(all(contact in everything["contacts"] for contact in some["contacts"]))
        nearest = min(contact["distance"] for contact in everything["contacts"])
        self.assertEqual(min(contact["distance"] for contact in some["contacts"]), nearest)
        first = self.answer("--contacts", "first")
        self.assertEqual((len(first["contacts"]), first["contact_count"]), (1, 1))
        self.assertTrue(first["contact_count_is_least"])
        self.assertEqual(self.answer("--contacts", "none")["contacts"], [])

    def test_are_those_that_the_scene_asks_for(self):
        scene = json.loads(scenes.plates(6))
        scene["options"]["contacts"] = 7
        name = self.file("seven.json", json.dumps(scene))
        self.assertEqual(len(json.loads(self.run_tool("check", "--json", name).stdout)["contacts"]), 7)
        again = json.loads(self.run_tool("check", "--json", "--contacts", "8", name).stdout)
        self.assertEqual(len(again["contacts"]), 8)
        for wrong in (0, 1.5, "most"):
            scene["options"]["contacts"] = wrong
            result = self.run_tool("check", self.file("wrong.json", json.dumps(scene)))
            self.assertEqual(result.returncode, 2)
            self.assertIn("options.contacts", result.stderr)

    def test_are_counted_in_words(self):
        count = self.answer("--contacts", "all")["contact_count"]
        self.assertIn(f"contacts   {count} feature pairs\n", self.check("--contacts", "all").stdout)
        self.assertIn(f"contacts   9 of {count} feature pairs\n", self.check("--contacts", "9").stdout)
        self.assertIn("contacts   1000 of more than 262144 feature pairs\n", self.check(cells=30).stdout)

    @NEEDS_BOUNDED_MEMORY
    def test_take_no_memory_that_nobody_needs(self):
        # All of them, as they were found and as a tree of JSON, would be some GB.
        self.file("plates.json", scenes.plates(40))
        for arguments in ("", "--json", "--all-pairs --json", "--contacts 5"):
            result = subprocess.run(
                ["sh", "-c", f'ulimit -v 700000; "$0" check plates.json --threads 1 {arguments} > out', TOOL],
                cwd=self.folder, capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual(result.returncode, 1, (arguments, result))


class Simulate(ToolTest):
    """A ball that falls on a floor."""

    BALL = {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 0, 0.3]}, "dynamics": {}}
    FLOOR = {"name": "floor", "shape": {"box": {"size": [9, 9, 0.2]}}, "pose": {"position": [0, 0, -0.1]}}
    SCENE = {"firstcontact": 1, "simulation": {"duration": 0.5, "step": 0.01}, "bodies": [BALL, FLOOR]}

    def scene(self, scene: dict) -> str:
        path = (self.folder / "scene.json")
        path.write_text(json.dumps(scene), encoding="utf-8")
        return str(path)

    def test_records_a_run_that_verifies(self):
        run = str((self.folder / "run.jsonl"))
        done = self.run_tool("simulate", self.scene(self.SCENE), "-o", run)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("50 of 50", done.stdout)
        self.assertIn("time lost  none", done.stdout)
        verified = self.run_tool("verify", run)
        self.assertEqual(verified.returncode, 0, verified.stdout + verified.stderr)

    def test_says_that_there_is_no_pair(self):
        done = self.run_in_shell("simulate - < " + self.scene({**self.SCENE, "bodies": [self.BALL]}))
        self.assertTrue(done.stdout.startswith("standard input: simulated; no pair was looked at"), done)
        self.assertIn("  apart      no pair to keep apart\n", done.stdout)

    def test_names_a_robot_that_waits_once(self):
        link = """<link name="{}"><collision><origin xyz="0 0 {}"/><geometry><box size="{}"/></geometry></collision></link>"""
        (self.folder / "r.urdf").write_text(
            '<robot name="r"><link name="base"/>' + link.format("sled", 0, "0.1 0.1 0.1")
            + link.format("arm", 0.3, "0.05 0.05 0.4")
            + '<joint name="rail" type="prismatic"><parent link="base"/><child link="sled"/><axis xyz="1 0 0"/>'
            '<origin xyz="0 0 0.06"/><limit lower="-9" upper="9" effort="0" velocity="9"/></joint>'
            '<joint name="mount" type="fixed"><parent link="sled"/><child link="arm"/></joint></robot>',
            encoding="utf-8")
        cube = {"name": "cube", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [0.29, 0, 0.051]},
                "dynamics": {"mass": 1}}
        wall = {"name": "wall", "shape": {"box": {"size": [0.1, 1, 1]}}, "pose": {"position": [0.4, 0, 0.5]}}
        done = self.run_tool("simulate", self.scene({
            "firstcontact": 1, "bodies": [cube, wall, self.FLOOR], "robots": [{
                "name": "r", "urdf": "r.urdf", "trajectory": {"joint_names": ["rail"], "points": [
                    {"positions": [0], "time_from_start": 0}, {"positions": [0.5], "time_from_start": 1}]}}],
            "simulation": {"duration": 1, "step": 0.01, "jams": "wait"}}))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertRegex(done.stdout, r"(?m)^  waited +r, up to [\d.]+ ms behind its motion$")

    def test_goes_on_bit_for_bit_where_it_was_cut_off(self):
        whole, cut = (self.folder / "whole.jsonl"), (self.folder / "cut.jsonl")
        scene = self.scene(self.SCENE)
        self.run_tool("simulate", scene, "-o", str(whole))
        text = whole.read_bytes()
        for size in (len(text), len(text) // 2, len(text.split(b"\n")[0]) + 1):
            cut.write_bytes(text[:size])
            done = self.run_tool("simulate", scene, "-o", str(cut), "--resume")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(cut.read_bytes(), text)

    def test_has_the_same_bits_for_any_number_of_threads(self):
        balls = [self.BALL | {"name": f"ball{k}", "pose": {"position": [2.0 * k, 0.0, 0.5 + 0.1 * k]}} for k in range(4)]
        scene = self.scene({"firstcontact": 1, "simulation": {"duration": 0.5}, "bodies": [*balls, self.FLOOR]})
        runs = []
        for threads in ("1", "2", "0"):
            run = self.folder / f"run{threads}.jsonl"
            done = self.run_tool("simulate", scene, "-o", str(run), "--threads", threads)
            self.assertEqual(done.returncode, 0, done.stderr)
            runs.append(run.read_bytes())
        self.assertEqual(runs[0], runs[1])
        self.assertEqual(runs[0], runs[2])

    def test_begins_anew_where_the_header_was_cut_off(self):
        scene = self.scene({"firstcontact": 1, "simulation": {"duration": 0.02}, "bodies": [self.BALL, self.FLOOR]})
        run = self.folder / "run.jsonl"
        self.assertEqual(self.run_tool("simulate", scene, "-o", str(run)).returncode, 0)
        whole = run.read_bytes()
        for size in (0, 100):
            run.write_bytes(whole[:size])
            result = self.run_tool("simulate", scene, "-o", str(run), "--resume")
            self.assertEqual(result.returncode, 0, result)
            self.assertEqual(run.read_bytes(), whole)

    def test_refuses_more_steps_than_anyone_waits_for(self):
        scene = self.scene({"firstcontact": 1, "bodies": [self.BALL, self.FLOOR]})
        for option, value in (("--duration", "1e300"), ("--step", "1e-320")):
            result = self.run_tool("simulate", scene, option, value, "-o", "run.jsonl")
            self.assertEqual(result.returncode, 2, result)
            self.assertIn("scene.json: simulation: expected at most 1e+08 steps, got ", result.stderr)
            self.assertFalse((self.folder / "run.jsonl").exists())

    def test_refuses_to_go_on_with_another_run(self):
        run = (self.folder / "run.jsonl")
        scene = self.scene(self.SCENE)
        self.run_tool("simulate", scene, "-o", str(run))
        before = run.read_bytes()
        done = self.run_tool("simulate", scene, "-o", str(run), "--resume", "--step", "0.02")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--resume", done.stderr)
        self.assertEqual(run.read_bytes(), before)

    def robot_scene(self, mass: str = "1") -> dict[str, str]:
        """Files of a scene whose body, robot and link are files of their own, by name."""
        tetrahedron = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
        urdf = (f'<robot name="r"><link name="base"/><link name="arm"><inertial><mass value="{mass}"/>'
                '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
                '<collision><geometry><mesh filename="arm.obj"/></geometry></collision></link>'
                '<joint name="turn" type="continuous"><parent link="base"/><child link="arm"/>'
                '<origin xyz="1 0 1"/><axis xyz="0 1 0"/></joint></robot>')
        scene = {"firstcontact": 1, "simulation": {"duration": 0.05, "step": 0.01},
                 "bodies": [{"name": "stone", "shape": {"mesh": "stone.obj"}, "pose": {"position": [0, 0, 1]},
                             "dynamics": {}},
                            {"name": "hull", "shape": {"convex_hull": {"mesh": "stone.obj"}}}],
                 "robots": [{"name": "r", "urdf": "r.urdf", "srdf": "r.srdf", "package_roots": ["."], "dynamics": {}}]}
        return {"stone.obj": tetrahedron, "arm.obj": tetrahedron, "r.urdf": urdf, "r.srdf": '<robot name="r"/>',
                "scene.json": json.dumps(scene)}

    def test_goes_on_however_its_paths_are_spelled(self):
        (self.folder / "scenes").mkdir()
        (self.folder / "other" / "place").mkdir(parents=True)
        for name, content in self.robot_scene().items():
            self.file("scenes/" + name, content)
        (self.folder / "scenes" / "also.json").symlink_to("scene.json")
        (self.folder / "linked").symlink_to("scenes")
        run = self.folder / "run.jsonl"
        spelled = ["scenes/scene.json", "./scenes/scene.json", "other/../scenes/scene.json", "scenes/also.json",
                   "linked/scene.json", str(self.folder / "scenes" / "scene.json")]
        for first in spelled:
            done = self.run_tool("simulate", first, "-o", str(run), "--force")
            self.assertEqual(done.returncode, 0, done.stderr)
            whole = run.read_bytes()
            self.assertEqual(self.run_tool("verify", str(run)).returncode, 0)
            cut = b"".join(whole.splitlines(keepends=True)[:3])
            for folder, second in [(self.folder, path) for path in spelled] + [
                    (self.folder / "scenes", "scene.json"), (self.folder / "other" / "place", "../../scenes/scene.json")]:
                run.write_bytes(cut)
                kept = subprocess.run([TOOL, "simulate", second, "-o", str(run)], cwd=folder, capture_output=True,
                                      text=True, timeout=120, check=False)
                self.assertIn("2 of 5 steps; go on with --resume", kept.stderr)
                done = subprocess.run([TOOL, "simulate", second, "-o", str(run), "--resume"], cwd=folder,
                                      capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual(done.returncode, 0, (first, second, done.stderr))
                self.assertEqual(run.read_bytes(), whole)
                self.assertEqual(self.run_tool("verify", str(run)).returncode, 0)

    def test_refuses_to_go_on_with_other_contents_of_its_files(self):
        files = self.robot_scene()
        for name, content in files.items():
            self.file(name, content)
        run = self.folder / "run.jsonl"
        self.assertEqual(self.run_tool("simulate", "scene.json", "-o", "run.jsonl").returncode, 0)
        cut = b"".join(run.read_bytes().splitlines(keepends=True)[:3])
        run.write_bytes(cut)
        changed = {"stone.obj": files["stone.obj"] + "# changed\n", "arm.obj": files["arm.obj"] + "# changed\n",
                   "r.urdf": self.robot_scene(mass="2")["r.urdf"], "r.srdf": '<robot name="r"><!-- changed --></robot>',
                   "scene.json": files["scene.json"] + "\n"}
        for name, content in changed.items():
            self.file(name, content)
            done = self.run_tool("simulate", "./scene.json", "-o", "run.jsonl", "--resume")
            self.assert_refused_with(done, "run.jsonl: holds a run of another scene")
            self.assertEqual(run.read_bytes(), cut)
            self.file(name, files[name])

    def test_replaces_a_run_only_when_told_to(self):
        scene, run = self.scene(self.SCENE), self.folder / "run.jsonl"
        self.run_tool("simulate", scene, "-o", str(run))
        whole = run.read_bytes()
        replace = "replace it with --force, or give another file"
        self.assert_refused(self.run_tool("simulate", scene, "-o", "run.jsonl"),
                            f"run.jsonl: holds a finished run; {replace}")
        self.assertEqual(run.read_bytes(), whole)
        lines = whole.splitlines(keepends=True)
        part = b"".join(lines[:21]) + lines[21][:9]
        run.write_bytes(part)
        self.assert_refused(self.run_tool("simulate", scene, "-o", "run.jsonl"),
                            f"run.jsonl: holds an unfinished run, 20 of 50 steps; go on with --resume, {replace}")
        self.assert_refused(self.run_tool("simulate", scene, "-o", "run.jsonl", "--step", "0.02"),
                            "run.jsonl: holds an unfinished run of another scene or with other options, "
                            f"20 of 50 steps; {replace}")
        self.assertEqual(run.read_bytes(), part)
        self.assertEqual(self.run_tool("simulate", scene, "-o", "run.jsonl", "--force").returncode, 0)
        self.assertEqual(run.read_bytes(), whole)
        run.write_bytes(b"notes\n")
        self.assert_refused(self.run_tool("simulate", scene, "-o", "run.jsonl"),
                            f"run.jsonl: holds something already, which is no run; {replace}")
        run.write_bytes(b"")
        self.assertEqual(self.run_tool("simulate", scene, "-o", "run.jsonl").returncode, 0)
        both = self.run_tool("simulate", scene, "-o", "run.jsonl", "--force", "--resume")
        self.assertEqual(both.returncode, 2, both)

    def test_summary_is_of_the_whole_run(self):
        scene = self.scene({**self.SCENE, "bodies": [dict(self.BALL, dynamics={"restitution": 0.9}), self.FLOOR]})
        run = self.folder / "run.jsonl"

        def summary(*options: str) -> list[str]:
            done = self.run_tool("simulate", scene, "-o", str(run), *options)
            self.assertEqual(done.returncode, 0, done)
            return [line for line in done.stdout.splitlines() if line.split()[0] not in ("took", "steps")]

        whole = summary()
        self.assertIn("energy", str(whole))
        self.assertRegex("\n".join(whole), r"impacts    \d+, [\d.]+ N s the greatest at one place")
        lines = run.read_bytes().splitlines(keepends=True)
        for kept in (0, 30, 50):
            run.write_bytes(b"".join(lines[:kept + 1]))
            self.assertEqual(summary("--resume"), whole)

    def test_says_what_is_wrong(self):
        inside = dict(self.BALL, pose={"position": [0, 0, 0.05]})
        for bodies, expected in (([inside, self.FLOOR], "meet at the start"), ([self.FLOOR], "dynamics")):
            scene = {"firstcontact": 1, "bodies": bodies}
            run = (self.folder / "none.jsonl")
            done = self.run_tool("simulate", self.scene(scene), "-o", str(run))
            self.assertEqual(done.returncode, 2)
            self.assertIn("scene.json", done.stderr)
            self.assertIn(expected, done.stderr)
            self.assertFalse(run.exists())

    def test_lost_time_is_status_3(self):
        press = {"name": "press", "shape": {"box": {"size": [1, 1, 0.1]}},
                 "motion": {"type": "waypoints", "times": [0, 0.2],
                            "poses": [{"position": [0, 0, 0.5]}, {"position": [0, 0, 0.1]}]}}
        scene = {"firstcontact": 1, "simulation": {"duration": 0.2, "step": 0.02, "events": 5},
                 "bodies": [dict(self.BALL, pose={"position": [0, 0, 0.11]}), self.FLOOR, press]}
        done = self.run_tool("simulate", self.scene(scene))
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)


class Verify(ToolTest):
    """A ball that falls towards a floor at 1 m/s and comes to rest at a height of 0.1 m over it."""

    SCENE = {"firstcontact": 1, "simulation": {"duration": 0.9, "step": 0.5}, "bodies": [
        {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 0, 1]}, "dynamics": {}},
        {"name": "floor", "shape": {"box": {"size": [9, 9, 0.2]}}, "pose": {"position": [0, 0, -0.1]}}]}
    HEADER = {"firstcontact_run": 1, "scene": SCENE, "version": "0.1.0", "scene_digest": "", "input_digest": "",
              "masses": [1, 0], "centres_of_mass": [[0, 0, 0], [0, 0, 0]]}

    def step(self, index: int, begin: float, lasted: float, height: float, fall: float, **more) -> dict:
        end = [0, 0, height - fall]
        piece = [lasted, 0, 0, height, 1, 0, 0, 0, 0, 0, -fall, 0, 0, 0]
        body = {"body": 0, "pieces": [piece], "position": end, "quaternion_wxyz": [1, 0, 0, 0],
                "linear_velocity": [0, 0, 0], "angular_velocity": [0, 0, 0]}
        return {"step": index, "time": begin + lasted, "lasted": lasted, "time_lost": 0.5 - lasted, "bodies": [body],
                "contacts": [], "clearance": 0.1, "kinetic_energy": 0, "potential_energy": 0,
                "linear_momentum": [0, 0, 0], "angular_momentum": [0, 0, 0], "residual": 0, "events": 0, **more}

    def setUp(self):
        super().setUp()
        self.steps = [self.step(1, 0, 0.5, 1, 0.5), self.step(2, 0.5, 0.25, 0.5, 0.25)]

    def verify(self, *arguments: str, cut: int = 0) -> subprocess.CompletedProcess:
        text = "".join(json.dumps(line) + "\n" for line in [self.HEADER, *self.steps])
        return self.run_tool("verify", self.file("run.jsonl", text[:len(text) - cut]), *arguments)

    def test_proves_a_run(self):
        result = self.verify()
        self.assertEqual(result.returncode, 0, result)
        self.assertEqual(result.stderr, "")
        self.assertRegex(result.stdout, r"""^run\.jsonl: proven: the one pair that was looked at interpenetrates at no time
  verified   2 steps, 750 ms of 900 ms
  least      1[45]\d.* mm \(proven\) to 15\d.* mm: ball and floor at 0\.7\d* s \(step 2\)
  time lost  250 ms
  tested     1 pair
$""")

    def test_writes_json(self):
        found = json.loads(self.verify("--json").stdout)
        self.assertEqual(found["verdict"], "proven")
        self.assertEqual((found["steps"], found["time"], found["time_lost"]), (2, 0.75, 0.25))
        self.assertEqual(found["closest"]["bodies"], ["ball", "floor"])
        self.assertEqual(found["closest"]["step"], 2)
        self.assertAlmostEqual(found["closest"]["distance"], 0.15, delta=0.009)
        self.assertLessEqual(found["least_distance"], 0.15)
        self.assertGreaterEqual(found["least_distance"], 0.142)
        self.assertEqual((found["problem"], found["problem_at"]), ("", None))
        self.assertEqual(found["pair_counts"], {"tested": 1, "ignored": 0, "left_out": 0, "untested": []})

    def test_refutes_a_run(self):
        self.steps.append(self.step(3, 0.75, 0.125, 0.25, 0.0625))
        result = self.verify()
        self.assertEqual(result.returncode, 1, result)
        self.assertRegex(result.stdout, r"^run\.jsonl: refuted\n  problem +\"ball\" and \"floor\" come closer than "
                         r"promised\.\n  when +0\.8\d+ s \(step 3\)\n  distance +\d\d.* mm or less\n")
        found = json.loads(self.verify("--json").stdout)
        self.assertEqual((found["verdict"], found["problem_at"]["step"]), ("refuted", 3))

    def test_refuses_a_broken_record(self):
        self.steps[1]["bodies"][0]["pieces"][0][1] = 0.25
        self.assert_refused(self.verify(), 'run.jsonl: Step 2: "ball" jumps by 0.25 m at 0.5 s.')
        result = self.verify("--json")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(json.loads(result.stdout)["verdict"], "broken")

    def test_says_what_comes_before_a_proof(self):
        scene = self.file("s.json", json.dumps({**json.loads(scenes.FREE)}, indent=2))
        self.assert_refused_with(self.run_tool("verify", scene), "s.json: expected a run, a result or a path, got a "
                                 "scene; first `firstcontact check s.json -o FILE`, then verify FILE")
        scene = self.file("s.json", Simulate.SCENE)
        self.assert_refused_with(self.run_tool("verify", scene), "first `firstcontact simulate s.json")

    def test_refuses_what_is_no_run(self):
        self.assert_refused(self.run_tool("verify", "gone.jsonl"), "gone.jsonl: expected a run, a result or a path, cannot open this file")
        self.assert_refused(self.run_tool("verify", self.file("scene.jsonl", '{"bodies": []}\n')),
                            'scene.jsonl:1: expected the header of a run, an object with "firstcontact_run": 1')
        self.steps[1]["lasted"] = None
        self.assert_refused(self.verify(), "run.jsonl:3: lasted: expected a number")

    def test_leaves_out_what_was_cut_off(self):
        result = self.verify(cut=10)
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("verified   1 step, 500 ms of 900 ms", result.stdout)
        self.assertIn("the file ends in the middle of a line, which was left out", result.stdout)

    def test_refuses_times_that_do_not_add_up(self):
        self.steps[1]["time_lost"] = 0.125
        self.assert_refused(self.verify(), "run.jsonl: Step 2: the step lasted 0.25 s and lost 0.125 s, but a step of the "
                            "scene is one of 0.5 s.")

    def test_refuses_a_run_whose_mesh_has_changed(self):
        plate = "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n"
        self.file("plate.obj", plate)
        self.file("rod.urdf", '<robot name="rod"><link name="base"/><joint name="turn" type="continuous">'
                  '<parent link="base"/><child link="rod"/></joint><link name="rod"><inertial><mass value="1"/><inertia ixx="1" iyy="1"'
                  ' izz="1"/></inertial><collision><geometry><mesh filename="rod.obj"/></geometry></collision></link>'
                  "</robot>")
        self.file("rod.srdf", '<robot name="rod"/>')
        self.file("rod.csv", "time,turn\n0,0\n1,0.1\n")
        rod = "v 5 0 0\nv 6 0 0\nv 5 0 1\nv 5 1 1\nf 1 2 3\nf 2 3 4\n"
        self.file("rod.obj", rod)
        scene = {**self.SCENE, "simulation": {"duration": 0.02}, "robots": [{
            "name": "rod", "urdf": "rod.urdf", "srdf": "rod.srdf", "trajectory": "rod.csv"}]}
        scene["bodies"] = [scene["bodies"][0], {"name": "plate", "shape": {"mesh": "plate.obj"}}]
        self.assertEqual(self.run_tool("simulate", self.file("s.json", json.dumps(scene)), "-o", "run.jsonl").returncode, 0)
        self.file("rod.csv", "gone")  # The run holds what it said.
        for name, text in (("plate.obj", plate), ("rod.obj", rod)):
            self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)
            self.file(name, text.replace("9", "8").replace("6", "7"))
            # Without the viewer's page `view` says that first.
            has_viewer = (pathlib.Path(TOOL).resolve().parent.parent / "share/firstcontact/viewer.html").exists()
            for command in (["verify"], *([["view", "--no-open"]] if has_viewer else [])):
                self.assert_refused(self.run_tool(*command, "run.jsonl"),
                                    "run.jsonl: header.input_digest: a mesh or robot file of its scene is not what "
                                    "it was when the run was made; restore the file, or make the run again")
            self.file(name, text)

    def test_refuses_a_run_of_another_scene(self):
        scene = {**self.SCENE, "simulation": {"duration": 0.1}}
        text = json.dumps(scene)
        self.assertEqual(self.run_tool("simulate", self.file("s.json", text), "-o", "run.jsonl").returncode, 0)
        self.assertEqual(self.run_tool("verify", "run.jsonl", "--scene", "s.json").returncode, 0)
        self.file("s.json", json.dumps({**scene, "simulation": {"duration": 0.2}}))
        self.assert_refused(self.run_tool("verify", "run.jsonl", "--scene", "s.json"),
                            "run.jsonl: the run is not one of s.json as it is now; simulate again")
        self.assert_refused_with(self.run_tool("verify", "run.jsonl", "--scene", "gone.json"), "gone.json: ")

    def test_refuses_a_run_whose_scene_was_edited(self):
        scene = {**self.SCENE, "simulation": {"duration": 0.02}}
        self.assertEqual(self.run_tool("simulate", self.file("s.json", json.dumps(scene)), "-o", "run.jsonl").returncode, 0)
        header, steps = (self.folder / "run.jsonl").read_text().split("\n", 1)
        edits = {"pairs": {"ignore": [["ball", "floor"]]}, "bodies": json.loads(header)["scene"]["bodies"][:1]}
        for key, value in edits.items():
            edited = json.loads(header)
            edited["scene"][key] = value
            self.file("run.jsonl", json.dumps(edited) + "\n" + steps)
            for more in ([], ["--scene", "s.json"]):
                self.assert_refused_with(self.run_tool("verify", "run.jsonl", *more), "run.jsonl:1: resolved_digest: ")

    def test_refuses_to_compare_a_run_of_no_file(self):
        self.file("s.json", json.dumps(self.SCENE))
        self.assert_refused(self.verify("--scene", "s.json"), "run.jsonl: header.scene_digest: the run states none, as "
                            "its scene was no file; leave out --scene")

    def test_says_what_is_not_proven(self):
        self.steps = []
        result = self.verify()
        self.assertEqual(result.returncode, 3, result)
        self.assertIn("run.jsonl: not proven\n  problem    The run has no step.\n", result.stdout)


class VerifiedResult(ToolTest):
    """Results of check that are proven again."""

    TILTED = scenes.scene(scenes.body("floor"), scenes.body("stone", motion={
        "type": "constant_velocity", "from": {"position": [0.1, 0.1, 1], "rpy": [0.2, 0.3, 0]}, "translation": [0, 0, -4]}))

    def check(self, scene: str) -> dict:
        self.run_tool("check", self.file("scene.json", scene), "-o", "result.json")
        return json.loads((self.folder / "result.json").read_text())

    def verify(self, result: dict, *arguments: str) -> subprocess.CompletedProcess:
        return self.run_tool("verify", self.file("result.json", json.dumps(result, separators=(",", ":"))), *arguments)

    def test_proves_a_contact_and_the_time_before(self):
        self.check(self.TILTED)
        result = self.run_tool("verify", "result.json", "--scene", "scene.json")
        self.assertEqual((result.returncode, result.stderr), (0, ""), result)
        self.assertRegex(result.stdout, r"""^result\.json: proven: contact at t = 0\.\d* \(.* ms\), free before
  contact    floor and stone at t: .* [pn]m(?: or less)?, 1 µm allowed beyond the margin
(?:  left open  the last .*
)?  tested     1 pair
$""")
        found = json.loads(self.run_tool("verify", "result.json", "--json").stdout)
        self.assertEqual((found["verdict"], found["claim"]["verdict"], found["problem"]), ("proven", "contact", ""))
        self.assertLessEqual(found["contact_distance"], 1e-6)

    def test_proves_what_is_free(self):
        result = self.verify(self.check(scenes.FREE))
        self.assertEqual(result.returncode, 0, result)
        self.assertRegex(result.stdout, r"^result\.json: proven: free\n  tested     1 pair\n$")

    def test_refutes_what_was_edited(self):
        claims = self.check(self.TILTED)
        free = {**claims, "verdict": "free", "t": 1, "t_upper": None, "time": 1, "pair": None}
        result = self.verify(free)
        self.assertEqual(result.returncode, 1, result)
        self.assertRegex(result.stdout, r'^result\.json: refuted\n  claim      free\n  problem    "floor" and "stone" are '
                         r"closer than the result claims\.\n  when       t = 0\.\d+\n  distance ")
        later, earlier = ({**claims, "t": t, "t_upper": t, "time": t} for t in (claims["t"] + 1e-6, claims["t"] - 1e-6))
        self.assertIn(self.verify(later).returncode, (1, 3))
        self.assertEqual(self.verify(earlier).returncode, 1)

    def test_refuses_what_contradicts_itself(self):
        claims = self.check(scenes.CONTACT)
        self.assert_refused(self.verify({**claims, "time": 0.5}),
                            "result.json:1: The time is not t times the duration of the scene.")
        result = self.verify({**claims, "time": 0.5}, "--json")
        self.assertEqual((result.returncode, json.loads(result.stdout)["verdict"]), (2, "broken"))
        self.assert_refused(self.verify({**claims, "t": "soon"}), "result.json:1: t: expected a number, got \"soon\"")
        self.assert_refused(self.verify({**claims, "t_upper": 0.9}), f"result.json:1: t_upper: expected {claims['t']}, as "
                            "t, since the verdict is a contact, got 0.9; check the scene again")

    def test_refuses_a_scene_that_has_changed(self):
        claims = self.check(scenes.CONTACT)
        claims["scene"]["bodies"][1]["motion"]["translation"][2] = 0
        self.assert_refused(self.verify(claims), "result.json:1: scene: this is not the scene that was checked, it was "
                            "edited in the result; check it again")
        self.check(scenes.CONTACT)
        self.file("scene.json", scenes.FREE)
        self.assert_refused(self.run_tool("verify", "result.json", "--scene", "scene.json"),
                            "result.json:1: the result is not one of scene.json as it is now; check it again")

    def test_refuses_a_mesh_that_has_changed(self):
        plate = "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n"
        self.file("plate.obj", plate)
        claims = self.check(scenes.scene({"name": "plate", "shape": {"mesh": "plate.obj"}}, scenes.falling(1)))
        self.assertEqual(self.verify(claims).returncode, 0)
        self.file("plate.obj", plate.replace("9", "8"))
        self.assert_refused(self.verify(claims), "result.json:1: input_digest: a mesh or robot file of the scene is not "
                            "what it was when the result was made; restore the file, or check again")

    def test_tells_what_is_wrong_with_a_damaged_file(self):
        text = json.dumps(self.check(scenes.CONTACT), separators=(",", ":"))
        for damaged in (text[:len(text) // 2], text.replace('"t":', '"t":0,"t":', 1)):
            result = self.run_tool("verify", self.file("damaged.json", damaged))
            self.assert_refused_with(result, "damaged.json:1: ")
            self.assertNotIn("the header of a run", result.stderr)
        for damaged in ('{"firstcontact_path":1,"verdict":"pro', '{"firstcontact_path":1,"goal":0,"goal":0}'):
            result = self.run_tool("verify", self.file("path.json", damaged))
            self.assert_refused_with(result, "path.json:1: ")
            self.assertNotIn("the header of a run", result.stderr)

    def test_warns_where_there_is_no_digest(self):
        claims = self.check(scenes.FREE)
        del claims["scene_digest"], claims["resolved_digest"]
        result = self.verify(claims)
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("the result states no digest of its scene", result.stdout)

    def test_proves_many_results(self):
        self.file("scenes.jsonl", scenes.FREE + "\n" + scenes.CONTACT + "\n")
        self.file("results.jsonl", self.run_tool("check", "scenes.jsonl").stdout)
        result = self.run_tool("verify", "results.jsonl")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("results.jsonl:1: proven: free\n", result.stdout)
        self.assertIn("results.jsonl:2: proven: contact at t = ", result.stdout)

    def test_reads_results_that_were_written_anew(self):
        claims = self.check(scenes.CONTACT)
        result = self.run_tool("verify", self.file("pretty.json", json.dumps(claims, indent=2)))
        self.assertEqual(result.returncode, 0, result)


class Robot(ToolTest):
    """A bar of 1 m that turns about z by `elbow`, its fixed tip a ball of 0.1 m at 1.05 m."""

    URDF = """<robot name="arm"><link name="base"/>
      <link name="bar"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
      <link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="elbow" type="revolute"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1.5" velocity="1" effort="1"/></joint>
      <joint name="weld" type="fixed"><parent link="bar"/><child link="tip"/><origin xyz="1.05 0 0"/></joint></robot>"""
    BALL = """world: {collision_objects: [{id: ball, primitives: [{type: sphere, dimensions: [0.1]}],
      primitive_poses: [{position: [0, 1.05, 0]}]}]}"""
    TOUCH = (math.pi / 2 - 2 * math.asin(0.1 / 1.05)) / 0.5  # [s] At half a radian in a second.

    def setUp(self):
        super().setUp()
        self.robot = self.file("arm.urdf", self.URDF)
        self.ball = self.file("ball.yaml", self.BALL)
        self.move = self.file("move.csv", "time,elbow\n0,0\n4,2\n")

    def check(self, *more: str) -> subprocess.CompletedProcess:
        return self.run_tool("check", "--robot", self.robot, *more)

    def test_says_when_and_which_links(self):
        result = self.check("--trajectory", self.move, "--environment", self.ball)
        self.assertEqual(result.returncode, 1, result)
        for words in ("move.csv: contact at t = 0.69", "(2.76", "ball and arm/tip", "warning",
                      'arm: joint "elbow" leaves its upper limit of 1.5 rad by 0.5 rad at 4 s'):
            self.assertIn(words, result.stdout)

    def test_writes_what_the_viewer_reads(self):
        result = self.check("--trajectory", self.move, "--environment", self.ball, "--json", "--closest",
                            "--all-contacts-in-time", "--all-pairs")
        answer = json.loads(result.stdout)
        self.assertAlmostEqual(answer["time"], self.TOUCH, places=5)
        self.assertEqual(answer["pair"], ["ball", "arm/tip"])
        self.assertEqual(answer["limits"][0]["joint"], "elbow")
        tip = [pair for pair in answer["pairs"] if pair["pair"] == answer["pair"]][0]
        self.assertAlmostEqual(tip["intervals"][0]["enter_time"], self.TOUCH, places=5)
        again = self.run_tool("check", "--json", self.file("again.json", json.dumps(answer["scene"])))
        self.assertEqual(json.loads(again.stdout)["t"], answer["t"])

    def test_draws_the_gap_and_says_what_sampling_sees(self):
        result = self.check("--trajectory", self.move, "--environment", self.ball, "--svg", "gap.svg",
                            "--gap", "gap.csv", "--sample-rate", "0.25")
        self.assertIn("0 of 2 samples in contact", result.stdout)
        self.assertIn("sampling misses this contact", result.stdout)
        text = (self.folder / "gap.svg").read_text(encoding="utf-8")
        self.assertIn("first contact at 2.76", text)
        rows = [row.split(",") for row in (self.folder / "gap.csv").read_text().splitlines()[1:]]
        self.assertEqual([row[0] for row in (rows[0], rows[-1])], ["0", "1"])
        for row in rows:
            if row[2]:
                turned = math.pi / 2 - 0.5 * float(row[1])
                along, across = 1.05 * math.cos(turned), 1.05 * abs(math.sin(turned))
                bar = math.hypot(max(along - 1, 0), max(across - 0.05, 0)) - 0.1
                tip = math.hypot(along - 1.05, across) - 0.2
                self.assertAlmostEqual(float(row[2]), max(min(bar, tip), 0), places=6)
                self.assertLessEqual(float(row[3]), float(row[2]))
        free = self.check("--start", "elbow=0", "--goal", "elbow=0.5", "--environment", self.ball, "--margin",
                          "0.01", "--svg", "free.svg")
        self.assertEqual(free.returncode, 0, free)
        self.assertIn("margin 10 mm", (self.folder / "free.svg").read_text(encoding="utf-8"))

    def test_makes_a_page_with_links_and_joints(self):
        if not (pathlib.Path(TOOL).resolve().parent.parent / "share/firstcontact/viewer.html").exists():
            self.skipTest("the viewer's page is not built")
        looks = self.URDF.replace("<collision><geometry><sphere", "<visual><geometry><mesh filename='gone.stl'/>"
                                  "</geometry></visual><collision><geometry><sphere")
        self.robot = self.file("looks.urdf", looks)
        self.check("--trajectory", self.move, "--environment", self.ball, "--html", "page.html", "-o", "r.json")
        view = self.view_of("page.html")
        robot = view["robots"][0]
        self.assertEqual([link["name"] for link in robot["links"]], ["base", "bar", "tip"])
        self.assertEqual(robot["joints"][0]["coordinates"][0]["segments"], [{"until": 1, "a": [0, 2]}])
        self.assertEqual(robot["joints"][0]["limits"], {"lower": -1, "upper": 1.5, "velocity": 1})
        self.assertEqual(robot["links"][2]["collision"][0]["radius"], 0.1)
        self.assertEqual(len(view["warnings"]), 1)
        self.assertIn("gone.stl", view["warnings"][0])
        again = self.run_tool("view", "r.json", "--no-open", "-o", "again.html")
        self.assertEqual(again.returncode, 0, again)
        self.assertEqual(self.view_of("again.html")["robots"], view["robots"])

    def view_of(self, page: str) -> dict:
        text = (self.folder / page).read_text(encoding="utf-8")
        return json.loads(text.split('type="application/json">', 1)[1].split("</script>", 1)[0])["view"]

    def test_keeps_margins_of_all_kinds(self):
        ask = ["--trajectory", self.move, "--environment", self.ball, "--json"]
        free = json.loads(self.check(*ask).stdout)["t"]
        for more in (["--padding", "0.01"], ["--tracking-error", "0.01"], ["--margin", "0.01"]):
            self.assertLess(json.loads(self.check(*ask, *more).stdout)["t"], free, more)

    def test_goes_straight_from_a_start_to_a_goal(self):
        result = self.check("--start", "elbow=0", "--goal", "elbow=0.5", "--environment", self.ball)
        self.assertEqual((result.returncode, result.stdout),
                         (0, "arm: free for the whole step of 500 ms\n  tested     2 pairs\n"
                          "  ignored    1 of links that joints connect: arm/bar and arm/tip\n"), result)

    def test_says_which_way_continuous_joints_went(self):
        self.robot = self.file("endless.urdf", self.URDF.replace('"revolute"', '"continuous"'))
        ask = ["--start", "elbow=3", "--goal", "elbow=-3", "--environment", self.ball]
        result = self.check(*ask)
        self.assertEqual((result.returncode, result.stdout), (
            0, "arm: free for the whole step of 283.2 ms\n"
               "  turn       arm/elbow by 0.283185 rad, the short way, from 3 to -3 rad\n"
               "  tested     2 pairs\n  ignored    1 of links that joints connect: arm/bar and arm/tip\n"), result)
        result = self.check(*ask, "--turning", "long")
        self.assertEqual(result.returncode, 1, result)
        self.assertIn("arm/elbow by -6 rad, the long way, as the numbers say, from 3 to -3 rad", result.stdout)
        turn = json.loads(self.check(*ask, "--json").stdout)["turns"][0]
        self.assertAlmostEqual(turn.pop("turned"), 2 * math.pi - 6, places=14)
        self.assertEqual(turn, {"robot": "arm", "joint": "elbow", "from": 3, "to": -3, "turning": "short"})
        self.assertEqual(self.check(*ask, "--turning", "shortest").returncode, 2)

    def test_unwraps_recordings(self):
        self.robot = self.file("endless.urdf", self.URDF.replace('"revolute"', '"continuous"'))
        move = self.file("recorded.csv", "time;elbow\n0;2,9\n1;3,1\n2;-3,0\n3;-2,8\n")
        ask = ["--trajectory", move, "--environment", self.ball]
        result = self.check(*ask)
        self.assertEqual(result.returncode, 1, result)
        self.assertIn('joint "elbow" jumps by a whole turn, from 3.1 rad to -3 rad at 2 s', result.stdout)
        result = self.check(*ask, "--unwrap")
        self.assertEqual(result.returncode, 0, result)
        self.assertNotIn("warning", result.stdout)

    def test_says_what_is_wrong(self):
        bad = self.file("bad.csv", "time,elbow\n0,0\n0,1\n")
        misspelt = self.file("misspelt.csv", "time,elbov\n0,0\n")
        for arguments, message in [
                (["--trajectory", bad], f'{bad}:3: column "time": expected one point at 0 s, got a second one '
                                        'with position 1 of "elbow" in place of 0'),
                (["--unwrap"], f"{self.robot}: expected a trajectory, whose whole turns unwrap takes out, got none"),
                (["--trajectory", misspelt], f'{misspelt}:1: column "elbov": expected a joint of the robot, '
                                             'got "elbov"; did you mean "elbow"?'),
                (["--trajectory", self.move, "--strict"],
                 f"{self.move}: expected a motion within the joint limits, but arm: joint \"elbow\" leaves its "
                 "upper limit of 1.5 rad by 0.5 rad at 4 s"),
                (["--trajectory", self.move, "--goal", "elbow=1"],
                 f"{self.move}: expected one of a trajectory, a request and a goal, got 2"),
                (["--trajectory", self.move, "--start", "elbow=1"],
                 f"{self.move}: expected a start beside a goal alone; where joints rest that the motion does not "
                 "name is the state"),
                (["--start", "elbow=nan", "--goal", "elbow=1"],
                 f'{self.robot}: start: expected NAME=POSITION with a finite number, such as elbow=0.1, got '
                 '"elbow=nan"'),
                (["--start", "elbow=0", "--goal", "elbow=1", "--goal", "elbow=2"],
                 f'{self.robot}: goal: expected joint "elbow" once, got it again in "elbow=2"'),
                (["--start", "0", "--goal", "1"],
                 f'{self.robot}: start: expected NAME=POSITION of a joint, got "0"; names of states are those '
                 "of an SRDF"),
                (["--environment", "none.stl"],
                 "none.stl: expected an environment (a mesh, a planning scene in .yaml, or a scene in .json), "
                 "found no such file")]:
            self.assert_refused(self.check(*arguments), message)
        self.assert_refused(self.run_tool("check"), "expected a SCENE, or --robot (see firstcontact check --help)")
        self.assert_refused(self.run_tool("check", "--trajectory", "x.csv"),
                            "expected --robot ROBOT.urdf beside x.csv")

    def test_says_what_to_do_with_a_file_that_is_no_scene(self):
        for name, got in [("r.urdf", "a robot; give it as --robot, or in \"robots\" of a scene"),
                          ("nut.OBJ", 'a mesh; a scene has it as the shape of a body: {"mesh": FILE}'),
                          ("scan.xyz", 'points; a scene has it as the shape of a body: {"points": FILE}'),
                          ("t.csv", "a trajectory; give it as --trajectory, beside --robot")]:
            path = self.file(name, "<robot/>")
            for command in ("check", "simulate", "plan"):
                self.assert_refused(self.run_tool(command, path), f"{path}: expected a scene (.json), got {got}")

    def test_has_options_that_are_refused_beside_a_scene(self):
        """Where they were ignored, the answer would be of another question."""
        scene = self.file("s.json", scenes.FREE)
        for option, value, place in [
                ("--srdf", "r.srdf", "robots[].srdf"), ("--trajectory", "t.csv", "robots[].trajectory"),
                ("--request", "r.yaml", "robots[].trajectory"), ("--start", "elbow=0", "robots[].trajectory"),
                ("--goal", "elbow=1", "robots[].trajectory"), ("--state", "elbow=1", "robots[].state"),
                ("--environment", "m.obj", "bodies"), ("--package-root", ".", "package_roots"),
                ("--padding", "0", "robots[].padding"), ("--tracking-error", "1", "robots[].tracking_error"),
                ("--visual", "", "robots[].surface"), ("--turning", "long", "robots[].turning"),
                ("--unwrap", "", "robots[].unwrap")]:
            self.assert_refused(self.run_tool("check", scene, option, *filter(None, [value])),
                                f"{option} belongs to --robot; in a scene, say it in {place}")


class About(ToolTest):
    """What an answer says it is about: its pairs and its files."""

    BALL = {"name": "a", "shape": {"sphere": {"radius": 0.1}},
            "motion": {"type": "constant_velocity", "from": {"position": [0, 0, 1]}, "translation": [0, 0, -2]}}
    PLATE = {"name": "b", "shape": {"box": {"size": [1, 1, 0.1]}}}
    CAN = {"name": "c", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [3, 0, 2]}, "dynamics": {}}

    def test_no_pair_is_no_proof_of_anything(self):
        scene = self.file("s.json", scenes.scene(self.BALL, self.PLATE, pairs={"ignore": [["a", "b"]]}))
        result = self.run_tool("check", scene)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("s.json: free for the whole step of 1 s, but no pair is tested\n", result.stdout)
        self.assertIn("  tested     no pair\n  ignored    1 by the scene's rules: a and b\n", result.stdout)
        self.assertIn("  warning    no pair is tested", result.stdout)
        answer = json.loads(self.run_tool("check", "--json", scene).stdout)
        self.assertEqual(answer["pair_counts"], {"tested": 0, "ignored": 1, "left_out": 0, "untested": [
            {"why": "rule", "count": 1, "first": [["a", "b"]]}]})
        self.assertIn("no pair is tested", answer["warnings"][0])

    def test_scripted_bodies_of_a_simulation_are_named(self):
        scene = self.file("s.json", scenes.scene(self.BALL, self.PLATE, self.CAN, simulation={"duration": 0.1}))
        for result in (self.run_tool("simulate", scene, "-o", "run.jsonl"), self.run_tool("verify", "run.jsonl")):
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("none of the 2 pairs that were looked at interpenetrates at any time", result.stdout)
            self.assertIn("  tested     2 pairs\n  left out   1 of which neither is free (they may pass through each "
                          "other): a and b\n", result.stdout)
            self.assertNotIn("no two bodies", result.stdout)

    def test_files_are_explained_where_that_is_asked(self):
        self.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        scene = self.file("s.json", scenes.scene(self.BALL, {"name": "m", "shape": {"mesh": "m.obj"}}))
        self.assertNotIn("files", self.run_tool("check", scene).stdout)
        result = self.run_tool("check", "--explain", scene)
        self.assertIn("  files\n    m.obj: ", result.stdout)
        files = json.loads(self.run_tool("check", "--json", scene).stdout)["files"]
        self.assertEqual([file["path"] for file in files], ["m.obj"])
        self.assertIn({"what": "triangles", "count": 1}, files[0]["contents"])
        of_info = json.loads(self.run_tool("info", "--json", "m.obj").stdout)["files"]
        self.assertEqual(of_info, files)

    def test_names_do_not_steer_the_terminal(self):
        bad = "x\n\x1b[31mred\x07\x9b\u202e"
        scene = self.file("s.json", scenes.scene({**self.BALL, "name": bad}, self.PLATE, id=bad))
        shown = "x\\n\\x1b[31mred\\x07\\x9b\\u202e"
        result = self.run_tool("check", "--all-pairs", "--closest", scene)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn(f"  bodies     {shown} and b\n", result.stdout)
        self.assertTrue(result.stdout.startswith(f"{shown}: contact at"), result.stdout)
        for letter in "\x1b\x07\x9b\u202e":
            self.assertNotIn(letter, result.stdout)
        answer = json.loads(self.run_tool("check", "--json", scene).stdout)
        self.assertEqual(answer["pair"], [bad, "b"])

    def test_lenient_reading_stays_in_the_result(self):
        scene = self.file("s.json", scenes.FREE)
        options = json.loads(self.run_tool("check", "--json", "--lenient", scene).stdout)["scene"]["options"]
        self.assertIs(options["lenient"], True)
        self.assertNotIn("lenient", json.loads(self.run_tool("check", "--json", scene).stdout)["scene"]["options"])


class ExitStatus(ToolTest):
    def status(self, *names_of_scenes: str) -> int:
        files = [self.file(f"{name}.json", getattr(scenes, name)) for name in names_of_scenes]
        return self.run_tool("check", *files).returncode

    def test_of_one_scene(self):
        for name, status in [("FREE", 0), ("CONTACT", 1), ("AT_START", 1), ("BAD", 2), ("UNDECIDED", 3)]:
            self.assertEqual(self.status(name), status, name)

    def test_of_several_scenes_is_the_worst(self):
        worst_first = [("BAD", 2), ("UNDECIDED", 3), ("CONTACT", 1), ("FREE", 0)]
        for k, (name, status) in enumerate(worst_first):
            better = [other for other, _ in worst_first[k:]]
            self.assertEqual(self.status(*better), status, name)
            self.assertEqual(self.status(*reversed(better)), status, name)


class Errors(ToolTest):
    def test_are_one_line_that_names_file_line_and_field(self):
        for text, message in [
                (scenes.BAD, 's.json:1: bodies[0].pose.positon: unknown key; did you mean "position"?'),
                (scenes.scene(scenes.body("a", pose={"quaternion_wxyz": [0, 0, 0, 0]})),
                 "s.json:1: bodies[0].pose.quaternion_wxyz: expected a quaternion [w, x, y, z], not zero, "
                 "its length in 1e-60 ... 1e60"),
                (scenes.scene(scenes.body("a", pose={"position": [0, 0, float("nan")]})),
                 's.json:1: expected a finite number, got "NaN"; JSON has no NaN and no infinity'),
                (scenes.scene(scenes.body("a"), options={"tolerance": -1}),
                 "s.json:1: options.tolerance: expected a number > 0, got -1"),
                ("{\n\"firstcontact\": 1,\n\"bodies\": [}",
                 's.json:3: expected a value (object, array, string, number, true, false or null), got "}"'),
        ]:
            self.assert_refused(self.run_tool("check", self.file("s.json", text)), message)

    def test_name_the_mesh_that_is_wrong(self):
        stl = bytes(80) + (2).to_bytes(4, "little") + bytes(60)
        ply = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n")
        for name, content, place in [("empty.obj", "", ""), ("cut.stl", stl, ": byte 144"),
                                     ("cut.ply", ply, ":11"), ("cut.glb", b"glTF\x02\0\0\0", ""),
                                     ("index.obj", "v 0 0 0\nf 1 2 3\n", ":2"), ("nan.obj", "v 0 0 nan\n", ":1")]:
            mesh = self.file(name, content)
            scene = self.file("s.json", scenes.scene({"name": "a", "shape": {"mesh": mesh}}))
            for arguments in (["check", scene], ["info", mesh]):
                result = self.run_tool(*arguments)
                self.assertEqual(result.returncode, 2, result)
                self.assertEqual(result.stdout, "")
                self.assertRegex(result.stderr, rf"^firstcontact: {re.escape(name + place)}: [^\n]+\n$")

    def test_name_the_file_that_is_missing(self):
        self.assert_refused(self.run_tool("check", "no.json"), "no.json: expected a scene file, found none")
        self.assert_refused(self.run_tool("check", "."), ".: expected a scene file, got a folder")
        scene = self.file("s.json", scenes.scene({"name": "a", "shape": {"mesh": "no.obj"}}))
        self.assert_refused(self.run_tool("check", scene), "s.json:1: bodies[0].shape.mesh: "
                            'expected a mesh file, found none at "no.obj"')

    def test_are_status_2_even_where_nobody_can_be_told(self):
        """Standard error is full, then closed."""
        for stream in ("2>/dev/full", "2>&-"):
            for arguments in ("check no.json", "check --fast"):
                self.assertEqual(self.run_in_shell(f"{arguments} {stream}").returncode, 2, (arguments, stream))
        self.file("bad.json", scenes.BAD)
        self.file("free.json", scenes.FREE)
        result = self.run_in_shell("check bad.json free.json 2>/dev/full")
        self.assertEqual((result.returncode, len(result.stdout.splitlines())), (2, 2), result)

    def test_are_kept_out_of_the_files_that_are_written(self):
        """A file must not get the number of a stream that is closed."""
        self.file("s.jsonl", scenes.BAD + "\n" + scenes.FREE)
        self.assertEqual(self.run_in_shell("check s.jsonl -o out.jsonl 2>&-").returncode, 2)
        answers = [json.loads(line) for line in (self.folder / "out.jsonl").read_text().splitlines()]
        self.assertEqual([a.get("verdict", "error") for a in answers], ["error", "free"])

    def test_tell_of_an_answer_that_could_not_be_written(self):
        self.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.file("s.json", scenes.FREE)
        for arguments in ("check s.json", "info m.obj", "info --json m.obj", "--help"):
            for stream in (">/dev/full", ">&-"):
                self.assert_refused(self.run_in_shell(f"{arguments} {stream}"),
                                    "standard output: cannot write all of the answer")

    def test_are_one_line_even_where_a_name_has_two(self):
        result = self.run_tool("check", "no\nsuch.json")
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr.count("\n"), 1)


class StandardInput(ToolTest):
    def ask(self, text: str, *arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run([TOOL, *arguments], cwd=self.folder, input=text, capture_output=True, text=True,
                              timeout=120, check=False)

    def test_is_a_scene(self):
        self.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        with_mesh = scenes.scene({"name": "a", "shape": {"mesh": "m.obj"}}, scenes.falling(1))
        for text, status in [(scenes.FREE, 0), (scenes.CONTACT, 1), (with_mesh, 1),
                             (json.dumps(json.loads(scenes.FREE), indent=2), 0)]:
            result = self.ask(text, "check", "-")
            self.assertEqual(result.returncode, status, result)
        self.assertTrue(self.ask(with_mesh, "check", "-").stdout.startswith("standard input: contact at "))

    def test_may_hold_a_scene_in_each_line(self):
        result = self.ask("\n".join(["", scenes.CONTACT, scenes.FREE, scenes.BAD]) + "\n", "check", "-", "--json")
        self.assertEqual(result.returncode, 2)
        answers = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([a.get("verdict", "error") for a in answers], ["contact", "free", "error"])
        self.assertEqual([a["line"] for a in answers], [2, 3, 4])

    def test_is_named_in_errors(self):
        for text, message in [("", "standard input:1: expected a value"), ("{", "standard input:1: expected"),
                              (scenes.BAD, "standard input:1: bodies[0].pose.positon: unknown key")]:
            result = self.ask(text, "check", "-")
            self.assertEqual(result.returncode, 2)
            self.assertTrue(result.stderr.startswith("firstcontact: " + message), result.stderr)

    def test_is_a_simulation(self):
        result = self.ask(scenes.DROP, "simulate", "-", "-o", "run.jsonl")
        self.assertEqual(result.returncode, 0, result)
        self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)


class Outputs(ToolTest):
    def test_follow_a_symbolic_link(self):
        """People link outputs to other disks: to a file, to none yet, along several links, into folders."""
        scene = self.file("s.json", scenes.FREE)
        (self.folder / "disk").mkdir()
        for name, target, there in [("a.json", "target.json", True), ("b.json", "new.json", False),
                                    ("c.json", "b.json", True), ("d.json", "disk/far.json", False),
                                    ("e.json", str(self.folder / "disk" / "absolute.json"), False)]:
            if there and target == "target.json":
                self.file(target, "old")
            (self.folder / name).symlink_to(target)
            self.assertEqual(self.run_tool("check", scene, "-o", name).returncode, 0)
            self.assertTrue((self.folder / name).is_symlink(), name)
            self.assertEqual(json.loads((self.folder / name).read_text())["verdict"], "free", name)
        self.assertEqual(sorted(p.name for p in (self.folder / "disk").iterdir()), ["absolute.json", "far.json"])

    def test_refuse_a_ring_of_links(self):
        scene = self.file("s.json", scenes.FREE)
        (self.folder / "a.json").symlink_to("b.json")
        (self.folder / "b.json").symlink_to("a.json")
        result = self.run_tool("check", scene, "-o", "a.json")
        self.assertEqual(result.returncode, 2)
        self.assertTrue((self.folder / "a.json").is_symlink())

    def test_beyond_a_limit_of_file_sizes_are_errors(self):
        """As on a full disk: a message, status 2, nothing half-written."""
        many = [scenes.body(f"body {k}", pose={"position": [3 * k, 0, 0]}) for k in range(40)]
        self.file("s.json", scenes.scene(*many))
        self.file("jobs.jsonl", scenes.scene(*many))
        for arguments, message in [
                ("check s.json -o out.json", "out.json: cannot write this file: File too large"),
                ("batch jobs.jsonl -o out.jsonl", "out.jsonl: cannot write all results: File too large")]:
            result = subprocess.run(["bash", "-c", f'ulimit -f 1; "$0" {arguments}', TOOL], cwd=self.folder,
                                    capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual(result.returncode, 2, result)
            self.assertEqual(result.stderr, f"firstcontact: {message}\n")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["jobs.jsonl", "out.jsonl", "out.jsonl.batch", "s.json"])


class JsonLines(ToolTest):
    LINES = "\n".join([scenes.CONTACT, scenes.BAD, "", scenes.FREE, "{", scenes.AT_START])

    def check_answers(self, text: str):
        answers = [json.loads(line) for line in text.splitlines()]
        self.assertEqual([a.get("verdict", "error") for a in answers],
                         ["contact", "error", "free", "error", "contact_at_start"])
        self.assertEqual([a.get("line") for a in answers], [1, 2, 4, 5, 6])
        self.assertTrue(answers[1]["error"].startswith("s.jsonl:2: bodies[0].pose.positon: unknown key"))

    def test_answers_every_line_in_order(self):
        result = self.run_tool("check", self.file("s.jsonl", self.LINES))
        self.assertEqual(result.returncode, 2)
        self.check_answers(result.stdout)
        self.assertEqual(len(result.stderr.splitlines()), 2)

    def test_goes_to_a_file_where_one_is_named(self):
        result = self.run_tool("check", "-o", "out.jsonl", self.file("s.jsonl", self.LINES))
        self.assertEqual(result.returncode, 2)
        self.check_answers((self.folder / "out.jsonl").read_text(encoding="utf-8"))
        self.assertIn("free: free for the whole step", result.stdout)

    def test_needs_a_scene(self):
        result = self.run_tool("check", self.file("s.jsonl", "\n \n"))
        self.assertEqual(result.returncode, 2)
        self.assertEqual(result.stderr, "firstcontact: s.jsonl: expected at least one scene, got none\n")

    def test_loads_a_mesh_once(self):
        """The file is gone when the second line comes, but its mesh is still there."""
        mesh = self.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        line = scenes.scene({"name": "a", "shape": {"mesh": mesh}}, scenes.falling(1)) + "\n"
        os.mkfifo(self.folder / "s.jsonl")
        process = self.start("check", "s.jsonl")
        with open(self.folder / "s.jsonl", "w", encoding="utf-8") as lines:
            lines.write(line)
            lines.flush()
            first = json.loads(process.stdout.readline())
            self.file(mesh, "no mesh any more")
            lines.write(line)
        second = json.loads(process.stdout.readline())
        self.assertEqual(process.wait(timeout=60), 1)
        process.communicate()
        self.assertEqual((first.pop("line"), second.pop("line")), (1, 2))
        self.assertEqual(first, second)


class OutputFile(ToolTest):
    def names(self) -> list:
        return sorted(path.name for path in self.folder.iterdir())

    def test_has_the_result(self):
        result = self.run_tool("check", "-o", "out.json", self.file("s.json", scenes.CONTACT))
        self.assertEqual(result.returncode, 1)
        self.assertEqual(json.loads((self.folder / "out.json").read_text())["verdict"], "contact")
        self.assertEqual(self.names(), ["out.json", "s.json"])

    def test_is_left_alone_by_bad_input(self):
        self.file("out.json", "old")
        result = self.run_tool("check", "-o", "out.json", self.file("s.json", scenes.BAD))
        self.assertEqual(result.returncode, 2)
        self.assertEqual((self.folder / "out.json").read_text(), "old")
        self.assertEqual(self.names(), ["out.json", "s.json"])

    def test_is_whole_at_every_instant(self):
        """While the second scene is not there yet, the file still has what it had before."""
        self.file("out.jsonl", "old")
        os.mkfifo(self.folder / "s.jsonl")
        process = self.start("check", "s.jsonl", "-o", "out.jsonl", "--json")
        with open(self.folder / "s.jsonl", "w", encoding="utf-8") as lines:
            lines.write(scenes.FREE + "\n")
            lines.flush()
            process.stdout.readline()
            self.assertEqual((self.folder / "out.jsonl").read_text(), "old")
            lines.write(scenes.CONTACT + "\n")
        process.communicate(timeout=60)
        self.assertEqual(len((self.folder / "out.jsonl").read_text().splitlines()), 2)
        self.assertEqual(self.names(), ["out.jsonl", "s.jsonl"])

    def test_may_be_read_as_any_new_file(self):
        self.run_tool("check", "-o", "out.json", self.file("s.json", scenes.FREE))
        plain = (self.folder / "s.json").stat().st_mode
        self.assertEqual(stat.S_IMODE((self.folder / "out.json").stat().st_mode), stat.S_IMODE(plain))

    def test_may_be_a_link_or_a_device(self):
        self.file("target.json", "old")
        (self.folder / "link.json").symlink_to("target.json")
        scene = self.file("s.json", scenes.FREE)
        self.assertEqual(self.run_tool("check", "-o", "link.json", scene).returncode, 0)
        self.assertTrue((self.folder / "link.json").is_symlink())
        self.assertEqual(json.loads((self.folder / "target.json").read_text())["verdict"], "free")
        self.assertEqual(self.run_tool("check", "-o", "/dev/null", scene).returncode, 0)
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    def test_may_be_a_pipe_or_the_standard_output(self):
        scene = self.file("s.json", scenes.FREE)
        piped = self.run_tool("check", scene, "--json", "-o", "/dev/stdout")  # A pipe to this test.
        self.assertEqual(piped.returncode, 0, piped.stderr)
        first, second = piped.stdout.splitlines()
        self.assertEqual(json.loads(first), json.loads(second))
        reader, writer = os.pipe()
        named = subprocess.run([TOOL, "check", scene, "-o", f"/dev/fd/{writer}"], pass_fds=[writer],
                               cwd=self.folder, capture_output=True, check=False)
        os.close(writer)
        with os.fdopen(reader, encoding="utf-8") as pipe:
            self.assertEqual(json.loads(pipe.read())["verdict"], "free")
        self.assertEqual(named.returncode, 0, named.stderr)

    def test_and_the_text_share_a_file(self):
        """Standard output goes into a file that holds something already."""
        scene = self.file("s.json", scenes.FREE)
        with open(self.folder / "out.txt", "w", encoding="utf-8") as out:
            out.write("before\n")
            out.flush()
            subprocess.run([TOOL, "check", scene, "--json", "-o", "/dev/stdout"], stdout=out,
                           cwd=self.folder, check=True)
        before, first, second = (self.folder / "out.txt").read_text().splitlines()
        self.assertEqual(before, "before")
        self.assertEqual(json.loads(first), json.loads(second))
        self.assertEqual(self.names(), ["out.txt", "s.json"])

    def test_keeps_the_permissions_of_what_it_replaces(self):
        scene = self.file("s.json", scenes.FREE)
        for mode in (0o600, 0o640, 0o755):
            self.file("out.json", "old")
            (self.folder / "out.json").chmod(mode)
            self.assertEqual(self.run_tool("check", "-o", "out.json", scene).returncode, 0)
            self.assertEqual(stat.S_IMODE((self.folder / "out.json").stat().st_mode), mode)
            self.assertEqual(json.loads((self.folder / "out.json").read_text())["verdict"], "free")

    def test_replaces_nothing_that_may_not_be_written(self):
        scene = self.file("s.json", scenes.FREE)
        self.file("out.json", "old")
        (self.folder / "out.json").chmod(0o444)
        self.assert_refused(self.run_tool("check", "-o", "out.json", scene),
                            "out.json: cannot write this file: Permission denied")
        self.assertEqual((self.folder / "out.json").read_text(), "old")
        self.assertEqual(self.names(), ["out.json", "s.json"])

    def test_is_never_the_scene(self):
        scene = self.file("s.json", scenes.FREE)
        for option in ("-o", "--svg"):
            self.assert_refused(self.run_tool("check", scene, option, "./s.json"),
                                f"{option} ./s.json: this would overwrite an input, s.json")
        self.assertEqual((self.folder / "s.json").read_text(), scenes.FREE)

    def inputs(self) -> dict:
        """Name and content of the files of a scene, and of a robot."""
        mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        link = '<link name="{}"><{}><geometry><mesh filename="{}"/></geometry></{}></link>'
        self.file("m.obj", mesh)
        self.file("hull.obj", mesh)
        self.file("link.obj", mesh)
        self.file("looks.obj", mesh)
        self.file("c.xyz", "0 0 0\n")
        self.file("h.txt", "0 0\n0 0\n")
        self.file("r.urdf", '<robot name="r">' + link.format("a", "collision", "link.obj", "collision") +
                  link.format("b", "visual", "looks.obj", "visual") + '<joint name="j" type="continuous">'
                  '<parent link="a"/><child link="b"/></joint></robot>')
        self.file("r.srdf", '<robot name="r"/>')
        self.file("t.csv", "time,j\n0,0\n1,1\n")
        shapes = [{"mesh": "m.obj"}, {"convex_hull": {"mesh": "hull.obj"}}, {"points": "c.xyz"},
                  {"heightmap": {"heights": "h.txt", "cell": [1, 1]}}]
        bodies = [{"name": f"body {k}", "shape": shape, "pose": {"position": [0, 0, 9 * k]}}
                  for k, shape in enumerate(shapes)]
        robot = {"name": "r", "urdf": "r.urdf", "srdf": "r.srdf", "trajectory": "t.csv",
                 "base": {"position": [0, 0, -9]}}
        self.file("s.json", json.dumps({"firstcontact": 1, "bodies": bodies, "robots": [robot]}))
        result = self.run_tool("check", "s.json")
        self.assertEqual(result.returncode, 0, result)
        return {path.name: path.read_bytes() for path in self.folder.iterdir()}

    def test_is_never_a_file_that_the_scene_names(self):
        before = self.inputs()
        (self.folder / "link").symlink_to("m.obj")
        for name in before:
            self.assert_refused(self.run_tool("check", "s.json", "-o", f"./{name}"),
                                f"-o ./{name}: this would overwrite an input, {name}")
        for option in ("--svg", "--gap"):
            self.assert_refused(self.run_tool("check", "s.json", option, "link"),
                                f"{option} link: this would overwrite an input, m.obj")
        self.assert_refused(self.run_tool("simulate", "s.json", "-o", "t.csv"),
                            "-o t.csv: this would overwrite an input, t.csv")
        robot = ["check", "--robot", "r.urdf", "--srdf", "r.srdf", "--trajectory", "t.csv", "--environment", "m.obj"]
        for name in ("r.urdf", "r.srdf", "t.csv", "m.obj", "link.obj"):
            self.assert_refused(self.run_tool(*robot, "-o", name), f"-o {name}: this would overwrite an input, {name}")
        for name, content in before.items():
            self.assertEqual((self.folder / name).read_bytes(), content)

    def test_is_never_a_file_of_any_of_many_scenes(self):
        """Those before it have an answer, but none in the place of the mesh."""
        self.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        line = scenes.scene({"name": "a", "shape": {"mesh": "m.obj"}}, scenes.falling(9))
        result = self.run_tool("check", self.file("s.jsonl", scenes.FREE + "\n" + line), "-o", "m.obj")
        self.assertEqual((result.returncode, result.stderr),
                         (2, "firstcontact: -o m.obj: this would overwrite an input, m.obj\n"))
        self.assertTrue((self.folder / "m.obj").read_text().startswith("v "))

    def test_is_never_another_output(self):
        scene = self.file("s.json", scenes.FREE)
        drop = self.file("drop.json", scenes.DROP)
        before = self.names()
        for command in (["check", scene, "-o", "a", "--gap", "./a"], ["simulate", drop, "-o", "a", "--html", "./a"]):
            self.assert_refused(self.run_tool(*command), f"{command[4]} ./a: this would overwrite the file of -o")
        self.assertEqual(self.names(), before)
        result = self.run_tool("check", scene, "-o", "/dev/null", "--gap", "/dev/null")
        self.assertEqual(result.returncode, 0, result)

    def test_needs_a_name(self):
        """An empty one is a shell's variable that is not set."""
        scene = self.file("s.json", scenes.FREE)
        for command, options in (("check", ["-o", "--svg", "--gap", "--html", "--robot", "--trajectory"]),
                                 ("simulate", ["-o", "--html"]), ("view", ["-o"]), ("batch", ["-o", "--html"])):
            for option in options:
                self.assert_refused(self.run_tool(command, scene, option, ""),
                                    f"{option} expects a file, got an empty name")

    def test_that_cannot_be_written_is_said_so(self):
        result = self.run_tool("check", "-o", "no/out.json", self.file("s.json", scenes.FREE))
        self.assert_refused(result, "no/out.json: cannot write this file: No such file or directory")


class Interrupt(ToolTest):
    def interrupted(self, *arguments: str) -> tuple:
        process = self.start("check", *arguments)
        time.sleep(1.5)
        self.assertIsNone(process.poll(), "ended by itself")
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)
        self.assertEqual(stderr, "")  # No progress where it is no terminal.
        return stdout

    def test_ends_with_what_is_proven(self):
        stdout = self.interrupted("--json", "-o", "out.json", self.file("s.json", scenes.ENDLESS))
        answer = json.loads(stdout)
        self.assertEqual((answer["verdict"], answer["reason"]), ("undecided", "cancelled"))
        self.assertLess(answer["t"], 1)
        self.assertEqual(json.loads((self.folder / "out.json").read_text()), answer)

    def test_is_told_in_words_too(self):
        stdout = self.interrupted(self.file("s.json", scenes.ENDLESS))
        self.assertIn("endless: undecided after t = ", stdout)
        self.assertIn("(cancelled)", stdout)

    def test_leaves_scenes_that_were_not_asked_undecided(self):
        os.mkfifo(self.folder / "s.jsonl")
        process = self.start("check", "s.jsonl")
        with open(self.folder / "s.jsonl", "w", encoding="utf-8") as lines:
            lines.write(scenes.FREE + "\n")
            lines.flush()
            self.assertEqual(json.loads(process.stdout.readline())["verdict"], "free")
            process.send_signal(signal.SIGINT)
            time.sleep(0.5)
            lines.write(scenes.FREE + "\n")
        self.assertEqual(process.communicate(timeout=60)[0], "")
        self.assertEqual(process.returncode, 3)

    def test_twice_ends_at_once(self):
        os.mkfifo(self.folder / "s.jsonl")
        process = self.start("check", "s.jsonl")
        with open(self.folder / "s.jsonl", "w", encoding="utf-8"):
            for _ in range(2):
                time.sleep(0.5)
                process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
        self.assertEqual(process.returncode, 128 + signal.SIGINT)

    def test_a_deadline_ends_it_too(self):
        result = self.run_tool("check", "--json", "--deadline", "0.3", self.file("s.json", scenes.ENDLESS))
        self.assertEqual(result.returncode, 3)
        self.assertEqual(json.loads(result.stdout)["reason"], "deadline")


    def test_a_deadline_beyond_the_clock_is_none(self):
        scene = self.file("s.json", scenes.CONTACT)
        for deadline in ("1e10", "1e300"):
            self.assertEqual(self.run_tool("check", "--deadline", deadline, scene).returncode, 1, deadline)


class Progress(ToolTest):
    def test_is_shown_on_a_terminal(self):
        ours, theirs = pty.openpty()
        process = self.start("check", "--deadline", "2", self.file("s.json", scenes.ENDLESS), stderr=theirs)
        process.communicate(timeout=60)
        os.close(theirs)
        shown = os.read(ours, 10000).decode()
        self.assertRegex(shown, r"endless: free until 0\.0000 s of 1\.0000 s \.\.\. 1\.\d s")  # A busy machine looks a little later.
        self.assertTrue(shown.endswith("\r\x1b[K"))  # Wiped out in the end.


class Plot(ToolTest):
    def test_is_a_picture_of_the_gap(self):
        title = json.loads(scenes.CONTACT)
        title["id"] = "a < b & c"
        self.run_tool("check", "--svg", "gap.svg", "--sample-rate", "10", self.file("s.json", json.dumps(title)))
        root = xml.etree.ElementTree.parse(self.folder / "gap.svg").getroot()
        self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
        self.assertIn("a < b & c", texts)
        self.assertIn("first contact at 250 ms", texts)
        self.assertEqual(len(list(root.iter("{http://www.w3.org/2000/svg}circle"))), 11)

    def test_has_a_title_that_fits(self):
        self.run_tool("check", "--svg", "gap.svg", self.file("s.json", {**json.loads(scenes.CONTACT), "id": "ä" * 300}))
        root = xml.etree.ElementTree.parse(self.folder / "gap.svg").getroot()
        title = next(root.iter("{http://www.w3.org/2000/svg}text")).text
        self.assertRegex(title, "^ä{30,70}…$")
        self.assertEqual(next(root.iter("{http://www.w3.org/2000/svg}title")).text, "ä" * 300)

    def test_is_a_table_with_a_proven_bound(self):
        self.run_tool("check", "--gap", "gap.csv", self.file("s.json", scenes.CONTACT))
        rows = (self.folder / "gap.csv").read_text().splitlines()
        self.assertEqual(rows[0], "t,time,distance,lower_bound")
        cells = [row.split(",") for row in rows[1:]]
        times = [float(row[0]) for row in cells]
        self.assertEqual(times, sorted(times))
        self.assertEqual((times[0], times[-1]), (0.0, 1.0))
        for row in cells:
            if row[2]:
                self.assertLessEqual(float(row[3]), float(row[2]))

    def test_is_of_one_scene(self):
        result = self.run_tool("check", "--svg", "gap.svg", self.file("s.jsonl", scenes.FREE))
        self.assert_refused(result, "--svg draws one scene; give one .json file")


def numbers(kind: str, base64_text: str) -> tuple:
    data = base64.b64decode(base64_text)
    return struct.unpack(f"<{len(data) // struct.calcsize(kind)}{kind}", data)


class ViewerPage(ToolTest):
    """Tools that are built without the page say so."""

    def setUp(self):
        super().setUp()
        self.template = pathlib.Path(TOOL).resolve().parent.parent / "share/firstcontact/viewer.html"
        self.missing = (f"{self.template}: the viewer's page is missing here; build it with "
                        "-DFIRSTCONTACT_BUILD_VIEWER=ON (needs npm)")

    def test_holds_the_result_of_a_check(self):
        scene = self.file("scene.json", scenes.CONTACT)
        result = self.run_tool("check", scene, "--html", "page.html", "-o", "result.json")
        if not self.template.exists():
            self.assert_refused(result, self.missing)
            return
        self.assertEqual(result.returncode, 1, result)
        page = (self.folder / "page.html").read_text(encoding="utf-8")
        answer = json.loads((self.folder / "result.json").read_text(encoding="utf-8"))
        data = json.loads(re.search(r'type="application/json">(.*?)</script>', page, re.DOTALL)[1])
        self.assertEqual({**data["result"], "pairs": None}, {**answer, "pairs": None})
        self.assertEqual(data["view"]["bodies"], [0, 1])

    def test_is_made_of_a_stored_result_too(self):
        scene = self.file("scene.json", scenes.FREE)
        self.run_tool("check", scene, "-o", "result.json")
        result = self.run_tool("view", "result.json", "--no-open")
        if not self.template.exists():
            self.assert_refused(result, self.missing)
            return
        self.assertEqual((result.returncode, result.stdout), (0, "result.html\n"), result)
        self.assertIn('"verdict":"free"', (self.folder / "result.html").read_text(encoding="utf-8"))

    def test_is_made_of_results_only(self):
        if not self.template.exists():
            self.skipTest("built without the viewer's page")
        self.assert_refused(
            self.run_tool("view", self.file("scene.json", scenes.FREE), "--no-open"),
            "scene.json: expected one result, as `firstcontact check SCENE -o FILE` writes it")
        self.assert_refused(self.run_tool("view", "none.json", "--no-open"),
                            "none.json: cannot be read")

    def run_of(self, page: str) -> dict:
        text = (self.folder / page).read_text(encoding="utf-8")
        return json.loads(re.search(r'type="application/json">(.*?)</script>', text, re.DOTALL)[1])["run"]

    def test_plays_a_run(self):
        scene = self.file("scene.json", scenes.DROP)
        made = self.run_tool("simulate", scene, "-o", "run.jsonl", "--html", "page.html")
        if not self.template.exists():
            self.assert_refused(made, self.missing)
            return
        self.assertEqual(made.returncode, 0, made)
        self.assertIn("  page       page.html\n", made.stdout)
        shown = self.run_of("page.html")
        header, *steps = [json.loads(line) for line in (self.folder / "run.jsonl").read_text().splitlines()]
        self.assertEqual(shown["header"], header)
        self.assertEqual(shown["steps"], [{**step, "bodies": [], "contacts": []} for step in steps])
        times = numbers("d", shown["ways"][0]["times"])
        self.assertEqual((len(shown["ways"]), times[0], times[-1]), (1, 0.0, steps[-1]["time"]))
        self.assertEqual(numbers("d", shown["ways"][0]["places"])[-3:], tuple(steps[-1]["bodies"][0]["position"]))
        counts = numbers("I", shown["contacts"]["until"])
        self.assertEqual(counts[-1], sum(len(step["contacts"]) for step in steps))
        self.assertGreater(counts[-1], 0)
        # The same of the record, and of a run that goes on.
        self.assertEqual(self.run_tool("view", "run.jsonl", "--no-open").stdout, "run.html\n")
        self.assertEqual(self.run_of("run.html"), shown)
        lines = (self.folder / "run.jsonl").read_text().splitlines(keepends=True)
        (self.folder / "run.jsonl").write_text("".join(lines[:4]))
        self.run_tool("simulate", scene, "-o", "run.jsonl", "--resume", "--html", "again.html")
        self.assertEqual(self.run_of("again.html"), shown)

    def test_needs_steps_of_a_run(self):
        if not self.template.exists():
            self.skipTest("built without the viewer's page")
        self.run_tool("simulate", self.file("scene.json", scenes.DROP), "-o", "run.jsonl")
        header = (self.folder / "run.jsonl").read_text().splitlines(keepends=True)[0]
        self.assert_refused(self.run_tool("view", self.file("none.jsonl", header), "--no-open"),
                            "none.jsonl: expected steps after the header; there is nothing to play")
        self.assert_refused(self.run_tool("simulate", "scene.json", "--html", "scene.json"),
                            "--html scene.json: this would overwrite an input, scene.json")

    def test_is_never_an_input(self):
        if not self.template.exists():
            self.skipTest("built without the viewer's page")
        mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        self.file("m.obj", mesh)
        stone = {**json.loads(scenes.DROP)["bodies"][0], "pose": {"position": [0, 0, 9]}}
        scene = self.file("s.json", json.dumps({"firstcontact": 1, "simulation": {"duration": 0.02}, "bodies": [
            stone, {"name": "floor", "shape": {"mesh": "m.obj"}}]}))
        self.assertEqual(self.run_tool("check", scene, "-o", "result.json").returncode, 0)
        self.assertEqual(self.run_tool("simulate", scene, "-o", "run.jsonl").returncode, 0)
        for option, command in (("--html", ["check", scene]), ("--html", ["simulate", scene]),
                                ("-o", ["view", "result.json"]), ("-o", ["view", "run.jsonl"])):
            self.assert_refused(self.run_tool(*command, option, "m.obj"),
                                f"{option} m.obj: this would overwrite an input, m.obj")
        self.assertEqual((self.folder / "m.obj").read_text(), mesh)

    def test_shows_one_scene(self):
        lines = self.file("scenes.jsonl", scenes.FREE + "\n" + scenes.CONTACT)
        self.assert_refused(self.run_tool("check", lines, "--html", "page.html"),
                            "--html shows one scene; give one .json file")


class Info(ToolTest):
    def test_counts_and_measures(self):
        mesh = self.file("m.obj", "v 0 0 0\nv 2 0 0\nv 0 0.001 0\nv 7 7 7\nf 1 2 3\n")
        result = self.run_tool("info", mesh)
        self.assertEqual(result.returncode, 0)
        for line in ("triangles              1", "edges                  3", "open edges             3",
                     "surface                not closed", "unused vertices        1",
                     "size                   2 m x 1 mm x 0 m"):
            self.assertIn(line, result.stdout)

    def test_says_of_what_it_knows_files(self):
        result = self.run_tool("info", self.file("s.json", scenes.FREE))
        self.assert_refused_with(result, "s.json: expected a mesh (.obj, ", "a cloud (.ply, .pcd, .xyz)",
                                 "a robot (.urdf), got \".json\"; of a scene `firstcontact check --explain`")

    def test_knows_a_cloud(self):
        header = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nend_header\n")
        points = "0 0 0\n1 2 3\n0 0 0\n"
        for cloud in (self.file("c.xyz", points), self.file("c.ply", header + points)):
            result = self.run_tool("info", cloud)
            self.assertEqual(result.returncode, 0, result.stderr)
            for line in ("points                 3", "points at one place    1",
                         "size                   1 m x 2 m x 3 m"):
                self.assertIn(line, result.stdout)

    def test_passes_over_a_byte_order_mark(self):
        for name, text in (("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ("c.xyz", "0 0 0\n1 2 3\n")):
            plain = self.run_tool("info", self.file(name, text))
            marked = self.run_tool("info", self.file(name, "\ufeff" + text))
            self.assertEqual((marked.returncode, marked.stdout), (0, plain.stdout), marked)

    def test_asks_whether_the_unit_is_right(self):
        # Beside a ball of 2 m.
        for size, alone, asks in ((99, False, False), (150, True, False), (250, True, True), (1000, True, True)):
            mesh = self.file("big.obj", f"v 0 0 0\nv {size} 0 0\nv 0 1 0\nf 1 2 3\n")
            said = self.run_tool("info", mesh).stdout
            self.assertIn("unit                   none in the file: metres are taken", said)
            self.assertEqual("is the unit right?" in said, alone)
            scene = self.file("big.json", json.dumps({"firstcontact": 1, "bodies": [
                {"name": "big", "shape": {"mesh": "big.obj"}},
                {"name": "ball", "shape": {"sphere": {"radius": 1}}, "pose": {"position": [0, 0, 9]}}]}))
            result = self.run_tool("check", scene)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(f'warning    body "big" is {size}' in result.stdout, asks)
            self.assertEqual("--environment-scale 0.001" in result.stdout, asks)
            told = json.loads(self.run_tool("check", "--json", scene).stdout).get("warnings", [])
            self.assertEqual(len(told), asks)

    ARM = """<robot name="arm">
<link name="base"><inertial><mass value="2.5"/><inertia ixx="1" iyy="1" izz="1"/></inertial><collision><geometry><mesh filename="m.obj"/></geometry></collision></link>
<link name="upper"><collision><geometry><sphere radius="0.5"/></geometry></collision></link>
<link name="tip"><inertial><origin xyz="0 0 1"/><mass value="0.25"/></inertial><visual><geometry><box size="1 1 1"/></geometry></visual></link>
<joint name="j" type="revolute"><parent link="base"/><child link="upper"/>
<limit lower="-1" upper="2" velocity="0" effort="1"/></joint>
<joint name="k" type="fixed"><parent link="upper"/><child link="tip"/></joint>
</robot>
"""

    def test_prints_the_tree_of_a_robot(self):
        self.file("m.obj", "v 0 0 0\nv 300 0 0\nv 0 1 0\nf 1 2 3\n")
        result = self.run_tool("info", self.file("arm.urdf", self.ARM))
        self.assertEqual(result.returncode, 0, result.stderr)
        for line in ("robot                  arm", "links                  3, 2 with collision geometry",
                     "joints                 1 fixed, 1 revolute", "coordinates            1",
                     "mass                   2.75 kg, of 2 of 3 links\n",
                     "    base; 2.5 kg; m.obj (1 triangles)\n"
                     "      upper by j: revolute, -1 ... 2 rad, up to 0 rad/s; no mass; sphere\n"
                     "        tip by k: fixed; 0.25 kg; no collision geometry\n",
                     "joint j: velocity limit 0: taken for none", "m.obj: open edges 3",
                     "link base: 300 m across; is its unit right?",
                     "link tip: is seen, but has no collision geometry"):
            self.assertIn(line, result.stdout)

    def test_indents_long_chains_no_further(self):
        links = "".join(f"<link name='l{k}'/>" for k in range(2000))
        joints = "".join(f"<joint name='j{k}' type='fixed'><parent link='l{k}'/><child link='l{k + 1}'/></joint>"
                         for k in range(1999))
        result = self.run_tool("info", self.file("r.urdf", f"<robot name='r'>{links}{joints}</robot>"))
        self.assertEqual(result.returncode, 0, result.stderr)
        for depth, start in ((40, 84 * " " + "l40 by"), (41, 84 * " " + "(41) l41 by"), (1999, 84 * " " + "(1999) l1999 by")):
            self.assertIn(f"\n{start} j{depth - 1}: fixed;", result.stdout)
        self.assertLess(len(result.stdout), 1000000)

    def test_says_whether_masses_are_given(self):
        for urdf, told in (
                ("<robot name='r'><link name='a'/></robot>", "not given of any link"),
                ("<robot name='r'><link name='a'><inertial><mass value='3'/></inertial></link></robot>", "3 kg\n")):
            result = self.run_tool("info", self.file("r.urdf", urdf))
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("mass                   " + told, result.stdout)

    def test_prints_json(self):
        mesh = self.file("m.obj", "v 0 0 0\nv 300 0 0\nv 0 1 0\nf 1 2 3\n")
        files = [self.file("arm.urdf", self.ARM), mesh, self.file("c.xyz", "0 0 0\n1 2 3\n0 0 0\n")]
        result = self.run_tool("info", "--json", *files)
        self.assertEqual(result.returncode, 0, result.stderr)
        robot, triangle, cloud = [json.loads(line) for line in result.stdout.splitlines()]
        self.assertEqual([robot["file"], triangle["file"], cloud["file"]], files)
        self.assertEqual((robot["name"], robot["mass"], robot["links_without_mass"]), ("arm", 2.75, 1))
        self.assertEqual([(link["name"], link["mass"], link["centre_of_mass"]) for link in robot["links"]],
                         [("base", 2.5, [0, 0, 0]), ("upper", None, None), ("tip", 0.25, [0, 0, 1])])
        self.assertEqual([shape["type"] for link in robot["links"] for shape in link["collision"]],
                         ["mesh", "sphere"])
        self.assertEqual([(joint["type"], joint["lower"], joint["effort"]) for joint in robot["joints"]],
                         [("revolute", -1, 1), ("fixed", None, None)])
        self.assertIn("m.obj: open edges 3", robot["remarks"])
        self.assertEqual((triangle["triangles"], triangle["open_edges"], triangle["volume"]), (1, 3, None))
        self.assertEqual(triangle["bounds"], {"lower": [0, 0, 0], "upper": [300, 1, 0]})
        self.assertEqual((cloud["points"], cloud["points_at_one_place"]), (3, 1))
        self.assertEqual(self.run_tool("info", "--json", "--always-in-contact", "arm.urdf").returncode, 2)

    def test_prints_the_pairs_that_always_touch(self):
        self.file("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        result = self.run_tool("info", "--always-in-contact", self.file("arm.urdf", self.ARM))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout,
                         '<disable_collisions link1="base" link2="upper" reason="Adjacent"/>\n')
        self.assert_refused(self.run_tool("info", "--always-in-contact", "m.obj"),
                            "m.obj: --always-in-contact expects a robot, a .urdf file")

    def test_names_the_place_of_an_error_in_a_robot(self):
        robot = self.file("arm.urdf", self.ARM.replace("m.obj", "package://pack/m.obj"))
        roots = str(pathlib.Path(robot).parent / "roots")
        result = self.run_tool("info", robot, "--package-root", roots)
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"arm.urdf:2: <mesh>: no package root holds a folder 'pack' "
                                        r"\(roots: [^\n]*roots\); name the folder that holds it: --package-root[^\n]*\n$")

    def test_refuses_a_cut_off_cloud(self):
        cloud = self.file("c.pcd", "FIELDS x y z\nPOINTS 2\nDATA ascii\n0 0 0\n")
        result = self.run_tool("info", cloud)
        self.assertEqual(result.returncode, 2)
        self.assertIn("c.pcd:5: expected point 2 of 2, got the end of the file", result.stderr)


if __name__ == "__main__":
    TOOL = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
