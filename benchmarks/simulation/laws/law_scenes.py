"""Scenes of laws.py, what simulates them, and the runs that come of it."""

import json
import math
import pathlib
import subprocess
import sys
import tempfile
import typing

G = 9.81  # [m/s^2]
NEAR = 1e-7  # [m]  A contact distance. A ball rolls on a circle that is larger by half of it.


def body(name, shape, position=(0, 0, 0), **more):
    quaternion = more.pop("quaternion_wxyz", [1, 0, 0, 0])
    return {"name": name, "shape": shape,
            "pose": {"position": list(position), "quaternion_wxyz": quaternion}, **more}


def box(*size):
    return {"box": {"size": list(size)}}


def ball(radius):
    return {"sphere": {"radius": radius}}


def leaning(angle):
    """A turn about y."""
    return [math.cos(0.5 * angle), 0, math.sin(0.5 * angle), 0]


def section(inner, outer, length):
    """Corners of a ring's section: radius and height."""
    return [(inner, -0.5 * length), (outer, -0.5 * length), (outer, 0.5 * length), (inner, 0.5 * length)]


def tube_corners(sides, inner, outer, length):
    """Those of a ring about z of rectangular section, four for each side."""
    return [[r * math.cos(2 * math.pi * k / sides), r * math.sin(2 * math.pi * k / sides), z]
            for k in range(sides) for r, z in section(inner, outer, length)]


def tube(sides, inner, outer, length):
    """A ring about z as a mesh."""
    triangles = []
    for k in range(sides):
        for s in range(4):
            a, b = 4 * k + s, 4 * k + (s + 1) % 4
            d, c = 4 * ((k + 1) % sides) + s, 4 * ((k + 1) % sides) + (s + 1) % 4
            triangles += [[a, d, c], [a, c, b]]
    return {"vertices": tube_corners(sides, inner, outer, length), "triangles": triangles}


def tube_hulls(sides, inner, outer, length):
    """The same ring as convex parts, for engines without meshes that move."""
    corners = tube_corners(sides, inner, outer, length)
    return [[corners[(4 * k + c) % len(corners)] for c in range(8)] for k in range(sides)]


def tube_dynamics(sides, inner, outer, length, density=1000):
    """Mass and moments of the same ring."""
    def polar(radius):  # Of area and of inertia, of a regular polygon.
        area = 0.5 * sides * radius ** 2 * math.sin(2 * math.pi / sides)
        return area, area * radius ** 2 / 6 * (2 + math.cos(2 * math.pi / sides))
    (large, turns), (small, less) = polar(outer), polar(inner)
    mass, along = density * length * (large - small), density * length * (turns - less)
    across = 0.5 * along + mass * length ** 2 / 12
    return {"mass": mass, "centre_of_mass": [0, 0, 0],
            "inertia": [[across, 0, 0], [0, across, 0], [0, 0, along]]}


def scene(bodies, duration, step, friction=0.0, gravity=G, contact_distance=1e-4, **more):
    settings = {"duration": duration, "step": step, "friction": friction, "gravity": [0, 0, -gravity],
                "contact_distance": contact_distance, **more.pop("simulation", {})}
    return {"firstcontact": 1, "bodies": bodies, "simulation": settings, **more}


def turned(quaternion_wxyz, vector):
    w, *axis = quaternion_wxyz

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    twice = [2 * x for x in cross(axis, vector)]
    return [v + w * t + c for v, t, c in zip(vector, twice, cross(axis, twice))]


def energy(state, mass, moments):
    """Of a body in a run, whose centre of mass is its origin."""
    w, *axis = state["quaternion_wxyz"]
    spin = turned([w, *(-x for x in axis)], state["angular_velocity"])
    return (0.5 * mass * sum(v * v for v in state["linear_velocity"]) + mass * G * state["position"][2]
            + 0.5 * sum(m * x * x for m, x in zip(moments, spin)))


class Run:
    """The steps of a run."""

    def __init__(self, lines):
        self.steps = [json.loads(line) for line in lines[1:]]

    def at(self, time):
        return min(self.steps, key=lambda step: abs(step["time"] - time))

    def body(self, number, time=math.inf):
        step = self.steps[-1] if time == math.inf else self.at(time)
        return next(b for b in step["bodies"] if b["body"] == number)

    def energies(self):
        return [step["kinetic_energy"] + step["potential_energy"] for step in self.steps]


class NotForPeer(Exception):
    """The engine has no such scene."""


class Diverged(Exception):
    """The run ends with numbers that are not finite."""


def rest_gap(tool, contact_distance):
    """Where bodies rest: one contact distance apart; peers have none."""
    return contact_distance if tool.is_ours else 0.0


class Tool(typing.NamedTuple):
    """What simulates a scene: ours, or a peer with one of its integrators."""
    program: pathlib.Path
    integrator: str = ""  # Empty: the default.

    @property
    def is_ours(self):
        return not self.program.name.startswith("laws_")

    def command(self):
        if self.is_ours:
            return [self.program, "simulate", "scene.json", "-o", "run.jsonl"]
        return [self.program, "scene.json", "run.jsonl", *([self.integrator] if self.integrator else [])]


def simulate(tool, described, files=()):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        for name, text in files:
            (path / name).write_text(text, encoding="utf-8")
        (path / "scene.json").write_text(json.dumps(described), encoding="utf-8")
        done = subprocess.run(tool.command(), cwd=path, capture_output=True, text=True, check=False)
        if done.returncode == 3 and not tool.is_ours:
            raise NotForPeer
        if done.returncode != 0:
            sys.exit(f"error: {done.stderr or done.stdout}")
        lines = (path / "run.jsonl").read_text(encoding="utf-8").splitlines()
        if "null" in lines[-1] and not tool.is_ours:  # So JSON has numbers that are not finite.
            raise Diverged
        return Run(lines)


# Oracles.

def runge_kutta(rates, state, duration, parts=20000):
    """The state after a duration, by the classical rule of fourth order."""
    h = duration / parts
    for _ in range(parts):
        a = rates(state)
        b = rates([x + 0.5 * h * k for x, k in zip(state, a)])
        c = rates([x + 0.5 * h * k for x, k in zip(state, b)])
        d = rates([x + h * k for x, k in zip(state, c)])
        state = [x + h / 6 * (k + 2 * l + 2 * m + n) for x, k, l, m, n in zip(state, a, b, c, d)]
    return state
