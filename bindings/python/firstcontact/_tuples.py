"""What is plain data: pairs of arrays or objects with names."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._words import JointLimit, UndecidedReason

if TYPE_CHECKING:
    from ._core import Motion, Shape


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
