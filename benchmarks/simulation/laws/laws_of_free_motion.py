"""What moves without contacts: each function takes a tool and a step, and returns an error."""

import math

from law_scenes import G, ball, body, box, runge_kutta, scene, simulate


# Of a double pendulum: masses [kg], from hinges to middles and from hinge to hinge [m], moments about middles.
m1, c1, l1, i1, m2, c2, i2 = 1.0, 0.25, 0.5, 0.0208333, 0.7, 0.2, 0.00933333


def two_links_mass(q2):
    """The mass matrix of a double pendulum: m11, m12, m22."""
    coupling = m2 * l1 * c2 * math.cos(q2)
    m22 = i2 + m2 * c2 * c2
    return i1 + m1 * c1 * c1 + m2 * l1 * l1 + m22 + 2 * coupling, m22 + coupling, m22


def two_links(damping):
    """Rates of a double pendulum whose second joint has damping."""

    def rates(state):
        q1, q2, v1, v2 = state
        m11, m12, m22 = two_links_mass(q2)
        h = m2 * l1 * c2 * math.sin(q2)
        f2 = -m2 * G * c2 * math.sin(q1 + q2) - h * v1 * v1 - damping * v2
        f1 = (-(m1 * c1 + m2 * l1) * G * math.sin(q1) - m2 * G * c2 * math.sin(q1 + q2)
              + h * (2 * v1 * v2 + v2 * v2))
        determinant = m11 * m22 - m12 * m12
        return [v1, v2, (m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant]
    return rates


def pendulum_urdf(damping, end=""):
    """@param end  what the second link has beside its mass"""
    def link(name, mass, middle, moment, more=""):
        return (f'<link name="{name}">{more}<inertial><origin xyz="0 0 {-middle}"/><mass value="{mass}"/><inertia '
                f'ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="0.0001"/></inertial></link>')

    def joint(name, parent, child, z, friction=""):
        return (f'<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/>'
                f'<origin xyz="0 0 {z}"/><axis xyz="0 1 0"/>{friction}</joint>')
    return ('<robot name="p">' + link("base", 1, 0, 1) + link("a", 1, 0.25, 0.0208333)
            + link("b", 0.7, 0.2, 0.00933333, end) + joint("j1", "base", "a", 0)
            + joint("j2", "a", "b", -0.5, f'<dynamics damping="{damping}"/>') + "</robot>")


SLIDER = """<robot name="s"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0"
iyy="1" iyz="0" izz="1"/></inertial></link><link name="a"><inertial><mass value="1"/><inertia ixx="0.01"
ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link><joint name="j" type="prismatic"><parent
link="base"/><child link="a"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="0" velocity="0"/></joint>
</robot>"""


def tumbling(tool, step):
    """The direction of the long axis after 3 s, and of the body beside the unstable axis."""
    moments = [1.0, 2.0, 3.0]
    start = [0.01, 3.0, 0.0]
    run = simulate(tool, scene([body("block", box(0.3, 0.2, 0.1), dynamics={
        "mass": 1, "centre_of_mass": [0, 0, 0], "angular_velocity": start,
        "inertia": [[1, 0, 0], [0, 2, 0], [0, 0, 3]]})], 3.0, step, gravity=0.0))

    def rates(state):
        q, w = state[:4], state[4:]
        turn = [0.5 * x for x in (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2],
                                  q[0] * w[0] + q[2] * w[2] - q[3] * w[1],
                                  q[0] * w[1] + q[3] * w[0] - q[1] * w[2],
                                  q[0] * w[2] + q[1] * w[1] - q[2] * w[0])]
        return turn + [(moments[1] - moments[2]) * w[1] * w[2] / moments[0],
                       (moments[2] - moments[0]) * w[2] * w[0] / moments[1],
                       (moments[0] - moments[1]) * w[0] * w[1] / moments[2]]
    right = runge_kutta(rates, [1.0, 0.0, 0.0, 0.0] + start, 3.0)[:4]
    found = run.body(0)["quaternion_wxyz"]
    # The arc between two quaternions, by their chord: the cosine has no digits left for small angles.
    return 4 * math.asin(0.5 * min(math.dist(right, found), math.dist(right, [-x for x in found])))


def free_pendulum(tool, step, damping=0.0, motors=None):
    """The greatest error of both angles after 3 s."""
    dynamics = {"base": "fixed"} | ({"motors": motors} if motors else {})
    robot = {"name": "p", "urdf": "p.urdf", "state": {"j1": 1.2, "j2": 0.8}, "dynamics": dynamics}
    run = simulate(tool, scene([], 3.0, step, robots=[robot]), [("p.urdf", pendulum_urdf(damping))])
    right = runge_kutta(two_links(damping), [1.2, 0.8, 0.0, 0.0], 3.0)
    found = run.steps[-1]["robots"][0]["positions"]
    return max(abs(a - b) for a, b in zip(right, found))


def spring(tool, step):
    """The place of 1 kg on a spring of 100 N/m after 3 s: about five periods."""
    robot = {"name": "s", "urdf": "s.urdf", "state": {"j": 0.1}, "dynamics": {
        "base": "fixed", "motors": {"j": {"position": 0, "stiffness": 100, "damping": 0}}}}
    run = simulate(tool, scene([], 3.0, step, robots=[robot]), [("s.urdf", SLIDER)])
    return abs(run.steps[-1]["robots"][0]["positions"][0] - 0.1 * math.cos(30.0))


def floating_arm():
    """A body of 2 kg with two links."""
    links = [("base", 2.0, 0.0, 0.02, None), ("a", 1.0, 0.25, 0.02, ("j1", "base", 0.1, "0 1 0")),
             ("b", 0.7, 0.2, 0.01, ("j2", "a", 0.5, "1 0 0"))]
    urdf = '<robot name="f">'
    for name, mass, middle, moment, joint in links:
        urdf += (f'<link name="{name}"><inertial><origin xyz="0 0 {middle}"/><mass value="{mass}"/><inertia '
                 f'ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{0.5 * moment}"/></inertial></link>')
        if joint:
            urdf += (f'<joint name="{joint[0]}" type="continuous"><parent link="{joint[1]}"/><child link="{name}"/>'
                     f'<origin xyz="0 0 {joint[2]}"/><axis xyz="{joint[3]}"/></joint>')
    return urdf + "</robot>"


def floating_robot(tool, step):
    """A run of 3 s of a robot that nothing holds, whose joints turn at 3 and -4 rad/s at first."""
    robot = {"name": "f", "urdf": "f.urdf", "state": {"j1": 0.5, "j2": 0.8}, "dynamics": {
        "base": "free", "velocities": {"j1": 3, "j2": -4}, "linear_velocity": [0.3, 0, 0.1],
        "angular_velocity": [0.5, 1, -1]}}
    return simulate(tool, scene([], 3.0, step, gravity=0.0, robots=[robot]), [("f.urdf", floating_arm())])


def momenta_of_robot(tool, step):
    """The change of linear and angular momentum."""
    first, *_, last = floating_robot(tool, step).steps
    return max(math.dist(first[key], last[key]) for key in ("linear_momentum", "angular_momentum"))


def energy_of_robot(tool, step):
    energies = [s["kinetic_energy"] for s in floating_robot(tool, step).steps]
    return max(abs(e - energies[0]) for e in energies)


def pendulum_on_hinge(tool, step):
    """The angle of a box on a hinge at its end that falls from the level, after 1 s: peers have a robot of one link."""
    length, depth, density = 0.5, 0.05, 1000
    mass = density * length * depth * depth
    across, along = mass * (length ** 2 + depth ** 2) / 12, mass * depth ** 2 / 6
    right = runge_kutta(lambda s: [s[1], 0.5 * G * length * math.cos(s[0]) / (across / mass + length ** 2 / 4)],
                        [0.0, 0.0], 1.0)[0]
    if tool.is_ours:
        run = simulate(tool, scene(
            [body("arm", box(length, depth, depth), (0.5 * length, 0, 0), dynamics={})], 1.0, step,
            simulation={"ties": [{"type": "hinge", "bodies": [None, "arm"], "axis": [0, 1, 0],
                                  "points": [[0, 0, 0], None]}]}))
        w, _, y, _ = run.body(0)["quaternion_wxyz"]
        return abs(math.remainder(2 * math.atan2(y, w) - right, 2 * math.pi))
    urdf = ('<robot name="h"><link name="base"/><link name="arm"><inertial>'
            f'<origin xyz="{0.5 * length} 0 0"/><mass value="{mass}"/><inertia ixx="{along}" ixy="0" ixz="0" '
            f'iyy="{across}" iyz="0" izz="{across}"/></inertial></link><joint name="j" type="continuous">'
            '<parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint></robot>')
    robot = {"name": "h", "urdf": "h.urdf", "dynamics": {"base": "fixed"}}
    run = simulate(tool, scene([], 1.0, step, robots=[robot]), [("h.urdf", urdf)])
    return abs(run.steps[-1]["robots"][0]["positions"][0] - right)


def spring_between_bodies(tool, step):
    """The place of 1 kg that hangs on a spring of 100 N/m and falls from its rest, after 3 s."""
    run = simulate(tool, scene([body("load", ball(0.05), (0, 0, -0.5), dynamics={"mass": 1})], 3.0, step, simulation={
        "ties": [{"type": "spring", "bodies": [None, "load"], "points": [[0, 0, 0], [0, 0, 0]], "stiffness": 100,
                  "length": 0.5}]}))
    return abs(run.body(0)["position"][2] + 0.5 + G / 100 * (1 - math.cos(30.0)))
