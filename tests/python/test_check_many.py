"""Batches answer as their jobs do one by one, whoever works."""

import json
import multiprocessing
import subprocess
import sys
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import firstcontact as fc
import pytest
from conftest import ROOT, TRIANGLE, falling_scene, without_work

PEG = ROOT / "demo/scenes/peg_tilted.json"


def jobs() -> list:
    """Of every kind: dicts, a path, a scene, pairs."""
    shape = fc.Shape(TRIANGLE)
    pairs = [((shape, fc.Motion.fixed()),
              (shape, fc.Motion.constant_velocity(fc.Pose((0.1, 0.1, height)), (0, 0, -2))))
             for height in (0.5, 1.0, 3.0)]
    return [*(falling_scene(0.25 * k) for k in range(1, 20)), PEG, fc.load_scene(PEG), *pairs]


def told(answer) -> object:
    return (without_work(answer.to_dict()) if isinstance(answer, fc.Result)
            else answer.__getstate__()[:-1])


def one_by_one() -> list:
    return [told(fc.first_contact(*job) if isinstance(job, tuple) else fc.check(job))
            for job in jobs()]


class InlineExecutor(Executor):
    """The least that an executor has to be."""

    def submit(self, fn, /, *args, **kwargs):
        future: Future = Future()
        future.set_result(fn(*args, **kwargs))
        return future


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_own_threads(threads):
    assert [told(answer) for answer in fc.check_many(jobs(), threads=threads)] == one_by_one()


@pytest.mark.parametrize("make", [
    lambda: InlineExecutor(), lambda: ThreadPoolExecutor(3),
    lambda: ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")),
    lambda: ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("fork")),
], ids=["inline", "threads", "spawned processes", "forked processes"])
def test_executors(make):
    with make() as executor:
        answers = fc.check_many(jobs(), executor)
    assert [told(answer) for answer in answers] == one_by_one()


# Of its own process, whose memory is limited.
LIMITED = """
import resource, sys
import firstcontact as fc
flat = {"heightmap": {"cell": [1e-3, 1e-3], "heights": [[0] * 41] * 41}}
def plates(contacts):
    return {"firstcontact": 1, "options": {"margin": 0.03, "contacts": contacts}, "bodies": [
        {"name": "lower", "shape": flat},
        {"name": "upper", "shape": flat, "pose": {"position": [0, 0, 0.01]}}]}
with open("/proc/self/statm") as file:
    used = int(file.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + 700_000_000,) * 2)
answers = fc.check_many([plates(5), plates("all"), plates(5)], threads=int(sys.argv[1]),
                        errors="return")
print([type(answer).__name__ for answer in answers], answers[1])
"""


@pytest.mark.parametrize("threads", [1, 2])
def test_lack_of_memory_is_the_error_of_its_job(threads):
    run = subprocess.run([sys.executable, "-c", LIMITED, str(threads)], capture_output=True,
                         text=True, timeout=120, check=False)
    expected = "['Result', 'MemoryError', 'Result'] not enough memory to answer this\n"
    assert run.stdout == expected, run.stderr


def test_batch_is_the_tools(tmp_path, tool):
    scenes = [falling_scene(0.25 * k) for k in range(1, 30)]
    lines = tmp_path / "jobs.jsonl"
    lines.write_text("".join(json.dumps(scene) + "\n" for scene in scenes))
    subprocess.run([tool, "batch", lines, "-o", tmp_path / "results.jsonl"], check=False,
                   capture_output=True)
    expected = [json.loads(line) for line in (tmp_path / "results.jsonl").read_text().splitlines()]
    assert [e.pop("line") for e in expected] == list(range(1, 30))
    answers = fc.check_many(scenes)
    assert [told(a) for a in answers] == [without_work(e) for e in expected]


def test_question_reaches_every_job():
    answers = fc.check_many(jobs(), margin=0.5, all_pairs=True, closest=True)
    for job, answer in zip(jobs(), answers, strict=True):
        if isinstance(job, tuple):
            expected = fc.first_contact(*job, margin=0.5)
        else:
            expected = fc.check(job, margin=0.5, all_pairs=True, closest=True)
        assert told(answer) == told(expected)


@pytest.mark.parametrize("make", [lambda: None, lambda: ThreadPoolExecutor(2),
                                  lambda: ProcessPoolExecutor(2)], ids=["own", "threads", "processes"])
def test_errors_stand_in_the_place_of_answers(make, tmp_path):
    bad = [falling_scene(), {"firstcontact": 2}, tmp_path / "none.json", falling_scene(3.0)]
    executor = make()
    answers = fc.check_many(bad, executor, errors="return")
    assert [type(answer) for answer in answers] == [fc.Result, fc.ParseError, FileNotFoundError,
                                                    fc.Result]
    assert answers[1].line == 1 and answers[2].filename == str(tmp_path / "none.json")
    with pytest.raises(fc.ParseError, match="firstcontact: expected 1"):
        fc.check_many(bad, executor)
    if executor is not None:
        executor.shutdown()


def test_bad_arguments():
    with pytest.raises(ValueError, match='errors: expected "raise" or "return"'):
        fc.check_many([], errors="ignore")
    with pytest.raises(TypeError):
        fc.check_many([3])
    with pytest.raises(TypeError, match="A: expected a pair"):
        fc.check_many([(1, 2)])
    with pytest.raises(ValueError, match="deadline must be > 0"):
        fc.check_many([falling_scene()], deadline=0)
    assert fc.check_many([]) == []


@pytest.mark.parametrize("make", [lambda: None, lambda: InlineExecutor()], ids=["own", "inline"])
def test_progress_rises_to_the_end(make):
    seen: list[float] = []
    fc.check_many([falling_scene()] * 40, make(), threads=1, progress=seen.append)
    assert seen == sorted(seen) and seen[-1] == 1.0 and len(seen) > 1


def test_progress_ends_at_1_whichever_thread_is_last():
    for _ in range(20):
        seen = []
        fc.check_many([falling_scene()] * 7, threads=4, progress=seen.append)
        assert seen == sorted(seen)
        assert seen[-1] == 1


def test_an_exception_of_progress_ends_the_batch():
    def refuse(done: float) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        fc.check_many([falling_scene()] * 40, threads=1, progress=refuse)


def test_jobs_may_come_from_a_generator():
    answers = fc.check_many(falling_scene(height) for height in (1.0, 2.0))
    assert [answer.id for answer in answers] == ["from 1.0 m", "from 2.0 m"]
