"""What is plain data: pairs of arrays or objects with names."""

import os
import pathlib
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._words import JointLimit, JointType, ProofVerdict, Turning, UndecidedReason

if TYPE_CHECKING:
    from ._core import Feature, Motion, Pose, Shape, Trajectory
    from ._reports import PairCounts


class Mesh(NamedTuple):
    """Triangles over shared vertices, in the body frame.

    A soup is legal: open, non-manifold, doubled, degenerate. Wherever a mesh is asked for, any
    pair of such arrays will do, as ``(tri.vertices, tri.faces)``.
    """

    vertices: npt.NDArray[np.float64]
    """[m]  n×3, one point per row."""
    triangles: npt.NDArray[np.uint32]
    """m×3, rows of ``vertices``."""


class MovingShape(NamedTuple):
    """A shape and its motion over the step; a plain pair of these will do as well."""

    shape: "Shape"
    X_WS: "Motion"
    """Pose of the shape in the world at each t in [0, 1]."""


class HeightMap(NamedTuple):
    """Heights over a regular grid in the plane z = 0 whose first sample is at the origin."""

    cell: Any
    """[m]  Distances of neighbouring samples along x and y."""
    heights: npt.NDArray[np.float64]
    """[m]  rows×columns, at least 2×2; row i is at y = i cell[1], column k at x = k cell[0]."""


class GapSamples(NamedTuple):
    """The least distance of all pairs of a scene at some times."""

    t: npt.NDArray[np.float64]
    """[-]  n times, normalised to the scene's duration."""
    distance: npt.NDArray[np.float64]
    """[m]  n distances; 0 where two surfaces meet, infinite where no pair is tested."""
    lower_bound: npt.NDArray[np.float64]
    """[m]  Proven at each t; ``distance`` less its rounding error."""


class GapPoints(NamedTuple):
    """A polyline that the gap of a scene is proven not to be below, at any time."""

    t: npt.NDArray[np.float64]
    """[-]  n times, normalised to the scene's duration."""
    distance: npt.NDArray[np.float64]
    """[m]  n bounds."""


class ContactInterval(NamedTuple):
    """A stretch of time in which a pair is in contact; outside of its intervals it is proven free.

    Gaps of less than 2 ms of a step of 1 s may be counted to the interval around them.
    """

    enter: float
    """[-]  Within margin + tolerance here, proven free before."""
    leave: float
    """[-]  Proven free after it, until the next interval."""
    enter_time: float
    """[s]"""
    leave_time: float
    """[s]"""
    reason: UndecidedReason
    """Not ``none``: not searched to its end, nothing is known in it after ``enter``."""


class LimitViolation(NamedTuple):
    """A joint beyond one of its limits; rad or m, per second for velocities."""

    robot: str
    joint: str
    limit: JointLimit
    value: float
    """The limit, as the robot's model has it."""
    excess: float
    """The greatest way beyond it."""
    time: float
    """[s]  Where that is attained."""
    intervals: npt.NDArray[np.float64]
    """[s]  n×2, begins and ends: outside of them the limit is proven to be kept."""


class JointTurn(NamedTuple):
    """Which way a continuous joint, or the angle of a planar one, went along its trajectory."""

    robot: str
    joint: str
    """As trajectories name the coordinate."""
    start: float
    """[rad]  As the first point has it."""
    end: float
    """[rad]  As the last point has it."""
    turned: float
    """[rad]  From the first point to the last, whole turns included."""
    turning: Turning
    """Between the points."""


class Mimic(NamedTuple):
    """A joint's coordinate is that of another one, times ``multiplier``, plus ``offset``."""

    joint: str
    multiplier: float
    """[-]"""
    offset: float
    """[rad or m]"""


class Joint(NamedTuple):
    """Connects a child link to its parent. Limits in rad, or in m for prismatic joints."""

    name: str
    type: JointType
    parent: str
    child: str
    pose: "Pose"
    """Of the joint frame in the parent; the child's frame where the coordinates are 0."""
    axis: npt.NDArray[np.float64]
    """[-]  (3,), in the joint frame, any length but zero."""
    lower: float | None
    upper: float | None
    velocity: float | None
    """Per second."""
    effort: float | None
    """[N m or N]"""
    mimic: Mimic | None


class RobotGroup(NamedTuple):
    """A named part of a robot."""

    links: tuple[str, ...]
    joints: tuple[str, ...]


class EndEffector(NamedTuple):
    """A group that serves as a tool, on a link of another."""

    group: str
    parent_link: str


class RobotSemantics(NamedTuple):
    """What an SRDF says of a robot."""

    path: str
    """Of its file."""
    disabled: tuple[tuple[str, str], ...]
    """Pairs of links that are not tested."""
    groups: dict[str, RobotGroup]
    states: dict[str, dict[str, float]]
    """Named configurations, as GROUP/STATE: positions by coordinate."""
    end_effectors: dict[str, EndEffector]
    warnings: tuple[str, ...]
    """Lines that name what the robot does not have; they have no effect."""


class PlanningRequest(NamedTuple):
    """From where to where, as a MoveIt request says it."""

    start: dict[str, float]
    """Positions by coordinate."""
    goal: dict[str, float]
    base: "Pose"
    """Of the robot, where the start says it."""
    warnings: tuple[str, ...] = ()
    """What a user should know of the file, such as positions of fixed joints."""
    velocity_scaling: float = 1.0
    """[-]  Factor of the velocity limits; in (0, 1]."""
    acceleration_scaling: float = 1.0
    """[-]  Factor of the acceleration limits; in (0, 1]."""
    planning_time: float | None = None
    """[s]  Most time of a planner, > 0; None where it is not set."""


class RunContacts(NamedTuple):
    """The m contacts that acted at the end of a step of a simulation, one a row."""

    bodies: npt.NDArray[np.int64]
    """m×2, numbers of the first and the second body."""
    points: npt.NDArray[np.float64]
    """[m]  m×3, in the world, between the two surfaces."""
    normals: npt.NDArray[np.float64]
    """[-]  m×3, from the first to the second body."""
    distances: npt.NDArray[np.float64]
    """[m]  (m,)"""
    impulses: npt.NDArray[np.float64]
    """[N s]  m×3, on the second body, over the step."""
    features: "tuple[tuple[Feature, Feature], ...]"
    """Of the first and the second body."""


class RunImpacts(NamedTuple):
    """The m places at which impacts within a step of a simulation acted, one a row, in the order of time."""

    times: npt.NDArray[np.float64]
    """[s]  (m,), since the step began."""
    bodies: npt.NDArray[np.int64]
    """m×2, numbers of the first and the second body."""
    points: npt.NDArray[np.float64]
    """[m]  m×3, in the world, between the two surfaces."""
    impulses: npt.NDArray[np.float64]
    """[N s]  m×3, on the second body."""


class RunTies(NamedTuple):
    """The mean forces of the m ties of a scene over a step of a simulation, one a row.

    Impacts are not among them.
    """

    forces: npt.NDArray[np.float64]
    """[N]  m×3, on the second body of each."""
    torques: npt.NDArray[np.float64]
    """[N m]  m×3, likewise; those of springs, cables and pins are 0."""


class RunDevices(NamedTuple):
    """The devices of the m tools of a haptic run as a step begins, one a row; no rows in simulations."""

    bodies: npt.NDArray[np.int64]
    """(m,), numbers of the tools."""
    positions: npt.NDArray[np.float64]
    """[m]  m×3, of the frame of each tool where its device leads it."""
    quaternions_wxyz: npt.NDArray[np.float64]
    """[-]  m×4, of that frame."""
    forces: npt.NDArray[np.float64]
    """[N]  m×3, on each device at the centre of its tool there."""
    torques: npt.NDArray[np.float64]
    """[N m]  m×3, on each device about that centre."""


class EdgeAnswers(NamedTuple):
    """The answers about edges, in their order."""

    free: npt.NDArray[np.bool_]
    """Whether each is proven free over its whole length."""
    undecided: npt.NDArray[np.bool_]
    """Whether the effort was spent on it; then it is not free either."""
    fraction: npt.NDArray[np.float64]
    """So far each is proven free: up to its start plus this share of it, rounded."""
    clearance: npt.NDArray[np.float64]
    """[m]  Proven lower bound of the distance of all tested pairs until there; NaN without pairs."""


class PlanAnswer(NamedTuple):
    """A path that is proven edge by edge, or none."""

    verdict: str
    """``proven``; ``approximate``: so too, but it ends before a goal; ``none``."""
    waypoints: npt.NDArray[np.float64]
    """n×d: a waypoint per row, from the start on; no rows without a path."""
    times: npt.NDArray[np.float64]
    """[s]  (n,): time of each waypoint, where other bodies or robots move; else (0,)."""
    clearance: npt.NDArray[np.float64]
    """[m]  Of each edge: proven lower bound of the distance of all tested pairs."""
    cost: float
    """The length of the path, in rad and m alike; of a body in m."""
    goal: int | None
    """At which goal it ends."""
    distance_to_goal: float
    """Of its end, by the same length."""
    blocked: tuple[tuple[str, str, int], ...]
    """Pairs, and how many edges and configurations each blocked; the most frequent first."""
    warnings: tuple[str, ...]
    json: str | None
    """The path file, as the tool's ``firstcontact plan -o`` writes it."""


class RetimedMoment(NamedTuple):
    """Two bodies or links at a time of a trajectory."""

    time: float
    """[s]"""
    pair: tuple[str, str]
    """Their names."""
    distance: float | None
    """[m]  Of the closest approach."""


class HeldPair(NamedTuple):
    """A contact pair of a path, and what it keeps for a while in place of its margin."""

    pair: tuple[str, str]
    """Their names."""
    distance: float
    """[m]  They are farther apart, proven if the trajectory is."""
    start: float
    """[s]  Of the trajectory."""
    end: float
    """[s]"""


class RateUse(NamedTuple):
    """The greatest size of a rate of a joint over a whole trajectory; rad or m, per s, s^2, s^3."""

    joint: str
    rate: str
    """``velocity``, ``acceleration`` or ``jerk``."""
    limit: float
    attained: float
    """The trajectory has this size, or more, at ``time``."""
    bound: float
    """Proven: no greater size at any time. Infinite where it jumps."""
    time: float
    """[s]"""


class RetimeAnswer(NamedTuple):
    """A trajectory that is proven as its controller executes it, or what is in the way of one."""

    verdict: str
    """``proven``; ``refused``: a contact or a limit is in the way; ``undecided``."""
    mode: str
    """That of the trajectory: ``stop`` where no blend is proven and faster."""
    trajectory: "Trajectory | None"
    """Joint names, and arrays of times, positions, velocities and accelerations; if proven."""
    duration: float
    """[s]"""
    stop_duration: float
    """[s]  With rest at every waypoint."""
    blends: int
    """Waypoints that are passed without rest."""
    shortened: int
    """Times that a blend was made shorter, as it was not free."""
    left_out: int
    """Waypoints that edges of the motion pass closely, without a blend."""
    closest: RetimedMoment | None
    """The closest approach, if proven; None where no pair is tested."""
    held: tuple[HeldPair, ...]
    """Pairs that are in contact at an end of the path."""
    rates: tuple[RateUse, ...]
    """Of each joint, and of each rate that is limited."""
    contact: RetimedMoment | None
    """The first contact, or what is undecided; else None."""
    limits: tuple[LimitViolation, ...]
    """Positions beyond the limits of robots."""
    warnings: tuple[str, ...]
    yaml: str | None
    """The file for a controller, a trajectory_msgs/JointTrajectory; proven as it is read back."""
    json: str | None
    """The same message as JSON, proven so too."""
    csv: str | None
    """A table, proven so too: a line for each point."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the file for a controller: .yaml, .json or .csv.

        ValueError where nothing is proven, or the name has another ending.
        """
        ending = pathlib.Path(path).suffix.lower()
        texts = {".yaml": self.yaml, ".yml": self.yaml, ".json": self.json, ".csv": self.csv}
        if ending not in texts:
            raise ValueError(f"path: expected a name that ends in .yaml, .json or .csv, got {os.fspath(path)!r}")
        text = texts[ending]
        if text is None:
            raise ValueError(f'the verdict is "{self.verdict}": a motion that is not proven is not written')
        pathlib.Path(path).write_text(text, encoding="utf-8")


class RunMoment(NamedTuple):
    """Two bodies at a moment of a run."""

    step: int
    """From 1."""
    time: float
    """[s]  Since the run began."""
    bodies: tuple[str, str]
    """Their names."""
    distance: float
    """[m]  At most so far apart."""


class RunVerification(NamedTuple):
    """What is proven of a recorded run."""

    verdict: ProofVerdict
    problem: str
    """One sentence; empty where the run is proven."""
    problem_at: RunMoment | None
    """Of ``refuted`` and ``not_proven``, where there is one."""
    steps: int
    """Verified; those up to the problem where there is one."""
    time: float
    """[s]  At the end of these."""
    time_lost: float
    """[s]  In all of them."""
    least_distance: float
    """[m]  Proven of these steps; infinite where no pair can touch."""
    closest: RunMoment | None
    """Where bodies come about as close as that."""
    greatest_jump: float
    """[m]  From the end of a piece to the begin of the next."""
    scripted_deviation: float
    """[m]  The greatest of a scripted body from its motion in the scene."""
    greatest_behind: float
    """[s]  No scripted body is behind its motion by more: it waited."""
    is_cut_off: bool
    """Whether the file ends in the middle of a line, which was left out."""
    pair_counts: "PairCounts"
    """What the proof is about: pairs of which one is free."""
    warnings: tuple[str, ...]
    """Of reading the scene's files."""


class ProofMoment(NamedTuple):
    """Two bodies or links over a stretch of time."""

    pair: tuple[str, str]
    """Their names."""
    begin: float
    """[-]  Of the duration of the scene; of a path within the edge."""
    end: float
    distance: float | None
    """[m]  At most so far apart, where that is known."""


class ResultVerification(NamedTuple):
    """What is proven of a result."""

    verdict: ProofVerdict
    problem: str
    """One sentence; empty where all is proven."""
    problem_at: ProofMoment | None
    """Of ``refuted`` and ``not_proven``, where there is one."""
    t: float
    """[-]  The claim: free before it."""
    time: float
    """[s]"""
    left_open: float
    """[-]  All but the last so much before t is proven to be free."""
    contact_distance: float | None
    """[m]  Where a contact is proven: at t the pair is at most so far apart."""
    tolerance: float
    """[m]  Of the contacts, as the result states it."""
    contacts: int
    """Pairs that are proven to be in contact."""
    has_digests: bool
    """Else it is not known whether a file or the scene has changed."""
    pair_counts: "PairCounts"
    """Which pairs the proof is about."""
    warnings: tuple[str, ...]
    """Of reading the scene's files."""


class PathVerification(NamedTuple):
    """What is proven of a planned path."""

    verdict: ProofVerdict
    problem: str
    """One sentence; empty where all is proven."""
    problem_at: ProofMoment | None
    """The pair that is left open or too close."""
    problem_edge: int | None
    """From 0."""
    edges: int
    """Proven, from the start on."""
    reaches_goal: bool
    """The last waypoint is a goal; else the path is approximate."""
    tested: int
    """Pairs of which one moves along edges."""
    warnings: tuple[str, ...]
    """Of reading the scene's files."""
