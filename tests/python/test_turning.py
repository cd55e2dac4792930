"""Continuous joints: which way they go, and recordings whose angles wrap."""

import math
import pickle

import firstcontact as fc
import numpy as np
import pytest

SPINNER = """<robot name="spinner"><link name="base"/>
  <link name="bar"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.04 0.04"/></geometry></collision></link>
  <link name="tip"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
    <limit effort="10" velocity="1"/></joint>
  <joint name="finger" type="fixed"><parent link="bar"/><child link="tip"/></joint></robot>"""
SHORT = 2 * math.pi - 6


@pytest.fixture
def spinner(tmp_path) -> fc.RobotModel:
    (tmp_path / "spinner.urdf").write_text(SPINNER)
    return fc.read_urdf(tmp_path / "spinner.urdf")


@pytest.fixture
def scene(spinner) -> fc.RobotScene:
    """With a post before the bar, which the long way from 3 to -3 rad sweeps."""
    scene = fc.RobotScene(spinner)
    scene.add_body("post", fc.make_box((0.1, 0.1, 0.6)), fc.Motion.fixed(fc.Pose((0.8, 0, 0))))
    return scene


def test_straight_motions_go_the_short_way_as_moveit(scene):
    short = scene.straight_motion({"turn": 3}, {"turn": -3})
    assert short.turning is fc.Turning.short and short.times[-1] == pytest.approx(SHORT)
    result = scene.check(short)
    assert result.verdict == "free"
    assert result.turns == (fc.JointTurn("spinner", "turn", 3, -3, pytest.approx(SHORT), "short"),)
    long = scene.straight_motion({"turn": 3}, {"turn": -3}, turning="long")
    assert scene.check(long).verdict == "contact" and scene.check(long).turns[0].turned == -6
    slow = scene.straight_motion({"turn": 3}, {"turn": -3}, velocity_scaling=0.5)
    assert slow.times[-1] == pytest.approx(2 * SHORT)
    with pytest.raises(ValueError, match="velocity_scaling"):
        scene.straight_motion({"turn": 3}, {"turn": -3}, velocity_scaling=0)
    assert short != long and pickle.loads(pickle.dumps(short)) == short


def test_trajectories_say_their_way(scene):
    arguments = (["turn"], [0, 10], [[3], [-3]])
    assert fc.Trajectory(*arguments).turning == "long"
    assert scene.check(fc.Trajectory(*arguments)).verdict == "contact"
    assert scene.check(fc.Trajectory(*arguments, turning="short")).verdict == "free"
    with pytest.raises(ValueError, match="Turning"):
        fc.Trajectory(*arguments, turning="shortest")


def test_recordings_that_wrap_are_warned_of_and_mended(scene, spinner, tmp_path):
    times = np.arange(101) / 10
    angles = np.remainder(2.5 + 0.2 * times + math.pi, 2 * math.pi) - math.pi
    recorded = fc.Trajectory(["turn"], times, angles[:, None])
    assert any('joint "turn" jumps by a whole turn' in w for w in scene.check(recorded).warnings)
    mended = recorded.unwrapped(spinner)
    assert np.allclose(mended.positions[:, 0], np.unwrap(angles), atol=1e-12)
    assert scene.check(mended).verdict == "free" and not scene.check(mended).warnings
    path = tmp_path / "recorded.csv"
    path.write_text("time;turn\n" + "".join(f"{t};{q}\n" for t, q in zip(times, angles, strict=True)))
    assert fc.read_trajectory(path, spinner, unwrap=True) == mended


def test_what_was_read_is_warned_of(scene, spinner, tmp_path):
    path = tmp_path / "move.csv"
    path.write_text("time,turn,finger\n0,0,1\n0,0,1\n1,0.1,1\n")
    read = fc.read_trajectory(path, spinner)
    assert len(read) == 2 and len(read.warnings) == 2
    assert pickle.loads(pickle.dumps(read)).warnings == read.warnings
    assert set(read.warnings) <= set(scene.check(read).warnings)
    request = tmp_path / "request.yaml"
    request.write_text("start_state: {joint_state: {name: [turn, finger], position: [0, 1]}}\n"
                       "goal_constraints: [{joint_constraints: [{joint_name: turn, position: 1}]}]\n")
    asked = fc.read_request(request, spinner)
    assert asked.start == {"turn": 0} and "finger" in asked.warnings[0]
    assert asked.velocity_scaling == asked.acceleration_scaling == 1
    assert asked.planning_time is None
    request.write_text(request.read_text() + "allowed_planning_time: 2.5\n")
    assert fc.read_request(request, spinner).planning_time == 2.5
    with pytest.warns(UserWarning, match="fixed joint, finger"):
        scene.straight_motion({"turn": 0, "finger": 1}, {"turn": 1})
