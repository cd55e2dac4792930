"""How does your own planner use proven edges? A plate goes through a window in a wall 10 micrometres thick."""

import firstcontact as fc
import numpy as np

HALF = 0.2  # [m]  Half of the width of the window; the plate has 0.1 m on each side of its middle.


def beam(name: str, y: tuple, z: tuple) -> dict:
    """Returns a box that is a part of the wall x = 0."""
    return {"name": name, "shape": {"box": {"size": [1e-5, y[1] - y[0], z[1] - z[0]]}},
            "pose": {"position": [0, sum(y) / 2, sum(z) / 2]}}


scene = {
    "firstcontact": 1,
    "bodies": [
        beam("left", (-2, -HALF), (-2, 2)), beam("right", (HALF, 2), (-2, 2)),
        beam("under", (-HALF, HALF), (-2, -HALF)), beam("over", (-HALF, HALF), (HALF, 2)),
        {"name": "plate", "shape": {"box": {"size": [0.004, 0.2, 0.2]}}, "pose": {"position": [-0.8, 0.7, 0.5]}},
    ],
    "plan": {"body": "plate", "goal": {"position": [0.8, -0.7, 0.5]}, "box": [[-1, -1, -1], [1, 1, 1]]},
}
edges = fc.EdgeChecker(fc.load_scene(scene))
start, goal = edges.start[:3], edges.goals[0, :3]
random = np.random.default_rng(1)


def poses(places: np.ndarray) -> np.ndarray:
    """Returns poses of the plate, which does not turn."""
    return np.hstack([places, np.tile([1.0, 0, 0, 0], (len(places), 1))])


def check(places: np.ndarray, further: np.ndarray) -> fc.EdgeAnswers:
    return edges.check(poses(places), poses(further))


# For comparison: a planner that samples 100 configurations of each edge.
steps = np.linspace(start, goal, 100)
seen = (edges.clearance(poses(steps)) > 0).all()
print(f"straight on: 100 configurations {'are free' if seen else 'are not free'}, "
      f"the edge is proven to {check(start[None], goal[None]).fraction[0]:.4f} of its length")

# Each round adds one edge for each sample. One call checks all edges of a round.
places, parents = start[None], [-1]
reached = None
while reached is None:
    samples = random.uniform(-1, 1, (64, 3))
    samples[0] = goal
    near = np.linalg.norm(samples[:, None] - places[None], axis=2).argmin(axis=1)
    way = samples - places[near]
    way *= np.minimum(1, 0.4 / np.linalg.norm(way, axis=1))[:, None]
    # A little less than the proven part of the edge.
    share = check(places[near], places[near] + way).fraction
    share[share < 1] *= 0.95
    kept = share * np.linalg.norm(way, axis=1) > 1e-3
    parents += near[kept].tolist()
    places = np.vstack([places, places[near[kept]] + share[kept, None] * way[kept]])
    ends = check(places, np.tile(goal, (len(places), 1))).free
    reached = int(ends.argmax()) if ends.any() else None

path = [goal]
while reached != -1:
    path.append(places[reached])
    reached = parents[reached]
path = np.array(path[::-1])

# Leave out waypoints that a proven edge can skip.
for _ in range(50):
    a, b = sorted(random.integers(0, len(path), 2))
    if b > a + 1 and check(path[a:a + 1], path[b:b + 1]).free[0]:
        path = np.vstack([path[:a + 1], path[b:]])

proof = check(path[:-1], path[1:])
length = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
print(f"a tree of {len(places)} places has a path of {len(path) - 1} edges and {length:.2f} m")
print("all are proven" if proof.free.all() else "not all are proven")
