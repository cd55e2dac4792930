#!/usr/bin/env python3
"""How far simulations are from closed forms at four steps, each half of the one before, and peers at the same steps.

    benchmarks/simulation/laws/laws.py [TOOL] [--peers FOLDER] [--update-docs]

TOOL is build/release/apps/firstcontact by default. FOLDER has laws_bullet and laws_mujoco, where these were
built. The order is that of the last three steps at which the error is above the noise. Where the simulator takes
long steps in parts, it is that of further halvings. A peer simulates each scene with each of its integrators; the one
with the least errors counts. The exit status is 1 where an order is below what the row asks for, or where a peer has
a smaller error at any step. With --update-docs the tables go into docs/physics.md.
"""

import argparse
import math
import pathlib
import sys
import typing

import laws_of_contacts as contacts
import laws_of_free_motion as motion
import laws_of_robots as robots
from law_scenes import Diverged, NotForPeer, Tool

ROOT = pathlib.Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs" / "physics.md"
STEPS = [0.01, 0.005, 0.0025, 0.00125]  # [s]
SMOOTH, JUMPS = 2, 1  # The orders asked for, by what velocities do.
NOISE = 1e-8


class Row(typing.NamedTuple):
    scene: str
    quantity: str
    unit: str
    asked: int  # The order.
    measure: typing.Callable
    noise: float = NOISE  # Errors below it are of the contact distance, or of the corners of a mesh.
    finer: int = 0  # Halvings after the last step that the table shows, for the order alone.


# Flights of robots have sub-steps of at most 0.0125 rad, however long the step. Their errors have no order in the step.
SUB_STEPS = 5e-8
# Tops that spin at 60 rad/s turn by more in a step of 1 ms than a plan may.
SPINS = 3

ROWS = [
    Row("block tumbles beside its middle axis, 3 s", "turn", "rad", SMOOTH, motion.tumbling),
    Row("double pendulum, 3 s", "angle", "rad", SMOOTH, motion.free_pendulum, SUB_STEPS),
    Row("the same with a motor of torque 0", "angle", "rad", SMOOTH,
     lambda tool, step: motion.free_pendulum(tool, step, motors={"j2": {"torque": 0}}), SUB_STEPS),
    Row("the same with damping 0.05 N m s", "angle", "rad", SMOOTH,
     lambda tool, step: motion.free_pendulum(tool, step, damping=0.05), SUB_STEPS),
    Row("1 kg on a spring of 100 N/m, 3 s", "place", "m", SMOOTH, motion.spring),
    Row("1 kg hangs on a spring between bodies, 3 s", "place", "m", SMOOTH, motion.spring_between_bodies),
    Row("box falls on a hinge, 1 s", "angle", "rad", SMOOTH, motion.pendulum_on_hinge),
    Row("robot that nothing holds, 3 s", "momenta", "N s", SMOOTH, motion.momenta_of_robot),
    Row("the same", "energy", "J", SMOOTH, motion.energy_of_robot),
    Row("block on a turntable, 2 rad/s, 3 s", "place", "m", SMOOTH, contacts.turntable),
    Row("the same, speeded up by a robot's motor, 1 s", "place", "m", SMOOTH, contacts.block_by_speeds),
    Row("ball rolls over a turntable, 2 rad/s, 3 s", "place", "m", SMOOTH, contacts.ball_on_a_turntable),
    Row("ball slides off a ball, no friction", "energy", "J/kg", SMOOTH, contacts.ball_off_a_ball),
    Row("ball rolls down 17 degrees, 1 s", "place", "m", SMOOTH, contacts.rolling_ball),
    Row("cylinder rolls on the level, 3 s", "velocity", "m/s", SMOOTH, contacts.rolling_cylinder),
    Row("block slides down 17 degrees, friction 0.2, 1 s", "place", "m", SMOOTH, contacts.sliding_down),
    Row("rod of 1 m slides on its end, 0.4 s", "lean", "rad", SMOOTH, contacts.rod_on_its_end),
    Row("top on its tip, 60 rad/s, 1 s", "axis", "rad", SMOOTH, contacts.top_on_its_tip, finer=SPINS),
    Row("the same on the tray of a robot", "axis", "rad", SMOOTH,
     lambda tool, step: contacts.top_on_its_tip(tool, step, robot="tray"), finer=SPINS),
    Row("the same as a robot that nothing holds", "axis", "rad", SMOOTH,
     lambda tool, step: contacts.top_on_its_tip(tool, step, robot="link"), finer=SPINS),
    Row("end of an arm slides along a floor, 0.4 s", "angle", "rad", SMOOTH,
     robots.arm_on_the_floor),
    Row("the same with damping 0.1 N m s", "angle", "rad", SMOOTH,
     lambda tool, step: robots.arm_on_the_floor(tool, step, damping=0.1)),
    Row("the same, pressed down by sprung motors", "angle", "rad", SMOOTH,
     lambda tool, step: robots.arm_on_the_floor(tool, step, press=(0.7, -1.2))),
    Row("the same from rest, pressed down by stiffer motors, 1 s", "angle", "rad", SMOOTH,
     lambda tool, step: robots.slow_arm(tool, step, resistance=2.0, distance=1e-4), finer=1),
    Row("the same, whose strong dampers let it creep", "angle", "rad", SMOOTH,
     lambda tool, step: robots.slow_arm(tool, step, resistance=200.0, distance=1e-7, creeps=True), finer=3),
    Row("sprung motor of a tray carries a load, 1 s", "place", "m", SMOOTH, robots.load_on_a_tray),
    Row("sprung motors of an arm carry a load, 1 s", "angle", "rad", SMOOTH, robots.load_on_an_arm),
    Row("four links in a loop fall, 3 s", "angle", "rad", SMOOTH, robots.angles_of_loop),
    Row("the same", "energy", "J", SMOOTH, robots.energy_of_loop),
    Row("disc goes round on its rim, 0.3 s", "energy", "part", SMOOTH, contacts.disc_on_its_rim, 1e-6),
    Row("ring of 180 corners swings on a pin, 1 s", "energy", "part", SMOOTH, contacts.ring_on_a_pin, 4e-6),
    Row("ellipsoid rocks, 1 s", "lean", "rad", SMOOTH, contacts.rocking_ellipsoid),
    Row("cubes of 1, 100 and 10,000 kg on each other, 1 s", "place", "m", SMOOTH,
     lambda tool, step: contacts.standing(tool, step, [1, 100, 10000])),
    Row("column of 50 cubes, 1 s", "place", "m", SMOOTH,
     lambda tool, step: contacts.standing(tool, step, [1] * 50)),
    Row("arm on a floor, from rest against strong dampers, 1 s", "angle", "rad", JUMPS,
     lambda tool, step: robots.slow_arm(tool, step, resistance=200.0, distance=1e-7)),
    Row("rows of positions drive a turntable, 1 s", "place", "m", JUMPS,
        contacts.block_by_positions),
    Row("ball with back spin slides, then rolls, 1 s", "place", "m", JUMPS, contacts.back_spin),
    Row("ball hits a row of four, e = 1", "velocity", "m/s", JUMPS, contacts.cradle),
    Row("block slides to a stop", "place", "m", JUMPS, contacts.sliding_stop),
    Row("ball bounces three times, e = 0.9", "height", "m", JUMPS, contacts.bounces),
    Row("two spinning boxes collide", "angular momentum", "kg m²/s", JUMPS, contacts.collision),
]


def order_of(errors, noise):
    """Between the last three errors above the noise; None where fewer than two are."""
    above = [k for k, error in enumerate(errors) if error > noise][-3:]
    if len(above) < 2:
        return None
    first, last = above[0], above[-1]
    return math.log2(errors[first] / errors[last]) / (last - first)


def mean_order_of(errors, noise):
    """Between the first and the last error above the noise."""
    above = [k for k, error in enumerate(errors) if error > noise]
    if len(above) < 2:
        return None
    return math.log2(errors[above[0]] / errors[above[-1]]) / (above[-1] - above[0])


def show(error):
    return f"{error:.1e}".replace("e-0", "e-").replace("e+00", "") if error > NOISE else "< 1e-8"


def show_order(order):
    return "exact" if order is None else f"{order:.1f}".replace("-0.0", "0.0").replace("-", "−")


class Peer(typing.NamedTuple):
    """An engine with those of its integrators that do best in a scene."""
    name: str
    tools: list  # One for each integrator.

    def measure(self, row):
        """The integrator whose errors at all steps are least in the mean of their logarithms, and these errors."""
        def mean(found):
            return sum(math.log(max(error, NOISE)) for error in found[1])
        found = []
        for tool in self.tools:
            try:
                found.append((tool.integrator, [row.measure(tool, step) for step in STEPS]))
            except (NotForPeer, Diverged):
                continue
        return min(found, key=mean, default=None)


class Measured(typing.NamedTuple):
    row: Row
    name: str  # That of the row, with what it is the same as.
    errors: list
    order: typing.Optional[float]
    peers: list  # What Peer.measure found, one for each peer.

    def line(self):
        row = self.row
        order = show_order(self.order) + ("\\*" if row.finer else "")
        return (f"| {row.scene} | {row.quantity} ({row.unit}) | " + " | ".join(map(show, self.errors))
                + f" | {order} | {row.asked} |")

    def line_of_peers(self):
        line = f"| {self.row.scene} | {self.row.quantity} ({self.row.unit}) | "
        for found in self.peers:
            if found is None:
                line += "– | – | – | – | "
            else:
                integrator, errors = found
                line += (f"{integrator} | {show(errors[0])} | {show(errors[-1])} | "
                         f"{show_order(mean_order_of(errors, self.row.noise))} | ")
        return line.rstrip()

    def better_peers(self):
        """For each step the least error of a peer, where it is smaller than ours, or None."""
        found = []
        for k, error in enumerate(self.errors):
            least = min((peer[1][k] for peer in self.peers if peer is not None), default=math.inf)
            found.append(least if error > max(least, self.row.noise) else None)
        return found

    def is_worse(self):
        return any(least is not None for least in self.better_peers())

    def line_of_better(self):
        return f"| {self.name} | " + " | ".join(
            "" if least is None else f"{show(error)} ({show(least)})"
            for error, least in zip(self.errors, self.better_peers())) + " |"


def full_names(rows):
    """The scenes of the rows, each with what it is the same as."""
    base, names = "", []
    for row in rows:
        if not row.scene.startswith("the same"):
            base = row.scene
        difference = row.scene.removeprefix("the same").strip(", ")
        names.append(row.scene if row.scene == base else f"{base}: {difference or row.quantity}")
    return names


def measure(row, name, tool, peers):
    errors = [row.measure(tool, step) for step in STEPS]
    finer = [row.measure(tool, STEPS[-1] / 2 ** (1 + k)) for k in range(row.finer)]
    return Measured(row, name, errors, order_of(errors + finer, row.noise), [peer.measure(row) for peer in peers])


def tables(measured, peers):
    """Ours, those of the peers, and where these are better."""
    ours = ["| scene | error | 10 ms | 5 ms | 2.5 ms | 1.25 ms | order | asked |",
            "|---|---|--:|--:|--:|--:|--:|--:|", *(m.line() for m in measured)]
    theirs = ["| scene | error |" + "".join(f" {peer.name} | 10 ms | 1.25 ms | order |" for peer in peers),
              "|---|---|" + "---|--:|--:|--:|" * len(peers), *(m.line_of_peers() for m in measured)]
    better = ["| scene | 10 ms | 5 ms | 2.5 ms | 1.25 ms |", "|---|--:|--:|--:|--:|",
              *(m.line_of_better() for m in measured if m.is_worse())]
    return {"laws": ours, "peers": theirs, "better": better}


def update_page(page, blocks):
    for name, lines in blocks.items():
        before, rest = page.split(f"<!-- {name} -->\n")
        after = rest.split("<!-- end -->", 1)[1]
        page = before + f"<!-- {name} -->\n\n" + "\n".join(lines) + "\n\n<!-- end -->" + after
    return page


def find_peers(folder):
    def peer(name, program, integrators):
        return Peer(name, [Tool(folder / program, integrator) for integrator in integrators])
    found = [peer("Bullet", "laws_bullet", ["Euler", "RK4"]),
             peer("MuJoCo", "laws_mujoco", ["Euler", "implicit", "RK4"])]
    return [peer for peer in found if peer.tools[0].program.exists()]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tool", nargs="?", type=pathlib.Path, default=ROOT / "build/release/apps/firstcontact")
    parser.add_argument("--peers", type=pathlib.Path, default=ROOT / "build/release/benchmarks/simulation/laws")
    parser.add_argument("--rows", metavar="WORD", help="measures only scenes with this word in their names")
    parser.add_argument("--update-docs", action="store_true", help="writes the tables into docs/physics.md")
    arguments = parser.parse_args()
    tool, peers = Tool(arguments.tool.resolve()), find_peers(arguments.peers.resolve())
    measured = []
    for row, name in zip(ROWS, full_names(ROWS)):
        if (arguments.rows or "") not in name:
            continue
        measured.append(measure(row, name, tool, peers))
        print(measured[-1].line(), measured[-1].line_of_peers(), sep="\n", flush=True)
    blocks = tables(measured, peers)
    if arguments.update_docs:
        PAGE.write_text(update_page(PAGE.read_text(encoding="utf-8"), blocks), encoding="utf-8")
    too_low = [m.name for m in measured if m.order is not None and m.order < m.row.asked - 0.15]
    worse = [m.name for m in measured if m.is_worse()]
    print("\n".join(blocks["better"]))
    if too_low or worse:
        sys.exit(f"below the order asked for: {'; '.join(too_low) or 'none'}\n"
                 f"worse than a peer at the same step: {'; '.join(worse) or 'none'}")


if __name__ == "__main__":
    main()
