"""Poses and motions are those of C++."""

import math
import pickle

import firstcontact as fc
import numpy as np
import pytest

QUARTER = math.pi / 2


def motions():
    a = fc.Pose((1, 2, 3), rpy=(0.1, 0.2, 0.3))
    b = fc.Pose((-1, 0, 2), rotation_vector=(0, 2, 0.5))
    return [fc.Motion.fixed(), fc.Motion.fixed(a),
            fc.Motion.constant_velocity(a, b),
            fc.Motion.constant_velocity(a, (1, 0, -2), (0, 30, 0)),
            fc.Motion.screw(a, b),
            fc.Motion.screw(a, (0, 0, 1), (1, 1, 0), angle=-9.0, translation=0.25),
            fc.Motion.waypoints([0.25, 0.5, 1.0], [a, b, a], between="screw")]


def test_pose_maps_points():
    pose = fc.Pose((1, 2, 3), rpy=(0, 0, QUARTER))
    np.testing.assert_allclose(pose.matrix @ [1, 0, 0, 1], [1, 3, 3, 1], atol=1e-15)
    np.testing.assert_array_equal(pose.position, [1, 2, 3])
    same = fc.Pose([1, 2, 3], rotation_vector=np.array([0, 0, QUARTER]))
    np.testing.assert_allclose(same.quaternion_wxyz, pose.quaternion_wxyz, atol=1e-16)
    np.testing.assert_allclose(fc.Pose.from_matrix(pose.matrix).matrix, pose.matrix, atol=1e-15)
    assert fc.Pose() == fc.Pose((0, 0, 0), quaternion_wxyz=(1, 0, 0, 0))
    assert eval(repr(pose), {"Pose": fc.Pose}) == pose  # pylint: disable=eval-used
    assert fc.Pose() != fc.Pose((0, 0, 1)) and hash(fc.Pose()) == hash(fc.Pose())


@pytest.mark.parametrize("arguments, complaint", [
    ({"position": (0, 0)}, r"position: expected 3 numbers, got an array of shape \(2,\)"),
    ({"position": "abc"}, "position: expected 3 numbers, got an array of dtype"),
    ({"position": (math.nan, 0, 0)}, "finite"),
    ({"quaternion_wxyz": (0, 0, 0, 0)}, "zero quaternion"),
    ({"quaternion_wxyz": (1, 0, 0)}, "expected 4 numbers, got 3"),
    ({"rpy": (0, 0, 0), "rotation_vector": (0, 0, 0)}, "one of quaternion_wxyz, rpy"),
])
def test_pose_refuses(arguments, complaint):
    with pytest.raises((ValueError, TypeError), match=complaint):
        fc.Pose(**arguments)


def test_pose_takes_no_quaternion_by_its_place():
    """It may be meant as xyzw, the order of ROS, SciPy and Bullet."""
    with pytest.raises(TypeError, match="quaternion_wxyz"):
        fc.Pose((0, 0, 0), (0, 0, 0, 1))


@pytest.mark.parametrize("matrix", [np.eye(3), 2 * np.eye(4), np.diag([1, 1, 1, 2]),
                                    np.diag([1, 1, -1, 1]), np.full((4, 4), np.nan)])
def test_matrix_that_is_not_rigid_is_refused(matrix):
    with pytest.raises(ValueError, match="matrix: expected"):
        fc.Pose.from_matrix(matrix)


def test_constant_velocity_turns_and_moves():
    motion = fc.Motion.constant_velocity(fc.Pose(), (2, 0, 0), (0, 0, math.pi))
    half = motion.pose(0.5).matrix
    np.testing.assert_allclose(half[:3, 3], [1, 0, 0], atol=1e-15)
    np.testing.assert_allclose(half[:3, :3] @ [1, 0, 0], [0, 1, 0], atol=1e-15)


def test_waypoints_rest_outside_and_have_breaks():
    a, b = fc.Pose((0, 0, 0)), fc.Pose((1, 0, 0))
    motion = fc.Motion.waypoints(np.array([0.25, 0.75]), [a, b])
    assert motion.pose(0.1) == a and motion.pose(1.0) == b
    np.testing.assert_array_equal(motion.pose(0.5).position, [0.5, 0, 0])
    np.testing.assert_array_equal(motion.breaks, [0, 0.25, 0.75, 1])
    with pytest.raises(ValueError):
        motion.breaks[0] = 1


@pytest.mark.parametrize("motion", motions(), ids=str)
def test_motion_pickles_as_the_same_motion(motion):
    again = pickle.loads(pickle.dumps(motion))
    assert again == motion and hash(again) == hash(motion) and repr(again) == repr(motion)
    for t in np.linspace(0, 1, 7):
        assert again.pose(t) == motion.pose(t)


def test_motions_differ():
    assert len({*motions()}) == len(motions())


@pytest.mark.parametrize("make, complaint", [
    (lambda: fc.Motion.constant_velocity(fc.Pose(), (0, math.inf, 0)), "finite"),
    (lambda: fc.Motion.screw(fc.Pose(), (0, 0, 0), (0, 0, 0), 1, 0), "axis"),
    (lambda: fc.Motion.waypoints([0.5, 0.25], [fc.Pose(), fc.Pose()]), "must increase"),
    (lambda: fc.Motion.waypoints([0.5], [fc.Pose(), fc.Pose()]), "as many"),
    (lambda: fc.Motion.waypoints([0, 1], [fc.Pose(), fc.Pose()], "spline"),
     'Between: expected one of "constant_velocity", "screw", got "spline"'),
])
def test_motion_refuses(make, complaint):
    with pytest.raises(ValueError, match=complaint):
        make()
