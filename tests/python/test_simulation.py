"""Simulations from Python: what the tool simulates, with states in and out as arrays."""

import copy
import json
import math
import os
import subprocess

import firstcontact as fc
import numpy as np
import pytest

GRAVITY = 9.81  # [m/s²]


def box_scene(height: float = 0.3, **dynamics) -> dict:
    """A box of 0.2 m whose centre of mass is so high over a floor."""
    return {"firstcontact": 1, "bodies": [
        {"name": "floor", "shape": {"box": {"size": [4, 4, 0.2]}}, "pose": {"position": [0, 0, -0.1]}},
        {"name": "box", "shape": {"box": {"size": [0.2, 0.2, 0.2]}},
         "pose": {"position": [0, 0, height]}, "dynamics": dynamics}],
        "simulation": {"duration": 0.5, "step": 0.01}}


FLOOR, BOX = 0, 1


@pytest.fixture
def simulator() -> fc.Simulator:
    return fc.Simulator(box_scene())


def test_simulator_knows_its_scene(simulator):
    assert simulator.names == ("floor", "box")
    np.testing.assert_allclose(simulator.masses, [0, 8])
    np.testing.assert_allclose(simulator.centres_of_mass[BOX], 0, atol=1e-15)
    assert (simulator.time, simulator.step_count) == (0, 0)
    assert (simulator.dt, simulator.duration, simulator.steps_of_duration) == (0.01, 0.5, 50)
    assert simulator.scene.to_dict()["simulation"]["contact_distance"] > 0


def test_free_fall_is_exact(simulator):
    step = simulator.step()
    assert (step.index, step.time, step.lasted, step.time_lost) == (1, 0.01, 0.01, 0)
    assert (simulator.time, simulator.step_count) == (0.01, 1)
    np.testing.assert_array_equal(step.bodies, [BOX])
    np.testing.assert_allclose(step.positions, [[0, 0, 0.3 - GRAVITY / 2 * 0.01**2]], rtol=1e-14)
    np.testing.assert_allclose(step.linear_velocities, [[0, 0, -GRAVITY * 0.01]], rtol=1e-14)
    np.testing.assert_allclose(step.linear_momentum, [0, 0, -8 * GRAVITY * 0.01], rtol=1e-14)
    assert step.kinetic_energy == pytest.approx(4 * (GRAVITY * 0.01)**2)
    assert step.kinetic_energy + step.potential_energy == pytest.approx(8 * GRAVITY * 0.3)
    assert step.events == 0 and len(step.contacts.bodies) == 0 and step.clearance > 0
    assert step.contacts.points.shape == step.contacts.impulses.shape == (0, 3)


def test_threads_change_nothing():
    scene = box_scene()
    for k in range(3):
        other = copy.deepcopy(scene["bodies"][1])
        other["name"] = f"box {k}"
        other["pose"]["position"] = [k - 1.5, 1, 0.2 + 0.1 * k]
        scene["bodies"].append(other)
    one, all_cores = fc.Simulator(scene, threads=1), fc.Simulator(scene)
    for _ in range(40):
        np.testing.assert_array_equal(one.step().positions, all_cores.step().positions)
    with pytest.raises(ValueError, match="negative"):
        fc.Simulator(scene, threads=-1)


def test_state_is_that_of_the_step(simulator):
    step = simulator.step()
    for of_all, of_moving in ((simulator.positions, step.positions),
                              (simulator.quaternions_wxyz, step.quaternions_wxyz),
                              (simulator.linear_velocities, step.linear_velocities),
                              (simulator.angular_velocities, step.angular_velocities)):
        assert len(of_all) == 2 and of_all.dtype == np.float64
        np.testing.assert_array_equal(of_all[step.bodies], of_moving)


def test_arrays_are_the_users_to_change(simulator):
    simulator.positions[:] = 7
    np.testing.assert_array_equal(simulator.positions[BOX], [0, 0, 0.3])


def test_box_comes_to_rest_on_the_floor(simulator):
    steps = [simulator.step() for _ in range(simulator.steps_of_duration)]
    assert sum(step.time_lost for step in steps) == 0
    assert min(step.clearance for step in steps) > 0
    assert steps[0].rest.tolist() == [False] and steps[-1].rest.tolist() == [True]
    np.testing.assert_array_equal(simulator.linear_velocities[BOX], 0)
    assert 0.1 < simulator.positions[BOX, 2] < 0.1 + 1e-3
    contacts = steps[-1].contacts
    m = len(contacts.bodies)
    assert m >= 3 and contacts.distances.shape == (m,) and len(contacts.features) == m
    np.testing.assert_array_equal(contacts.bodies, [[FLOOR, BOX]] * m)
    np.testing.assert_allclose(contacts.normals, [[0, 0, 1]] * m, atol=1e-5)
    np.testing.assert_allclose(contacts.points[:, 2], 0, atol=1e-3)
    # What carries the box is its weight.
    np.testing.assert_allclose(contacts.impulses.sum(axis=0), [0, 0, 8 * GRAVITY * 0.01], atol=1e-5)


def test_impacts_are_what_stops_the_box():
    simulator = fc.Simulator(box_scene(restitution=0.9))
    steps = [simulator.step() for _ in range(simulator.steps_of_duration)]
    times = np.concatenate([step.impacts.times for step in steps])
    bodies = np.vstack([step.impacts.bodies for step in steps])
    points = np.vstack([step.impacts.points for step in steps])
    assert len(times) == len(points) > 0 and times.min() >= 0
    np.testing.assert_array_equal(bodies, [[FLOOR, BOX]] * len(times))
    # It falls on the floor at 2 m/s, and leaves it at 1.8 m/s.
    first = next(step for step in steps if len(step.impacts.times) > 0)
    speed = math.sqrt(2 * GRAVITY * 0.2)
    assert first.impacts.impulses[:, 2].sum() == pytest.approx(1.9 * 8 * speed, rel=0.02)


def test_pieces_lead_from_state_to_state(simulator):
    before = simulator.positions[BOX]
    for _ in range(simulator.steps_of_duration):
        step = simulator.step()
        pieces = step.pieces(BOX)
        assert pieces.shape[1] == 14 and pieces[-1, 0] == step.lasted
        np.testing.assert_allclose(pieces[0, 1:4], before, atol=1e-14)
        before = step.positions[0]
    assert len(step.pieces(FLOOR)) == 0


def test_set_state_changes_what_it_is_given(simulator):
    simulator.set_state("box", position=(0.5, 0, 1))
    simulator.set_state(BOX, linear_velocity=np.array([0, 0, 2.0]))
    simulator.set_state(np.int64(1), quaternion_wxyz=[0, 0, 0, 3], angular_velocity=[0, 0, 1])
    np.testing.assert_array_equal(simulator.positions, [[0, 0, -0.1], [0.5, 0, 1]])
    np.testing.assert_array_equal(simulator.linear_velocities[BOX], [0, 0, 2])
    np.testing.assert_array_equal(simulator.quaternions_wxyz[BOX], [0, 0, 0, 1])
    np.testing.assert_array_equal(simulator.angular_velocities[BOX], [0, 0, 1])
    step = simulator.step()
    np.testing.assert_allclose(step.positions[0], [0.5, 0, 1 + 0.02 - GRAVITY / 2 * 0.01**2])


def test_forces_act_for_one_step():
    simulator = fc.Simulator(box_scene())
    simulator.set_gravity((0, 0, 0))
    simulator.apply_force("box", (8, 0, 0))
    simulator.apply_force(BOX, torque=[0, 0, 1])
    simulator.apply_force(BOX, (0, 8, 0), point=simulator.positions[BOX] + [1, 0, 0])
    simulator.step()
    np.testing.assert_allclose(simulator.linear_velocities[BOX], [0.01, 0.01, 0], atol=1e-14)
    spin = simulator.angular_velocities[BOX]
    np.testing.assert_allclose(spin, [0, 0, 9 * 0.01 / (8 * 0.04 / 6)], atol=1e-12)
    simulator.step()
    np.testing.assert_allclose(simulator.angular_velocities[BOX], spin, atol=1e-12)


def test_surfaces_change():
    simulator = fc.Simulator(box_scene(height=0.11))
    for _ in range(30):
        simulator.step()
    simulator.set_surface("floor", velocity=(1, 0, 0))
    for _ in range(30):
        simulator.step()
    assert simulator.linear_velocities[BOX, 0] == pytest.approx(1, abs=1e-3)
    simulator.set_surface("floor", velocity=(0, 0, 0))
    simulator.set_pair_surface("box", "floor", friction=0)
    simulator.step()
    assert simulator.linear_velocities[BOX, 0] == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize(("call", "complaint"), [
    (lambda s: s.apply_force("floor", (1, 0, 0)), "apply_force: body 0 is not free"),
    (lambda s: s.apply_force("box", (math.nan, 0, 0)), "finite"),
    (lambda s: s.apply_force("box", (0, 0, 1e300)), "apply_force: .* at most 1e60"),
    (lambda s: s.set_gravity((0, 0, 1e300)), "set_gravity: .* at most 1e60"),
    (lambda s: s.apply_force("bax", (1, 0, 0)), "there is none of the name"),
    (lambda s: s.set_gravity((0, 0)), "gravity: expected 3 numbers"),
    (lambda s: s.set_surface("box", friction=-1), "friction must be >= 0"),
    (lambda s: s.set_pair_surface("box", "floor", restitution=2), r"restitution must be in \[0, 1\]"),
    (lambda s: s.set_motor(0, "hinge", position=1), "there is no robot 0 with dynamics"),
    (lambda s: s.set_motor(0, "hinge"), "expected one of position, velocity and torque"),
])
def test_bad_commands_change_nothing(simulator, call, complaint):
    with pytest.raises(ValueError, match=complaint):
        call(simulator)
    assert simulator.step().to_json() == fc.Simulator(simulator.scene).step().to_json()


@pytest.mark.parametrize(("arguments", "state", "complaint"), [
    ((FLOOR,), {"position": (0, 0, 9)}, "is not free"),
    ((BOX,), {"position": (0, 0, 0)}, '"floor" and "box" meet'),
    ((BOX,), {"position": (math.nan, 0, 0)}, "finite"),
    ((BOX,), {"position": (0, 0)}, "position: expected 3 numbers"),
    ((BOX,), {"quaternion_wxyz": (0, 0, 0, 0)}, "quaternion"),
    ((BOX,), {"quaternion_wxyz": (1, 0, 0)}, "quaternion_wxyz: expected 4 numbers"),
    ((2,), {}, "body: expected a number from 0 to 1, got 2"),
    ((-1,), {}, "body: expected a number from 0 to 1, got -1"),
    (("bax",), {}, 'body: there is none of the name "bax"'),
])
def test_bad_state_changes_nothing(simulator, arguments, state, complaint):
    before = (simulator.positions, simulator.quaternions_wxyz)
    with pytest.raises(ValueError, match=complaint):
        simulator.set_state(*arguments, **state)
    np.testing.assert_array_equal(simulator.positions, before[0])
    np.testing.assert_array_equal(simulator.quaternions_wxyz, before[1])


def test_bad_type_of_a_body(simulator):
    with pytest.raises(TypeError, match="body: expected a number or a name, got float"):
        simulator.set_state(1.0)


def without(scene: dict, *keys) -> dict:
    scene = copy.deepcopy(scene)
    for body in scene["bodies"]:
        for key in keys:
            body.pop(key, None)
    return {key: value for key, value in scene.items() if key not in keys}


@pytest.mark.parametrize(("scene", "options", "complaint"), [
    (box_scene(height=0.05), {}, '"floor" and "box" meet at the start'),
    (without(box_scene(), "dynamics", "simulation"), {}, 'expected "simulation" or a body with'),
    (box_scene(), {"step": 0}, "step must be > 0"),
    (box_scene(), {"step": math.nan}, "step must be > 0"),
    (box_scene(), {"duration": -1}, "duration must be > 0"),
    (box_scene(), {"duration": math.inf}, "duration must be > 0 and finite"),
    (box_scene(density=-3), {}, "density"),
])
def test_bad_scene_is_a_value_error(scene, options, complaint):
    with pytest.raises(ValueError, match=complaint):
        fc.Simulator(scene, **options)


def test_bad_path():
    with pytest.raises(FileNotFoundError):
        fc.Simulator("none.json")
    with pytest.raises(FileNotFoundError):
        fc.verify_run("none.jsonl")
    with pytest.raises(FileNotFoundError):
        fc.RunReader("none.jsonl")


def test_scene_comes_as_check_takes_it(tmp_path):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(box_scene()))
    expected = fc.Simulator(box_scene()).step().to_json()
    for scene in (path, str(path), fc.load_scene(path), fc.read_simulation_scene(path)):
        assert fc.Simulator(scene).step().to_json() == expected


def test_fixture_of_rigid_ipc_falls(tmp_path):
    (tmp_path / "ball.obj").write_text(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    fixture = {"rigid_body_problem": {"gravity": [0, -9.8, 0], "rigid_bodies": [
        {"mesh": "ball.obj", "position": [0, 2, 0]}]}, "timestep": 0.01, "max_time": 0.02, "odd": 1}
    path = tmp_path / "fixture.json"
    path.write_text(json.dumps(fixture))
    simulator = fc.Simulator(path)
    assert simulator.steps_of_duration == 2 and "odd" in simulator.warnings[0]
    simulator.step()
    np.testing.assert_allclose(simulator.linear_velocities, [[0, -0.098, 0]], atol=1e-15)
    assert fc.Simulator(fc.read_simulation_scene(path)).names == simulator.names


def test_scripted_body_pushes():
    scene = box_scene(height=0.11)
    scene["bodies"].append({
        "name": "pusher", "shape": {"sphere": {"radius": 0.05}},
        "motion": {"type": "waypoints", "times": [0, 0.5],
                   "poses": [{"position": [-0.3, 0, 0.1]}, {"position": [0.2, 0, 0.1]}]}})
    simulator = fc.Simulator(scene)
    for _ in range(simulator.steps_of_duration):
        simulator.step()
    np.testing.assert_allclose(simulator.positions[2], [0.2, 0, 0.1], atol=1e-9)
    np.testing.assert_allclose(simulator.linear_velocities[2], [1, 0, 0], atol=1e-9)
    assert simulator.positions[BOX, 0] >= 0.2 + 0.05 + 0.1


def test_script_waits_for_what_it_would_crush(tmp_path):
    scene = box_scene(height=0.1001)
    scene["bodies"].append({"name": "wall", "shape": {"box": {"size": [0.1, 1, 1]}},
                            "pose": {"position": [0.16, 0, 0.51]}})
    scene["bodies"].append({
        "name": "pusher", "shape": {"box": {"size": [0.1, 0.2, 0.1]}},
        "motion": {"type": "waypoints", "times": [0, 0.5],
                   "poses": [{"position": [-0.3, 0, 0.1]}, {"position": [0.2, 0, 0.1]}]}})
    scene["simulation"]["jams"] = "wait"
    path = tmp_path / "run.jsonl"
    steps = fc.simulate(scene, record=path)
    pusher = list(steps[-1].bodies).index(3)
    assert sum(step.time_lost for step in steps) == 0
    assert 0.2 < steps[-1].behind[pusher] < 0.4 and not steps[-1].linear_velocities[pusher].any()
    found = fc.verify_run(path)
    assert found.verdict == "proven" and found.greatest_behind == steps[-1].behind[pusher]
    assert [step.behind[pusher] for step in fc.RunReader(path)][-1] == found.greatest_behind


def test_run_is_the_tools(tmp_path, tool):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(box_scene(angular_velocity=[1, 2, 3], linear_velocity=[0.3, 0, 0])))
    subprocess.run([tool, "simulate", path, "-o", tmp_path / "tool.jsonl", "--duration", "0.3"],
                   check=True, capture_output=True, timeout=300)
    told = []
    steps = fc.simulate(path, 0.3, record=tmp_path / "ours.jsonl", progress=told.append)
    assert (tmp_path / "ours.jsonl").read_bytes() == (tmp_path / "tool.jsonl").read_bytes()
    assert len(steps) == 30 and told == [k / 30 for k in range(1, 31)]


def test_recorded_run_reads_back_and_is_proven(tmp_path):
    path = tmp_path / "run.jsonl"
    steps = fc.simulate(box_scene(angular_velocity=[1, 2, 3]), record=path)
    run = fc.RunReader(path)
    assert run.names == ("floor", "box") and run.masses[BOX] == pytest.approx(8)
    assert [step.to_json() for step in run] == [step.to_json() for step in steps]
    assert not run.is_cut_off
    times = []
    found = fc.verify_run(path, progress=times.append)
    assert found.verdict == "proven" and found.verdict is fc.ProofVerdict.proven
    assert (found.problem, found.problem_at, found.is_cut_off) == ("", None, False)
    assert found.steps == 50 and found.time == pytest.approx(0.5) and times == sorted(times)
    assert 0 < found.least_distance <= found.closest.distance < 1e-2
    assert found.closest.bodies == ("floor", "box") and 1 <= found.closest.step <= 50


def test_broken_run_is_not_proven(tmp_path):
    path = tmp_path / "run.jsonl"
    fc.simulate(box_scene(), 0.05, record=path)
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:2] + lines[3:]))
    with pytest.raises(fc.ParseError, match=r"run\.jsonl:3: "):
        fc.verify_run(path)
    step = json.loads(lines[2])
    step["bodies"][0]["pieces"][0][1] += 0.5
    path.write_text("".join([*lines[:2], json.dumps(step) + "\n"]))
    found = fc.verify_run(path)
    assert found.verdict == "broken" and "box" in found.problem


def test_cut_off_run_goes_on_where_it_ended(tmp_path):
    path = tmp_path / "run.jsonl"
    steps = fc.simulate(box_scene(), record=path)
    path.write_bytes(path.read_bytes()[:-10])
    run = fc.RunReader(path)
    *_, last = run
    assert run.is_cut_off and last.index == 49 and fc.verify_run(path).is_cut_off
    simulator = fc.Simulator(box_scene())
    simulator.resume(last)
    assert simulator.step_count == 49
    assert simulator.step().to_json() == steps[-1].to_json()


def test_resume_refuses_a_step_of_another_scene(simulator):
    two = box_scene()
    two["bodies"].append({**two["bodies"][1], "name": "other", "pose": {"position": [1, 0, 1]}})
    with pytest.raises(ValueError, match="of another scene"):
        simulator.resume(fc.Simulator(two).step())


def test_record_does_not_overwrite_the_scene(tmp_path):
    path = tmp_path / "scene.json"
    path.write_text(json.dumps(box_scene()))
    with pytest.raises(ValueError, match="record: .* is the scene"):
        fc.simulate(path, record=tmp_path / "." / "scene.json")
    assert json.loads(path.read_text()) == box_scene()
    with pytest.raises(FileNotFoundError):
        fc.simulate(path, record=tmp_path / "none" / "run.jsonl")


def test_stop_leaves_the_state_alone(simulator):
    stop = fc.StopSource()
    assert simulator.step(stop).index == 1
    stop.request_stop()
    before = simulator.positions
    assert simulator.step(stop) is None
    assert simulator.step_count == 1
    np.testing.assert_array_equal(simulator.positions, before)
    assert fc.simulate(box_scene(), stop=stop) == []
    assert simulator.step().index == 2


def test_exception_of_progress_ends_the_run(tmp_path):
    def progress(done):
        if done >= 0.5:
            raise KeyError(done)
    with pytest.raises(KeyError):
        fc.simulate(box_scene(), record=tmp_path / "run.jsonl", progress=progress)
    assert len(list(fc.RunReader(tmp_path / "run.jsonl"))) == 25
    with pytest.raises(KeyError):
        fc.verify_run(tmp_path / "run.jsonl", progress=lambda _: progress(1))


@pytest.mark.skipif("FIRSTCONTACT_DATA_DIR" not in os.environ, reason="needs FIRSTCONTACT_DATA_DIR")
def test_fixture_of_rigid_ipc_as_it_comes():
    steps = fc.simulate(os.path.join(os.environ["FIRSTCONTACT_DATA_DIR"], "sim_rigid_ipc/fixtures/3D",
                                     "unit-tests/spinning-cube-over-plane.json"), 0.1)
    assert len(steps) > 1 and all(step.clearance > 0 for step in steps)


PENDULUM = """<robot name="pendulum"><link name="base"/><link name="rod">
<inertial><origin xyz="0 0 -0.25"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial>
<collision><origin xyz="0 0 -0.25"/><geometry><box size="0.02 0.02 0.5"/></geometry></collision></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>
"""


def test_robot_swings_and_is_moved(tmp_path):
    (tmp_path / "pendulum.urdf").write_text(PENDULUM)
    scene = {
        "firstcontact": 1,
        "robots": [{"name": "p", "urdf": str(tmp_path / "pendulum.urdf"), "state": {"hinge": 1.0},
                    "dynamics": {"velocities": {"hinge": 0.5}}}],
    }
    simulator = fc.Simulator(scene, step=0.01)
    assert simulator.names == ("p/rod",)
    assert simulator.robot_positions[0] == pytest.approx([1.0])
    assert simulator.robot_velocities[0] == pytest.approx([0.5])
    simulator.step()
    # The weight at 0.25 m over the moment about the hinge, 0.01 + 0.25^2.
    fallen = 0.5 - 0.01 * 9.81 * 0.25 * np.sin(1.0) / 0.0725
    assert simulator.robot_velocities[0] == pytest.approx([fallen], abs=1e-3)
    simulator.set_robot_state(0, positions=[0.0], velocities=[0.0])
    simulator.step()
    assert simulator.robot_positions[0] == pytest.approx([0.0], abs=1e-12)
    with pytest.raises(ValueError, match="1 positions"):
        simulator.set_robot_state(0, positions=[0.0, 1.0])
    with pytest.raises(ValueError, match="finite"):
        simulator.set_robot_state(0, velocities=[math.nan])
    with pytest.raises(ValueError, match=r"positions: expected an array of shape \(n,\)"):
        simulator.set_robot_state(0, positions=[[0.0]])
    with pytest.raises(TypeError, match="positions: expected n numbers"):
        simulator.set_robot_state(0, positions=["0"])
    with pytest.raises(ValueError, match="robot: expected a number below 1"):
        simulator.set_robot_state(1)
    with pytest.raises(ValueError, match="is a link"):
        simulator.set_state("p/rod", position=[0, 0, 1])


def test_motors_are_set_while_it_runs(tmp_path):
    (tmp_path / "pendulum.urdf").write_text(PENDULUM)
    scene = {"firstcontact": 1, "robots": [{"name": "p", "urdf": str(tmp_path / "pendulum.urdf"),
                                            "dynamics": {}}]}
    simulator = fc.Simulator(scene, step=0.01)
    simulator.set_motor(0, "hinge", velocity=0.5)
    for _ in range(10):
        simulator.step()
    assert simulator.robot_velocities[0] == pytest.approx([0.5])
    target = simulator.robot_positions[0][0] + 0.1
    simulator.set_motor(0, "hinge", position=target)
    for _ in range(5):
        simulator.step()
    assert simulator.robot_positions[0] == pytest.approx([target])
    simulator.set_motor(0, "hinge", position=target, stiffness=1e4, damping=1e3, effort=50)
    simulator.set_motor(0, "hinge", position=target - 0.1)  # The spring stays.
    simulator.step()
    assert abs(simulator.robot_positions[0][0] - target + 0.1) > 1e-3
    with pytest.raises(ValueError, match='robot "p" has no joint of one coordinate that is named "knee"'):
        simulator.set_motor(0, "knee", torque=1)
    with pytest.raises(ValueError, match="stiffness is for a position"):
        simulator.set_motor(0, "hinge", torque=1, stiffness=2)
    simulator.apply_force("p/rod", (0, 0, 1))


def test_steps_tell_the_forces_of_ties():
    ball = {"name": "ball", "shape": {"sphere": {"radius": 0.1}},
            "pose": {"position": [0, 0, -1]}, "dynamics": {"mass": 2}}
    scene = {"firstcontact": 1, "bodies": [ball], "simulation": {"step": 0.01, "ties": [
        {"type": "cable", "bodies": [None, "ball"], "points": [[0, 0, 0], [0, 0, 0]]}]}}
    simulator = fc.Simulator(scene)
    for _ in range(5):
        step = simulator.step()
    assert step.ties.forces == pytest.approx(np.array([[0, 0, 2 * 9.81]]), abs=1e-6)
    assert step.ties.torques == pytest.approx(np.zeros((1, 3)))


def test_steps_tell_what_motors_apply(tmp_path):
    (tmp_path / "pendulum.urdf").write_text(PENDULUM)
    scene = {"firstcontact": 1, "robots": [{
        "name": "p", "urdf": str(tmp_path / "pendulum.urdf"), "state": {"hinge": -math.pi / 2},
        "dynamics": {"motors": {"hinge": {"position": -math.pi / 2}}}}]}
    steps = fc.simulate(scene, 0.1, record=tmp_path / "run.jsonl")
    (effort,) = steps[-1].robot_efforts
    assert effort == pytest.approx([-9.81 * 0.25], abs=1e-5)
    assert steps[-1].robot_positions[0] == pytest.approx([-math.pi / 2])
    assert steps[-1].robot_velocities[0] == pytest.approx([0], abs=1e-9)
    *_, last = fc.RunReader(tmp_path / "run.jsonl")
    assert last.robot_efforts[0] == effort


def test_quaternion_of_a_free_base_is_not_zero(tmp_path):
    heavy = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
    (tmp_path / "pendulum.urdf").write_text(PENDULUM.replace("/>", f">{heavy}</link>", 1))
    scene = {"firstcontact": 1, "robots": [{"name": "p", "urdf": str(tmp_path / "pendulum.urdf"),
                                            "dynamics": {"base": "free"}}]}
    simulator = fc.Simulator(scene)
    with pytest.raises(ValueError, match="positions 3 to 6 are a quaternion, which must not be zero"):
        simulator.set_robot_state(0, positions=[0.0] * 8)
    simulator.set_robot_state(0, positions=[0, 0, 1, 0, 0, 0, 2, 0])
    assert list(simulator.robot_positions[0]) == [0, 0, 1, 0, 0, 0, 1, 0]


def test_run_has_arrays(tmp_path):
    path = tmp_path / "run.jsonl"
    run = fc.simulate(box_scene(linear_velocity=[0.3, 0, 0]), record=path)
    k, n = len(run), 2
    assert isinstance(run, fc.Run) and run.names == ("floor", "box") and repr(run) == "<Run of 50 steps, 0.5 s>"
    np.testing.assert_allclose(run.times, np.arange(1, k + 1) * 0.01)
    assert run.positions.shape == (k, n, 3) and run.quaternions_wxyz.shape == (k, n, 4)
    np.testing.assert_array_equal(run.positions[:, FLOOR], [[0, 0, -0.1]] * k)
    np.testing.assert_array_equal(run.quaternions_wxyz[:, FLOOR], [[1, 0, 0, 0]] * k)
    np.testing.assert_array_equal(run.positions[7, BOX], run[7].positions[0])
    np.testing.assert_array_equal(run.linear_velocities[3, BOX], run[3].linear_velocities[0])
    np.testing.assert_array_equal(run.angular_velocities[:, FLOOR], np.zeros((k, 3)))
    assert run.kinetic_energies[0] == run[0].kinetic_energy and (run.clearances > 0).all()
    assert run.potential_energies[-1] < run.potential_energies[0]
    again = fc.read_run(path)
    assert again.header_json == run.header_json
    np.testing.assert_array_equal(again.positions, run.positions)
    with pytest.raises(fc.ParseError):
        fc.read_run(__file__)


def test_run_fills_the_page():
    run = fc.simulate(box_scene(), 0.05)
    try:
        page = run.to_html()
    except FileNotFoundError as error:
        assert "CMAKE_ARGS" in str(error)
        assert run._repr_html_() == "<code>&lt;Run of 5 steps, 0.05 s&gt;</code>"
    else:
        assert '"firstcontact_run":1' in page
        assert run._repr_html_().startswith('<iframe title="Run"')
    assert fc.simulate(box_scene(), stop=stopped())._repr_html_().startswith("<code>")


def stopped() -> fc.StopSource:
    stop = fc.StopSource()
    stop.request_stop()
    return stop
