"""Trajectories for controllers, proven as they are executed."""

import json
import pathlib
import pickle
import subprocess
import threading

import numpy as np
import pytest

import firstcontact as fc

URDF = """<robot name="arm"><link name="base"/>
  <link name="upper"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
  <link name="lower"><collision><origin xyz="0.25 0 0"/><geometry><box size="0.5 0.1 0.1"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="2" effort="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><axis xyz="0 0 1"/>
    <origin xyz="1 0 0"/><limit lower="-3" upper="3" velocity="2" effort="1"/></joint></robot>"""
LIMITS = {"shoulder": {"max_velocity": 1.5, "max_acceleration": 5.0, "max_jerk": 100.0},
          "elbow": {"max_acceleration": 8.0, "max_jerk": 200.0}}
WAY = [[0, 0], [1, 0], [1, 1], [0, 0.5]]
MODES = ["stop", "blend", "time_optimal"]


@pytest.fixture
def arm(tmp_path):
    (tmp_path / "arm.urdf").write_text(URDF)
    ball = {"name": "ball", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0.07, 0.9, 0]}}
    return {"firstcontact": 1, "bodies": [ball], "robots": [{"name": "arm", "urdf": tmp_path / "arm.urdf"}]}


def along(arm: dict, waypoints) -> dict:
    """The scene of the arm with waypoints for its trajectory."""
    points = [{"time": k, "positions": place} for k, place in enumerate(waypoints)]
    robot = {**arm["robots"][0], "trajectory": {"joint_names": ["shoulder", "elbow"], "points": points}}
    return {**arm, "robots": [robot]}


def state_at(way: fc.Trajectory, time: float) -> np.ndarray:
    """Positions of a controller's quintic or cubic, from the polynomial's conditions at both ends."""
    k = min(max(int(np.searchsorted(way.times, time)) - 1, 0), len(way) - 2)
    length, s = way.times[k + 1] - way.times[k], time - way.times[k]
    rows = [way.positions, way.velocities, way.accelerations][:2 if way.accelerations is None else 3]
    powers = np.arange(2 * len(rows))

    def derivatives(t):
        found = [np.power(float(t), powers)]
        for _ in rows[1:]:
            found.append(np.concatenate([[0], powers[1:] * found[-1][:-1]]))
        return found

    system = np.array(derivatives(0) + derivatives(length))
    values = np.array([row[k] for row in rows] + [row[k + 1] for row in rows])
    return np.power(s, powers) @ np.linalg.solve(system, values)


@pytest.mark.parametrize("mode", MODES)
def test_is_free_and_within_limits_as_executed(arm, mode):
    answer = fc.retime(along(arm, WAY), mode=mode, limits=LIMITS)
    assert (answer.verdict, answer.mode, answer.contact, answer.limits) == ("proven", mode, None, ())
    way = answer.trajectory
    assert way.joint_names == ("shoulder", "elbow")
    assert way.positions[0].tolist() == WAY[0] and way.positions[-1].tolist() == WAY[-1]
    assert not way.velocities[[0, -1]].any() and not way.accelerations[[0, -1]].any()
    assert way.times[0] == 0 and way.times[-1] == answer.duration and (np.diff(way.times) > 0).all()
    assert answer.duration <= answer.stop_duration
    assert {(use.joint, use.rate) for use in answer.rates} == {
        (joint, rate) for joint in LIMITS for rate in ("velocity", "acceleration", "jerk")}
    for use in answer.rates:
        assert use.limit == LIMITS[use.joint].get(f"max_{use.rate}", 2.0)
        assert use.attained <= use.bound <= use.limit
    # A check of the same motion is free, and no sample of it comes closer.
    checked = fc.check({**arm, "robots": [{**arm["robots"][0], "trajectory": {
        "joint_names": way.joint_names, "points": [
            {"time": t, "positions": p, "velocities": v, "accelerations": a} for t, p, v, a in zip(
                way.times, way.positions, way.velocities, way.accelerations, strict=True)]}}]}, closest=True)
    assert checked.verdict == "free"
    assert answer.closest.distance == pytest.approx(checked.closest.distance, abs=2e-6)
    assert answer.closest.pair in [("ball", "arm/upper"), ("ball", "arm/lower")]
    assert 0 <= answer.closest.time <= answer.duration


def test_stop_keeps_to_the_edges(arm):
    way = fc.retime(along(arm, WAY), limits=LIMITS).trajectory
    for time in np.linspace(0, way.times[-1], 500):
        place = state_at(way, time)
        gaps = []
        for a, b in zip(np.array(WAY[:-1], float), np.array(WAY[1:], float), strict=True):
            share = np.clip((place - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
            gaps.append(np.linalg.norm(place - a - share * (b - a)))
        assert min(gaps) < 1e-9


def test_each_mode_is_no_slower(arm):
    durations = [fc.retime(along(arm, WAY), mode=mode, limits=LIMITS).duration for mode in MODES]
    assert durations[1] < durations[0] and durations[2] <= durations[1]
    blended = fc.retime(along(arm, WAY), mode="blend", limits=LIMITS)
    assert blended.blends == 2 and blended.stop_duration == durations[0]


def test_files_read_back_to_the_same_numbers(arm, tmp_path):
    answer = fc.retime(along(arm, WAY), mode="blend", limits=LIMITS)
    robot = fc.read_urdf(tmp_path / "arm.urdf")
    for ending in ("yaml", "json", "csv"):
        answer.save(tmp_path / f"way.{ending}")
        assert (tmp_path / f"way.{ending}").read_text() == getattr(answer, ending)
        assert fc.read_trajectory(tmp_path / f"way.{ending}", robot) == answer.trajectory
    with pytest.raises(ValueError, match="path"):
        answer.save(tmp_path / "way.txt")
    again = pickle.loads(pickle.dumps(answer))
    assert again.trajectory == answer.trajectory and again.rates == answer.rates and again.csv == answer.csv


def test_is_the_trajectory_of_the_tool(arm, tmp_path, tool):
    plan = {**arm, "plan": {"robot": "arm", "joints": ["elbow", "shoulder"], "goal": {"elbow": 1, "shoulder": 1}}}
    path = fc.plan(plan)
    (tmp_path / "path.json").write_text(path.json)
    (tmp_path / "limits.json").write_text(json.dumps({"joint_limits": LIMITS}))
    out = tmp_path / "out.yaml"
    subprocess.run([tool, "retime", tmp_path / "path.json", "--limits", tmp_path / "limits.json", "--mode", "blend",
                    "-o", out], check=True, capture_output=True)
    for source in (path, tmp_path / "path.json", str(tmp_path / "path.json"), json.loads(path.json)):
        answer = fc.retime(source, mode="blend", limits=tmp_path / "limits.json")
        assert answer.yaml == out.read_text()
        assert answer.trajectory.joint_names == ("elbow", "shoulder")
    (tmp_path / "arm.urdf").write_text(URDF.replace("1 0.1 0.1", "1 0.2 0.1"))
    with pytest.raises(ValueError, match="is not what it was when the path was planned"):
        fc.retime(path, limits=LIMITS)


def test_names_pair_and_time_of_what_is_in_the_way(arm, tmp_path):
    answer = fc.retime(along(arm, [[0, 0], [1.5, 0]]), mode="blend", limits=LIMITS)
    assert (answer.verdict, answer.trajectory, answer.yaml, answer.closest) == ("refused", None, None, None)
    assert answer.contact.pair == ("ball", "arm/upper") and 0 < answer.contact.time < answer.duration
    with pytest.raises(ValueError, match="refused"):
        answer.save(tmp_path / "way.yaml")
    assert not (tmp_path / "way.yaml").exists()
    beyond = fc.retime(along(arm, [[0, 0], [-3.5, 0]]), limits=LIMITS)
    assert (beyond.verdict, beyond.limits[0].joint, beyond.limits[0].value) == ("refused", "shoulder", -3.0)


def test_tracking_error_counts(arm):
    assert fc.retime(along(arm, WAY), limits=LIMITS, tracking_error=0.01).verdict == "proven"
    assert fc.retime(along(arm, WAY), limits=LIMITS, tracking_error=0.5).verdict == "refused"


def test_scaling_multiplies_all_limits(arm):
    fast = fc.retime(along(arm, WAY), limits=LIMITS)
    slow = fc.retime(along(arm, WAY), limits=LIMITS, velocity_scaling=0.25, acceleration_scaling=0.5)
    assert slow.duration > 2 * fast.duration
    assert {(use.joint, use.rate): use.limit for use in slow.rates} == {
        (use.joint, use.rate): use.limit * {"velocity": 0.25, "acceleration": 0.5, "jerk": 1}[use.rate]
        for use in fast.rates}
    for option in ("velocity_scaling", "acceleration_scaling"):
        for bad in (0, 1.5, float("nan")):
            with pytest.raises(ValueError, match=option):
                fc.retime(along(arm, WAY), limits=LIMITS, **{option: bad})


def test_blends_stay_within_their_deviation(arm):
    wide = fc.retime(along(arm, WAY), mode="blend", limits=LIMITS)
    narrow = fc.retime(along(arm, WAY), mode="blend", limits=LIMITS, blend_deviation=0.01)
    assert wide.left_out == narrow.left_out == 0 and narrow.duration > wide.duration
    places = np.array([state_at(narrow.trajectory, t) for t in np.linspace(0, narrow.duration, 4000)])
    for waypoint in WAY:
        assert np.abs(places - waypoint).max(axis=1).min() <= 0.01 + 1e-3  # Sampled.
    with pytest.raises(ValueError, match="blend_deviation"):
        fc.retime(along(arm, WAY), mode="blend", limits=LIMITS, blend_deviation=0)


def test_finely_divided_edges_cost_no_time(arm):
    fine = np.linspace([0, 0], [1, 0.5], 301)
    coarse = fc.retime(along(arm, [[0, 0], [1, 0.5]]), mode="blend", limits=LIMITS)
    answer = fc.retime(along(arm, fine.tolist()), mode="blend", limits=LIMITS)
    assert answer.left_out == 299
    assert answer.duration == pytest.approx(coarse.duration, rel=1e-3)


def test_limits_for_all_joints(arm):
    answer = fc.retime(along(arm, WAY), max_acceleration=4)
    assert answer.verdict == "proven" and answer.trajectory.accelerations is None
    assert {use.limit for use in answer.rates} == {2, 4}


def test_takes_a_loaded_scene_and_a_robot_scene(arm, tmp_path):
    expected = fc.retime(along(arm, WAY), limits=LIMITS)
    assert fc.retime(fc.load_scene(along(arm, WAY)), limits=LIMITS).csv == expected.csv
    waiting = fc.RobotScene(fc.read_urdf(tmp_path / "arm.urdf"))
    scene = waiting.along(fc.Trajectory(["shoulder", "elbow"], [0, 1, 2, 3], WAY))
    assert fc.retime(scene, limits=LIMITS).csv == expected.csv


def test_times_several_robots_with_one_clock(arm):
    robots = [{**arm["robots"][0], "name": name, "base": {"position": [x, 0, 0]}} for name, x in (("a", 0), ("b", 5))]
    scene = {**arm, "robots": robots, "plan": {"robots": ["a", "b"], "goal": {"a/elbow": 1, "b/shoulder": 1}}}
    path = fc.plan(scene)
    answer = fc.retime(path, limits={"a/elbow": {"max_acceleration": 3}}, max_acceleration=5)
    assert answer.verdict == "proven" and answer.trajectory.joint_names == ("a/elbow", "b/shoulder")
    assert {use.joint: use.limit for use in answer.rates if use.rate == "acceleration"} == {
        "a/elbow": 3, "b/shoulder": 5}
    with pytest.raises(ValueError, match='path of robot "a" alone'):
        fc.retime(path, which="a", max_acceleration=5)
    with pytest.raises(ValueError, match="a/elbow"):
        fc.retime(path, limits={"elbow": {"max_acceleration": 3}}, max_acceleration=5)


@pytest.mark.parametrize("policy, share", [("may_stay", 1 / 2), ("not_deeper", 15 / 16), ("must_open", 15 / 16)])
def test_holds_contact_pairs(arm, policy, share):
    # The ball is 0.5 mm beside the upper arm, whose margin is 10 mm.
    ball = {**arm["bodies"][0], "pose": {"position": [0.5, -0.1505, 0]}}
    scene = {**arm, "bodies": [ball], "plan": {
        "robot": "arm", "goal": {"shoulder": 1, "elbow": 0.5}, "margin": 0.01,
        "contact_pairs": [{"pair": ["arm/upper", "ball"], "policy": policy}]}}
    path = fc.plan(scene)
    assert path.verdict == "proven"
    for mode in MODES:
        answer = fc.retime(path, mode=mode, limits=LIMITS)
        assert answer.verdict == "proven" and answer.closest.distance == pytest.approx(0.0005, abs=1e-6)
        (held,) = answer.held
        assert held.pair == ("ball", "arm/upper") and held.distance == pytest.approx(share * 0.0005, abs=1e-6)
        assert held.start == 0 and 0 < held.end <= answer.duration
        assert held.end == answer.duration or policy == "must_open"
    edited = json.loads(path.json)
    edited["contact_pairs"][0]["distance"] = 0.000501
    answer = fc.retime(edited, limits=LIMITS)
    assert (answer.verdict, answer.contact.pair, answer.contact.time) == ("refused", ("ball", "arm/upper"), 0)


def test_a_stop_ends_it_undecided(arm):
    stop = fc.StopSource()
    stop.request_stop()
    answer = fc.retime(along(arm, WAY), limits=LIMITS, stop=stop)
    assert (answer.verdict, answer.trajectory) == ("undecided", None)


def test_lets_go_of_the_interpreter(arm):
    found = [None] * 4

    def ask(k):
        found[k] = fc.retime(along(arm, WAY), mode="blend", limits=LIMITS, threads=1).csv

    threads = [threading.Thread(target=ask, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found[0] is not None and len(set(found)) == 1


@pytest.mark.parametrize("field, change", [
    ("mode", {"mode": "fast"}), ("max_velocity", {"max_velocity": 0}),
    ("max_acceleration", {"max_acceleration": float("nan")}), ("max_jerk", {"max_jerk": -1}),
    ("tolerance", {"tolerance": 0}), ("tracking_error", {"tracking_error": -1}),
    ('"shoulder": expected a limit of the acceleration', {"limits": None}),
    ("joint_limits.shoulde", {"limits": {"shoulde": {"max_velocity": 1}}}),
    ("joint_limits.elbow.max_jerk", {"limits": {**LIMITS, "elbow": {"max_jerk": -1}}}),
    ('robot of the scene, got "leg"', {"which": "leg"})])
def test_names_the_field_that_is_wrong(arm, field, change):
    with pytest.raises(ValueError, match=field):
        fc.retime(along(arm, WAY), **{"limits": LIMITS, **change})


def test_refuses_what_is_no_path(arm, tmp_path):
    with pytest.raises(ValueError, match="two waypoints or more, got 1"):
        fc.retime(along(arm, WAY[:1]), limits=LIMITS)
    with pytest.raises(ValueError, match="waypoint 3"):
        fc.retime(along(arm, [[0, 0], [1, 1], [1, 1]]), limits=LIMITS)
    with pytest.raises(ValueError, match="expected a trajectory"):
        fc.retime(arm, limits=LIMITS)
    with pytest.raises(FileNotFoundError):
        fc.retime(tmp_path / "none.json", limits=LIMITS)
    with pytest.raises(FileNotFoundError):
        fc.retime(along(arm, WAY), limits=pathlib.Path("none.yaml"))
    closed = [{"name": "wall", "shape": {"box": {"size": [1e-5, 100, 100]}}},
              {"name": "peg", "shape": {"box": {"size": [0.1, 0.1, 0.1]}}, "pose": {"position": [-0.5, 0, 0]}}]
    without = fc.plan({"firstcontact": 1, "bodies": closed, "plan": {
        "body": "peg", "goal": {"position": [0.5, 0, 0]}, "box": [[-1, -1, -1], [1, 1, 1]]}}, time=0.1)
    with pytest.raises(ValueError, match='verdict is "none"'):
        fc.retime(without, max_acceleration=1)
    of_body = fc.plan({"firstcontact": 1, "bodies": closed[1:],
                       "plan": {"body": "peg", "goal": {"position": [0.5, 0, 0]}}})
    with pytest.raises(ValueError, match='body "peg", which has no joints'):
        fc.retime(of_body, max_acceleration=1)
