"""What slides, rolls, turns and collides: each function takes a tool and a step, and returns an error."""

import math

from law_scenes import (G, NEAR, ball, body, box, energy, leaning, rest_gap, runge_kutta, scene, simulate,
                        tube, tube_dynamics, tube_hulls, turned)


def turntable(tool, step):
    """How far a block at 0.5 m is from its place on a table that turns at 2 rad/s, after 3 s."""
    table = {"name": "table", "shape": box(3, 3, 0.1), "motion": {
        "type": "constant_velocity", "from": {"position": [0, 0, -0.05]}, "rotation_vector": [0, 0, 6]}}
    block = body("block", box(0.1, 0.1, 0.04), (0.5, 0, 0.0201),
                 dynamics={"linear_velocity": [0, 1, 0], "angular_velocity": [0, 0, 2]})
    run = simulate(tool, scene([table, block], 3.0, step, friction=1.0))
    x, y, _ = run.body(1)["position"]
    return math.hypot(x - 0.5 * math.cos(6.0), y - 0.5 * math.sin(6.0))


def ball_on_a_turntable(tool, step):
    """How far a ball that rolls over a table at 2 rad/s is from its circle after 3 s, beyond 1e-6 m."""
    rate, speed = 2 * 2.0 / 7, 0.3
    table = {"name": "table", "shape": box(4, 4, 0.1), "motion": {
        "type": "constant_velocity", "from": {"position": [0, 0, -0.05]}, "rotation_vector": [0, 0, 6]}}
    rolling = body("ball", ball(0.05), (0, 0, 0.05 + NEAR), dynamics={
        "linear_velocity": [speed, 0, 0], "angular_velocity": [0, speed / 0.05, 0]})
    run = simulate(tool, scene([table, rolling], 3.0, step, friction=1.0, contact_distance=NEAR))
    x, y, _ = run.body(1)["position"]
    angle = 3.0 * rate
    right = (speed / rate * math.sin(angle), speed / rate * (1 - math.cos(angle)))
    return max(0.0, math.hypot(x - right[0], y - right[1]) - 1e-6)


def block_by_speeds(tool, step):
    """How far a block slips in 1 s on a turntable whose motor speeds it up to 2 rad/s, 0.3 m from the axis."""
    return block_on_a_motor(tool, step, {"velocity": [[0, 0], [1, 2]]})


def block_by_positions(tool, step):
    """The same where rows say each 2.5 ms where the table is: its speed jumps there."""
    return block_on_a_motor(tool, step, {"position": [[0.0025 * k, (0.0025 * k) ** 2] for k in range(401)]})


def block_on_a_motor(tool, step, motor):
    """How far a block slips in 1 s on a turntable that a motor drives, 0.3 m from the axis."""
    inertial = '<inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    urdf = (f'<robot name="r"><link name="base">{inertial}</link><link name="table">{inertial}<collision><geometry>'
            '<box size="2 2 0.1"/></geometry></collision></link><joint name="j" type="continuous">'
            '<parent link="base"/><child link="table"/><axis xyz="0 0 1"/></joint></robot>')
    robot = {"name": "r", "urdf": "r.urdf", "dynamics": {"base": "fixed", "motors": {"j": motor}}}
    block = body("block", box(0.2, 0.2, 0.1), (0.3, 0, 0.1001), dynamics={})
    run = simulate(tool, scene([block], 1.0, step, friction=1.0, robots=[robot]), [("r.urdf", urdf)])
    x, y, _ = run.body(0)["position"]
    angle = run.steps[-1]["robots"][0]["positions"][0]
    return math.hypot(x - 0.3 * math.cos(angle), y - 0.3 * math.sin(angle))


def ball_off_a_ball(tool, step):
    """The greatest change of energy per mass while a ball slides off another one, to 0.7 rad."""
    apart = 1.0  # [m]  Of the centres.
    speed = math.sqrt(2 * G * apart * (1 - math.cos(0.2)))
    run = simulate(tool, scene([
        body("below", ball(0.7999)),
        body("ball", ball(0.2), (apart * math.sin(0.2), 0, apart * math.cos(0.2)), dynamics={
            "mass": 1, "linear_velocity": [speed * math.cos(0.2), 0, -speed * math.sin(0.2)]})], 0.3, step))
    worst = 0.0
    for time in (s["time"] for s in run.steps):
        x, _, z = run.body(1, time)["position"]
        if math.atan2(x, z) > 0.7:
            break
        v = run.body(1, time)["linear_velocity"]
        worst = max(worst, abs(0.5 * sum(c * c for c in v) + G * (z - apart)))
    return worst


def rolling_ball(tool, step):
    """How far a ball is from 5/14 g sin(a) t^2 after 1 s on a slope of 0.3 rad, beyond three contact distances."""
    slope = 0.3
    half = 0.5 * slope
    run = simulate(tool, scene([
        body("slope", box(20, 2, 0.1), (0.05 * -math.sin(slope), 0, -0.05 * math.cos(slope)),
             quaternion_wxyz=[math.cos(half), 0, math.sin(half), 0]),
        body("ball", ball(0.1), ((0.1 + NEAR) * math.sin(slope), 0, (0.1 + NEAR) * math.cos(slope)), dynamics={})],
        1.0, step, friction=0.5, contact_distance=NEAR))
    x, _, z = run.body(1)["position"]
    along = x * math.cos(slope) - z * math.sin(slope)
    return max(0.0, abs(along - 5 / 14 * G * math.sin(slope)) - 3.1 * NEAR)


def rolling_cylinder(tool, step):
    """How much a cylinder of 1 m/s gets slower or faster from 0.5 to 3 s on the level."""
    run = simulate(tool, scene([
        body("floor", box(20, 2, 0.1), (0, 0, -0.05)),
        body("wheel", {"cylinder": {"radius": 0.1, "length": 0.2}}, (-3, 0, 0.1001),
             quaternion_wxyz=[math.sqrt(0.5), math.sqrt(0.5), 0, 0],
             dynamics={"linear_velocity": [1, 0, 0], "angular_velocity": [0, 10, 0]})],
        3.0, step, friction=0.8))
    return abs(run.body(1)["linear_velocity"][0] - run.body(1, 0.5)["linear_velocity"][0])


def sliding_stop(tool, step):
    """How far a block of 1 m/s stops from v^2 / (2 mu g), at mu = 0.5."""
    run = simulate(tool, scene([
        body("floor", box(20, 2, 0.1), (0, 0, -0.05)),
        body("block", box(0.2, 0.2, 0.05), (0, 0, 0.0251), dynamics={"linear_velocity": [1, 0, 0]})],
        0.5, step, friction=0.5))
    return abs(run.body(1)["position"][0] - 1 / G)


def bounces(tool, step):
    """The height of the third bounce of a ball of restitution 0.9 that falls 0.5 m."""
    run = simulate(tool, scene([
        body("floor", box(2, 2, 0.1), (0, 0, -0.05)),
        body("ball", ball(0.1), (0, 0, 0.6), dynamics={"restitution": 0.9})],
        2.2, step, contact_distance=1e-5))
    fall = math.sqrt(2 * 0.5 / G)
    top = fall + 2 * fall * (0.9 + 0.81 + 0.729 / 2)
    near = [run.body(1, s["time"]) for s in run.steps if abs(s["time"] - top) < 0.15]
    # Between steps it is on top where its velocity leads to.
    height = max(b["position"][2] + b["linear_velocity"][2] ** 2 / (2 * G) for b in near)
    return abs(height - (0.1 + 0.5 * 0.9 ** 6))


def collision(tool, step):
    """The change of the angular momentum while two spinning boxes collide off their centres."""
    run = simulate(tool, scene([
        body("a", box(0.4, 0.2, 0.1), (-0.5, 0.05, 0), dynamics={
            "mass": 1, "restitution": 0.5, "linear_velocity": [1, 0, 0], "angular_velocity": [1, 2, 3]}),
        body("b", box(0.3, 0.3, 0.2), (0.2, -0.05, 0.02), dynamics={
            "mass": 2, "restitution": 0.5, "linear_velocity": [-1, 0.1, 0], "angular_velocity": [0, -1, 2]})],
        1.0, step, friction=0.3, gravity=0.0))
    first, last = run.steps[0]["angular_momentum"], run.steps[-1]["angular_momentum"]
    return math.dist(first, last)


FLOOR = body("floor", box(20, 2, 0.1), (0, 0, -0.05))
SLOPE = 0.3  # [rad]


def sliding_down(tool, step):
    """How far a block on a slope of 0.3 rad is from g (sin a - mu cos a) t^2 / 2 after 1 s, at mu = 0.2."""
    down = leaning(SLOPE)
    height = 0.0251
    run = simulate(tool, scene([
        body("slope", box(20, 2, 0.1), (-0.05 * math.sin(SLOPE), 0, -0.05 * math.cos(SLOPE)), quaternion_wxyz=down),
        body("block", box(0.2, 0.2, 0.05), (height * math.sin(SLOPE), 0, height * math.cos(SLOPE)),
             quaternion_wxyz=down, dynamics={})], 1.0, step, friction=0.2))
    x, _, z = run.body(1)["position"]
    along = x * math.cos(SLOPE) - z * math.sin(SLOPE)
    return abs(along - 0.5 * G * (math.sin(SLOPE) - 0.2 * math.cos(SLOPE)))


def back_spin(tool, step):
    """The place after 1 s of a ball with back spin that slides until it rolls, at mu = 0.2."""
    speed, spin, radius = 1.0, -20.0, 0.1
    run = simulate(tool, scene([FLOOR, body("ball", ball(radius), (0, 0, radius + NEAR), dynamics={
        "linear_velocity": [speed, 0, 0], "angular_velocity": [0, spin, 0]})],
        1.0, step, friction=0.2, contact_distance=NEAR))
    rolling = (5 * speed + 2 * radius * spin) / 7
    slides = (speed - rolling) / (0.2 * G)
    right = speed * slides - 0.1 * G * slides ** 2 + rolling * (1 - slides)
    return abs(run.body(1)["position"][0] - right)


def rod_on_its_end(tool, step):
    """How much a rod of 1 m leans, which slides on its end without friction, 0.4 s from 0.3 rad."""
    moment, half, lean, distance = 1 / 12, 0.5, 0.3, 1e-3
    run = simulate(tool, scene([FLOOR, body(
        "rod", {"capsule": {"radius": 0.01, "length": 1.0}},
        (half * math.sin(lean), 0, 0.01 + rest_gap(tool, distance) + half * math.cos(lean)),
        quaternion_wxyz=leaning(lean), dynamics={
            "mass": 1, "centre_of_mass": [0, 0, 0], "inertia": [[moment, 0, 0], [0, moment, 0], [0, 0, 1e-4]]})],
        0.4, step, contact_distance=distance))

    def rates(state):
        q, w = state
        s, c = math.sin(q), math.cos(q)
        return [w, half * s * (G - half * c * w * w) / (moment + half * half * s * s)]
    x, _, z = turned(run.body(1)["quaternion_wxyz"], [0, 0, 1])
    return abs(math.atan2(x, z) - runge_kutta(rates, [lean, 0.0], 0.4)[0])


TRAY = """<robot name="lift"><link name="base"/><link name="tray">
  <inertial><mass value="2"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0 0 -0.05"/><geometry><box size="2 2 0.1"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="tray"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="0" velocity="9"/></joint></robot>"""


TOP = """<robot name="top"><link name="top">
  <inertial><origin xyz="0 0 0.1"/><mass value="0.3"/>
  <inertia ixx="5e-4" iyy="5e-4" izz="6e-4" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><sphere radius="0.02"/></geometry></collision></link></robot>"""


def top_on_its_tip(tool, step, robot=None):
    """How far the axis of a top gets from the right one within 1 s, which spins at 60 rad/s without friction. On a
    floor, on a "tray" that the motor of a robot holds, or as the "link" of a robot that nothing holds."""
    mass, arm, across, along, spin, lean = 0.3, 0.1, 5e-4, 6e-4, 60.0, 0.3
    spins = [spin * math.sin(lean), 0, spin * math.cos(lean)]
    top = body("top", ball(0.02), (0, 0, 0.02001), quaternion_wxyz=leaning(lean), dynamics={
        "mass": mass, "centre_of_mass": [0, 0, arm], "inertia": [[across, 0, 0], [0, across, 0], [0, 0, along]],
        "angular_velocity": spins})
    tray = {"name": "lift", "urdf": "lift.urdf", "dynamics": {"base": "fixed", "motors": {"lift": {"position": 0}}}}
    link = {"name": "top", "urdf": "top.urdf", "base": top["pose"], "dynamics": {
        "base": "free", "angular_velocity": spins}}
    bodies, robots = {None: ([FLOOR, top], []), "tray": ([top], [tray]), "link": ([FLOOR], [link])}[robot]
    run = simulate(tool, scene(bodies, 1.0, step, contact_distance=1e-5, **({"robots": robots} if robots else {})),
                   [("lift.urdf", TRAY), ("top.urdf", TOP)])
    about_axis = along * spin
    about_z = about_axis * math.cos(lean)

    def rates(state):
        q, w, _ = state
        s, c = math.sin(q), math.cos(q)
        round_z = (about_z - about_axis * c) / (across * s * s)
        push = (across * round_z ** 2 * c - about_axis * round_z + mass * G * arm - mass * arm ** 2 * w * w * c) * s
        return [w, push / (across + mass * arm ** 2 * s * s), round_z]
    worst, state = 0.0, [lean, 0.0, 0.0]
    for tenth in range(1, 11):
        state = runge_kutta(rates, state, 0.1, 2000)
        right = [math.sin(state[0]) * math.cos(state[2]), math.sin(state[0]) * math.sin(state[2]), math.cos(state[0])]
        found = turned(run.body(0 if robot == "tray" else 1, 0.1 * tenth)["quaternion_wxyz"], [0, 0, 1])
        worst = max(worst, math.dist(found, right))
    return worst


def disc_on_its_rim(tool, step):
    """The part of the energy that a disc loses in 0.3 s, which goes round on its rim without friction."""
    radius, half, lean = 0.05, 0.0025, 0.25
    across, along = radius ** 2 / 4 + half ** 2 / 3, radius ** 2 / 2
    # The lowest point of the rim is at this level arm; with the centre at rest, weight turns the disc.
    arm = radius * math.cos(lean) - half * math.sin(lean)
    rate = math.sqrt(G * arm / (across * math.sin(lean) * math.cos(lean)))
    run = simulate(tool, scene([FLOOR, body(
        "disc", {"cylinder": {"radius": radius, "length": 2 * half}},
        (0, 0, radius * math.sin(lean) + half * math.cos(lean) + 1e-5), quaternion_wxyz=leaning(lean), dynamics={
            "mass": 1, "centre_of_mass": [0, 0, 0], "inertia": [[across, 0, 0], [0, across, 0], [0, 0, along]],
            "angular_velocity": turned(leaning(lean), [-rate * math.sin(lean), 0, 0])})],
        0.3, step, contact_distance=1e-5))
    energies = [energy(step["bodies"][0], 1.0, [across, across, along]) for step in run.steps]
    return max(abs(e - energies[0]) for e in energies) / energies[0]


def ring_on_a_pin(tool, step):
    """The part of its swing that a ring of 180 corners loses in 1 s, which hangs on a pin without friction."""
    upright = [math.sqrt(0.5), math.sqrt(0.5), 0, 0]
    near = 1e-6  # [m]
    away, lean = 0.48 * math.cos(math.pi / 180) - 0.02 - near, math.pi / 3
    sizes = (180, 0.48, 0.52, 0.05)
    ring = body("ring", tube(*sizes), (away * math.sin(lean), 0, -away * math.cos(lean)), quaternion_wxyz=upright,
                dynamics=tube_dynamics(*sizes) | {
                    "locked_translation": [False, True, False], "locked_rotation": [True, False, True]},
                **({} if tool.is_ours else {"hulls": tube_hulls(*sizes)}))
    run = simulate(tool, scene([
        body("pin", {"capsule": {"radius": 0.02, "length": 0.5}}, quaternion_wxyz=upright), ring],
        1.0, step, contact_distance=near))
    energies = run.energies()
    return max(abs(e - energies[0]) for e in energies) / max(step["kinetic_energy"] for step in run.steps)


def rocking_ellipsoid(tool, step):
    """How much an ellipsoid leans too far after 1 s, which rocks on the level from 0.1 rad without slipping."""
    radii, lean = [0.1, 0.08, 0.05], 0.1
    long, _, high = radii
    moments = [(radii[1] ** 2 + radii[2] ** 2) / 5, (radii[0] ** 2 + radii[2] ** 2) / 5,
               (radii[0] ** 2 + radii[1] ** 2) / 5]

    def height(q):
        return math.hypot(long * math.sin(q), high * math.cos(q))

    def rates(state):
        q, w = state
        h, squares = height(q), long ** 2 - high ** 2
        slope = squares * math.sin(q) * math.cos(q) / h
        bend = (squares * math.cos(2 * q) - slope ** 2) / h
        return [w, -slope * (w * w * (h + bend) + G) / (moments[1] + h * h + slope * slope)]
    run = simulate(tool, scene([FLOOR, body(
        "egg", {"ellipsoid": {"radii": radii}}, (0, 0, height(lean) + 1e-6),
        quaternion_wxyz=leaning(lean), dynamics={
            "mass": 1, "centre_of_mass": [0, 0, 0],
            "inertia": [[moments[0], 0, 0], [0, moments[1], 0], [0, 0, moments[2]]]})],
        1.0, step, friction=2.0, contact_distance=1e-6))
    x, _, z = turned(run.body(1)["quaternion_wxyz"], [0, 0, 1])
    return abs(math.atan2(x, z) - runge_kutta(rates, [lean, 0.0], 1.0)[0])


def cradle(tool, step):
    """The greatest error of the velocities after a ball has hit a row of four, 0.1 mm apart."""
    run = simulate(tool, scene([
        body(f"ball {k}", ball(0.05), (0.1001 * k - (0.2 if k == 0 else 0), 0, 0), dynamics={
            "restitution": 1, "linear_velocity": [1 if k == 0 else 0, 0, 0]}) for k in range(5)],
        0.5, step, gravity=0.0, contact_distance=1e-6))
    return max(abs(run.body(k)["linear_velocity"][0] - (1 if k == 4 else 0)) for k in range(5))


def standing(tool, step, masses):
    """How far any of cubes that stand on each other gets in 1 s, once they rest."""
    size, gap = 0.1, 1e-5
    cubes = [body(f"cube {k}", box(size, size, size), (0, 0, 0.5 * size + gap + k * (size + gap)),
                  dynamics={"mass": mass}) for k, mass in enumerate(masses)]
    run = simulate(tool, scene([FLOOR, *cubes], 1.5, step, friction=0.5, contact_distance=gap))
    return max(math.dist(run.body(k, 0.5)["position"], run.body(k)["position"])
               for k in range(1, len(masses) + 1))
