"""How close does a drone come to a wall that was scanned as a point cloud?"""

import firstcontact as fc
import numpy as np

# A wall of scanned points near x = 2 m. The error of each point is at most 5 mm.
rng = np.random.default_rng(7)
points = np.column_stack([2 + rng.normal(0, 0.01, 5_000), rng.uniform(-2, 2, (5_000, 2))])
wall = (fc.make_point_cloud(points, radius=0.005), fc.Motion.fixed())

# The drone is the convex hull of its corners. It flies past the wall along three waypoints.
corners = [(x, y, z) for x in (-0.3, 0.3) for y in (-0.3, 0.3) for z in (-0.1, 0.1)]
flight = fc.Motion.waypoints([0, 0.5, 1], [fc.Pose((0, -1.5, 0)), fc.Pose((1.2, 0, 0), rpy=(0, 0, 0.8)),
                                           fc.Pose((0, 1.5, 0))])
drone = (fc.make_convex_hull(corners), flight)

closest = fc.closest_approach(wall, drone, tolerance=1e-4)
print(f"{closest.distance:.3f} m at t = {closest.t:.3f}, to point {closest.closest.features[0].index}")
print(f"never less than {closest.lower_bound:.3f} m: proven")

margin = closest.distance + 0.1
print(f"{margin:.3f} m are kept until t = {fc.first_contact(wall, drone, margin=margin).t:.3f}")
