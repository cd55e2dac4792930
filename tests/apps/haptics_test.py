"""`firstcontact haptics` as a user meets it: runs that are proven, logs, errors that name what is wrong.

    haptics_test.py TOOL PLUGIN [unittest arguments]

PLUGIN is the example of a plug-in, as a shared library.
"""

import collections
import csv
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import time
import unittest
import urllib.error
import urllib.request

import haptic_services
import tool_test


PLATE = {"name": "plate", "shape": {"box": {"size": [0.2, 0.2, 0.0001]}}}
PEG = {"name": "peg", "shape": {"box": {"size": [0.02, 0.02, 0.04]}}, "pose": {"position": [0, 0, 0.04]}}


PLUGIN = ""


def scene(tools=({"body": "peg"},), bodies=(PLATE, PEG), **more):
    return {"firstcontact": 1, "bodies": list(bodies), "haptics": {"tools": list(tools), **more}}


class Haptics(tool_test.ToolTest):
    def haptics(self, *arguments, out="run.jsonl"):
        return self.run_tool("haptics", "scene.json", *arguments, "-o", out)

    def has_viewer(self):
        return (pathlib.Path(tool_test.TOOL).parent.parent / "share/firstcontact/viewer.html").exists()

    def assert_writes_nothing(self, result, *words):
        self.assert_refused_with(result, *words)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name != "scene.json"
                          and path.suffix != ".csv"], [])

    def test_is_felt_recorded_and_proven(self):
        self.file("scene.json", scene(friction=0.3))
        result = self.run_tool("haptics", "scene.json", "--device", "simulated", "--duration", "0.5", "--speed", "5",
                           "-o", "run.jsonl", "--ticks", "ticks.csv", "--cycles", "cycles.csv", "--plot", "plot.svg")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("no tool passed through anything", result.stdout)
        self.assertIn("2000 of the force loop, 500 cycles", result.stdout)
        proof = self.run_tool("verify", "run.jsonl", "--json")
        self.assertEqual(proof.returncode, 0, proof)
        self.assertEqual(json.loads(proof.stdout)["verdict"], "proven")
        with open(self.folder / "ticks.csv", encoding="utf-8") as file:
            ticks = list(csv.DictReader(file))
        self.assertEqual(len(ticks), 2000)
        self.assertEqual([int(tick["time_ns"]) for tick in ticks[:3]], [0, 250000, 500000])
        self.assertLessEqual(max(float(tick["command_fz"]) for tick in ticks), 10.0)
        with open(self.folder / "cycles.csv", encoding="utf-8") as file:
            cycles = list(csv.DictReader(file))
        self.assertEqual(len(cycles), 500)
        self.assertEqual({(cycle["angle_rad"], cycle["processor_s"]) for cycle in cycles}, {("0", "")})
        self.assert_devices_are_those_of_ticks(ticks, cycles)
        self.assertTrue((self.folder / "plot.svg").read_text().startswith("<svg"))

    def assert_devices_are_those_of_ticks(self, ticks, cycles):
        """Each step of the record has the device of the tick that its cycle followed. Gives the forces."""
        tick_at = {tick["time_ns"]: tick for tick in ticks}
        steps = [json.loads(line) for line in (self.folder / "run.jsonl").read_text().splitlines()[1:]]
        self.assertEqual(len(steps), len(cycles))
        for cycle, step in zip(cycles, steps):
            (device,), tick = step["devices"], tick_at[cycle["time_ns"]]
            self.assertEqual(device["body"], 1)
            for key, row in (("position", "target_p"), ("force", "force_"), ("torque", "torque_")):
                for axis, value in zip("xyz", device[key]):
                    self.assertAlmostEqual(value, float(tick[row + axis]), delta=1e-6 * max(1, abs(value)))
        return [step["devices"][0]["force"] for step in steps]

    def handle(self, *options):
        """The places along z of a handle that a simulated hand leads, in the order of ticks."""
        result = self.haptics("--device", "simulated", "--duration", "0.2", "--ticks", "ticks.csv", "--force", *options)
        self.assertEqual(result.returncode, 0, result)
        with open(self.folder / "ticks.csv", encoding="utf-8") as file:
            return [float(tick["device_pz"]) for tick in csv.DictReader(file)]

    def test_takes_a_hand_of_another_kind(self):
        self.file("scene.json", scene())
        usual = self.handle()
        for option, value in (("--hand-stiffness", "1500"), ("--hand-mass", "1"), ("--hand-tremor", "0.001")):
            self.assertNotEqual(self.handle(option, value), usual, option)
        loose = self.handle("--hand-stiffness", "0")  # Only the damper pulls the handle.
        self.assertLess(max(map(abs, loose)), 0.8 * max(map(abs, usual)))
        coarse = self.handle("--encoder-step", "0.001")
        self.assertTrue(all(abs(z / 0.001 - round(z / 0.001)) < 1e-9 for z in coarse), coarse[:9])
        self.assertGreater(len(set(coarse)), 2)
        exact = self.handle("--encoder-step", "0")
        self.assertFalse(all(abs(z / 1e-5 - round(z / 1e-5)) < 1e-6 for z in exact))
        for option, value, kept in (("--hand-stiffness", "1501", "from 0 to 1500"), ("--hand-mass", "0.04", "0.05 to 1"),
                                    ("--hand-tremor", "-1e-9", "0 to 0.01"), ("--encoder-step", "nan", "0 to 0.01")):
            result = self.haptics("--device", "simulated", option, value, out="other.jsonl")
            self.assert_refused_with(result, option, kept, value)
        self.recording((0, 0), (1_000_000, 0))
        self.assert_refused_with(self.haptics("--device", "hand.csv", "--hand-mass", "1", out="other.jsonl"),
                                 "--hand-mass is for --device simulated")

    def test_is_the_same_on_every_run(self):
        self.file("scene.json", scene())
        for name in ("a", "b"):
            result = self.run_tool("haptics", "scene.json", "--device", "simulated", "--duration", "0.1",
                                   "-o", f"{name}.jsonl", "--ticks", f"{name}.csv")
            self.assertEqual(result.returncode, 0, result)
        for end in (".jsonl", ".csv"):
            self.assertEqual((self.folder / f"a{end}").read_bytes(), (self.folder / f"b{end}").read_bytes())

    def jaws(self, grip={"joints": {"slide": [0, 0.035]}}):
        """The scene of a gripper above a cube of 4 cm."""
        path = pathlib.Path(__file__).parents[2] / "benchmarks/haptics/scenes/jaws_on_cube.json"
        scene = json.loads(path.read_text())
        scene["robots"][0]["urdf"] = str(path.parent / "jaws.urdf")
        scene["haptics"]["tools"][0]["grips"] = [grip]
        self.file("scene.json", scene)

    def glove(self, grips, columns=",grip0", head=()):
        """A recording of a hand that goes down by 1 cm, then closes."""
        lines = ["# firstcontact recording: 1", *head, "time_ns,sequence,x,y,z,qw,qx,qy,qz" + columns]
        for k, grip in enumerate(grips):
            lines.append(f"{k * 1000000},{k + 1},0,0,{max(-0.015, -1e-4 * k)},1,0,0,0{grip}")
        self.file("glove.csv", "\n".join(lines) + "\n")

    def test_closes_jaws_on_a_cube(self):
        self.jaws()
        # 35 mm in 6 ms: 5.8 m/s.
        closing = [f",{min(1, max(0, (k - 300) / 6))}" for k in range(600)]
        self.glove(closing, head=["# max_grip_effort: 2"])
        result = self.haptics("--device", "glove.csv", "--ticks", "ticks.csv", "--cycles", "cycles.csv")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("work from open to closed", result.stdout)
        proof = json.loads(self.run_tool("verify", "run.jsonl", "--json").stdout)
        self.assertEqual(proof["verdict"], "proven", proof)
        self.assertGreater(proof["least_distance"], 0)
        with open(self.folder / "cycles.csv", encoding="utf-8") as file:
            cycles = list(csv.DictReader(file))
        self.assertAlmostEqual(float(cycles[-1]["joint0"]), 0.015, delta=3e-5)
        with open(self.folder / "ticks.csv", encoding="utf-8") as file:
            ticks = list(csv.DictReader(file))
        self.assertEqual({float(tick["effort_j0"]) for tick in ticks[:1200]}, {0.0})
        self.assertAlmostEqual(float(ticks[-1]["effort_j0"]), -20, delta=0.2)
        self.assertAlmostEqual(float(ticks[-1]["command_g0"]), -0.7, delta=0.007)
        lines = (self.folder / "run.jsonl").read_text().splitlines()
        step = json.loads(lines[500])
        step["bodies"][-1]["pieces"][0][1] += 0.02
        lines[500] = json.dumps(step)
        self.file("forged.jsonl", "\n".join(lines) + "\n")
        self.assert_refused_with(self.run_tool("verify", "forged.jsonl"), '"gripper/left" jumps by 0.02 m')

    def test_is_compared_with_its_scene(self):
        for write in (lambda: self.file("scene.json", scene()), self.jaws):  # Without and with a robot.
            write()
            self.assertEqual(self.haptics("--device", "simulated", "--duration", "0.05", "--force").returncode, 0)
            self.assertEqual(self.run_tool("verify", "run.jsonl", "--scene", "scene.json").returncode, 0)
            self.file("scene.json", (self.folder / "scene.json").read_text() + " ")
            self.assert_refused_with(self.run_tool("verify", "run.jsonl", "--scene", "scene.json"),
                                     "run.jsonl: the run is not one of scene.json as it is now; record it again")

    def recording(self, *samples):
        """A hand that is at a height at a time each, in ns."""
        lines = ["# firstcontact recording: 1", "time_ns,sequence,x,y,z,qw,qx,qy,qz"]
        lines += [f"{time},{k},0,0,{z},1,0,0,0" for k, (time, z) in enumerate(samples)]
        self.file("hand.csv", "\n".join(lines) + "\n")

    def test_gives_one_force_on_a_device_of_another_scale(self):
        """A tool of half the scale: the peg is pressed 5 mm into the plate, which is 5 N; the hand feels half."""
        self.file("scene.json", scene(tools=[{"body": "peg", "scale": 0.5}]))
        self.recording(*((1_000_000 * k, -min(0.05, 1e-4 * k)) for k in range(1000)))
        result = self.haptics("--device", "hand.csv", "--ticks", "ticks.csv", "--cycles", "cycles.csv")
        self.assertEqual(result.returncode, 0, result)
        ticks, cycles = ([*csv.DictReader((self.folder / name).read_text().splitlines())]
                         for name in ("ticks.csv", "cycles.csv"))
        forces = self.assert_devices_are_those_of_ticks(ticks, cycles)
        self.assertAlmostEqual(forces[-1][2], 2.5, delta=0.05)
        self.assertAlmostEqual(float(ticks[-1]["force_z"]), 2.5, delta=0.05)

    def ticks_that_are_alike(self, *names):
        """The ticks of the first table, in which a force is felt, and whose numbers are those of the second one."""
        first, second = [self.table(name) for name in names]
        self.assertTrue(any(float(tick["force_z"]) for tick in first))
        self.assertEqual(len(first), len(second))
        # A recording has the times of ticks in place of those of samples.
        other = {key for one, two in zip(first, second) for key in one if one[key] != two[key]} - {"sample_ns"}
        self.assertEqual(other, set())
        return first

    def table(self, name):
        with open(self.folder / name, encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_records_a_hand_that_plays_again(self):
        """The forces of the second session are those of the first one, tick by tick."""
        self.file("scene.json", scene(bodies=(PLATE, PEG | {"pose": {"position": [0, 0, 0.021]}})))
        some = ("--duration", "0.5", "--force", "--ticks")
        first = self.haptics("--device", "simulated", "--speed", "5", "--seed", "2", *some, "first.csv",
                             "--record", "hand.csv")
        self.assertEqual(first.returncode, 0, first)
        self.assertIn("hand.csv; --device plays it again", first.stdout)
        again = self.haptics("--device", "hand.csv", *some, "again.csv")
        self.assertEqual(again.returncode, 0, again)
        self.assertEqual(len(self.ticks_that_are_alike("first.csv", "again.csv")), 2000)
        self.assert_refused_with(self.haptics("--device", "hand.csv", "--record", "hand.csv", out="other.jsonl"),
                                 "hand.csv")
        self.file("precious.csv", "here")
        self.assert_refused_with(self.haptics("--device", "simulated", "--record", "precious.csv", out="other.jsonl"),
                                 "precious.csv: holds something already", "--force")
        two = ("--record", "a.csv", "--record", "b.csv")
        self.assert_refused_with(self.haptics("--device", "simulated", *two, out="other.jsonl"),
                                 "--record", "for each --device, 1; got 2")
        for name in ("a.csv", "b.csv", "other.jsonl"):
            self.assertFalse((self.folder / name).exists(), name)

    def test_records_what_a_hand_lacked(self):
        """Waits, silences and losses of two devices are played at their ticks, and so is the end."""
        pegs = [{**PEG, "name": name, "pose": {"position": [x, 0, 0.021]}} for name, x in (("left", -0.05), ("right", 0.05))]
        self.file("scene.json", scene([{"body": "left"}, {"body": "right"}], [PLATE, *pegs]))
        head = "# firstcontact recording: 1\n# kind: pose\n# sensed: 111111\ntime_ns,sequence,status,x,y,z,qw,qx,qy,qz\n"

        def hand(words):
            return head + "".join(f"{7000000 * k},{k // 2},{word},0,0,{-0.0005 * k},1,0,0,0\n"
                                  for k, word in enumerate(words))
        self.file("a.csv", hand(["waiting"] * 4 + ["live"] * 8 + ["lost"] * 3 + ["live"] * 4))
        self.file("b.csv", hand(["live"] * 9 + ["silent"] * 3 + ["live"] * 2 + ["ended"] * 2))
        some = ("--duration", "0.2", "--force", "--ticks")
        first = self.haptics("--device", "a.csv", "--device", "b.csv", *some, "first.csv",
                             "--record", "c.csv", "--record", "d.csv")
        self.assertEqual(first.returncode, 0, first)
        self.assertEqual(self.haptics("--device", "c.csv", "--device", "d.csv", *some, "again.csv").returncode, 0)
        ticks = self.ticks_that_are_alike("first.csv", "again.csv")
        self.assertEqual({tick["status"] for tick in ticks}, {"waiting", "live", "lost", "silent", "ended"})

    def test_plays_the_last_sample_of_a_recording(self):
        self.file("scene.json", scene())
        for samples, count in (([(0, 0), (10_000_000, 0.01)], 440), ([(5, 0.01)], 400)):
            self.recording(*samples)
            result = self.haptics("--device", "hand.csv", "--ticks", "ticks.csv", "--force")
            self.assertEqual(result.returncode, 0, result)
            with open(self.folder / "ticks.csv", encoding="utf-8") as file:
                ticks = list(csv.DictReader(file))
            self.assertEqual(len(ticks), count)
            self.assertEqual((ticks[-1]["status"], float(ticks[-1]["device_pz"])), ("live", 0.01))

    def test_names_a_recording_that_is_too_long(self):
        self.file("scene.json", scene())
        for last in (2**63 - 1, 10**18 - 2**63):
            self.recording((-2**63, 0), (last, 0))
            self.assert_writes_nothing(self.haptics("--device", "hand.csv"), "hand.csv: time_ns: the times span ",
                                       "at most 1e9 s", "--duration")
            self.assertEqual(self.haptics("--device", "hand.csv", "--duration", "0.01", "--force").returncode, 0)
            (self.folder / "run.jsonl").unlink()

    def test_names_grips_that_nothing_closes(self):
        self.jaws()
        self.glove([""] * 10, columns="")
        self.assert_writes_nothing(self.haptics("--device", "glove.csv"), "scene.json",
                                   '"gripper" follow 1 values', 'give grips a "button"')
        self.glove([",0"] * 5 + [",nan"])
        self.assert_writes_nothing(self.haptics("--device", "glove.csv"), "glove.csv:8: column 10 (grip0)", "'nan'")
        self.jaws({"joints": {"slid": [0, 0.035]}})
        self.assert_writes_nothing(self.haptics("--device", "simulated"), "grips[0].joints.slid", 'expected one of "slide"')
        self.jaws({"joints": {"slide": [0, 0.05]}})
        self.assert_writes_nothing(self.haptics("--device", "simulated"), "within its limits, 0 to 0.036, got 0.05")
        self.jaws({"joints": {"slide": [0, 0.035]}, "button": 0, "seconds": 0.1})
        self.assertEqual(self.haptics("--device", "simulated", "--duration", "0.2").returncode, 0)

    def test_refuses_a_button_that_a_recording_has_no_column_for(self):
        self.jaws({"joints": {"slide": [0, 0.035]}, "button": 1, "seconds": 0.1})
        self.glove([""] * 10, columns="")
        self.assert_writes_nothing(self.haptics("--device", "glove.csv"), "scene.json",
                                   "button of a grip is 1", "the device has 0 buttons")
        self.glove([",2"] * 10, columns=",buttons")
        self.assertEqual(self.haptics("--device", "glove.csv").returncode, 0)

    def test_keeps_a_run_that_is_there(self):
        self.file("scene.json", scene())
        some = ("--device", "simulated", "--duration", "0.1")
        self.assertEqual(self.haptics(*some).returncode, 0)
        run = (self.folder / "run.jsonl").read_text()
        self.file("run.jsonl", "".join(run.splitlines(keepends=True)[:50]))
        result = self.haptics(*some)
        self.assert_refused_with(result, "run.jsonl", "49 of 100 steps", "--force")
        self.assertNotIn("--resume", result.stderr)
        self.assertEqual(self.haptics(*some, "--force").returncode, 0)
        self.assertEqual((self.folder / "run.jsonl").read_text(), run)

    def test_refuses_folders_that_are_missing_before_the_session(self):
        self.file("scene.json", scene())
        for option, *needs in (("--ticks",), ("--cycles",), ("--plot",), ("--html",), ("--timing", "--wall")):
            if option == "--html" and not self.has_viewer():
                continue
            result = self.haptics("--device", "simulated", "--duration", "1e6", option, "none/file", *needs)
            self.assert_writes_nothing(result, "none/file: cannot write this file")

    def test_moves_a_sphere_that_is_a_point_with_a_radius(self):
        self.file("scene.json", scene(bodies=[PLATE, {**PEG, "shape": {"sphere": {"radius": 0.01}}}]))
        result = self.haptics("--device", "simulated", "--duration", "1", "--ticks", "ticks.csv")
        self.assertEqual(result.returncode, 0, result)
        with open(self.folder / "ticks.csv", encoding="utf-8") as file:
            self.assertGreater(max(abs(float(tick["target_px"])) for tick in csv.DictReader(file)), 0.002)

    def peak_memory(self, *arguments):
        """[bytes]  Of a session, however its allocator keeps what is freed."""
        process = self.start("haptics", "scene.json", "--device", "simulated", "--force", *arguments,
                             env={**os.environ,
                                  "ASAN_OPTIONS": "quarantine_size_mb=1:thread_local_quarantine_size_kb=64"})
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(process.returncode, 0, process.stderr.read())
        return usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024)

    def test_takes_no_more_memory_for_a_longer_session(self):
        self.file("scene.json", scene())
        files = ("-o", "run.jsonl", "--ticks", "ticks.csv", "--cycles", "cycles.csv", "--plot", "plot.svg")
        for clock, short, long in (((), 1, 16), (("--wall",), 1, 4)):
            least = self.peak_memory("--duration", str(short), *clock, *files)
            more = self.peak_memory("--duration", str(long), *clock, *files)
            # 15 s are 15,000 cycles and 60,000 ticks: 100 bytes of each tick would be 6 MB.
            self.assertLess(more, least + 4e6, clock)
            if not clock:  # A busy machine skips ticks on the wall.
                self.assertGreater((self.folder / "ticks.csv").stat().st_size, 2e6)

    def test_runs_on_the_wall(self):
        self.file("scene.json", scene())
        result = self.run_tool("haptics", "scene.json", "--device", "simulated", "--duration", "0.1", "--wall",
                               "-o", "run.jsonl", "--timing", "timing.csv", "--ticks", "ticks.csv",
                               "--cycles", "cycles.csv")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("SCHED_FIFO", result.stdout)
        self.assertRegex(result.stdout, r"empty loop +[1-9]\d* ticks, late by")
        self.assert_counts_ticks_by_contacts(result.stdout)
        tables = []
        for name in ("ticks.csv", "cycles.csv"):
            with open(self.folder / name, encoding="utf-8") as file:
                tables.append(list(csv.DictReader(file)))
        self.assert_devices_are_those_of_ticks(*tables)
        self.assertTrue(all(0.0 < float(cycle["processor_s"]) < 100.0 for cycle in tables[1]))
        self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)

    def assert_counts_ticks_by_contacts(self, answer):
        """Requires that timing.csv has each tick once more, by its number of contacts."""
        ticks = collections.Counter()
        with open(self.folder / "timing.csv", encoding="utf-8") as file:
            for line in csv.DictReader(file):
                ticks[line["what"]] += int(line["count"])
        by_contacts = {what: count for what, count in ticks.items() if what.startswith("tick_cpu_contacts_")}
        self.assertGreater(ticks["tick_cpu"], 0)
        self.assertEqual(sum(by_contacts.values()), ticks["tick_cpu"])
        self.assertIn(f"{by_contacts['tick_cpu_contacts_0']} ticks with 0 contacts: median", answer)

    def test_runs_an_empty_loop_for_as_long_as_the_session(self):
        self.file("scene.json", scene())
        result = self.run_tool("haptics", "scene.json", "--device", "simulated", "--duration", "0.3", "--wall",
                               "--empty-loop", "5", "--timing", "timing.csv")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("empty loop 1200 ticks", result.stdout)
        self.assert_refused_with(self.haptics("--device", "simulated", "--empty-loop", "1"), "--wall")

    def felt_by(self, device, *arguments):
        """Runs a device of a hand against the plate, proves the run, and gives the ticks."""
        self.file("scene.json", scene())
        result = self.run_tool("haptics", "scene.json", "--device", device, "-o", "run.jsonl", "--ticks", "ticks.csv",
                               *arguments)
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("SCHED_FIFO", result.stdout)  # On the wall, although nobody asked for it.
        self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)
        with open(self.folder / "ticks.csv", encoding="utf-8") as file:
            return result, list(csv.DictReader(file))

    def test_follows_a_spacemouse(self):
        daemon = haptic_services.SpaceNavigator(self.folder / "spnav.sock")
        self.addCleanup(daemon.close)
        result, ticks = self.felt_by(f"spacemouse={daemon.path}", "--duration", "0.4")
        self.assertRegex(result.stdout, r"device +SpaceMouse .*spnav.sock: [1-9]\d* samples, 0 missed, 0 malformed\n")
        self.assertIn("live", {tick["status"] for tick in ticks})
        self.assertLess(float(ticks[-1]["target_pz"]), 0.03)

    def test_follows_a_haply_of_both_generations(self):
        for is_since_3_5 in (False, True):
            service = haptic_services.InverseService(is_since_3_5)
            self.addCleanup(service.close)
            result, ticks = self.felt_by(f"haply=ws://{service.address}", "--duration", "0.6", "--force",
                                         "--cycles", "cycles.csv")
            self.assertRegex(result.stdout, r"device +inverse3 049D: [1-9]\d* samples")
            self.assertAlmostEqual(float(ticks[-1]["target_pz"]), 0.01)
            self.assertAlmostEqual(max(service.forces), 2.0)  # The plate pushes up, to the device's limit.
            self.assertEqual(service.forces[-1], 0.0)
            with open(self.folder / "cycles.csv", encoding="utf-8") as file:
                forces = self.assert_devices_are_those_of_ticks(ticks, list(csv.DictReader(file)))
            self.assertGreater(max(force[2] for force in forces), 2.0)  # As asked, beyond the limit of the device.

    def test_follows_a_plug_in(self):
        result, ticks = self.felt_by(f"plugin={PLUGIN},radius=0.05", "--duration", "0.3")
        self.assertRegex(result.stdout, r"device +orbit: [1-9]\d* samples")
        self.assertGreater(len({tick["device_px"] for tick in ticks}), 100)

    def live(self):
        """Starts a session whose tool follows a page; gives the process and the port."""
        if not self.has_viewer():
            self.skipTest("built without the viewer")
        self.file("scene.json", scene())
        process = self.start("haptics", "scene.json", "--device", "mouse", "-o", "run.jsonl", "--ticks", "ticks.csv",
                             "--plot", "plot.svg")
        return process, int(re.match(r"http://127.0.0.1:(\d+)/ ", process.stdout.readline()).group(1))

    def test_follows_the_mouse_on_its_page(self):
        process, port = self.live()
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=20) as page:
            self.assertIn(b'<script id="firstcontact-live" type="application/json">'
                          b'{"tools":[{"body":1,"links":[]}],"mouse":0,"grips":0}</script>', page.read())
        page = haptic_services.Page(port, f"http://127.0.0.1:{port}")
        self.addCleanup(page.close)
        self.assertEqual(page.status, 101)
        self.assertEqual(page.picture()["handle"], [0, 0, 0, 1, 0, 0, 0])
        page.send('{"position": [0, 0, -0.025], "rotation": [1, 0, 0, 0]}')
        picture = page.picture()
        while picture["tools"][0]["force"][2] < 4.9:  # A spring of 1,000 N/m, 5 mm in the plate.
            picture = page.picture()
        self.assertAlmostEqual(picture["tools"][0]["target"][2], 0.015)
        self.assertEqual(picture["bodies"][0][0], 1)
        self.assertGreater(picture["bodies"][0][3], 0.02)
        self.assertGreater(len(picture["contacts"]), 2)
        page.send('{"position": [0, 0, 1e9], "rotation": [1, 0, 0, 0]}')
        page.send('{"position": [0, 0, 0.01], "rotation": [1, 0, 0, 0]}')
        while picture["tools"][0]["force"][2] > 0:
            picture = page.picture()
        process.send_signal(signal.SIGINT)
        stdout, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)
        self.assertRegex(stdout, rf"device +mouse 127.0.0.1:{port}: 2 samples, 0 missed, 1 malformed")
        self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)
        # The mouse pushes nobody's hand, but what it would push with is known.
        force = re.search(r"force +at most ([\d.]+) N and [\d.e-]+ N m; the mouse drives none of it\n", stdout)
        self.assertGreater(float(force.group(1)), 4.9)
        plot = (self.folder / "plot.svg").read_text(encoding="utf-8")
        self.assertIn("force [N]; the mouse drives none of it", plot)
        curve = re.search(r'points="([^"]*)"', plot).group(1).split()
        self.assertGreater(len({point.split(",")[1] for point in curve}), 2)
        self.assertGreater(float(curve[-1].split(",")[0]), 870.0)  # The panel ends with the session.
        ticks = re.findall(r'text-anchor="middle">([\d.]+)</text>', plot)
        unit = re.search(r"time \[(\w+)\]", plot).group(1)
        self.assertLess(float(ticks[-1]) * {"s": 1.0, "ms": 1e-3}[unit], 40.0)  # Planned were 60 s.

    def shown(self, *arguments):
        """Starts a session with --live; gives the process, its first line and the port."""
        if not self.has_viewer():
            self.skipTest("built without the viewer")
        process = self.start("haptics", "scene.json", *arguments, "-o", "run.jsonl")
        line = process.stdout.readline()
        return process, line, int(re.match(r"http://127.0.0.1:(\d+)/ ", line).group(1))

    def test_shows_a_recording_from_its_begin_on(self):
        self.file("scene.json", scene())
        self.recording(*((k * 1_000_000, max(-0.025, -5e-5 * k)) for k in range(800)))
        process, line, port = self.shown("--device", "hand.csv", "--live")
        self.assertIn("begins when the page is open", line)
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=20) as page:
            self.assertIn(b'<script id="firstcontact-live" type="application/json">'
                          b'{"tools":[{"body":1,"links":[]}]}</script>', page.read())
        page = haptic_services.Page(port, f"http://127.0.0.1:{port}")
        self.addCleanup(page.close)
        first = page.picture()
        self.assertNotIn("handle", first)
        self.assertGreater(first["tools"][0]["target"][2], 0.03)
        picture = first
        while picture["tools"][0]["force"][2] < 4.9:
            picture = page.picture()
        self.assertAlmostEqual(picture["tools"][0]["target"][2], 0.015, delta=1e-4)
        self.assertGreater(picture["bodies"][0][3], 0.02)
        self.assertGreater(len(picture["contacts"]), 2)
        page.send('{"position": [0, 0, 1], "rotation": [1, 0, 0, 0]}')  # Moves nothing.
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)

    def test_shows_devices_of_hands_at_once(self):
        daemon = haptic_services.SpaceNavigator(self.folder / "spnav.sock")
        self.addCleanup(daemon.close)
        self.file("scene.json", scene())
        process, line, _ = self.shown("--device", f"spacemouse={daemon.path}", "--live", "--duration", "0.3")
        self.assertNotIn("begins", line)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)

    def test_ends_while_it_waits_for_its_page(self):
        self.file("scene.json", scene())
        process, _, _ = self.shown("--device", "simulated", "--live")
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)

    def test_leaves_no_temporary_file_where_it_is_ended_twice(self):
        self.file("scene.json", scene())
        process = subprocess.Popen(
            [tool_test.TOOL, "haptics", "scene.json", "--device", "simulated", "--duration", "3000", "-o", "run.jsonl",
             "--ticks", "ticks.csv", "--cycles", "cycles.csv"], cwd=self.folder, stdout=subprocess.DEVNULL)
        while not any(self.folder.glob("cycles.csv.*")):
            time.sleep(0.01)
        for _ in range(50):  # The first one asks it to end, the second one ends it at once.
            process.send_signal(signal.SIGINT)
            time.sleep(0.001)
        process.wait(timeout=60)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.suffix not in (".json", ".jsonl", ".csv")],
                         [])

    def test_shows_nothing_live_in_virtual_time(self):
        self.file("scene.json", scene())
        self.assert_writes_nothing(self.haptics("--device", "simulated", "--live", "--latency", "0.01"),
                                   "--latency is for virtual time, but --live runs on the wall clock")
        self.assert_writes_nothing(self.haptics("--device", "mouse", "--live"), "mouse has a live page of its own")
        for port in ("0", "70000", "page"):
            self.assert_writes_nothing(self.haptics("--device", "simulated", "--live", port), "--live", f'got "{port}"')
        if self.has_viewer():
            with socket.create_server(("127.0.0.1", 0)) as taken:
                port = taken.getsockname()[1]
                self.assert_writes_nothing(self.haptics("--device", "simulated", "--live", str(port)),
                                           f"127.0.0.1:{port}", "another port")

    def test_gives_the_tool_to_its_own_page_only(self):
        process, port = self.live()
        for origin, status in (("http://example.com", 403), (f"http://localhost:{port}", 101),
                               (f"http://127.0.0.1:{port}", 403)):
            page = haptic_services.Page(port, origin)
            self.addCleanup(page.close)
            self.assertEqual(page.status, status, origin)
        with self.assertRaises(urllib.error.HTTPError) as refusal:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/scene.json", timeout=20)
        refusal.exception.close()
        self.assertEqual(refusal.exception.code, 404)
        self.assert_refused_with(self.run_tool("haptics", "scene.json", "--device", f"mouse={port}", "-o", "other.jsonl"),
                                 f"127.0.0.1:{port}", "another port")
        process.send_signal(signal.SIGTERM)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)

    def test_refuses_a_button_that_the_device_lacks(self):
        if not self.has_viewer():
            self.skipTest("built without the viewer")
        self.file("scene.json", scene(({"body": "peg", "dead_man_button": 0},)))
        self.assert_refused_with(self.run_tool("haptics", "scene.json", "--device", "mouse", "-o", "run.jsonl"),
                                 "scene.json", "dead_man_button", "mouse has 0 buttons")
        self.assertFalse((self.folder / "run.jsonl").exists())

    def test_says_which_service_does_not_answer(self):
        self.file("scene.json", scene())
        self.assert_writes_nothing(self.haptics("--device", "spacemouse=none.sock"), "none.sock",
                                   "systemctl start spacenavd")
        with socket.create_server(("127.0.0.1", 0)) as closed:
            address = "127.0.0.1:%d" % closed.getsockname()[1]
        self.assert_writes_nothing(self.haptics("--device", f"haply={address}"), address, "start Haply Hub")
        self.assert_writes_nothing(self.haptics("--device", "plugin=none.so"), "none.so", "found no file")

    def test_refuses_addresses_of_another_form(self):
        self.file("scene.json", scene())
        for device, mend in (("haply=ws://localhost", "ws://HOST:PORT"), ("haply=:10001", "ws://HOST:PORT"),
                             ("haply=localhost:70000", "ws://HOST:PORT"), ("haply=http://localhost:1", "ws://HOST:PORT"),
                             ("spacemouse=", "spacemouse=SOCKET"), ("mouse=0", "mouse=PORT"),
                             ("mouse=x", "mouse=PORT"), ("plugin", "plugin=FILE"),
                             ("plugin=,radius=1", "plugin=FILE"), ("spaceball", "spacemouse, haply")):
            self.assert_writes_nothing(self.haptics("--device", device), f"--device {device}: ", mend)

    def test_refuses_virtual_time_with_a_hand(self):
        self.file("scene.json", scene())
        latency = ("--latency", "0.01")
        self.assert_writes_nothing(self.haptics("--device", "haply", *latency), "--device haply runs on the wall clock")
        self.assert_writes_nothing(self.haptics("--device", "simulated", "--wall", *latency), "--wall runs on the wall")

    def test_names_what_is_wrong(self):
        self.file("scene.json", {"firstcontact": 1, "bodies": [PLATE, PEG]})
        device = ("--device", "simulated")
        self.assert_writes_nothing(self.haptics(*device), "scene.json", '"haptics"')
        self.file("scene.json", scene(tools=[{"body": "pin"}]))
        self.assert_writes_nothing(self.haptics(*device), '"plate", "peg"')
        self.file("scene.json", scene(bodies=[PLATE, {**PEG, "pose": {"position": [0, 0, 0.01]}}]))
        self.assert_writes_nothing(self.haptics(*device), '"peg" and "plate" meet')
        self.file("scene.json", scene())
        self.assert_writes_nothing(self.haptics(*device, *device), "--device", "1 of them; got 2")
        self.assert_writes_nothing(self.haptics("--device", "mouse", "--device", "mouse"), "mouse moves one tool")
        self.assert_writes_nothing(self.haptics("--device", "none.csv"), "none.csv")
        self.assert_writes_nothing(self.haptics(*device, out="scene.json"), "scene.json")
        self.file("scene.json", scene(tools=[{"body": "peg", "scale": 1e7}]))
        self.assert_writes_nothing(self.haptics(*device), "scene.json:", "haptics.tools[0].scale", "at most 1e6")
        self.file("scene.json", scene())
        self.assert_writes_nothing(self.haptics(*device, "--latency", "11"), "--latency", "10")
        for option in ("--ticks", "--cycles", "--plot", "--html"):
            self.assert_writes_nothing(self.haptics(*device, option, "-"), option, "/dev/stdout")
        self.assert_writes_nothing(self.haptics(*device, out="-"), "-o", "/dev/stdout")
        self.assertFalse((self.folder / "-").exists())
        self.file("broken.csv", "no recording\n")
        self.assert_writes_nothing(self.haptics("--device", "broken.csv"), "broken.csv")
        self.recording((0, 0), (1_000_000, 0.01))
        self.file("hand.csv", (self.folder / "hand.csv").read_text().replace(",", ";"))
        self.assert_writes_nothing(self.haptics("--device", "hand.csv"), "hand.csv:2", "separated by commas", "semicolons")

    def test_verifies_runs_but_no_tables(self):
        self.file("scene.json", scene())
        result = self.haptics("--device", "simulated", "--duration", "0.01", "--ticks", "ticks.csv", "--cycles",
                              "cycles.csv")
        self.assertEqual(result.returncode, 0, result)
        for name in ("ticks", "cycles"):
            self.assert_refused_with(self.run_tool("verify", f"{name}.csv"), f"{name}.csv: expected the run of the session",
                                     "-o run.jsonl", f"its table of {name}")

    def test_warns_of_a_recording_in_millimetres(self):
        self.file("scene.json", scene())
        for unit, warns in ((1.0, False), (1000.0, True)):
            # 0.1 m/s, and a rest that counts for neither.
            self.recording(*((1_000_000 * k, unit * (0.04 + 1e-4 * min(k, 50))) for k in range(500)))
            result = self.haptics("--device", "hand.csv", "--duration", "0.1", "--force")
            self.assertEqual(result.returncode, 0, result)
            self.assertEqual("hand.csv: faster than 20 m/s in 50 of 50 samples that move" in result.stdout, warns, result)
            self.assertEqual("calibration_scale: 0.001" in result.stdout, warns)
        text = (self.folder / "hand.csv").read_text()
        self.file("hand.csv", text.replace("1\n", "1\n# calibration_scale: 0.001\n", 1))
        self.assertNotIn("faster than", self.haptics("--device", "hand.csv", "--duration", "0.1", "--force").stdout)

    def test_warns_of_gains_beyond_those_of_the_device(self):
        """With a scale of 0.5 the device feels a quarter of the stiffness and the damping."""
        self.file("scene.json", scene(tools=[{"body": "peg", "stiffness": 8000, "angular_stiffness": 2, "damping": 4,
                                              "scale": 0.5}]))
        for limits, words in (("max_stiffness: 1999", 'the stiffness of "peg" is 2000 N/m at the device'),
                              ("max_angular_stiffness: 1.9", 'the angular_stiffness of "peg" is 2 N m/rad'),
                              ("max_damping: 0.9", 'the damping of "peg" is 1 N s/m at the device, whose max_damping is 0.9'),
                              ("max_angular_damping: 0.0009", 'the damping about axes of "peg" is 0.001 N m s/rad'),
                              ("max_stiffness: 2000", ""), ("max_damping: 1", "")):
            self.recording((0, 0), (1_000_000, 0))
            text = (self.folder / "hand.csv").read_text()
            self.file("hand.csv", text.replace("1\n", f"1\n# driven: 111111\n# {limits}\n", 1))
            result = self.haptics("--device", "hand.csv", "--duration", "0.01", "--force")
            self.assertEqual(result.returncode, 0, result)
            self.assertEqual("warning" in result.stdout, words != "", result)
            self.assertIn(words, result.stdout)


if __name__ == "__main__":
    tool_test.TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    PLUGIN = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
