"""`firstcontact haptics` as a user meets it: runs that are proven, logs, errors that name what is wrong.

    haptics_test.py TOOL [unittest arguments]
"""

import csv
import json
import pathlib
import sys
import unittest

import tool_test


PLATE = {"name": "plate", "shape": {"box": {"size": [0.2, 0.2, 0.0001]}}}
PEG = {"name": "peg", "shape": {"box": {"size": [0.02, 0.02, 0.04]}}, "pose": {"position": [0, 0, 0.04]}}


def scene(tools=({"body": "peg"},), bodies=(PLATE, PEG), **more):
    return {"firstcontact": 1, "bodies": list(bodies), "haptics": {"tools": list(tools), **more}}


class Haptics(tool_test.ToolTest):
    def haptics(self, *arguments, out="run.jsonl"):
        return self.run_tool("haptics", "scene.json", *arguments, "-o", out)

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
        self.assertEqual(len((self.folder / "cycles.csv").read_text().splitlines()), 501)
        self.assertTrue((self.folder / "plot.svg").read_text().startswith("<svg"))

    def test_is_the_same_on_every_run(self):
        self.file("scene.json", scene())
        for name in ("a", "b"):
            result = self.run_tool("haptics", "scene.json", "--device", "simulated", "--duration", "0.1",
                                   "-o", f"{name}.jsonl", "--ticks", f"{name}.csv")
            self.assertEqual(result.returncode, 0, result)
        for end in (".jsonl", ".csv"):
            self.assertEqual((self.folder / f"a{end}").read_bytes(), (self.folder / f"b{end}").read_bytes())

    def test_runs_on_the_wall(self):
        self.file("scene.json", scene())
        result = self.run_tool("haptics", "scene.json", "--device", "simulated", "--duration", "0.1", "--wall",
                               "-o", "run.jsonl", "--timing", "timing.csv")
        self.assertEqual(result.returncode, 0, result)
        self.assertIn("SCHED_FIFO", result.stdout)
        self.assertIn("empty loop", result.stdout)
        self.assertIn("tick_cpu", (self.folder / "timing.csv").read_text())
        self.assertEqual(self.run_tool("verify", "run.jsonl").returncode, 0)

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
        self.assert_writes_nothing(self.haptics("--device", "none.csv"), "none.csv")
        self.assert_writes_nothing(self.haptics(*device, out="scene.json"), "scene.json")
        self.file("broken.csv", "no recording\n")
        self.assert_writes_nothing(self.haptics("--device", "broken.csv"), "broken.csv")


if __name__ == "__main__":
    tool_test.TOOL = str(pathlib.Path(sys.argv.pop(1)).resolve())
    unittest.main()
