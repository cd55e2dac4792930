"""What a call from Python costs beyond the C++ that it calls, and what a batch reaches.

    overhead.py CPP_PROGRAM [--quick] OUTPUT.json

CPP_PROGRAM, benchmarks/python/cpp_baseline, asks the same questions in C++. Times of single queries
are processor times of the calling thread, those of batches are on the wall; the two programs take
turns, and of each the fastest turn counts: other load on the machine only slows down.
"""

import json
import subprocess
import sys
import time

import firstcontact as fc
import numpy as np

TRIANGLE = fc.Shape(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
JOBS = 10_000
CALLS_OF_A_TURN = 1_000


def far_pair() -> tuple:
    """Two triangles that no motion of theirs brings together: the least work of a query."""
    away = fc.Motion.constant_velocity(fc.Pose((0, 0, 9)), (0, 0, 1))
    return (TRIANGLE, fc.Motion.fixed()), (TRIANGLE, away)


def knot(segments: int, sides: int) -> fc.Shape:
    """A torus knot; as benchmarks/python/cpp_baseline.cpp makes it."""
    vertices = []
    triangles = []
    for i in range(segments):
        s = 2 * np.pi * i / segments
        centre = np.array([(2 + np.cos(3 * s)) * np.cos(2 * s), (2 + np.cos(3 * s)) * np.sin(2 * s),
                           np.sin(3 * s)])
        for k in range(sides):
            a = 2 * np.pi * k / sides
            vertices.append(centre + 0.4 * np.array([np.cos(a), np.sin(a), np.sin(a + s)]))
            j, l = (i + 1) % segments, (k + 1) % sides
            a0, a1, b0, b1 = i * sides + k, i * sides + l, j * sides + k, j * sides + l
            triangles += [[a0, b0, a1], [a1, b0, b1]]
    return fc.Shape((np.array(vertices), np.array(triangles)))


def batch() -> list:
    """Two knots that fly past or into each other, `JOBS` times."""
    shape = knot(100, 5)
    rest = fc.Motion.fixed()
    jobs = []
    for k in range(JOBS):
        x = -8 + 16 * ((k * 7919) % JOBS) / JOBS
        motion = fc.Motion.constant_velocity(fc.Pose((x, 0.1, 9)), (0, 0, -18), (0.5, 1, 0.25))
        jobs.append(((shape, rest), (shape, motion)))
    return jobs


def time_of_call(calls: int) -> float:
    """[us]  Processor time of one query, in the fastest of many short turns."""
    A, B = far_pair()
    workspace = fc.Workspace()
    ask = fc.first_contact
    turn = range(CALLS_OF_A_TURN)
    least = float("inf")
    for _ in range(calls // CALLS_OF_A_TURN):
        begin = time.thread_time_ns()
        for _ in turn:
            ask(A, B, workspace)
        least = min(least, time.thread_time_ns() - begin)
    return least / CALLS_OF_A_TURN / 1000


def time_of_batch(jobs: list, threads: int) -> float:
    """[s]  On the wall, from jobs in Python to results in Python."""
    begin = time.perf_counter()
    answers = fc.check_many(jobs, threads=threads)
    taken = time.perf_counter() - begin
    assert len(answers) == JOBS
    return taken


def main() -> None:
    program, *flags, output = sys.argv[1:]
    quick = "--quick" in flags
    calls = 20_000 if quick else 200_000
    jobs = batch()
    best: dict[str, float] = {}

    def take(name: str, value: float) -> None:
        best[name] = min(value, best.get(name, value))

    for _ in range(2 if quick else 10):
        take("call_python_us", time_of_call(calls))
        for threads in (1, 2):
            take(f"batch_python_{threads}_s", time_of_batch(jobs, threads))
        baseline = json.loads(subprocess.run([program, str(calls)], capture_output=True, check=True,
                                             text=True).stdout)
        for name, value in baseline.items():
            if name != "contacts":
                take(name, value)
    contacts = sum(answer.verdict != "free" for answer in fc.check_many(jobs))
    assert contacts == baseline["contacts"], "the two programs ask different questions"
    with open(output, "w", encoding="utf-8") as file:
        json.dump({**best, "jobs": JOBS, "contacts": contacts}, file, indent=2)


main()
