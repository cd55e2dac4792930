"""Is a robot's motion free if both its ends are? And how far must the robot lift its arm?"""

import pathlib

import firstcontact as fc
import numpy as np

ROBOTS = pathlib.Path(__file__).resolve().parents[2] / "data/robots"

robot = fc.read_urdf(ROBOTS / "puma560_description/urdf/puma560_robot.urdf", visual=True)
scene = fc.RobotScene(robot, state={name: 0.0 for name in robot.coordinates}, tracking_error=0.002)
scene.add_body("post", fc.make_cylinder(0.05, 0.8), fc.Motion.fixed(fc.Pose((0.0, 0.5, 0.4))))


def swing(lift: float) -> fc.Trajectory:
    """Returns half a turn in two seconds, with the arm lifted by `lift` [rad] halfway."""
    times = np.linspace(0, 2, 9)
    s = times / 2
    positions = np.column_stack([np.pi * (3 * s**2 - 2 * s**3), lift * np.sin(np.pi * s)**2])
    velocities = np.column_stack([np.pi * 3 * (s - s**2), lift * np.pi / 2 * np.sin(2 * np.pi * s)])
    return fc.Trajectory(["j1", "j2"], times, positions, velocities)


result = scene.check(swing(0.0), all_contacts_in_time=True)
ends = fc.sample_gap(result.scene, [0.0, 1.0])
print(f"at its ends {ends.distance.min():.3f} m or more from everything")
print(f"{result.verdict}: {' and '.join(result.pair)} after {result.time:.4f} s")
for pair in result.pairs:
    for interval in pair.intervals:
        print(f"  {pair.pair[1]} from {interval.enter_time:.3f} s to {interval.leave_time:.3f} s")

lifts = np.linspace(0, 1.5, 16)
answers = fc.check_many([scene.along(swing(lift)) for lift in lifts])
free = [lift for lift, answer in zip(lifts, answers) if answer.verdict == "free"]
print(f"lifted by {min(free):.1f} rad the way is free, with 2 mrad of play in every joint: proven")
