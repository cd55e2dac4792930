"""Robots answer as the tool does, about files and about what is in memory."""

import json
import math
import pickle
import threading

import firstcontact as fc
import numpy as np
import pytest
from conftest import ROOT, without_work

PUMA = ROOT / "data/robots/puma560_description/urdf/puma560_robot.urdf"
POST = fc.Pose((0, 1, 0))
SRDF = """<robot name="arm"><group name="all"><joint name="elbow"/></group>
  <group_state name="half" group="all"><joint name="elbow" value="0.5"/></group_state>
  <group name="tool"><link name="tip"/></group>
  <end_effector name="hand" group="tool" parent_link="bar"/>
  <disable_collisions link1="base" link2="tip" reason="Never"/>
  <disable_collisions link1="base" link2="tail" reason="Never"/></robot>"""


@pytest.fixture
def arm(arm_folder) -> fc.RobotModel:
    return fc.read_urdf(arm_folder / "arm.urdf")


@pytest.fixture
def srdf(arm_folder):
    path = arm_folder / "arm.srdf"
    path.write_text(SRDF)
    return path


@pytest.fixture
def swing() -> fc.Trajectory:
    """2 rad in 4 s."""
    return fc.Trajectory(["elbow"], [0, 4], [[0], [2]])


@pytest.fixture
def scene(arm) -> fc.RobotScene:
    """Beside a post of 0.1 m that stands 1 m off."""
    scene = fc.RobotScene(arm)
    scene.add_body("post", fc.make_sphere(0.1), fc.Motion.fixed(POST))
    return scene


def test_model_shows_what_was_read(arm):
    assert (arm.name, arm.root, arm.links) == ("arm", "base", ("base", "bar", "tip"))
    elbow, weld = arm.joints
    assert (elbow.name, elbow.parent, elbow.child) == ("elbow", "base", "bar")
    assert elbow.type is fc.JointType.revolute and elbow.axis.tolist() == [0, 0, 1]
    assert (elbow.lower, elbow.upper, elbow.velocity, elbow.mimic) == (-1, 1.5, 1, None)
    assert weld.type == "fixed" and weld.pose == fc.Pose((1.05, 0, 0)) and weld.lower is None
    assert arm.coordinates == ("elbow",)
    assert pickle.loads(pickle.dumps(arm)).joints[1].pose == weld.pose


def test_semantics_show_what_was_read(arm, srdf):
    semantics = fc.read_srdf(srdf, arm)
    assert semantics.disabled == (("base", "tip"),)
    assert semantics.states == {"all/half": {"elbow": 0.5}}
    assert semantics.groups["tool"].links == ("tip",)
    assert semantics.end_effectors == {"hand": fc.EndEffector("tool", "bar")}
    assert len(semantics.warnings) == 1 and "tail" in semantics.warnings[0]
    assert pickle.loads(pickle.dumps(semantics)) == semantics


def test_bad_robots_are_errors(tmp_path, arm):
    with pytest.raises(FileNotFoundError):
        fc.read_urdf(tmp_path / "none.urdf")
    with pytest.raises(FileNotFoundError):
        fc.RobotScene(arm, tmp_path / "none.srdf")
    bad = tmp_path / "bad.urdf"
    bad.write_text("<robot name='r'>\n<lnk/></robot>")
    with pytest.raises(fc.ParseError, match="bad.urdf"):
        fc.read_urdf(bad)


def test_trajectory_is_made_of_arrays(swing):
    assert swing.joint_names == ("elbow",) and len(swing) == 2
    assert swing.times.tolist() == [0, 4] and swing.positions.tolist() == [[0], [2]]
    assert swing.velocities is None and swing.accelerations is None
    times = np.linspace(0, 1, 5)
    full = fc.Trajectory(("a", "b"), times, np.outer(times, [1, 2]), np.ones((5, 2)),
                         np.zeros((5, 2)))
    assert full.positions.shape == full.velocities.shape == full.accelerations.shape == (5, 2)
    again = pickle.loads(pickle.dumps(full))
    assert again == full and hash(again) == hash(full) and again != swing


@pytest.mark.parametrize("arguments, complaint", [
    ((["a"], [0, 1], [[0, 1], [1, 2]]), r"positions: expected an array of shape \(2, 1\).*got shape \(2, 2\)"),
    ((["a"], [0, 0], [[0], [1]]), "times: expected numbers >= 0 that increase, got 0.0"),
    ((["a"], [-1, 0], [[0], [1]]), "times: expected"),
    ((["a"], [0, math.nan], [[0], [1]]), "times: expected"),
    ((["a"], [], np.zeros((0, 1))), "times: expected at least one"),
    ((["a", "a"], [0], [[0, 0]]), "joint_names: expected one or more, each once"),
    ((["a"], [0], [[math.inf]]), "positions: expected finite numbers, got inf"),
    ((["a"], [0], [[0]], [[0, 0]]), "velocities: expected an array of shape"),
    ((["a"], [0], [[0]], None, [[0]]), "accelerations: expected velocities beside them"),
])
def test_bad_trajectories_are_errors(arguments, complaint):
    with pytest.raises(ValueError, match=complaint):
        fc.Trajectory(*arguments)


def test_unknown_joints_are_errors(scene):
    with pytest.raises(ValueError, match='expected a joint of the robot, got "elbo"; did you mean "elbow"'):
        scene.check(fc.Trajectory(["elbo"], [0], [[0]]))


def test_answer_is_the_tools(arm, srdf, arm_folder, ask_tool):
    move = arm_folder / "move.csv"
    move.write_text("time,elbow\n0,0\n4,2\n")
    around = arm_folder / "around.json"
    around.write_text(json.dumps({"firstcontact": 1, "bodies": [
        {"name": "post", "shape": {"sphere": {"radius": 0.1}}, "pose": {"position": [0, 1, 0]}}]}))
    expected = ask_tool("--robot", arm.path, "--srdf", srdf, "--trajectory", move, "--environment", around,
                        "--padding", "0.01", "--tracking-error", "0.001", "--margin", "0.002",
                        "--all-pairs", "--closest", "--all-contacts-in-time")
    scene = fc.RobotScene(arm, fc.read_srdf(srdf, arm), around, padding=0.01, tracking_error=0.001,
                          margin=0.002)
    question = {"all_pairs": True, "closest": True, "all_contacts_in_time": True}
    told = scene.check(move, **question).to_dict()
    for what in ("input_digest", "scene_digest", "work"):
        del told[what], expected[what]
    # A trajectory is an argument here, whose file is not the scene's.
    expected["files"] = [file for file in expected["files"] if file["format"] != "trajectory"]
    assert told == expected
    again = scene.check(fc.read_trajectory(move, arm), **question)
    assert again.t == told["t"] and again.id == "arm"


def test_first_contact_is_where_geometry_says(scene, swing):
    result = scene.check(swing)
    assert result.pair == ("post", "arm/tip") and result.verdict == "contact"
    # Balls of 0.1 m, 1.05 m and 1 m from the axis, meet 0.2 m apart.
    left = math.acos((1.05**2 + 1 - 0.2**2) / 2.1)
    assert result.time == pytest.approx(2 * (math.pi / 2 - left), abs=1e-5)
    assert result.time <= 2 * (math.pi / 2 - left)
    assert scene.check(None).verdict == "free"


def test_padding_margins_and_errors_come_earlier(arm, swing):
    def contact(margins=(), **options):
        scene = fc.RobotScene(arm, **options)
        scene.add_body("post", fc.make_sphere(0.1), fc.Motion.fixed(POST))
        for margin in margins:
            scene.set_margin(*margin)
        return scene.check(swing).t

    plain = contact()
    assert contact(padding=0.01) == contact(padding={"tip": 0.01}) < plain
    assert contact(padding={"bar": 0.01}) == plain
    assert contact([("post", "tip", 0.01)]) == contact(margin=0.01) == contact(padding=0.01)
    assert contact([("post", "arm", 0.02), ("post", "arm/tip", 0.01)]) == contact(margin=0.01)
    assert contact(tracking_error=0.01) == contact(tracking_error={"elbow": 0.01}) < plain


def test_rules_that_ignore(scene, swing):
    scene.ignore("post", "tip")
    assert scene.check(swing).pair == ("post", "arm/bar")
    scene.ignore("arm", "post")
    result = scene.check(swing)
    assert result.verdict == "free" and result.clearance == math.inf


def test_bodies_move_for_as_long_as_the_trajectory(arm):
    scene = fc.RobotScene(arm)
    scene.add_body("by line", fc.make_sphere(0.1),
                   fc.Motion.constant_velocity(fc.Pose((3, 0, 0)), (-2, 0, 0)))
    scene.add_body("by points", fc.make_sphere(0.1),
                   fc.Motion.waypoints([0.2, 0.8], [fc.Pose((0, 0, 3)), fc.Pose((0.5, 0, 0))]))
    for seconds in (1.0, 5.0):
        rest = fc.Trajectory(["elbow"], [0, seconds], [[0], [0]])
        result = scene.check(rest, all_pairs=True)
        pairs = {pair.pair: pair for pair in result.pairs}
        assert result.scene.duration == seconds
        assert pairs["by line", "arm/tip"].t == pytest.approx((3 - 1.25) / 2, abs=1e-6)
        # On a line of slope 6 down to a bar of 0.05 m half thickness.
        assert 0.7 < pairs["by points", "arm/bar"].t < 0.8
    again = pickle.loads(pickle.dumps(scene))
    assert again.check(rest).t == scene.check(rest).t


def test_what_is_carried_touches_nothing_of_its_link(arm, swing):
    scene = fc.RobotScene(arm)
    scene.add_body("post", fc.make_sphere(0.1), fc.Motion.fixed(POST))
    scene.add_body("part", fc.make_sphere(0.05), fc.Motion.fixed(fc.Pose((1.14, 0, 0))))
    assert scene.check(swing).verdict == "contact_at_start"
    scene.attach("part", "tip", touch_links=["bar"])
    carried = scene.check(swing, all_pairs=True)
    verdicts = {pair.pair: pair.verdict for pair in carried.pairs}
    assert verdicts["part", "arm/tip"] == verdicts["part", "arm/bar"] == "free"
    assert verdicts["post", "part"] == "contact"
    assert pickle.loads(pickle.dumps(scene)).check(swing).t == carried.t
    held = fc.RobotScene(arm)
    held.add_body("part", fc.make_sphere(0.05))
    held.attach("part", "tip", touch_links=["bar"], pose=fc.Pose((0.5, 0, 0)))
    held.add_body("far", fc.make_sphere(0.1), fc.Motion.fixed(fc.Pose((0, 1.55, 0))))
    for scene_held in (held, pickle.loads(pickle.dumps(held))):
        assert scene_held.check(swing).pair == ("part", "far")
    with pytest.raises(ValueError, match="body: expected"):
        scene.attach("arm", "tip")
    with pytest.raises(ValueError, match='did you mean "arm/tip"'):
        scene.attach("part", "tap")


def test_bad_arguments_are_errors(arm, scene):
    for bad in ({"padding": -1}, {"tracking_error": math.nan}, {"margin": -1}, {"padding": {"tap": 1}},
                {"tracking_error": {"weld": 1}}, {"tracking_error": {"elbo": 1}}, {"state": "half"}):
        with pytest.raises(ValueError):
            fc.RobotScene(arm, **bad)
    with pytest.raises(ValueError, match="name: expected one that no body"):
        scene.add_body("post", fc.make_sphere(1))
    with pytest.raises(ValueError, match='got "pst"; did you mean "post"'):
        scene.ignore("pst", "arm")
    with pytest.raises(TypeError):
        fc.RobotScene(arm, state=3)


def test_bodies_that_deform_meet_the_arm(arm, scene):
    sheet = fc.Shape(([[3, 0, 1], [-3, 3, 1], [-3, -3, 1], [0, 0, 1]], [[0, 1, 3], [1, 2, 3], [2, 0, 3]]))
    flag = fc.move_vertices(sheet, [[3, 0, 1], [-3, 3, 1], [-3, -3, 1], [0, 0, -1]])
    scene.add_body("flag", *flag)
    still = fc.Trajectory(["elbow"], [0, 1], [[0], [0]])
    answer = scene.check(still, all_pairs=True)
    times = [pair.t for pair in answer.pairs if "flag" in pair.pair and pair.verdict == "contact"]
    assert times and 0.4 < min(times) <= 0.5
    scene.attach("flag", "tip")
    with pytest.raises(ValueError, match="'flag' deforms; a link holds rigid bodies only"):
        scene.check(still)


@pytest.mark.parametrize(("make", "complaint"), [
    (lambda fc, arm, scene: scene.check(np.zeros((3, 1))), "trajectory: expected a Trajectory, .*, got ndarray"),
    (lambda fc, arm, scene: scene.along(3), "trajectory: expected a Trajectory, .*, got int"),
    (lambda fc, arm, scene: fc.RobotScene(None), "robot: expected a RobotModel, or the path .*, got NoneType"),
    (lambda fc, arm, scene: fc.RobotScene(arm, 7), "srdf: expected .*, got int"),
    (lambda fc, arm, scene: fc.RobotScene(arm, environment={"bodies": []}), "environment: expected .*, got dict"),
    (lambda fc, arm, scene: fc.RobotScene(arm, environment=[1, 2]), "environment: expected .*, got list"),
    (lambda fc, arm, scene: fc.RobotScene(arm, padding="much"), "padding: expected a number, .*, got str"),
    (lambda fc, arm, scene: fc.RobotScene(arm, padding={"bar": "much"}), "padding: expected .*, got dict"),
    (lambda fc, arm, scene: fc.RobotScene(arm, tracking_error=[0.1]), "tracking_error: expected .*, got list"),
    (lambda fc, arm, scene: fc.RobotScene(arm, state={"elbow": "up"}), "positions: expected .*, got dict"),
])
def test_arguments_of_a_wrong_type_are_named(arm, scene, make, complaint):
    with pytest.raises(TypeError, match=complaint):
        make(fc, arm, scene)


class Frame:
    """What of a data frame of pandas is asked for."""

    def __init__(self, columns: dict, index):
        self._columns, self.columns, self.index = columns, list(columns), index

    def __getitem__(self, name):
        return self._columns[name]


@pytest.mark.parametrize("like", [
    {"joint_names": ["elbow"], "points": [{"time": 0, "positions": [0]}, {"time": 4, "positions": [2]}]},
    {"joint_names": ["elbow"], "points": [{"time": 0, "positions": np.zeros(1)}, {"time": 4, "positions": [2]}]},
    {"time": [0, 4], "elbow": [0, 2]},
    {"Time": np.array([0, 4]), "elbow": np.array([0, 2])},
    Frame({"time": [0, 4], "elbow": [0, 2]}, range(2)),
    Frame({"elbow": [0, 2]}, np.array([0.0, 4.0])),
], ids=["points", "arrays in points", "columns", "arrays", "frame", "frame by its index"])
def test_trajectory_may_be_a_dict_or_a_data_frame(scene, swing, like):
    answer, expected = scene.check(like), scene.check(swing)
    assert (answer.verdict, answer.t) == (expected.verdict, expected.t)


def test_columns_have_velocities_too(scene):
    columns = {"time": [0, 2], "elbow": [0, 1], "elbow.velocity": [0, 0]}
    cubic = fc.Trajectory(["elbow"], [0, 2], [[0], [1]], [[0], [0]])
    assert scene.check(columns).t == scene.check(cubic).t


@pytest.mark.parametrize(("columns", "complaint"), [
    ({"elbow": [0, 1]}, 'expected one column "time"'), ({"time": [0, 1]}, "a column for at least one joint"),
    ({"time": [0, 1], "elbo": [0, 1]}, 'did you mean "elbow"'),
    ({"time": [0, 1], "elbow": [0, math.nan]}, "expected finite numbers"),
    ({"time": [1, 0], "elbow": [0, 1]}, "times: expected numbers >= 0 that increase"),
    ({"time": [0, 1], "elbow": [0, 1], "wrist.velocity": [0, 0]}, "of all joints or of none"),
])
def test_bad_columns_are_errors(scene, columns, complaint):
    with pytest.raises(ValueError, match=complaint):
        scene.check(columns)


def test_implausible_sizes_are_warned_of(arm, arm_folder):
    scene = fc.RobotScene(arm)
    scene.add_body("near", fc.make_box((900, 1, 1)), fc.Motion.fixed(fc.Pose((0, 0, 9))))
    scene.add_body("far", fc.make_box((1500, 1, 1)), fc.Motion.fixed(fc.Pose((0, 0, -9))))
    big = arm_folder / "big.urdf"
    big.write_text((arm_folder / "arm.urdf").read_text().replace('size="1 0.1 0.1"', 'size="300 0.1 0.1"'))
    asked = [w for w in scene.check(None).warnings + fc.RobotScene(big).check(None).warnings
             if "is its unit right?" in w]
    assert len(asked) == 2 and 'body "far" is 1500' in asked[0] and 'link "bar" is 300' in asked[1]


def test_states_and_straight_motions(arm, srdf):
    scene = fc.RobotScene(arm, srdf, state="half")
    straight = scene.straight_motion("all/half", {"elbow": 1.5})
    assert straight.positions.tolist() == [[0.5], [1.5]] and straight.times[1] == pytest.approx(1)
    assert scene.check(straight, strict=True).verdict == "free"
    assert scene.check(None).scene.to_dict()["robots"][0]["state"] == {"elbow": 0.5}
    assert scene.check(None).warnings == fc.RobotScene(arm, srdf, state=["half", {"elbow": 0.1}]).check(None).warnings


def test_surroundings_keep_their_rules_and_duration(arm, arm_folder, swing):
    around = arm_folder / "around.json"
    around.write_text(json.dumps({"firstcontact": 1, "bodies": [
        {"name": "ball", "shape": {"sphere": {"radius": 0.1}},
         "motion": {"type": "constant_velocity", "from": {"position": [0, 3, 0]}, "translation": [0, -1, 0]}}],
        "options": {"duration": 4, "margin": 0.25}}))
    scene = fc.RobotScene(arm, environment=[around])
    assert scene.bodies == ("ball",) and scene.check(swing, all_pairs=True).pairs[0].margin == 0.25
    with pytest.raises(ValueError, match="expected one of 4.0 s, .* got one of 3.0 s"):
        scene.check(fc.Trajectory(["elbow"], [0, 3], [[0], [2]]))


def test_budgets_end_with_what_is_proven(scene, swing):
    stop = fc.StopSource()
    stop.request_stop()
    result = scene.check(swing, stop=stop)
    assert (result.verdict, result.reason) == ("undecided", "cancelled")
    with pytest.raises(ValueError, match="deadline"):
        scene.check(swing, deadline=0)
    seen = []
    assert scene.check(swing, progress=seen.append).verdict == "contact"
    assert all(0 <= done <= 1 for done in seen)


def test_many_trajectories(scene):
    ways = [fc.Trajectory(["elbow"], [0, 1], [[0], [angle]]) for angle in (0.5, 1.0, 1.4, 1.5)]
    answers = fc.check_many([scene.along(way) for way in ways])
    assert [a.verdict for a in answers] == ["free", "free", "contact", "contact"]
    assert [a.to_dict() for a in map(scene.check, ways)] == [a.to_dict() for a in answers]
    assert len({a.scene.input_digest for a in answers}) == 4


def test_threads_share_a_scene(scene, swing):
    found = []
    threads = [threading.Thread(target=lambda: found.append(scene.check(swing, threads=1).t))
               for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4 and len(set(found)) == 1


def test_puma_with_real_meshes():
    robot = fc.read_urdf(PUMA, visual=True)
    scene = fc.RobotScene(robot)
    names = robot.coordinates
    result = scene.check(fc.Trajectory(names, [0, 1], [[0] * 6, [0.3] * 6]), all_pairs=True, closest=True)
    assert result.scene.robots == (robot.name,) and len(names) == 6
    assert result.closest.distance - result.closest.lower_bound <= 1e-6
