"""Ctrl-C ends a query at once, and nothing else does."""

import signal
import subprocess
import sys
import textwrap

import pytest
from conftest import ROOT

PRELUDE = f"""
import os, signal, sys, threading, time
signal.signal(signal.SIGINT, signal.default_int_handler)  # A shell's background jobs ignore it.
sys.path.insert(0, {str(ROOT / "tests/python")!r})
import firstcontact as fc
from conftest import long_query, resting_balls
A, B = long_query()
deadline = 120  # [s]  Beyond the patience of the test.

def interrupt_soon(times=1):
    def act():
        for _ in range(times):
            time.sleep(0.3)
            os.kill(os.getpid(), signal.SIGINT)
    threading.Thread(target=act, daemon=True).start()
"""


def run(script: str) -> str:
    done = subprocess.run([sys.executable, "-c", PRELUDE + textwrap.dedent(script)], timeout=60,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


QUESTIONS = {
    "first_contact": "fc.first_contact(A, B, deadline=deadline)",
    "closest_approach": "fc.closest_approach(A, B, tolerance=1e-12, deadline=deadline)",
    "many bodies": "fc.first_contact(bodies, deadline=deadline)",
    "check_many": "fc.check_many([(A, B)] * 3, deadline=deadline)",
    "check_many of threads": "fc.check_many([(A, B)] * 3, pool, deadline=deadline)",
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_interrupt_raises_keyboard_interrupt(question):
    assert run(f"""
        from concurrent.futures import ThreadPoolExecutor
        bodies = fc.BodySet()
        for shape, motion in (A, B):
            bodies.add(shape, motion)
        pool = ThreadPoolExecutor(2)
        for _ in range(2):  # Once more: the first leaves nothing behind.
            interrupt_soon()
            try:
                {QUESTIONS[question]}
                print("answered")
            except KeyboardInterrupt:
                print("interrupted")
    """).split() == ["interrupted"] * 2


def test_handler_that_raises_nothing_changes_no_answer():
    assert run("""
        seen = []
        signal.signal(signal.SIGINT, lambda *_: seen.append(1))
        bodies = fc.BodySet()
        one = fc.make_sphere(1.0)
        for k in range(200):
            bodies.add(one, fc.Motion.constant_velocity(fc.Pose((1.9 * k, 0, 0)), (0, 0, 1)))
        expected = [a.__getstate__() for a in fc.answer_each_pair(bodies)]
        told = []
        def progress(done):
            if len(told) < 2:
                os.kill(os.getpid(), signal.SIGINT)
            told.append(done)
        answers = fc.answer_each_pair(bodies, progress=progress)
        print(len(seen) > 0, [a.__getstate__() for a in answers] == expected)
    """).split() == ["True", "True"]


def test_interrupt_ends_a_simulation_and_keeps_its_record(tmp_path):
    done, counted = run(f"""
        path = {str(tmp_path / "run.jsonl")!r}
        told = []
        interrupt_soon()
        try:
            fc.simulate(resting_balls(64), record=path, progress=told.append)
        except KeyboardInterrupt:
            print(len(told), len(list(fc.RunReader(path))))
    """).split()
    assert int(done) > 0 and int(counted) - int(done) in (0, 1)


def test_handler_that_raises_nothing_changes_no_step():
    assert run("""
        expected = [step.to_json() for step in fc.simulate(resting_balls(16), 0.4)]
        seen = []
        signal.signal(signal.SIGINT, lambda *_: seen.append(1))
        simulator = fc.Simulator(resting_balls(16))
        over = threading.Event()
        def act():
            while not over.wait(0.002):
                os.kill(os.getpid(), signal.SIGINT)
        thread = threading.Thread(target=act)
        thread.start()
        steps = [simulator.step().to_json() for _ in range(40)]
        over.set()
        thread.join()
        print(len(seen) > 0, steps == expected)
    """).split() == ["True", "True"]


def test_step_lets_other_threads_run_and_keeps_them_away():
    assert run("""
        simulator = fc.Simulator(resting_balls(64))
        refused = []
        over = threading.Event()
        def look():
            while not over.is_set():
                try:
                    simulator.time
                except RuntimeError as error:
                    refused.append(str(error))
                time.sleep(0.0005)
        thread = threading.Thread(target=look)
        thread.start()
        while not refused:
            simulator.step()
        over.set()
        thread.join()
        print(refused[0].split(":")[0])
    """).split() == ["Simulator"]


def test_new_handler_is_obeyed():
    assert run("""
        class Enough(Exception):
            pass
        def handler(*_):
            raise Enough
        interrupt_soon(2)
        for _ in range(2):
            try:
                fc.first_contact(A, B, deadline=deadline)
            except (KeyboardInterrupt, Enough) as error:
                print(type(error).__name__)
            signal.signal(signal.SIGINT, handler)
    """).split() == ["KeyboardInterrupt", "Enough"]


def test_ignored_interrupt_is_ignored():
    assert run("""
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        interrupt_soon()
        print(fc.first_contact(A, B, deadline=1.0).reason)
    """).split() == ["deadline"]


def test_default_action_kills():
    done = subprocess.run([sys.executable, "-c", PRELUDE + textwrap.dedent("""
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        interrupt_soon()
        fc.first_contact(A, B, deadline=deadline)
    """)], timeout=60, capture_output=True, check=False)
    assert done.returncode == -signal.SIGINT


def test_forked_child_is_interrupted_too():
    assert run("""
        interrupt_soon()
        try:
            fc.first_contact(A, B, deadline=deadline)
        except KeyboardInterrupt:
            pass
        child = os.fork()
        if child == 0:
            interrupt_soon()
            try:
                fc.first_contact(A, B, deadline=deadline)
            except KeyboardInterrupt:
                os._exit(7)
            os._exit(1)
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    """).split() == ["7"]


def test_interrupt_leaves_jobs_that_have_not_begun(arm_folder):
    """Each of the many jobs makes its robot's motion before it looks at a stop: minutes, if they were begun."""
    assert run(f"""
        import numpy as np
        scene = fc.RobotScene({str(arm_folder / "arm.urdf")!r})
        scene.add_body("post", fc.make_sphere(0.1), fc.Motion.fixed(fc.Pose((0, 2, 0))))
        times = np.linspace(0, 100, 3000)
        job = scene.along(fc.Trajectory(["elbow"], times, np.sin(times)[:, None]))
        interrupt_soon()
        try:
            fc.check_many([job] * 20000, closest=True, all_pairs=True, margin=0.001)
            print("answered")
        except KeyboardInterrupt:
            print("interrupted")
    """).split() == ["interrupted"]
