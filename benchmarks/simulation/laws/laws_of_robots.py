"""Robots under motors with targets, and loops of links: each function takes a tool and a step, and returns an error."""

import functools
import math

from law_scenes import G, box, body, runge_kutta, scene, simulate

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
    gap = 1e-6
    urdf = (f'<robot name="lift"><link name="base"/><link name="tray"><inertial><mass value="{TRAY_MASS}"/>'
            '<inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
            '<collision><origin xyz="0 0 -0.05"/><geometry><box size="1 1 0.1"/></geometry></collision></link>'
            '<joint name="lift" type="prismatic"><parent link="base"/><child link="tray"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="1" effort="0" velocity="9"/></joint></robot>')
    start = -0.01  # [m]
    robot = {"name": "lift", "urdf": "lift.urdf", "state": {"lift": start}, "dynamics": {
        "base": "fixed", "motors": {"lift": {"position": 0, "stiffness": STIFFNESS, "damping": RESISTANCE,
                                             "effort": 1000}}}}
    load = body("load", box(0.2, 0.2, 0.1), (0, 0, start + 0.05 + gap), dynamics={"mass": LOAD})
    run = simulate(tool, scene([load], 1.0, step, friction=0.5, robots=[robot], contact_distance=gap),
                   [("lift.urdf", urdf)])
    mass = TRAY_MASS + LOAD
    rest, decay = -mass * G / STIFFNESS, 0.5 * RESISTANCE / mass
    rate = math.sqrt(STIFFNESS / mass - decay ** 2)

    def right(t):
        return rest + (start - rest) * math.exp(-decay * t) * (math.cos(rate * t) + decay / rate * math.sin(rate * t))
    return max(abs(run.at(0.01 * k)["robots"][0]["positions"][0] - right(0.01 * k)) for k in range(1, 101))
