"""Paths that are proven edge by edge, and edges for planners of others."""

import json
import threading

import numpy as np
import pytest

import firstcontact as fc

SCENE = {
    "firstcontact": 1,
    "bodies": [
        {"name": "wall", "shape": {"box": {"size": [1e-5, 1, 1]}}},
        {"name": "peg", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}},
    ],
    "plan": {"body": "peg", "goal": {"position": [0.5, 0.1, 0.25]}, "seed": 3},
}


def pose(x, y, z):
    return [x, y, z, 1, 0, 0, 0]


def test_plans_a_path():
    answer = fc.plan(SCENE)
    assert answer.verdict == "proven"
    assert answer.goal == 0
    assert answer.waypoints[0].tolist() == pose(-0.5, 0, 0)
    assert answer.waypoints[-1].tolist() == pose(0.5, 0.1, 0.25)
    assert len(answer.clearance) == len(answer.waypoints) - 1
    assert (answer.clearance > 0).all()
    assert answer.blocked[0][:2] == ("wall", "peg")
    path = json.loads(answer.json)
    assert path["waypoints"] == answer.waypoints.tolist()
    assert path["planner"]["seed"] == 3
    assert fc.plan(SCENE, threads=1).waypoints.tolist() == answer.waypoints.tolist()
    assert fc.plan(SCENE, seed=4).waypoints.tolist() != answer.waypoints.tolist()
    checker = fc.EdgeChecker(fc.load_scene(SCENE))
    assert checker.check(answer.waypoints[:-1], answer.waypoints[1:]).free.all()


@pytest.mark.parametrize("seed", [2**53, 2**63, 2**64, -1, 1.5, "1"])
def test_seeds_are_whole_numbers_that_a_path_file_holds(seed):
    with pytest.raises(ValueError, match=r"seed: expected a whole number from 0 to 9007199254740991, got"):
        fc.plan(SCENE, seed=seed)


def test_takes_the_greatest_seed_and_refuses_counts_below_zero():
    answer = fc.plan(SCENE, seed=np.int64(2**53 - 1))
    assert json.loads(answer.json)["planner"]["seed"] == 2**53 - 1
    with pytest.raises(ValueError, match="shortcuts: expected a whole number from 0 to"):
        fc.plan(SCENE, shortcuts=-1)


@pytest.mark.parametrize("threads", [-1, 1025])
def test_refuses_numbers_of_threads_that_the_tool_refuses(threads):
    with pytest.raises(ValueError, match="threads: expected a whole number from 0 to 1024, got"):
        fc.plan(SCENE, threads=threads)
    checker = fc.EdgeChecker(fc.load_scene(SCENE))
    with pytest.raises(ValueError, match="threads: expected a whole number from 0 to 1024, got"):
        checker.check([pose(-0.5, 0, 0)], [pose(-0.5, 1, 0)], threads=threads)


def test_plans_in_time_among_what_moves():
    poses = [{"position": [0, y, 0]} for y in (0, 4, 0, 0)]
    door = {"name": "door", "shape": {"box": {"size": [0.02, 3, 3]}},
            "motion": {"type": "waypoints", "times": [0, 3, 6, 8], "poses": poses}}
    scene = {"firstcontact": 1, "bodies": [door, SCENE["bodies"][1]],
             "plan": {"body": "peg", "goal": {"position": [0.5, 0, 0]}, "speeds": {"linear": 1, "angular": 1},
                      "box": [[-1, -0.1, -0.1], [1, 0.1, 0.1]]}}
    answer = fc.plan(scene)
    assert answer.verdict == "proven"
    assert len(answer.times) == len(answer.waypoints)
    assert (answer.times[0], answer.times[-1]) == (0, 8)
    # It passes x = 0 while the door is open.
    crossing = np.interp(0, answer.waypoints[:, 0], answer.times)
    assert 1.1 < crossing < 4.9
    assert json.loads(answer.json)["times"] == answer.times.tolist()
    assert fc.plan(SCENE).times.size == 0
    with pytest.raises(ValueError, match="moves"):
        fc.EdgeChecker(fc.load_scene(scene))


def test_moves_in_contact():
    answer = fc.plan(SCENE, contacts="both")
    assert answer.verdict == "proven"
    assert json.loads(answer.json)["planner"]["contacts"] == "both"
    with pytest.raises(ValueError, match="contacts"):
        fc.plan(SCENE, contacts="roll")


def test_has_no_path_where_there_is_none():
    closed = {**SCENE, "bodies": [{"name": "wall", "shape": {"box": {"size": [1e-5, 100, 100]}}}, SCENE["bodies"][1]],
              "plan": {**SCENE["plan"], "box": [[-1, -1, -1], [1, 1, 1]]}}
    answer = fc.plan(closed, time=0.1)
    assert (answer.verdict, answer.json, len(answer.waypoints)) == ("none", None, 0)
    assert fc.plan(closed, time=0.1, approximate=True).verdict == "approximate"


def test_names_what_is_wrong():
    inside = {**SCENE, "plan": {"body": "peg", "goal": {"position": [0, 0, 0]}}}
    with pytest.raises(ValueError, match='the goal is not free: "wall" and "peg"'):
        fc.plan(inside)
    with pytest.raises(ValueError, match="planner"):
        fc.plan(SCENE, planner="rrt")
    with pytest.raises(ValueError, match="time"):
        fc.plan(SCENE, time=0)
    with pytest.raises(ValueError, match='"plan"'):
        fc.plan({key: value for key, value in SCENE.items() if key != "plan"})


def test_checks_edges():
    checker = fc.EdgeChecker(fc.load_scene(SCENE))
    assert checker.start.tolist() == pose(-0.5, 0, 0)
    assert checker.goals.tolist() == [pose(0.5, 0.1, 0.25)]
    start = np.array([pose(-0.5, 0, 0), pose(-0.5, 0, 0)], float)
    end = np.array([pose(0.5, 0, 0), pose(-0.5, 1, 0)], float)
    answers = checker.check(start, end)
    assert answers.free.tolist() == [False, True]
    assert answers.undecided.tolist() == [False, False]
    # The faces meet at x = -0.050005.
    assert answers.fraction[0] == pytest.approx(0.449995, abs=2e-6)
    assert answers.fraction[0] <= 0.449995
    assert answers.fraction[1] == 1
    gap = checker.clearance(np.array([pose(-0.5, 0, 0), pose(0, 0, 0)], float))
    assert gap[0] == pytest.approx(0.449995, abs=1e-5)
    assert gap[0] <= 0.449995
    assert gap[1] == 0
    with pytest.raises(ValueError, match="start"):
        checker.check(start[:, :3], end)
    with pytest.raises(ValueError, match="end"):
        checker.check(start, np.full_like(end, np.nan))
    zero = start.copy()
    zero[1, 3:] = 0
    with pytest.raises(ValueError, match="start: row 1: .*quaternion"):
        checker.check(zero, end)
    with pytest.raises(ValueError, match="places: row 1: .*quaternion"):
        checker.clearance(zero)


def test_measures_the_clearance_along_edges():
    wall = {"name": "wall", "shape": {"box": {"size": [2, 2, 1]}}, "pose": {"position": [0, 0, -0.5]}}
    ball = {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 0, 1]}}
    scene = {"firstcontact": 1, "bodies": [wall, ball], "plan": {"body": "ball", "goal": {"position": [0, 0, 2]}}}
    checker = fc.EdgeChecker(fc.load_scene(scene))
    starts, ends = [pose(0, 0, 1), pose(0, 0, 1)], [pose(0.5, 0, 0.35), pose(0, 0, 0)]
    answers = checker.check(starts, ends, closest=True)
    assert answers.free.tolist() == [True, False]
    assert 0.25 - 2e-6 <= answers.clearance[0] <= 0.25
    assert answers.fraction[1] == pytest.approx(0.9, abs=1e-3)
    assert checker.check(starts, ends).free.tolist() == [True, False]
    with pytest.raises(ValueError, match="as many"):
        checker.check(starts, ends[:1], closest=True)


def test_says_what_is_within_limits(tmp_path):
    (tmp_path / "slide.urdf").write_text("""<robot name="slide"><link name="base"/><link name="tool"><collision>
        <geometry><sphere radius="0.1"/></geometry></collision></link><joint name="x" type="prismatic">
        <parent link="base"/><child link="tool"/><axis xyz="1 0 0"/><limit lower="-1" upper="2" effort="1"
        velocity="1"/></joint></robot>""")
    scene = {"firstcontact": 1, "robots": [{"name": "slide", "urdf": tmp_path / "slide.urdf"}],
             "plan": {"robot": "slide", "goal": {"x": 1}}}
    checker = fc.EdgeChecker(fc.load_scene(scene))
    places = [[-1], [2], [2.1], [-50], [float("nan")]]
    assert checker.within_limits(places).tolist() == [True, True, False, False, False]
    assert checker.check([[-5]], [[5]]).free.all()
    body = fc.EdgeChecker(fc.load_scene(SCENE))
    assert body.within_limits([pose(0, 0, 0), [0, 0, 0, 2, 0, 0, 0]]).tolist() == [True, False]


def test_plan_takes_margin_tolerance_and_tells_its_progress():
    assert fc.plan(SCENE, margin=0.01).clearance.min() >= 0.01
    assert json.loads(fc.plan(SCENE, tolerance=1e-5).json)["tolerance"] == 1e-5
    closed = {**SCENE, "bodies": [{"name": "wall", "shape": {"box": {"size": [0.01, 9, 9]}}}, SCENE["bodies"][1]]}
    closed["plan"] = {**SCENE["plan"], "box": [[-1, -1, -1], [1, 1, 1]]}
    told = []
    answer = fc.plan(closed, time=0.5, progress=lambda *done: told.append(done))
    assert answer.verdict == "none" and len(told) > 2
    assert all(0 <= seconds < 5 and nodes > 0 and cost is None for seconds, nodes, cost in told)

    def fail(*_):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        fc.plan(closed, time=60, progress=fail)


def test_checks_from_many_threads():
    checker = fc.EdgeChecker(fc.load_scene(SCENE))
    random = np.random.default_rng(1)
    start = np.hstack([random.uniform(-1, 1, (50, 3)), np.tile([1.0, 0, 0, 0], (50, 1))])
    end = np.hstack([random.uniform(-1, 1, (50, 3)), np.tile([1.0, 0, 0, 0], (50, 1))])
    expected = checker.check(start, end, threads=1)
    found = [None] * 4

    def ask(k):
        found[k] = checker.check(start, end, threads=1)

    threads = [threading.Thread(target=ask, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for answers in found:
        assert answers.free.tolist() == expected.free.tolist()
        assert answers.fraction.tolist() == expected.fraction.tolist()
