"""Questions about two shapes and about many."""

import math
import pickle
import threading

import firstcontact as fc
import numpy as np
import pytest
from conftest import long_query


def test_first_contact_is_that_of_the_readme(triangle, falling):
    result = fc.first_contact((triangle, fc.Motion.fixed()), (triangle, falling))
    assert result.verdict is fc.Verdict.contact and result.verdict == "contact"
    assert 0.5 - 1e-6 < result.t <= 0.5 and result.t_upper == result.t
    corner = result.contacts[-1]
    assert [feature.type for feature in corner.features] == ["face", "vertex"]
    assert corner.triangles == (0, 0) and corner.features[1].index == 0
    assert corner.points.shape == (2, 3) and abs(corner.distance) <= 1e-6
    np.testing.assert_allclose(corner.points[1], [0.1, 0.1, 0], atol=1e-6)
    np.testing.assert_array_equal(corner.normal, [0, 0, 1])
    assert corner.normal_velocity == -2.0


def test_swapped_bodies_answer_alike(triangle, falling):
    rest = fc.Motion.fixed()
    result = fc.first_contact((triangle, rest), (triangle, falling))
    swapped = fc.first_contact(fc.MovingShape(triangle, falling), fc.MovingShape(triangle, rest))
    assert swapped.t == result.t and swapped.clearance == result.clearance
    assert swapped.contacts[0].features == result.contacts[0].features[::-1]


def test_a_pose_is_a_body_at_rest(triangle, falling):
    start = fc.Pose((0.1, 0.1, 1))
    rest = fc.Motion.fixed(start)
    moving = (triangle, falling)
    assert fc.distance((triangle, fc.Pose()), (triangle, start)).distance == 1.0
    assert fc.distance((triangle, fc.Pose()), moving).distance == 1.0
    for ask in (fc.first_contact, fc.closest_approach):
        assert pickle.dumps(ask((triangle, start), moving)) == pickle.dumps(ask((triangle, rest), moving))
    assert fc.check_many([((triangle, start), moving)])[0].verdict == "contact_at_start"
    with pytest.raises(TypeError, match=r"A: expected a pair \(Shape, Motion\) or \(Shape, Pose\), got"):
        fc.distance(triangle, (triangle, start))


def test_answers_are_no_conditions(triangle, falling):
    bodies = fc.BodySet()
    bodies.add(triangle, falling)
    for answer in (fc.first_contact((triangle, fc.Pose()), (triangle, falling)), fc.first_contact(bodies)):
        with pytest.raises(TypeError, match="compare its verdict"):
            bool(answer)


def test_workspace_changes_no_answer(triangle, falling):
    workspace = fc.Workspace()
    rest = fc.Motion.fixed()
    states = {pickle.dumps(fc.first_contact((triangle, rest), (triangle, falling), *extra))
              for extra in ([], [workspace], [workspace], [])}
    assert len(states) == 1


def test_options_reach_the_search(triangle, falling):
    A, B = (triangle, fc.Motion.fixed()), (triangle, falling)
    assert fc.first_contact(A, B, margin=0.5).t == pytest.approx(0.25, abs=1e-6)
    assert fc.first_contact(A, B, contacts="none").contacts == ()
    assert fc.first_contact(A, B, contacts=fc.ContactState.first).contacts != ()
    undecided = fc.first_contact(A, B, steps=0)
    assert undecided.verdict == "undecided" and undecided.reason is fc.UndecidedReason.work
    assert "undecided (work)" in repr(undecided)
    touching = (triangle, fc.Motion.fixed(fc.Pose((0, 0, 1e-7))))
    assert fc.first_contact(A, touching).verdict == "contact_at_start"
    assert fc.first_contact(A, touching, start_contacts="keep_half").verdict == "free"


def test_closest_approach_and_distance(triangle, falling):
    A, B = (triangle, fc.Motion.fixed(fc.Pose((0, 0, -2)))), (triangle, falling)
    closest = fc.closest_approach(A, B)
    assert closest.distance == pytest.approx(1.0) and closest.lower_bound <= 1.0
    assert closest.t == 1.0 and closest.closest.distance == closest.distance
    found = fc.distance(A, B, 0.25)
    assert found.distance == pytest.approx(2.5) and found.lower_bound <= found.distance


@pytest.mark.parametrize("options, complaint", [
    ({"tolerance": 0}, "tolerance"), ({"tolerance": math.nan}, "tolerance"),
    ({"margin": -1}, "margin"), ({"deadline": 0}, "deadline must be > 0"),
    ({"deadline": math.nan}, "deadline"), ({"contacts": "some"}, "ContactState: expected one of"),
])
def test_options_outside_their_range_are_refused(triangle, falling, options, complaint):
    with pytest.raises(ValueError, match=complaint):
        fc.first_contact((triangle, falling), (triangle, falling), **options)


def test_wrong_arguments_get_clear_complaints(triangle, falling):
    with pytest.raises(TypeError, match=r"A: expected a pair \(Shape, Motion\) or \(Shape, Pose\), got <Shape"):
        fc.first_contact(triangle, (triangle, falling))
    with pytest.raises(TypeError, match=r"B: expected a pair \(Shape, Motion\)"):
        fc.first_contact((triangle, falling), (falling, triangle))
    with pytest.raises(TypeError, match="incompatible function arguments"):
        fc.first_contact((triangle, falling), (triangle, falling), marign=1)
    with pytest.raises(ValueError, match="t must|t is|in .0, 1"):
        fc.distance((triangle, falling), (triangle, falling), 2.0)


def test_results_pickle_whole(triangle, falling):
    A, B = (triangle, fc.Motion.fixed()), (triangle, falling)
    bodies = fc.BodySet()
    for shape, motion in (A, B):
        bodies.add(shape, motion)
    for result in (fc.first_contact(A, B), fc.closest_approach(A, B), fc.distance(A, B, 0.5),
                   fc.first_contact(bodies), *fc.answer_each_pair(bodies, closest=True)):
        again = pickle.loads(pickle.dumps(result))
        assert type(again) is type(result) and again.__getstate__() == result.__getstate__()


def three_bodies(triangle, falling) -> fc.BodySet:
    bodies = fc.BodySet(fc.PairRules(margin=0.0))
    for shape, motion in ((triangle, fc.Motion.fixed()), (triangle, falling),
                          (triangle, fc.Motion.fixed(fc.Pose((0, 0, 5))))):
        bodies.add(shape, motion)
    return bodies


def test_many_bodies_answer_as_their_pairs(triangle, falling):
    bodies = three_bodies(triangle, falling)
    alone = fc.first_contact((triangle, fc.Motion.fixed()), (triangle, falling))
    result = fc.first_contact(bodies, fc.ManyBodiesWorkspace(), threads=2)
    assert (result.t, result.verdict) == (alone.t, alone.verdict)
    assert result.pairs[result.first].members == (0, 1)
    answers = fc.answer_each_pair(bodies)
    assert [answer.members for answer in answers] == [(0, 1), (0, 2), (1, 2)]
    assert answers[0].__getstate__()[0] == alone.__getstate__()
    assert answers[1].closest is None


def test_rules_hold(triangle, falling):
    bodies = three_bodies(triangle, falling)
    bodies.rules.set_margin((1, 0), 0.5)
    assert bodies.rules.margin((0, 1)) == 0.5
    assert fc.first_contact(bodies).t == pytest.approx(0.25, abs=1e-6)
    group = bodies.rules.add_group([0, 1])
    bodies.rules.ignore_groups(group, group)
    assert bodies.rules.margin((0, 1)) is None
    assert fc.first_contact(bodies).verdict == "free"
    rules = fc.PairRules(0.25)
    rules.ignore((0, 2))
    assert fc.BodySet(rules).rules.margin((2, 0)) is None
    with pytest.raises(ValueError):
        rules.set_margin((1, 1), 0.5)


def test_bodies_are_replaced(triangle, falling):
    bodies = three_bodies(triangle, falling)
    bodies.set_motion(1, fc.Motion.fixed(fc.Pose((0, 0, 1))))
    assert fc.first_contact(bodies).verdict == "free" and len(bodies) == 3
    ball = fc.make_sphere(1.0)
    bodies.set_shape(1, ball)
    assert bodies.shape(1) is ball
    assert fc.first_contact(bodies).verdict == "contact_at_start"
    with pytest.raises(IndexError, match="body 3 of 3"):
        bodies.set_motion(3, falling)


def test_progress_is_told_and_its_errors_come_back(triangle, falling):
    bodies = three_bodies(triangle, falling)
    told = []
    fc.answer_each_pair(bodies, progress=told.append)
    assert told and all(0 <= done <= 1 for done in told)

    def fail(done):
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        fc.answer_each_pair(bodies, progress=fail)


def test_nothing_changes_under_a_query(triangle, falling):
    bodies = three_bodies(triangle, falling)
    workspace = fc.ManyBodiesWorkspace()
    complaints = []

    def meddle(done):
        for act in (lambda: bodies.set_motion(0, falling), lambda: bodies.rules.ignore((0, 1)),
                    lambda: fc.first_contact(bodies, workspace)):
            with pytest.raises(RuntimeError) as complaint:
                act()
            complaints.append(str(complaint.value))
        fc.first_contact(bodies)  # Another query of the same set, with memory of its own.

    fc.answer_each_pair(bodies, workspace, progress=meddle)
    assert any("a query is running" in c for c in complaints)
    assert any("serves another query" in c for c in complaints)
    bodies.set_motion(0, falling)


def test_other_threads_run_during_a_query():
    A, B = long_query()
    stop = fc.StopSource()
    results = []
    thread = threading.Thread(target=lambda: results.append(fc.first_contact(A, B, stop=stop)))
    thread.start()
    for _ in range(100_000):  # Would not get on if the query kept the interpreter.
        pass
    assert thread.is_alive()
    stop.request_stop()
    thread.join()
    assert results[0].reason is fc.UndecidedReason.cancelled


def test_threads_share_shapes_and_need_no_workspaces(triangle, falling):
    expected = pickle.dumps(fc.first_contact((triangle, fc.Motion.fixed()), (triangle, falling)))
    answers = []

    def ask():
        for _ in range(200):
            answers.append(pickle.dumps(
                fc.first_contact((triangle, fc.Motion.fixed()), (triangle, falling))))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 800 and set(answers) == {expected}
