#!/usr/bin/env python3
"""How far simulations are from closed forms at four steps, each half of the one before, and peers at the first.

    benchmarks/simulation/laws/laws.py [TOOL] [--peers FOLDER] [--update-docs]

TOOL is build/release/apps/firstcontact by default. FOLDER has laws_bullet and laws_mujoco, where these were
built. The order is that of the last three steps at which the error is above the noise. Where the simulator takes
long steps in parts, it is that of further halvings. The exit status is 1 where one is below what the row asks for.
With --update-docs the table goes into docs/physics.md.
"""

import argparse
import math
import pathlib
import sys
import typing

import laws_of_contacts as contacts
import laws_of_free_motion as motion
from law_scenes import NotForPeer

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


# Tops that spin at 60 rad/s turn by more in a step of 1 ms than a plan may.
SPINS = 3

ROWS = [
    Row("block tumbles beside its middle axis, 3 s", "turn", "rad", SMOOTH, motion.tumbling),
    Row("double pendulum, 3 s", "angle", "rad", SMOOTH, motion.free_pendulum),
    Row("the same with a motor of torque 0", "angle", "rad", SMOOTH,
     lambda tool, step: motion.free_pendulum(tool, step, motors={"j2": {"torque": 0}})),
    Row("the same with damping 0.05 N m s", "angle", "rad", SMOOTH,
     lambda tool, step: motion.free_pendulum(tool, step, damping=0.05)),
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
     lambda tool, step: contacts.arm_on_the_floor(tool, step, damping=0.0)),
    Row("the same with damping 0.1 N m s", "angle", "rad", SMOOTH,
     lambda tool, step: contacts.arm_on_the_floor(tool, step, damping=0.1)),
    Row("disc goes round on its rim, 0.3 s", "energy", "part", SMOOTH, contacts.disc_on_its_rim, 1e-6),
    Row("ring of 180 corners swings on a pin, 1 s", "energy", "part", SMOOTH, contacts.ring_on_a_pin, 4e-6),
    Row("ellipsoid rocks, 1 s", "lean", "rad", SMOOTH, contacts.rocking_ellipsoid),
    Row("cubes of 1, 100 and 10,000 kg on each other, 1 s", "place", "m", SMOOTH,
     lambda tool, step: contacts.standing(tool, step, [1, 100, 10000])),
    Row("column of 50 cubes, 1 s", "place", "m", SMOOTH,
     lambda tool, step: contacts.standing(tool, step, [1] * 50)),
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
    for row in ROWS:
        errors = [row.measure(tool, step) for step in STEPS]
        finer = [row.measure(tool, STEPS[-1] / 2 ** (1 + k)) for k in range(row.finer)]
        order = order_of(errors + finer, row.noise)
        if order is not None and order < row.asked - 0.15:
            too_low.append(row.scene)
        shown = "exact" if order is None else f"{order:.1f}" + ("\\*" if finer else "")
        lines.append(f"| {row.scene} | {row.quantity} ({row.unit}) | " + " | ".join(map(show, errors))
                     + f" | {shown} | {row.asked} |"
                     + "".join(f" {at_first_step(row.measure, program.resolve())} |" for _, program in peers))
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
