"""Which of a hundred balls touch first?"""

import firstcontact as fc
import numpy as np

ball = fc.make_sphere(0.1)  # All balls share one shape.
rng = np.random.default_rng(1)

bodies = fc.BodySet()
for k in range(100):
    place = (0.5 * (k % 10), 0.5 * (k // 10), 0)
    bodies.add(ball, fc.Motion.constant_velocity(fc.Pose(place), rng.normal(0, 0.3, 3)))
bodies.rules.ignore((0, 1))  # These two balls may touch.

result = fc.first_contact(bodies)
first = result.pairs[result.first]
print(f"balls {first.members} at t = {result.t:.5f}")

# Stop one ball and ask again: only its motion is replaced, and nothing is rebuilt.
held = first.members[0]
bodies.set_motion(held, fc.Motion.fixed(bodies.motion(held).pose(0)))
print(f"with ball {held} held: t = {fc.first_contact(bodies).t:.5f}")
