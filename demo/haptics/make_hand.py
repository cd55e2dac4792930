#!/usr/bin/env python3
"""Writes the recording of a hand that feels its way into a hole: make_hand.py > peg_hand.csv

The hand presses the peg on the rim, slides it over the hole, tilts it inside, presses it on the
ground and pulls it out. It wants to go through the walls, by a millimetre.
"""

import math

RATE = 250  # [Hz]

# The handle at some times [s]: x, y, z [mm] and turns about x and y [degrees], in the device's frame.
# The peg begins 4 mm beside the hole and 3.5 mm above its rim.
WAY = (
    (0.00, 0.0, 0.0, 0.0, 0.0, 0.0),
    (0.30, 0.0, 0.0, -4.5, 0.0, 0.0),
    (0.66, -1.5, 2.0, -4.5, 0.0, 0.0),
    (0.96, -3.0, -1.0, -4.5, 0.0, 0.0),
    (1.20, -4.0, 0.0, -4.5, 0.0, 0.0),
    (1.44, -4.0, 0.0, -8.0, 0.0, 0.0),
    (1.68, -3.4, 0.0, -9.0, 0.0, 4.0),
    (1.98, -4.5, 0.5, -10.0, 3.0, -4.0),
    (2.22, -4.0, 0.0, -13.5, 0.0, 0.0),
    (2.46, -4.0, 0.0, -13.5, 0.0, 0.0),
    (2.88, -4.0, 0.0, 2.0, 0.0, 0.0),
    (3.00, -4.0, 0.0, 2.0, 0.0, 0.0),
)

HEAD = """# firstcontact recording: 1
## Made by demo/haptics/make_hand.py.
# device: hand of a program
# kind: pose
# sensed: 111111
# driven: 000000
# sample_rate: 250
# calibration_scale: 0.001
time_ns,sequence,x,y,z,qw,qx,qy,qz"""


def handle(time):
    """Between two places the hand moves as people do: with the least jerk."""
    begin, end = next((a, b) for a, b in zip(WAY, WAY[1:]) if time <= b[0])
    s = (time - begin[0]) / (end[0] - begin[0])
    s = s**3 * (10 - 15 * s + 6 * s**2)
    return [a + s * (b - a) for a, b in zip(begin[1:], end[1:])]


def line(k):
    x, y, z, about_x, about_y = handle(k / RATE)
    angle = math.radians(math.hypot(about_x, about_y))
    half = 0.5 * math.sin(angle / 2) / (angle / 2) if angle > 0 else 0.5
    turn = (math.cos(angle / 2), half * math.radians(about_x), half * math.radians(about_y), 0.0)
    numbers = [f"{value:.5f}" for value in (x, y, z)] + [f"{value:.7f}" for value in turn]
    return f"{k * 1_000_000_000 // RATE},{k},{','.join(numbers)}"


if __name__ == "__main__":
    print(HEAD)
    for k in range(int(WAY[-1][0] * RATE) + 1):
        print(line(k))
