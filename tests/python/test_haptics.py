"""Tools that follow haptic devices."""

import concurrent.futures
from pathlib import Path

import numpy as np
import pytest

import firstcontact as fc

SCENE = {
    "firstcontact": 1,
    "bodies": [
        {"name": "floor", "shape": {"box": {"size": [1, 1, 0.1]}}, "pose": {"position": [0, 0, -0.05]}},
        {"name": "cube", "shape": {"box": {"size": [0.04, 0.04, 0.04]}}, "pose": {"position": [0, 0, 0.03]}},
    ],
    "haptics": {"tools": [{"body": "cube", "clutch_button": 1}], "contact_distance": 1e-5},
}


def press(session, depth, ticks=2000, buttons=()):
    tick = None
    for _ in range(ticks):
        tick = session.step([fc.Pose((0, 0, -depth))], list(buttons))
    return tick


def test_pushes_back_where_a_tool_touches():
    session = fc.HapticSession(SCENE)
    assert session.dt == 0.00025
    tick = press(session, 0.005)
    assert (tick.forces == 0).all() and tick.faults == [""]
    tick = press(session, 0.012)
    assert tick.forces.shape == (1, 3)
    assert tick.forces[0, 2] == pytest.approx(2.0, rel=0.02)
    assert session.poses[0].position[2] > 0.02
    assert tick.targets[0].position[2] == pytest.approx(0.018)
    assert session.contact_points.shape == (4, 3)
    assert np.allclose(session.contact_normals, [0, 0, 1])
    assert (session.contact_gaps >= 1e-5 * (1 - 1e-6)).all()


def test_takes_and_gives_arrays():
    by_poses, by_arrays = fc.HapticSession(SCENE), fc.HapticSession(SCENE)
    for k in range(1200):
        height, turn = -1e-5 * k, 1e-4 * k
        tick = by_poses.step([fc.Pose((0, 0, height), rotation_vector=(0, 0, turn))], [0])
        row = np.array([[0, 0, height, np.cos(turn / 2), 0, 0, np.sin(turn / 2)]])
        same = by_arrays.step(row, np.zeros(1, dtype=np.uint32), np.zeros((1, 0)))
        assert np.allclose(same.forces, tick.forces, atol=1e-9)
    assert same.forces[0, 2] > 1.9
    assert same.target_array.shape == (1, 7) and by_arrays.pose_array.shape == (1, 7)
    target, pose = same.targets[0], by_arrays.poses[0]
    assert np.array_equal(same.target_array[0], [*target.position, *target.quaternion_wxyz])
    assert np.array_equal(by_arrays.pose_array[0], [*pose.position, *pose.quaternion_wxyz])
    assert same.target_array[0, 2] == pytest.approx(0.03 - 0.01199)
    assert same.target_array[0, 6] == pytest.approx(np.sin(0.05995))
    assert by_arrays.step(np.full((1, 7), np.nan)).faults == ["device"]
    assert by_arrays.step([[0, 0, 0, 1, 0, 0, 0]]).target_array.shape == (1, 7)  # Rows of a list.


def test_gives_the_devices_of_its_record():
    session = fc.HapticSession(SCENE)
    tick = press(session, 0.012, ticks=2001)  # The last one begins a cycle.
    devices = session.cycle.devices
    assert devices.bodies.tolist() == [1]
    assert np.array_equal(devices.positions, tick.target_array[:, :3])
    assert np.array_equal(devices.quaternions_wxyz, tick.target_array[:, 3:])
    assert np.array_equal(devices.forces, tick.forces_world) and devices.forces[0, 2] > 1
    assert devices.torques.shape == (1, 3)


def test_names_the_pose_that_is_wrong():
    session = fc.HapticSession(SCENE)
    with pytest.raises(ValueError, match=r"poses: .*\(n, 7\).*got 6 columns"):
        session.step(np.zeros((1, 6)))
    with pytest.raises(ValueError, match="poses: row 0: "):
        session.step(np.zeros((1, 7)))  # No rotation.
    with pytest.raises(ValueError, match="poses: row 0: "):
        session.step(np.array([[np.nan, 0, 0, 1, 0, 0, 0]]))
    with pytest.raises(ValueError, match="each tool"):
        session.step(np.zeros((0, 7)))
    with pytest.raises(TypeError, match="poses"):
        session.step(["up"])


def test_names_the_buttons_and_grips_that_are_wrong():
    session = fc.HapticSession(SCENE)
    for buttons in (["a"], [-1], [0.5], 3):
        with pytest.raises(TypeError, match="^step: buttons: expected a whole number"):
            session.step([fc.Pose()], buttons=buttons)
    for grips in ([["a"]], [0.5], "open"):
        with pytest.raises(TypeError, match="^step: grips: expected a list of numbers"):
            session.step([fc.Pose()], grips=grips)
    with pytest.raises(ValueError, match="^step: buttons: "):
        session.step([fc.Pose()], buttons=[0, 0])
    with pytest.raises(ValueError, match="^step: grips: tool 0 has 0 grips, got 1"):
        session.step([fc.Pose()], grips=[[0.5]])
    session.step([fc.Pose()], grips=[[]])


def test_gives_the_force_on_a_device_of_another_scale():
    tools = [{**SCENE["haptics"]["tools"][0], "scale": 0.5}]
    session = fc.HapticSession({**SCENE, "haptics": {**SCENE["haptics"], "tools": tools}})
    tick = press(session, 0.024, ticks=2001)
    assert tick.forces[0, 2] > 0.5
    assert np.allclose(tick.forces_world, tick.forces, atol=1e-9)
    assert np.array_equal(session.cycle.devices.forces, tick.forces_world)


def test_feels_nothing_by_a_lost_device_or_a_clutch():
    session = fc.HapticSession(SCENE)
    assert press(session, 0.012).forces[0, 2] > 1
    tick = session.step([None])
    assert (tick.forces == 0).all() and tick.faults == ["device"]
    tick = press(session, 0.012, buttons=[2])
    assert (tick.forces == 0).all() and tick.faults == ["disengaged"]


def test_sessions_of_several_threads_feel_what_each_feels_alone():
    def felt(depth):
        session = fc.HapticSession(SCENE)
        return [press(session, depth, ticks=1).forces.tolist() for _ in range(600)]

    depths = [0.011, 0.012, 0.014]
    with concurrent.futures.ThreadPoolExecutor(len(depths)) as pool:
        assert list(pool.map(felt, depths)) == [felt(depth) for depth in depths]


def test_is_proven_by_its_record(tmp_path):
    session = fc.HapticSession(SCENE, duration=0.1)
    lines = [session.header_json]
    for k in range(400):
        session.step([fc.Pose((0.1 * np.sin(0.05 * k), 0, -0.06 * np.sin(0.02 * k)))])
        if session.cycle is not None:
            lines.append(session.cycle.to_json())
    record = tmp_path / "run.jsonl"
    record.write_text("\n".join(lines) + "\n")
    proof = fc.verify_run(record)
    assert proof.verdict == "proven"
    assert proof.steps == 100


def test_feels_with_a_robot_in_one_posture(arm_folder):
    scene = {
        "firstcontact": 1,
        "bodies": [SCENE["bodies"][0]],
        "robots": [{"name": "arm", "urdf": str(arm_folder / "arm.urdf"), "state": {"elbow": 0.5},
                    "base": {"position": [-0.8, -0.4, 0.12]}}],
        "haptics": {"tools": [{"robot": "arm"}]},
    }
    session = fc.HapticSession(scene)
    tick = press(session, 0.03)
    # The ball at the tip rests on the floor, and turns the arm against 1 N m/rad.
    assert 0.01 < tick.forces[0, 2] < 1.0
    assert session.contact_points.shape[0] >= 1 and abs(session.contact_points[0][0] - 0.12) < 0.05
    scene["robots"][0]["padding"] = 0.1
    with pytest.raises(ValueError, match='robot "arm": expected no "padding"'):
        fc.HapticSession(scene)


def test_refuses_what_makes_no_sense():
    with pytest.raises(ValueError, match="haptics"):
        fc.HapticSession({key: value for key, value in SCENE.items() if key != "haptics"})
    inside = {**SCENE, "bodies": [SCENE["bodies"][0], {**SCENE["bodies"][1], "pose": {"position": [0, 0, 0]}}]}
    with pytest.raises(ValueError, match='"cube" and "floor" meet'):
        fc.HapticSession(inside)
    session = fc.HapticSession(SCENE)
    with pytest.raises(ValueError, match="each tool"):
        session.step([])


def test_moves_fingers_by_grips():
    scene = Path(__file__).parents[2] / "benchmarks/haptics/scenes/jaws_on_cube.json"
    session = fc.HapticSession(scene)
    assert session.joint_names == ["slide"]
    down = [fc.Pose((0, 0, -0.015))]
    for _ in range(1000):
        tick = session.step(down, [], [[0.0]])
    assert tick.joint_efforts.shape == (1,) and tick.grip_efforts == [[0.0]]
    for _ in range(1000):
        tick = session.step(down, grips=[[1.0]])
    # Jaws at 35 mm hold a cube of 40 mm.
    assert session.joints[0] == pytest.approx(0.015, abs=2e-5)
    assert tick.joint_efforts[0] == pytest.approx(1000 * (0.015 - 0.035), rel=5e-3)
    assert tick.grip_efforts[0][0] == pytest.approx(0.035 * tick.joint_efforts[0])
    for values in ([], [0.0, 0.0]):
        with pytest.raises(ValueError, match=f"tool 0 has 1 grips, got {len(values)} values"):
            session.step(down, grips=[values])
