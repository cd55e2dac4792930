"""Scenes with robots answer as the tool does, and tell more than scenes of bodies."""

import json
import pickle
import re
import subprocess

import firstcontact as fc
import numpy as np
import pytest
from conftest import without_work


@pytest.fixture
def swing(arm_folder) -> dict:
    """An arm of 1.15 m that swings 2 rad in 4 s, past a post."""
    return {"firstcontact": 1, "id": "swing",
            "bodies": [{"name": "post", "shape": {"sphere": {"radius": 0.1}},
                        "pose": {"position": [0, 1, 0]}}],
            "robots": [{"name": "arm", "urdf": str(arm_folder / "arm.urdf"),
                        "trajectory": {"joint_names": ["elbow"],
                                       "points": [{"time": 0, "positions": [0]},
                                                  {"time": 4, "positions": [2]}]}}]}


def test_result_is_the_tools(swing, tmp_path, ask_tool):
    path = tmp_path / "swing.json"
    path.write_text(fc.load_scene(swing).to_json())
    options = {"all_pairs": True, "closest": True, "all_contacts_in_time": True}
    expected = ask_tool("--all-pairs", "--closest", "--all-contacts-in-time", path)
    assert without_work(fc.check(path, **options).to_dict()) == without_work(expected)


def test_attributes_are_those_of_the_json(swing):
    result = fc.check(swing, all_pairs=True, closest=True, all_contacts_in_time=True)
    told = result.to_dict()
    assert result.scene.robots == ("arm",) and result.scene.bodies == ("post",)
    for name in ("verdict", "t", "t_upper", "time", "clearance", "warnings"):
        assert getattr(result, name) == told[name]
    assert list(result.pair) == told["pair"] == ["post", "arm/tip"]
    for contact, expected in zip(result.contacts, told["contacts"], strict=True):
        assert list(contact.bodies) == expected["bodies"]
        assert list(contact.geometries) == expected["geometries"]
        assert contact.points.tolist() == expected["points"]
        assert contact.normal_velocity == expected["normal_velocity"]
    closest, expected = result.closest, told["closest"]
    assert (closest.distance, closest.time) == (expected["distance"], expected["time"])
    assert list(closest.pair) == expected["pair"]
    assert closest.points.tolist() == expected["points"]
    for pair, expected in zip(result.pairs, told["pairs"], strict=True):
        for name in ("verdict", "margin", "t", "t_upper", "time", "clearance"):
            assert getattr(pair, name) == expected[name]
        for interval, told_interval in zip(pair.intervals, expected["intervals"], strict=True):
            assert (interval.enter_time, interval.leave_time) == (told_interval["enter_time"],
                                                                  told_interval["leave_time"])
            assert interval.reason == "none" and told_interval["reason"] is None


def test_closest_of_all_pairs_is_that_of_one_of_them(swing):
    of_all, of_each = fc.check(swing, closest=True), fc.check(swing, closest=True, all_pairs=True)
    assert of_all.closest.distance == pytest.approx(of_each.closest.distance, abs=1e-6)
    apart = np.diff(of_all.closest.points, axis=0)
    assert np.linalg.norm(apart) == pytest.approx(of_all.closest.distance, abs=1e-12)
    assert of_all.verdict == of_each.verdict and of_all.t == of_each.t
    assert len(of_all.pairs) < len(of_each.pairs)
    assert pickle.loads(pickle.dumps(of_all)).closest.points.tolist() == of_all.closest.points.tolist()


def test_intervals_are_where_the_post_is_passed(swing):
    pairs = {p.pair[1]: p for p in fc.check(swing, all_contacts_in_time=True).pairs}
    enter, leave = pairs["arm/bar"].intervals[0][:2]
    # Bar of 0.1 m, ball of 0.1 m, 1 m from the axis: 0.15 rad before and behind, 2 rad in the step.
    assert enter < 0.7854 - 0.07 and leave > 0.7854 + 0.07 and len(pairs["arm/bar"].intervals) == 1
    assert fc.check(swing).pairs[0].intervals == ()


def test_limits_are_told(swing):
    result = fc.check(swing)
    violation, = result.limits
    assert (violation.robot, violation.joint, violation.limit) == ("arm", "elbow", "upper_position")
    assert violation.limit is fc.JointLimit.upper_position
    assert (violation.value, violation.excess, violation.time) == (1.5, pytest.approx(0.5), 4.0)
    assert violation.intervals == pytest.approx(np.array([[3, 4]]))
    assert any("leaves its upper limit of 1.5 rad by 0.5 rad" in w for w in result.warnings)
    with pytest.raises(ValueError, match="within the joint limits, but arm: joint"):
        fc.check(swing, strict=True)
    answer, = fc.check_many([swing], strict=True, errors="return")
    assert isinstance(answer, ValueError)


def test_pickles_whole(swing):
    result = fc.check(swing, all_pairs=True, closest=True, all_contacts_in_time=True)
    again = pickle.loads(pickle.dumps(result))
    assert again.to_json() == result.to_json()
    for part in (*result.contacts, *result.pairs, result.closest):
        assert repr(pickle.loads(pickle.dumps(part))) == repr(part)
    assert pickle.loads(pickle.dumps(result.contacts[0])).geometries == result.contacts[0].geometries
    assert pickle.loads(pickle.dumps(result.pairs[1])).intervals == result.pairs[1].intervals


def test_many_ask_for_intervals_too(swing):
    answer, = fc.check_many([swing], all_contacts_in_time=True)
    assert answer.pairs[0].intervals == fc.check(swing, all_contacts_in_time=True).pairs[0].intervals


def test_gap_is_sampled(swing):
    result = fc.check(swing, sample_rate=10)
    gap = fc.sample_gap(result.scene, [0.0, result.t])
    assert gap.distance[0] == pytest.approx(0.85)
    assert gap.distance[1] == pytest.approx(0, abs=2e-6)
    assert result.to_dict()["sampling"]["samples"] == 41
    samples, bound = result.gap_curve()
    assert result.t in samples.t and (bound.distance <= np.interp(bound.t, *samples[:2]) + 1e-3).all()


def test_bodies_have_intervals_as_links_do(swing):
    ball = {"sphere": {"radius": 0.1}}
    bodies = [{"name": "post", "shape": ball},
              {"name": "stone", "shape": ball, "motion": {
                  "type": "constant_velocity", "from": {"position": [-1, 0, 0]},
                  "translation": [2, 0, 0]}}]
    pair, = fc.check({"firstcontact": 1, "bodies": bodies}, all_contacts_in_time=True).pairs
    (enter, leave, *_), = pair.intervals
    assert enter == pytest.approx(0.4, abs=1e-3) and leave == pytest.approx(0.6, abs=1e-3)


def test_page_is_the_tools(swing, tool, tmp_path):
    path = tmp_path / "swing.json"
    path.write_text(fc.load_scene(swing).to_json())
    subprocess.run([tool, "check", path, "--html", tmp_path / "tool.html"], capture_output=True,
                   check=False, timeout=300)
    fc.check(path).save_html(tmp_path / "ours.html")

    def view(name: str) -> dict:
        text = (tmp_path / name).read_text()
        return json.loads(re.search(r'application/json">(.*?)</script>', text, re.S)[1])["view"]
    ours, theirs = view("ours.html"), view("tool.html")
    assert [link["name"] for link in ours["robots"][0]["links"]] == ["base", "bar", "tip"]
    for drawn in ("bodies", "robots", "carried", "meshes", "warnings"):
        assert ours[drawn] == theirs[drawn]
