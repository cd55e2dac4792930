#!/usr/bin/env python3
"""How far simulations are from closed forms at four steps, each half of the one before, and peers at the first.

    benchmarks/simulation/laws/laws.py [TOOL] [--peers FOLDER] [--update-docs]

TOOL is build/release/apps/firstcontact by default. FOLDER has laws_bullet and laws_mujoco, where these were built. The order is that of the last three steps at which the error
is above the noise; the exit status is 1 where one is below what the row asks for. With --update-docs the table
goes into docs/physics.md.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs" / "physics.md"
STEPS = [0.01, 0.005, 0.0025, 0.00125]  # [s]
G = 9.81  # [m/s^2]
NEAR = 1e-7  # [m]  A contact distance. A ball rolls on a circle that is larger by half of it.


# Scenes.

def body(name, shape, position=(0, 0, 0), **more):
    quaternion = more.pop("quaternion_wxyz", [1, 0, 0, 0])
    return {"name": name, "shape": shape,
            "pose": {"position": list(position), "quaternion_wxyz": quaternion}, **more}


def box(*size):
    return {"box": {"size": list(size)}}


def ball(radius):
    return {"sphere": {"radius": radius}}


def scene(bodies, duration, step, friction=0.0, gravity=G, contact_distance=1e-4, **more):
    settings = {"duration": duration, "step": step, "friction": friction, "gravity": [0, 0, -gravity],
                "contact_distance": contact_distance, **more.pop("simulation", {})}
    return {"firstcontact": 1, "bodies": bodies, "simulation": settings, **more}


class Run:
    """The steps of a run."""

    def __init__(self, lines):
        self.steps = [json.loads(line) for line in lines[1:]]

    def at(self, time):
        return min(self.steps, key=lambda step: abs(step["time"] - time))

    def body(self, number, time=math.inf):
        step = self.steps[-1] if time == math.inf else self.at(time)
        return next(b for b in step["bodies"] if b["body"] == number)

    def energies(self):
        return [step["kinetic_energy"] + step["potential_energy"] for step in self.steps]


class NotForPeer(Exception):
    """The engine has no such scene."""


def is_ours(tool):
    return not pathlib.Path(tool).name.startswith("laws_")


def simulate(tool, described, files=()):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        for name, text in files:
            (path / name).write_text(text, encoding="utf-8")
        (path / "scene.json").write_text(json.dumps(described), encoding="utf-8")
        inputs = ["scene.json", "-o", "run.jsonl"] if is_ours(tool) else ["scene.json", "run.jsonl"]
        done = subprocess.run([tool, *(["simulate"] if is_ours(tool) else []), *inputs], cwd=path,
                              capture_output=True, text=True, check=False)
        if done.returncode == 3 and not is_ours(tool):
            raise NotForPeer
        if done.returncode != 0:
            sys.exit(f"error: {done.stderr or done.stdout}")
        return Run((path / "run.jsonl").read_text(encoding="utf-8").splitlines())


# Oracles.

def runge_kutta(rates, state, duration, parts=20000):
    """The state after a duration, by the classical rule of fourth order."""
    h = duration / parts
    for _ in range(parts):
        a = rates(state)
        b = rates([x + 0.5 * h * k for x, k in zip(state, a)])
        c = rates([x + 0.5 * h * k for x, k in zip(state, b)])
        d = rates([x + h * k for x, k in zip(state, c)])
        state = [x + h / 6 * (k + 2 * l + 2 * m + n) for x, k, l, m, n in zip(state, a, b, c, d)]
    return state


def two_links(damping):
    """Rates of a double pendulum: masses 1 and 0.7 kg, links of 0.5 m, moments about their middles."""
    m1, c1, l1, i1, m2, c2, i2 = 1.0, 0.25, 0.5, 0.0208333, 0.7, 0.2, 0.00933333

    def rates(state):
        q1, q2, v1, v2 = state
        coupling = m2 * l1 * c2 * math.cos(q2)
        m12 = i2 + m2 * c2 * c2 + coupling
        m11 = i1 + m1 * c1 * c1 + m2 * l1 * l1 + i2 + m2 * c2 * c2 + 2 * coupling
        m22 = i2 + m2 * c2 * c2
        h = m2 * l1 * c2 * math.sin(q2)
        f2 = -m2 * G * c2 * math.sin(q1 + q2) - h * v1 * v1 - damping * v2
        f1 = (-(m1 * c1 + m2 * l1) * G * math.sin(q1) - m2 * G * c2 * math.sin(q1 + q2)
              + h * (2 * v1 * v2 + v2 * v2))
        determinant = m11 * m22 - m12 * m12
        return [v1, v2, (m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant]
    return rates


def pendulum_urdf(damping):
    def link(name, mass, middle, moment):
        return (f'<link name="{name}"><inertial><origin xyz="0 0 {-middle}"/><mass value="{mass}"/><inertia '
                f'ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="0.0001"/></inertial></link>')

    def joint(name, parent, child, z, friction=""):
        return (f'<joint name="{name}" type="continuous"><parent link="{parent}"/><child link="{child}"/>'
                f'<origin xyz="0 0 {z}"/><axis xyz="0 1 0"/>{friction}</joint>')
    return ('<robot name="p">' + link("base", 1, 0, 1) + link("a", 1, 0.25, 0.0208333)
            + link("b", 0.7, 0.2, 0.00933333) + joint("j1", "base", "a", 0)
            + joint("j2", "a", "b", -0.5, f'<dynamics damping="{damping}"/>') + "</robot>")


SLIDER = """<robot name="s"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0"
iyy="1" iyz="0" izz="1"/></inertial></link><link name="a"><inertial><mass value="1"/><inertia ixx="0.01"
ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link><joint name="j" type="prismatic"><parent
link="base"/><child link="a"/><axis xyz="1 0 0"/><limit lower="-9" upper="9" effort="0" velocity="0"/></joint>
</robot>"""


# What is measured: functions of the tool and the step that return the error.

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
    return 2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(right, found)))))


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


def turntable(tool, step):
    """How far a block at 0.5 m is from its place on a table that turns at 2 rad/s, after 3 s."""
    table = {"name": "table", "shape": box(3, 3, 0.1), "motion": {
        "type": "constant_velocity", "from": {"position": [0, 0, -0.05]}, "rotation_vector": [0, 0, 6]}}
    block = body("block", box(0.1, 0.1, 0.04), (0.5, 0, 0.0201),
                 dynamics={"linear_velocity": [0, 1, 0], "angular_velocity": [0, 0, 2]})
    run = simulate(tool, scene([table, block], 3.0, step, friction=1.0))
    x, y, _ = run.body(1)["position"]
    return math.hypot(x - 0.5 * math.cos(6.0), y - 0.5 * math.sin(6.0))


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


SMOOTH, IMPACTS = 2, 1
NOISE = 1e-8

# What is simulated, the error and its unit, the order that is asked for, and what measures it.
ROWS = [
    ("block tumbles beside its middle axis, 3 s", "turn", "rad", SMOOTH, tumbling),
    ("double pendulum, 3 s", "angle", "rad", SMOOTH, free_pendulum),
    ("the same with a motor of torque 0", "angle", "rad", SMOOTH,
     lambda tool, step: free_pendulum(tool, step, motors={"j2": {"torque": 0}})),
    ("the same with damping 0.05 N m s", "angle", "rad", SMOOTH,
     lambda tool, step: free_pendulum(tool, step, damping=0.05)),
    ("1 kg on a spring of 100 N/m, 3 s", "place", "m", SMOOTH, spring),
    ("block on a turntable, 2 rad/s, 3 s", "place", "m", SMOOTH, turntable),
    ("ball slides off a ball, no friction", "energy", "J/kg", SMOOTH, ball_off_a_ball),
    ("ball rolls down 17 degrees, 1 s", "place", "m", SMOOTH, rolling_ball),
    ("cylinder rolls on the level, 3 s", "velocity", "m/s", SMOOTH, rolling_cylinder),
    ("block slides to a stop", "place", "m", IMPACTS, sliding_stop),
    ("ball bounces three times, e = 0.9", "height", "m", IMPACTS, bounces),
    ("two spinning boxes collide", "angular momentum", "kg m²/s", IMPACTS, collision),
]


def order_of(errors, noise=NOISE):
    """Between the last three errors above the noise; None where fewer than two are."""
    above = [k for k, error in enumerate(errors) if error > noise][-3:]
    if len(above) < 2:
        return None
    first, last = above[0], above[-1]
    return math.log2(errors[first] / errors[last]) / (last - first)


def at_first_step(measure, program):
    """The error of a peer, as text."""
    try:
        return show(measure(program, STEPS[0]))
    except NotForPeer:
        return "–"


def show(error):
    return f"{error:.1e}".replace("e-0", "e-") if error > NOISE else "< 1e-8"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", nargs="?", type=pathlib.Path, default=ROOT / "build/release/apps/firstcontact")
    parser.add_argument("--peers", type=pathlib.Path, default=ROOT / "build/release/benchmarks/simulation/laws")
    parser.add_argument("--update-docs", action="store_true", help="writes the table into docs/physics.md")
    arguments = parser.parse_args()
    tool = arguments.tool.resolve()
    peers = [(name, program) for name, program in
             [("Bullet, 10 ms", arguments.peers / "laws_bullet"), ("MuJoCo, 10 ms", arguments.peers / "laws_mujoco")]
             if program.exists()]
    lines = ["| scene | error | 10 ms | 5 ms | 2.5 ms | 1.25 ms | order | asked |"
             + "".join(f" {name} |" for name, _ in peers),
             "|---|---|--:|--:|--:|--:|--:|--:|" + "--:|" * len(peers)]
    print("\n".join(lines), flush=True)
    too_low = []
    for name, quantity, unit, asked, measure in ROWS:
        errors = [measure(tool, step) for step in STEPS]
        order = order_of(errors)
        if order is not None and order < asked - 0.15:
            too_low.append(name)
        shown = "exact" if order is None else f"{order:.1f}"
        lines.append(f"| {name} | {quantity} ({unit}) | " + " | ".join(map(show, errors))
                     + f" | {shown} | {asked} |"
                     + "".join(f" {at_first_step(measure, program.resolve())} |" for _, program in peers))
        print(lines[-1], flush=True)
    if arguments.update_docs:
        page = PAGE.read_text(encoding="utf-8")
        begin, end = "<!-- laws -->\n", "<!-- end -->"
        before, rest = page.split(begin)
        PAGE.write_text(before + begin + "\n" + "\n".join(lines) + "\n\n" + end + rest.split(end, 1)[1],
                        encoding="utf-8")
    if too_low:
        sys.exit("below the order asked for: " + ", ".join(too_low))


if __name__ == "__main__":
    main()
