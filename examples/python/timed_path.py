"""Which trajectory follows a proven path? Times the path of a Panda past a post, in three modes."""

import pathlib
import sys

import firstcontact as fc

ROBOTS = pathlib.Path(__file__).resolve().parents[2] / "data/robots"
PANDA = ROBOTS / "moveit_resources_panda_description"

scene = {
    "firstcontact": 1,
    "package_roots": [ROBOTS],
    "bodies": [{"name": "post", "shape": {"box": {"size": [0.06, 0.06, 0.8]}}, "pose": {"position": [0.32, 0, 0.4]}}],
    "robots": [{"name": "panda", "urdf": PANDA / "urdf/panda.urdf", "srdf": PANDA / "srdf/panda.srdf",
                "state": {"panda_finger_joint1": 0}}],
    "plan": {"robot": "panda", "start": ["ready", {"panda_joint1": 0.8}], "goal": ["ready", {"panda_joint1": -0.8}],
             "margin": 0.005},
}
path = fc.plan(scene)
print(f"path: {path.verdict}, {len(path.waypoints) - 1} edges")

# Limits of acceleration and jerk. The velocity limits are in the URDF.
accelerations = dict(zip([f"panda_joint{k}" for k in range(1, 8)], [3.75, 1.875, 2.5, 3.125, 3.75, 5, 5]))
limits = {joint: {"max_acceleration": most, "max_jerk": 100 * most} for joint, most in accelerations.items()}
for mode in ("stop", "blend", "time_optimal"):
    answer = fc.retime(path, mode=mode, limits=limits, tracking_error=1e-4)
    nearest = max(answer.rates, key=lambda use: use.bound / use.limit)
    print(f"{mode}: {answer.verdict}, {answer.duration:.3f} s, {len(answer.trajectory)} points, "
          f"{1e3 * answer.closest.distance:.2f} mm from {' and '.join(answer.closest.pair)}")
    print(f"  {nearest.rate} of {nearest.joint}: {100 * nearest.bound / nearest.limit:.3f} % of its limit, proven")

# The arrays, for plots and controllers of your own, and the file for ROS.
way = answer.trajectory
print(f"arrays: {way.times.shape} times, {way.positions.shape} positions, {way.accelerations.shape} accelerations")
if len(sys.argv) > 1:
    answer.save(sys.argv[1])
