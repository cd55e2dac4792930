"""Batches as a user meets them: killed, interrupted, split, resumed.

    batch_test.py TOOL [unittest arguments]
"""

import json
import os
import pathlib
import pty
import random
import signal
import subprocess
import sys
import time
import unittest

import scenes
import tool_test

def spinning(name: str, angle: float, gap: float) -> str:
    """A tip that passes a wall once a turn; many turns take a few milliseconds."""
    wall = {"vertices": [[1, -9, -9], [1, 9, -9], [1, 0, 9]], "triangles": [[0, 1, 2]]}
    return scenes.scene(
        {"name": "tip", "shape": {"vertices": [[0, 0, 0], [1, 0, 0]], "triangles": [[0, 1, 1]]},
         "motion": {"type": "constant_velocity", "rotation_vector": [0, 0, angle]}},
        {"name": "wall", "shape": wall, "pose": {"position": [gap, 0, 0]}},
        id=name, options={"tolerance": 1e-9})


def some_jobs(count: int) -> str:
    """Long and short ones, every tenth bad."""
    rng = random.Random(1)
    return "".join((scenes.BAD if k % 10 == 9 else spinning(str(k), rng.choice([10, 300, 3000]), 1e-6)) + "\n"
                   for k in range(count))


class BatchTest(tool_test.ToolTest):
    def batch(self, *arguments: str, jobs: str = "jobs.jsonl", results: str = "out.jsonl"):
        return self.run_tool("batch", jobs, "-o", results, *arguments)

    def results(self, name: str = "out.jsonl") -> bytes:
        return (self.folder / name).read_bytes()

    def undisturbed(self) -> bytes:
        self.batch(results="whole.jsonl")
        return self.results("whole.jsonl")


@tool_test.NEEDS_BOUNDED_MEMORY
class Memory(BatchTest):
    """Of a line that needs more than there is."""

    def batch_within(self, kilobytes: int, *arguments: str):
        command = " ".join(["batch", "jobs.jsonl", "-o", "out.jsonl", *arguments])
        return self.run_in_shell_within(kilobytes, command)

    def run_in_shell_within(self, kilobytes: int, command: str):
        return subprocess.run(["sh", "-c", f'ulimit -v {kilobytes}; exec "$0" {command}', tool_test.TOOL],
                              cwd=self.folder, capture_output=True, text=True, timeout=120, check=False)

    def setUp(self):
        super().setUp()
        self.large = scenes.plates(40, contacts="all").replace("\n", "")
        self.file("jobs.jsonl", "".join(line + "\n" for line in (
            scenes.FREE, scenes.CONTACT, self.large, scenes.FREE, self.large, scenes.CONTACT)))

    def assert_lines(self, text: str):
        lines = [json.loads(line) for line in text.splitlines()]
        self.assertEqual([line.get("verdict") for line in lines],
                         ["free", "contact", None, "free", None, "contact"])
        for number in (3, 5):
            line = lines[number - 1]
            self.assertIn(line.pop("id"), ("", "plates"))
            self.assertEqual(line, {
                "file": "jobs.jsonl", "line": number, "reason": "memory",
                "error": f"jobs.jsonl:{number}: not enough memory to answer this scene"})

    def test_is_an_error_and_the_rest_goes_on(self):
        for threads in ("1", "2"):
            result = self.batch_within(1000000, "--threads", threads)
            self.assertEqual(result.returncode, 2, result)
            self.assertIn("jobs.jsonl:3: not enough memory to answer this scene", result.stderr)
            self.assert_lines(self.results().decode())
            for name in ("out.jsonl", "out.jsonl.batch"):
                (self.folder / name).unlink()

    def test_does_not_keep_a_batch_from_going_on_later(self):
        self.batch_within(1000000, "--threads", "1")
        whole = self.results()
        cut = b"".join(whole.splitlines(keepends=True)[:3])
        (self.folder / "out.jsonl").write_bytes(cut)
        result = self.batch_within(1000000, "--threads", "1", "--resume")
        self.assertEqual(result.returncode, 2, result)
        self.assertIn("3 of them by an earlier run", result.stdout)
        self.assertEqual(self.results(), whole)

    def test_is_an_error_of_its_line_in_a_check_too(self):
        result = self.run_in_shell_within(1000000, "check jobs.jsonl --threads 1")
        self.assertEqual(result.returncode, 2)
        self.assert_lines(result.stdout)

    def test_is_the_error_of_one_scene(self):
        self.file("large.json", self.large)
        result = self.run_in_shell_within(1000000, "check large.json --threads 1")
        self.assertEqual((result.returncode, result.stderr), (2, "firstcontact: not enough memory\n"))


class Answers(BatchTest):
    def test_are_those_of_check_for_every_number_of_threads(self):
        # Fewer answers of a slow tool show as well how it comes by them.
        count = 20 if tool_test.SANITIZED else 60
        jobs = self.file("jobs.jsonl", some_jobs(count))
        expected = self.run_tool("check", jobs).stdout.encode()
        self.assertEqual(len(expected.splitlines()), count)
        for threads in ("1", "2", "8"):
            result = self.batch("--threads", threads, results=f"{threads}.jsonl")
            self.assertEqual(result.returncode, 2)
            self.assertEqual(self.results(f"{threads}.jsonl"), expected)

    def test_take_the_options_of_the_command_line(self):
        jobs = self.file("jobs.jsonl", scenes.FREE)
        options = ["--margin", "2", "--tolerance", "1e-3", "--closest", "--all-pairs"]
        self.assertEqual(self.batch(*options).returncode, 1)
        self.assertEqual(self.results().decode(), self.run_tool("check", jobs, *options).stdout)

    def test_have_every_contact_in_time(self):
        # Two balls of 1 m across at a distance of |3 - 6 t| m, there and back.
        poses = [{"position": [x, 0, 0]} for x in (3, -3, 3)]
        ball = {"shape": {"sphere": {"radius": 0.5}}}
        jobs = self.file("jobs.jsonl", scenes.scene(
            {"name": "a", **ball},
            {"name": "b", **ball, "motion": {"type": "waypoints", "times": [0, 1, 2], "poses": poses}}))
        self.assertEqual(self.batch("--all-contacts-in-time").returncode, 1)
        line = self.results().decode()
        self.assertEqual(line, self.run_tool("check", jobs, "--all-contacts-in-time").stdout)
        (pair,) = json.loads(line)["pairs"]
        times = [(i["enter_time"], i["leave_time"]) for i in pair["intervals"]]
        for (enter, leave), truth in zip(times, ((1 / 3, 2 / 3), (4 / 3, 5 / 3)), strict=True):
            self.assertLessEqual(enter, truth[0])
            self.assertAlmostEqual(enter, truth[0], places=5)
            self.assertAlmostEqual(leave, truth[1], places=2)

    def test_are_of_lines(self):
        self.file("jobs.jsonl", json.dumps(json.loads(scenes.FREE), indent=2))
        self.assert_refused_with(self.batch(), "jobs.jsonl: expected JSON Lines", "`firstcontact check`")
        self.assertFalse((self.folder / "out.jsonl").exists())

    def test_name_the_bad_lines_and_do_the_rest(self):
        self.file("cut.obj", "v 0 0\n")
        mesh = scenes.scene({"name": "a", "shape": {"mesh": "cut.obj"}})
        self.file("jobs.jsonl", "\n".join([scenes.CONTACT, scenes.BAD, "", mesh, scenes.FREE]))
        result = self.batch()
        self.assertEqual(result.returncode, 2)
        complaints = result.stderr.splitlines()
        self.assertEqual(len(complaints), 2)
        self.assertTrue(complaints[0].startswith("firstcontact: jobs.jsonl:2: bodies[0].pose.positon: "))
        self.assertTrue(complaints[1].startswith("firstcontact: jobs.jsonl:4: cut.obj:1: "))
        answers = [json.loads(line) for line in self.results().splitlines()]
        self.assertEqual([a.get("verdict", "error") for a in answers], ["contact", "error", "error", "free"])
        self.assertEqual([a["line"] for a in answers], [1, 2, 4, 5])

    def test_are_summed_up(self):
        self.file("jobs.jsonl", "\n".join([scenes.CONTACT, scenes.FREE, scenes.FREE, scenes.AT_START, scenes.BAD]))
        first, second = self.batch().stdout.splitlines()
        self.assertEqual(first, "5 of 5 scenes answered: 2 free, 1 contact, 1 contact at start, 1 error")
        self.assertRegex(second, r"^5 in \d+ s, [\d.e+]+ a second$")

    def test_give_the_worst_status(self):
        worst_first = [("BAD", 2), ("UNDECIDED", 3), ("CONTACT", 1), ("FREE", 0)]
        for k, (name, status) in enumerate(worst_first):
            better = "\n".join(getattr(scenes, other) for other, _ in worst_first[k:])
            jobs, results = self.file(f"{name}.jsonl", better), f"{name}.out"
            self.assertEqual(self.batch(jobs=jobs, results=results).returncode, status)
            # Of what is there already, too.
            self.assertEqual(self.batch("--resume", jobs=jobs, results=results).returncode, status)

    def test_progress_is_shown_on_a_terminal(self):
        self.file("jobs.jsonl", scenes.FREE + "\n" + scenes.ENDLESS)
        ours, theirs = pty.openpty()
        process = self.start("batch", "jobs.jsonl", "-o", "out.jsonl", "--deadline", "2", stderr=theirs)
        process.communicate(timeout=60)
        os.close(theirs)
        shown = os.read(ours, 10000).decode()
        self.assertRegex(shown, r"\[={10} {10}\]  50 %  1 of 2, [\d.e+]+ a second, \d+ s left \.\.\. 1\.\d s")
        self.assertTrue(shown.endswith("\r\x1b[K"))


class Shards(BatchTest):
    def test_make_up_the_whole(self):
        self.file("jobs.jsonl", some_jobs(40))
        whole = self.undisturbed().splitlines()
        merged = [b""] * len(whole)
        for i in (1, 2, 3):
            self.batch("--shard", f"{i}/3", results=f"{i}.jsonl")
            merged[i - 1::3] = self.results(f"{i}.jsonl").splitlines()
        self.assertEqual(merged, whole)

    def test_may_be_empty(self):
        self.file("jobs.jsonl", scenes.CONTACT)
        self.assertEqual(self.batch("--shard", "1/2", results="1").returncode, 1)
        self.assertEqual(self.batch("--shard", "2/2", results="2").returncode, 0)
        self.assertEqual(self.results("2"), b"")

    def test_need_a_number_of_theirs(self):
        self.file("jobs.jsonl", scenes.FREE)
        for text in ("0/3", "4/3", "1", "1/", "/3", "-1/3", "1/3x", "1.5/3", "1/0"):
            self.assert_refused(self.batch(f"--shard={text}"), "--shard: expected i/N, such as 1/4, with i from "
                                f'1 to N, got "{text}" (see firstcontact batch --help)')


class Resume(BatchTest):
    def test_after_twenty_kills_leaves_no_trace_of_them(self):
        self.file("jobs.jsonl", some_jobs(200))
        begin = time.monotonic()
        whole = self.undisturbed()
        seconds = time.monotonic() - begin
        rng = random.Random(1)
        kills = 0
        lengths = set()
        while kills < 20:
            process = self.start("batch", "jobs.jsonl", "-o", "out.jsonl", "--resume")
            time.sleep(rng.uniform(0, seconds / 4))
            if process.poll() is None:
                kills += 1
                process.kill()
            process.communicate(timeout=60)
            found = self.results() if (self.folder / "out.jsonl").exists() else b""
            self.assertTrue(whole.startswith(found))
            lengths.add(len(found))
            if found == whole:
                (self.folder / "out.jsonl").unlink()
        self.assertEqual(self.batch("--resume").returncode, 2)
        self.assertEqual(self.results(), whole)
        self.assertGreaterEqual(len(lengths - {0, len(whole)}), 3, "hardly ever killed in the middle")

    def test_goes_on_from_every_byte(self):
        self.file("jobs.jsonl", some_jobs(12))
        whole = self.undisturbed()
        self.batch()
        ends = [k + 1 for k, byte in enumerate(whole) if byte == ord("\n")]
        for length in [0, 1, len(whole) - 1, len(whole), *ends[:3], *(end - 1 for end in ends[:3]), ends[5] + 100]:
            os.truncate(self.folder / "out.jsonl", length)
            self.assertEqual(self.batch("--resume").returncode, 2)
            self.assertEqual(self.results(), whole, length)

    def test_does_nothing_twice(self):
        self.file("jobs.jsonl", scenes.FREE)
        self.batch()
        self.assertEqual(self.batch("--resume").stdout, "1 of 1 scenes answered: 1 free\n1 of them by an earlier run\n")
        self.assertEqual(len(self.results().splitlines()), 1)

    def test_goes_on_after_an_interrupt(self):
        """What the interrupt cut short is done again."""
        self.file("jobs.jsonl", "\n".join([scenes.FREE, scenes.ENDLESS, scenes.CONTACT]))
        process = self.start("batch", "jobs.jsonl", "-o", "out.jsonl")
        time.sleep(1.5)
        process.send_signal(signal.SIGINT)
        stdout, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 3)
        self.assertTrue(stdout.startswith("1 of 3 scenes answered: 1 free\n"))
        self.assertTrue(stdout.endswith("\ninterrupted; go on with --resume\n"))
        self.assertEqual(len(self.results().splitlines()), 1)

    def test_must_be_asked_for(self):
        self.file("jobs.jsonl", scenes.FREE)
        self.file("out.jsonl", "")  # As good as none.
        self.assertEqual(self.batch().returncode, 0)
        self.assert_refused(self.batch(), "out.jsonl: there are results already; go on with --resume, or remove them")

    def test_refuses_results_of_something_else(self):
        self.file("jobs.jsonl", some_jobs(3))
        self.file("other.jsonl", some_jobs(3))
        self.batch()
        before = self.results()
        go_on = "out.jsonl: cannot go on: these results are of the "
        for message, arguments, more in [
                ("jobs jobs.jsonl, ", [], {"jobs": "other.jsonl"}),
                ("options none, not of the options --margin 0.1", ["--margin", "0.1"], {}),
                ("options none, not of the options --closest --all-pairs", ["--closest", "--all-pairs"], {}),
                ("options none, not of the options --all-contacts-in-time", ["--all-contacts-in-time"], {}),
                ("shard 1/1, not of the shard 1/2", ["--shard", "1/2"], {})]:
            result = self.batch("--resume", *arguments, **more)
            self.assertEqual(result.returncode, 2)
            self.assertTrue(result.stderr.startswith("firstcontact: " + go_on + message), result.stderr)
        self.file("jobs.jsonl", some_jobs(4))
        self.assertIn(go_on + "jobs jobs.jsonl, digest ", self.batch("--resume").stderr)
        (self.folder / "out.jsonl.batch").unlink()
        self.assert_refused(self.batch("--resume"), "out.jsonl: cannot go on: out.jsonl.batch, which says what these "
                            "results are of, is missing")
        self.assertEqual(self.results(), before)

    def test_refuses_what_is_no_result(self):
        self.file("jobs.jsonl", some_jobs(3))
        self.batch()
        self.file("out.jsonl", "{}\n")
        self.assert_refused(self.batch("--resume"), 'out.jsonl:1: expected a result with a "verdict" or an "error"')
        self.file("out.jsonl", "".join(f'{{"line": {k}, "error": ""}}\n' for k in range(1, 5)))
        self.assert_refused(self.batch("--resume"), "out.jsonl:4: expected no more results than jobs")


    def test_refuses_results_that_changed_places(self):
        """A result says of which line it is: nobody notices two that were swapped by their verdicts."""
        self.file("jobs.jsonl", "\n".join([scenes.CONTACT, "", scenes.FREE, scenes.BAD, scenes.CONTACT]))
        self.batch()
        lines = self.results().splitlines(keepends=True)
        self.assertEqual([json.loads(line)["line"] for line in lines], [1, 3, 4, 5])
        for order, place, got in [([1, 0, 2, 3], "out.jsonl:1: expected the result of line 1", "line 3"),
                                  ([0, 1, 3, 2], "out.jsonl:3: expected the result of line 4", "line 5"),
                                  ([0, 0], "out.jsonl:2: expected the result of line 3", "line 1"),
                                  ([3], "out.jsonl:1: expected the result of line 1", "line 5")]:
            self.file("out.jsonl", b"".join(lines[k] for k in order))
            self.assert_refused(self.batch("--resume"), f"{place} of the jobs, got that of {got}; results have to stay "
                                "as they were written")
        self.file("out.jsonl", b"".join(lines[:2]))
        self.assertEqual(self.batch("--resume").returncode, 2)  # Of the bad line.
        self.assertEqual(self.results(), b"".join(lines))

    def test_of_a_shard_say_their_lines(self):
        self.file("jobs.jsonl", some_jobs(5))
        self.batch("--shard", "2/2")
        self.assertEqual([json.loads(line)["line"] for line in self.results().splitlines()], [2, 4])


class Page(BatchTest):
    """The page that lists the results."""

    def setUp(self):
        super().setUp()
        self.template = pathlib.Path(tool_test.TOOL).resolve().parent.parent / "share/firstcontact/viewer.html"
        self.file("jobs.jsonl", "".join(line + "\n" for line in (scenes.CONTACT, scenes.BAD, scenes.FREE)))

    def test_has_every_result_and_each_mesh_once(self):
        if not self.template.exists():
            self.skipTest("the viewer's page is not built")
        result = self.batch("--html", "list.html")
        self.assertEqual(result.returncode, 2, result)
        self.assertTrue(result.stdout.endswith("page of 3 results, 2 to be played: list.html\n"), result)
        self.assert_list()
        (self.folder / "list.html").unlink()
        result = self.batch("--resume", "--html", "list.html")  # Nothing is left to be answered.
        self.assertEqual(result.returncode, 2, result)
        self.assert_list()

    def assert_list(self):
        text = (self.folder / "list.html").read_text(encoding="utf-8")
        data = json.loads(text.split('type="application/json">', 1)[1].split("</script>", 1)[0])
        lines = [json.loads(line) for line in self.results().splitlines()]
        self.assertEqual([data["list"][k]["result"] for k in (0, 2)], [lines[0], lines[2]])
        self.assertEqual(data["list"][1], {"summary": {key: lines[1][key] for key in data["list"][1]["summary"]}})
        self.assertEqual(data["list"][1]["summary"]["error"], lines[1]["error"])
        self.assertEqual(len(data["meshes"]), 1)  # All bodies have the same triangle.

    def test_is_neither_the_results_nor_the_jobs(self):
        for page, why in (("out.jsonl", "the file of -o"), ("jobs.jsonl", "an input, jobs.jsonl")):
            self.assert_refused(self.batch("--html", page), f"--html {page}: this would overwrite {why}")
        self.assertFalse((self.folder / "out.jsonl").exists())

    def test_is_missed_before_any_work(self):
        if self.template.exists():
            self.skipTest("the viewer's page is built")
        result = self.batch("--html", "list.html")
        self.assertEqual(result.returncode, 2, result)
        self.assertIn("the viewer's page is missing here", result.stderr)
        self.assertFalse((self.folder / "out.jsonl").exists())


class Files(BatchTest):
    def test_that_cannot_be_used_are_said_so(self):
        self.file("jobs.jsonl", scenes.FREE)
        self.file("empty.jsonl", "\n\n")
        os.mkfifo(self.folder / "fifo.jsonl")
        for arguments, message in [
                ({"jobs": "no.jsonl"}, "no.jsonl: expected a file of scenes, found none"),
                ({"jobs": "fifo.jsonl"}, "fifo.jsonl: expected a plain file of scenes, which can be read twice"),
                ({"jobs": "empty.jsonl"}, "empty.jsonl: expected at least one scene, got none"),
                ({"results": "./jobs.jsonl"}, "-o ./jobs.jsonl: this would overwrite an input, jobs.jsonl"),
                ({"results": "/dev/null"}, "/dev/null: expected a plain file for the results, got something else"),
                ({"results": "no/out"}, "no/out: cannot write this file: No such file or directory")]:
            self.assert_refused(self.batch(**arguments), message)
        jobs = self.file("out.batch", scenes.FREE)  # Where it is written what the results in `out` are of.
        self.assert_refused(self.batch(jobs=jobs, results="out"),
                            "-o out.batch: this would overwrite an input, out.batch")

    def test_have_one_writer(self):
        self.file("jobs.jsonl", scenes.ENDLESS)
        process = self.start("batch", "jobs.jsonl", "-o", "out.jsonl")
        time.sleep(1)
        self.assert_refused(self.batch("--resume"), "out.jsonl: another batch is writing this file")
        process.kill()
        process.communicate(timeout=60)

    def test_of_jobs_must_stay_as_they_are(self):
        jobs = self.file("jobs.jsonl", scenes.ENDLESS + "\n" + 1000 * (scenes.FREE + "\n"))
        process = self.start("batch", jobs, "-o", "out.jsonl", "--threads", "1", "--deadline", "2")
        time.sleep(1)
        with open(self.folder / jobs, "a", encoding="utf-8") as lines:
            lines.write(scenes.FREE + "\n")
        _, stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2)
        self.assertEqual(stderr, "firstcontact: jobs.jsonl: changed while its scenes were answered\n")


if __name__ == "__main__":
    tool_test.TOOL = str(pathlib.Path(sys.argv[1]).resolve())
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]], verbosity=2)
