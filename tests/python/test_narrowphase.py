"""Elementary tests answer as in C++."""

import math

import firstcontact as fc
import numpy as np
import pytest

FACE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_linear_features_meet_at_the_closed_form():
    found = fc.linear_vertex_face_contact(((0.2, 0.2, 1), (0.2, 0.2, -1)), (FACE, FACE),
                                          tolerance=1e-9)
    assert found.verdict is fc.Verdict.contact and 0.5 - 1e-9 <= found.t <= 0.5
    edge, other = np.array([[0, -1, 0], [0, 1, 0]]), np.array([[-1, 0, 1], [1, 0, 1]])
    found = fc.linear_edge_edge_contact((edge, edge), (other, other - [0, 0, 4]), margin=0.2)
    assert found.verdict == "contact" and 0.2 - 1e-6 <= found.t <= 0.2
    found = fc.linear_edge_edge_contact((edge, edge), (other, other + [0, 0, 4]))
    assert found.verdict is fc.Verdict.free and found.t == 1


def test_turning_features_meet_at_the_closed_form():
    turn = fc.Motion.constant_velocity(fc.Pose((0.25, 0.25, 0.0)), (0, 0, 0), (0, math.pi, 0))
    # A lever of 0.1 m along z that turns about y by half a turn lies in the plane half way.
    found = fc.vertex_face_contact(FACE, fc.Motion.fixed(), (0, 0, 0.1), turn)
    assert found.verdict is fc.ElementaryVerdict.contact and found.existence_proven
    assert found.t_lower <= 0.5 <= found.t_upper and found.t_upper - found.t_lower < 1e-9
    found = fc.edge_edge_contact([[0, 0, 0], [1, 0, 0]], fc.Motion.fixed(), [[0, -1, 1], [0, 1, 1]],
                                 fc.Motion.constant_velocity(fc.Pose((0.5, 0, 0)), (0, 0, -2)))
    assert found.verdict == "contact" and found.t_lower <= 0.5 <= found.t_upper


def test_bad_features_get_clear_complaints():
    fixed = fc.Motion.fixed()
    with pytest.raises(ValueError, match="face_A: expected 3 points, got 2"):
        fc.vertex_face_contact(FACE[:2], fixed, (0, 0, 1), fixed)
    with pytest.raises(ValueError, match="one piece"):
        fc.vertex_face_contact(FACE, fixed, (0, 0, 1),
                               fc.Motion.waypoints([0, 0.5, 1], [fc.Pose()] * 3))
    with pytest.raises(ValueError, match="tolerance"):
        fc.linear_vertex_face_contact(((0, 0, 1), (0, 0, -1)), (FACE, FACE), tolerance=0)
    with pytest.raises(TypeError, match="vertex: expected a pair"):
        fc.linear_vertex_face_contact([0, 0, 1], (FACE, FACE))
