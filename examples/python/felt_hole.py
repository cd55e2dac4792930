"""Which force does a hand feel that presses a peg on its hole? Draws a map of the forces.

    python3 felt_hole.py [MAP.svg [CELLS]]

The hand presses the peg half a millimetre below the rim, at CELLS x CELLS places around the axis of
the hole. Near the axis the peg goes in, and the hand feels no force. Beside it the chamfer of the peg
slides on the chamfer of the hole: the force points to the axis. Farther out the peg stands on the
rim, and the force points up.
"""

import json
import pathlib
import sys

import firstcontact as fc

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "demo/haptics"
REACH = 1.0  # [mm]  Half of the width of the map.
OVER, PRESSED = -3.0, -4.0  # [mm]  The height of the handle: 0.5 mm over the rim, and 0.5 mm below it.


def session() -> fc.HapticSession:
    scene = json.loads((FOLDER / "peg_and_hole.json").read_text())
    for body in scene["bodies"]:
        body["shape"]["mesh"] = str(FOLDER / body["shape"]["mesh"])
    scene["haptics"].update({"friction": 0, "force_rate": 1000, "contact_rate": 1000})
    felt = fc.HapticSession(scene)
    for _ in range(300):  # Forces of a new session grow over 0.2 s.
        felt.step([fc.Pose()])
    return felt


def press(felt: fc.HapticSession, x: float, y: float):
    """Returns the force [N] on a hand that moves the axis of the peg to x, y [mm] and presses it down."""
    tick = None
    for height, ticks in ((OVER, 3), (PRESSED, 12)):
        for _ in range(ticks):  # The peg begins 4 mm beside the axis of the hole, with the handle at 0.
            tick = felt.step([fc.Pose((1e-3 * (x - 4), 1e-3 * y, 1e-3 * height))])
    for _ in range(3):
        felt.step([fc.Pose((1e-3 * (x - 4), 1e-3 * y, 1e-3 * OVER))])
    return tick.forces[0]


def draw(rows: list, most: float) -> str:
    """Draws a square for each place, darker for a stronger force, and an arrow along its horizontal part."""
    size, cells = 12, len(rows)
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size * cells} {size * cells}">']
    for row, places in enumerate(rows):
        for column, force in enumerate(places):
            shade = round(255 * (1 - min(1.0, force[2] / most)))
            left, top = size * column, size * (cells - 1 - row)
            lines.append(f'<rect x="{left}" y="{top}" width="{size}" height="{size}" '
                         f'fill="rgb({shade},{(shade + 255) // 2},255)"><title>{force[2]:.3f} N</title></rect>')
            x, y = left + size / 2, top + size / 2
            lines.append(f'<path d="M{x} {y}l{size * force[0] / most:.2f} {-size * force[1] / most:.2f}" '
                         'stroke="black"/>')
    return "\n".join([*lines, "</svg>\n"])


cells = int(sys.argv[2]) if len(sys.argv) > 2 else 17
places = [REACH * (2 * k / (cells - 1) - 1) for k in range(cells)]
felt = session()
forces = [[press(felt, x, y) for x in places] for y in places]
most = max(force[2] for row in forces for force in row)
print("pushed up by [N], led to the axis by [N]:")
for x, force in zip(places, forces[cells // 2]):
    print(f"{x:6.3f} mm  {force[2]:.4f}  {-force[0] if x > 0 else force[0]:.4f}")
if len(sys.argv) > 1:
    pathlib.Path(sys.argv[1]).write_text(draw(forces, most), encoding="utf-8")
    print(f"{cells} x {cells} forces: {sys.argv[1]}")
