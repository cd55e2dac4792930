"""When does a tumbling box hit the floor, and with which feature?"""

import math

import firstcontact as fc

box = fc.make_box((0.2, 0.2, 0.2))
floor = fc.make_box((10, 10, 1))

# One step: the box moves 1 m down while it turns once about the x axis.
start = fc.Pose((0, 0, 0.9))
tumble = fc.Motion.constant_velocity(start, translation=(0, 0, -1), rotation_vector=(2 * math.pi, 0, 0))
rest = fc.Motion.fixed(fc.Pose((0, 0, -0.5)))

result = fc.first_contact((box, tumble), (floor, rest))
print(f"{result.verdict} at t = {result.t:.4f} of the step; before it they are apart: proven")
for contact in result.contacts:
    ours, theirs = contact.features
    print(f"{ours.type} {ours.index} of the box, {theirs.type} {theirs.index} of the floor: {contact.points[1].round(3)} m")
