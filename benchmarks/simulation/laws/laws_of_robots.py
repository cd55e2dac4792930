"""Robots under motors with targets, and loops of links: each function takes a tool and a step, and returns an error."""

import functools
import math

from laws_of_free_motion import pendulum_urdf, two_links, two_links_mass
from law_scenes import G, body, box, leaning, rest_gap, runge_kutta, scene, simulate

ARM_START = [0.9, -1.4]  # [rad]  Of two links whose end touches a floor.


def rise_of_end(q1, q2):
    """How fast the end of two links rises with each angle."""
    return [0.5 * (math.sin(q1) + math.sin(q1 + q2)), 0.5 * math.sin(q1 + q2)]


def arm_on_the_floor(tool, step, damping=0.0, press=None, stiffness=20.0, resistance=0.5, speed=1.0, duration=0.4,
                     distance=1e-4):
    """The greatest error of the angles of two links whose end slides along a floor without friction. Motors with
    targets "press" the end on the floor: springs [N m/rad] and dampers [N m s/rad]."""
    radius = 0.02
    up = rise_of_end(*ARM_START)
    start = [*ARM_START, speed, -speed * up[0] / up[1]]
    tip = 0.5 * (math.cos(start[0]) + math.cos(start[0] + start[1]))  # [m]  Below the first hinge.
    dynamics = {"base": "fixed", "velocities": {"j1": start[2], "j2": start[3]}}
    if press:
        dynamics["motors"] = {joint: {"position": target, "stiffness": stiffness, "damping": resistance, "effort": 100}
                              for joint, target in zip(("j1", "j2"), press)}
    robot = {"name": "arm", "urdf": "arm.urdf", "state": {"j1": start[0], "j2": start[1]}, "dynamics": dynamics}
    floor = body("floor", box(9, 9, 0.1), (0, 0, -tip - radius - rest_gap(tool, distance) - 0.05))
    end = f'<collision><origin xyz="0 0 -0.5"/><geometry><sphere radius="{radius}"/></geometry></collision>'
    run = simulate(tool, scene([floor], duration, step, robots=[robot], contact_distance=distance),
                   [("arm.urdf", pendulum_urdf(damping, end))])
    hanging, mass = two_links(damping), two_links_mass

    def rates(state):
        """Those of the links without the floor, and what the force of the floor on the end adds."""
        q1, q2, v1, v2 = state
        up = rise_of_end(q1, q2)
        m11, m12, m22 = mass(q2)

        def turned_by(torques):
            return [(m22 * torques[0] - m12 * torques[1]) / (m11 * m22 - m12 * m12),
                    (m11 * torques[1] - m12 * torques[0]) / (m11 * m22 - m12 * m12)]
        free = hanging(state)[2:]
        if press:
            motors = turned_by([stiffness * (target - q) - resistance * v
                                for target, q, v in zip(press, (q1, q2), (v1, v2))])
            free = [a + b for a, b in zip(free, motors)]
        push = turned_by(up)
        rises = (up[0] * free[0] + up[1] * free[1]
                 + 0.5 * (math.cos(q1) * v1 * v1 + math.cos(q1 + q2) * (v1 + v2) ** 2))
        force = -rises / (up[0] * push[0] + up[1] * push[1])
        return [v1, v2, free[0] + force * push[0], free[1] + force * push[1]]
    worst, state = 0.0, start
    for k in range(1, 9):
        state = runge_kutta(rates, state, duration / 8, 2500)
        found = run.at(k * duration / 8)["robots"][0]["positions"]
        worst = max(worst, abs(found[0] - state[0]), abs(found[1] - state[1]))
    return worst


def speed_of_creep(press, stiffness, resistance):
    """[rad/s]  The rate of the first angle where springs and gravity turn strong dampers, and no mass matters."""
    up = rise_of_end(*ARM_START)
    along = [1.0, -up[0] / up[1]]
    falls = two_links(0.0)([*ARM_START, 0.0, 0.0])[2:]
    m11, m12, m22 = two_links_mass(ARM_START[1])
    weights = [m11 * falls[0] + m12 * falls[1], m12 * falls[0] + m22 * falls[1]]
    torques = [weight + stiffness * (target - q) for weight, target, q in zip(weights, press, ARM_START)]
    return sum(a * t for a, t in zip(along, torques)) / (resistance * sum(a * a for a in along))


def slow_arm(tool, step, resistance, distance, creeps=False):
    """The same within 1 s, where springs of 200 N m/rad press with 20 N m and dampers are weak or strong. It starts
    from rest, or at the speed at which it creeps."""
    up = rise_of_end(*ARM_START)
    length = math.hypot(*up)
    down, along = [-x / length for x in up], [up[1] / length, -up[0] / length]
    press = [q + 0.1 * d + 0.01 * a for q, d, a in zip(ARM_START, down, along)]
    speed = speed_of_creep(press, 200.0, resistance) if creeps else 0.0
    return arm_on_the_floor(tool, step, press=press, stiffness=200.0, resistance=resistance, speed=speed, duration=1.0,
                            distance=distance)


# A loop of four links between two hinges: lengths of crank, coupler and rocker, and of the base [m].
CRANK, COUPLER, ROCKER, BASE = 0.2, 0.5, 0.4, 0.6
MASSES = (1.0, 1.5, 1.2)  # [kg]  The links are thin rods.
MOMENTS = tuple(m * l * l / 12 for m, l in zip(MASSES, (CRANK, COUPLER, ROCKER)))


def rod_link(name, length, mass, moment):
    """A link along -z; a small ball in its middle touches nothing."""
    return (f'<link name="{name}"><inertial><origin xyz="0 0 {-0.5 * length}"/><mass value="{mass}"/><inertia '
            f'ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="1e-4"/></inertial><collision>'
            f'<origin xyz="0 0 {-0.5 * length}"/><geometry><sphere radius="0.005"/></geometry></collision></link>')


def hinge(name, parent, child, x, z):
    return (f'<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{x} 0 {z}"/><axis xyz="0 1 0"/></joint>')


def loop_urdf():
    return ('<robot name="loop"><link name="base"/>' + rod_link("crank", CRANK, MASSES[0], MOMENTS[0])
            + rod_link("coupler", COUPLER, MASSES[1], MOMENTS[1]) + rod_link("rocker", ROCKER, MASSES[2], MOMENTS[2])
            + hinge("j1", "base", "crank", 0, 0) + hinge("j2", "crank", "coupler", 0, -CRANK)
            + hinge("j3", "base", "rocker", BASE, 0) + "</robot>")


def closed(crank):
    """The angles of coupler and rocker from -z, for that of the crank: the rocker is on the right."""
    x, z = -CRANK * math.sin(crank), -CRANK * math.cos(crank)
    across, up = BASE - x, -z  # From the crank's end to the rocker's hinge.
    apart = math.hypot(across, up)
    # The coupler's end is below the line between both.
    bend = math.acos((COUPLER ** 2 + apart ** 2 - ROCKER ** 2) / (2 * COUPLER * apart))
    along = math.atan2(up, across) - bend
    end = x + COUPLER * math.cos(along), z + COUPLER * math.sin(along)
    return math.atan2(-(end[0] - x), -(end[1] - z)), math.atan2(-(end[0] - BASE), -end[1])


def solve(rows, right):
    """A linear system, by elimination with the largest pivots."""
    rows = [[*row, b] for row, b in zip(rows, right)]
    size = len(rows)
    for k in range(size):
        best = max(range(k, size), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        for i in range(k + 1, size):
            part = rows[i][k] / rows[k][k]
            rows[i] = [x - part * y for x, y in zip(rows[i], rows[k])]
    found = [0.0] * size
    for k in reversed(range(size)):
        found[k] = (rows[k][size] - sum(rows[k][j] * found[j] for j in range(k + 1, size))) / rows[k][k]
    return found


def loop_rates(state):
    """Lagrange's equations in the angles of the three links from -z, with the two forces that close the loop."""
    a, b, c, *rates = state
    (m1, m2, m3), (i1, i2, i3) = MASSES, MOMENTS
    coupling = 0.5 * m2 * CRANK * COUPLER
    sine, cosine = coupling * math.sin(a - b), coupling * math.cos(a - b)
    forces = [-G * CRANK * (0.5 * m1 + m2) * math.sin(a) - sine * rates[1] ** 2,
              -0.5 * G * COUPLER * m2 * math.sin(b) + sine * rates[0] ** 2,
              -0.5 * G * ROCKER * m3 * math.sin(c)]
    # The coupler's end and the rocker's: x and z of one less that of the other.
    lengths = (CRANK, COUPLER, -ROCKER)
    along = [-l * math.cos(q) for l, q in zip(lengths, (a, b, c))]
    across = [l * math.sin(q) for l, q in zip(lengths, (a, b, c))]
    bends = [-sum(l * math.sin(q) * w * w for l, q, w in zip(lengths, (a, b, c), rates)),
             -sum(l * math.cos(q) * w * w for l, q, w in zip(lengths, (a, b, c), rates))]
    mass = [[i1 + CRANK ** 2 * (0.25 * m1 + m2), cosine, 0], [cosine, i2 + 0.25 * m2 * COUPLER ** 2, 0],
            [0, 0, i3 + 0.25 * m3 * ROCKER ** 2]]
    rows = [[*mass[k], -along[k], -across[k]] for k in range(3)] + [[*along, 0, 0], [*across, 0, 0]]
    return [*rates, *solve(rows, forces + bends)[:3]]


LOOP_START = 2.0  # [rad]  Of the crank.


@functools.lru_cache
def right_loop():
    """The angles of crank, coupler and rocker after 3 s."""
    return runge_kutta(loop_rates, [LOOP_START, *closed(LOOP_START), 0.0, 0.0, 0.0], 3.0)[:3]


@functools.lru_cache
def run_of_loop(tool, step):
    coupler, rocker = closed(LOOP_START)
    robot = {"name": "loop", "urdf": "loop.urdf", "dynamics": {"base": "fixed"},
             "state": {"j1": LOOP_START, "j2": coupler - LOOP_START, "j3": rocker}}
    pin = {"type": "pin", "bodies": ["loop/coupler", "loop/rocker"],
           "points": [[0, 0, -COUPLER], [0, 0, -ROCKER]]}
    return simulate(tool, scene([], 3.0, step, robots=[robot], simulation={"ties": [pin]}),
                    [("loop.urdf", loop_urdf())])


def angles_of_loop(tool, step):
    """The greatest error of the angles of a loop of four links after 3 s, which falls from rest."""
    a, b, c = run_of_loop(tool, step).steps[-1]["robots"][0]["positions"]
    return max(abs(x - y) for x, y in zip((a, a + b, c), right_loop()))


def energy_of_loop(tool, step):
    """The greatest change of its energy."""
    energies = run_of_loop(tool, step).energies()
    return max(abs(e - energies[0]) for e in energies)


TRAY_MASS, LOAD, STIFFNESS, RESISTANCE = 2.0, 1.0, 2000.0, 40.0


def load_on_a_tray(tool, step):
    """The greatest error within 1 s of the place of a tray that carries a load: its motor is a spring with a damper."""
    distance = 1e-4
    urdf = (f'<robot name="lift"><link name="base"/><link name="tray"><inertial><mass value="{TRAY_MASS}"/>'
            '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
            '<collision><origin xyz="0 0 -0.05"/><geometry><box size="1 1 0.1"/></geometry></collision></link>'
            '<joint name="lift" type="prismatic"><parent link="base"/><child link="tray"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="1" effort="0" velocity="9"/></joint></robot>')
    start = -0.01  # [m]
    robot = {"name": "lift", "urdf": "lift.urdf", "state": {"lift": start}, "dynamics": {
        "base": "fixed", "motors": {"lift": {"position": 0, "stiffness": STIFFNESS, "damping": RESISTANCE,
                                             "effort": 1000}}}}
    load = body("load", box(0.2, 0.2, 0.1), (0, 0, start + 0.05 + rest_gap(tool, distance)), dynamics={"mass": LOAD})
    run = simulate(tool, scene([load], 1.0, step, friction=0.5, robots=[robot], contact_distance=distance),
                   [("lift.urdf", urdf)])
    mass = TRAY_MASS + LOAD
    rest, decay = -mass * G / STIFFNESS, 0.5 * RESISTANCE / mass
    rate = math.sqrt(STIFFNESS / mass - decay ** 2)

    def right(t):
        return rest + (start - rest) * math.exp(-decay * t) * (math.cos(rate * t) + decay / rate * math.sin(rate * t))
    return max(abs(run.at(0.01 * k)["robots"][0]["positions"][0] - right(0.01 * k)) for k in range(1, 101))


def two_rods(masses, middles, moments, length, torques):
    """Rates of two links on hinges, from -z: with the distances of their centres from their hinges, and motors."""
    (m1, m2), (c1, c2), (i1, i2) = masses, middles, moments

    def rates(state):
        q1, q2, v1, v2 = state
        coupling = m2 * length * c2 * math.cos(q2)
        h = m2 * length * c2 * math.sin(q2)
        m22 = i2 + m2 * c2 * c2
        m12 = m22 + coupling
        m11 = i1 + m1 * c1 * c1 + m2 * length * length + m22 + 2 * coupling
        f1, f2 = torques(state)
        f1 += (-(m1 * c1 + m2 * length) * G * math.sin(q1) - m2 * G * c2 * math.sin(q1 + q2)
               + h * (2 * v1 * v2 + v2 * v2))
        f2 += -m2 * G * c2 * math.sin(q1 + q2) - h * v1 * v1
        determinant = m11 * m22 - m12 * m12
        return [v1, v2, (m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant]
    return rates


def load_on_an_arm(tool, step, stiffness=200.0, damping=4.0, load=1.0, duration=1.0):
    """The greatest error within 1 s of the angles of two links that carry a load on a plate: their motors are springs
    with dampers. The load lies still on the plate, so it turns with the second link."""
    distance, size = 1e-4, 0.1
    masses, middle, moment, length = (1.0, 0.7), 0.25, 0.02, 0.5
    start = (0.5 * math.pi, 0.0)
    # The plate is in the plane of y and z of its link; the load lies on its side of -x, above in the world.
    plate = '<collision><origin xyz="0 0 -0.25"/><geometry><box size="0.04 0.3 0.3"/></geometry></collision>'
    urdf = '<robot name="arm"><link name="base"/>'
    for name, mass, more in zip("ab", masses, ("", plate)):
        urdf += (f'<link name="{name}">{more}<inertial><origin xyz="0 0 {-middle}"/><mass value="{mass}"/><inertia '
                 f'ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/></inertial></link>')
    urdf += hinge("j1", "base", "a", 0, 0) + hinge("j2", "a", "b", 0, -length) + "</robot>"
    targets = (start[0] + 0.1, start[1] + 0.03)  # The weight of all turns the joints by 0.075 and 0.021 rad.
    spring = {"stiffness": stiffness, "damping": damping, "effort": 1000}
    robot = {"name": "arm", "urdf": "arm.urdf", "state": {"j1": start[0], "j2": start[1]}, "dynamics": {
        "base": "fixed", "motors": {f"j{k + 1}": spring | {"position": target} for k, target in enumerate(targets)}}}
    above = 0.02 + 0.5 * size + rest_gap(tool, distance)  # [m]  From the link to the load's centre.
    cube = body("load", box(size, size, size), (-length - middle, 0, above), quaternion_wxyz=leaning(0.5 * math.pi),
                dynamics={"mass": load})
    run = simulate(tool, scene([cube], duration, step, friction=1.0, robots=[robot], contact_distance=distance),
                   [("arm.urdf", urdf)])
    # The second link and the load are one body, whose centre is off the link by the angle off.
    total = masses[1] + load
    aside = load * above / total
    off = math.atan2(aside, middle)
    both = moment + load * size ** 2 / 6 + masses[1] * aside ** 2 + load * (above - aside) ** 2

    def torques(state):
        return [stiffness * (targets[0] - state[0]) - damping * state[2],
                stiffness * (targets[1] + off - state[1]) - damping * state[3]]
    rates = two_rods((masses[0], total), (middle, math.hypot(middle, aside)), (moment, both), length, torques)
    worst, state = 0.0, [start[0], start[1] + off, 0.0, 0.0]
    for k in range(1, round(100 * duration) + 1):
        state = runge_kutta(rates, state, 0.01, 200)
        found = run.at(0.01 * k)["robots"][0]["positions"]
        worst = max(worst, abs(found[0] - state[0]), abs(found[1] + off - state[1]))
    return worst
