"""How does a controller move a crate over a floor to its goal? Sets its velocity between simulation steps.

    python3 pushed_crate.py [RUN.jsonl]
"""

import sys

import firstcontact as fc
import numpy as np

scene = {
    "firstcontact": 1,
    "bodies": [
        {"name": "floor", "shape": {"box": {"size": [9, 9, 0.2]}}, "pose": {"position": [0, 0, -0.1]}},
        {"name": "crate", "shape": {"box": {"size": [0.4, 0.4, 0.4]}},
         "pose": {"position": [0, 0, 0.21]}, "dynamics": {"density": 200, "friction": 0.4}},
    ],
    "simulation": {"duration": 1.5, "step": 0.01},
}
GOAL = 0.5  # [m]  Along x.

simulator = fc.Simulator(scene)
crate = simulator.names.index("crate")
print(f"The crate has {simulator.masses[crate]:.1f} kg")

# In each step the controller reads the place of the crate, and sets the crate's velocity.
closest = np.inf
while simulator.step_count < simulator.steps_of_duration:
    away = GOAL - simulator.positions[crate, 0]
    velocity = simulator.linear_velocities[crate]
    velocity[0] = np.clip(4 * away, -1, 1)
    simulator.set_state("crate", linear_velocity=velocity)
    closest = min(closest, simulator.step().clearance)
print(f"It is at {simulator.positions[crate, 0]:.3f} m, never nearer to the floor than "
      f"{1e6 * closest:.2f} µm, proven")

# Without the controller: a recorded run, and its proof by other code.
if len(sys.argv) > 1:
    steps = fc.simulate(scene, record=sys.argv[1])
    force = steps[-1].contacts.impulses.sum(axis=0) / steps[-1].lasted
    print(f"At rest the floor carries it with {force[2]:.1f} N")
    print(f"The run is {fc.verify_run(sys.argv[1]).verdict}")
