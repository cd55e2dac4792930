"""Trajectories from what people have at hand: dicts and data frames."""

import json
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np

from ._core import Trajectory

_EXPECTED = ("trajectory: expected a Trajectory, the path of one, a dict or a data frame with a column for "
             "the time and one for each joint, or None")


class Columns(Protocol):
    """A data frame, such as those of pandas."""

    @property
    def columns(self) -> Any: ...

    @property
    def index(self) -> Any: ...

    def __getitem__(self, name: Any) -> Any: ...


def _plain(value: object) -> object:
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    raise TypeError(f"trajectory: expected numbers, text, lists and dicts, got {type(value).__name__}")


def _of_columns(columns: Mapping[str, Any]) -> Trajectory:
    """As the columns of a CSV file: the time, NAME, NAME.velocity and NAME.acceleration."""
    times = [name for name in columns if name.lower() in ("time", "t")]
    if len(times) != 1:
        raise ValueError(f'trajectory: expected one column "time" [s], got {len(times)} among {list(columns)}')
    suffixes = (".velocity", ".acceleration")
    joints = [name for name in columns if name != times[0] and not name.endswith(suffixes)]

    def rows(suffix: str) -> np.ndarray[Any, Any] | None:
        names = [joint + suffix for joint in joints]
        there = [name for name in columns if suffix and name.endswith(suffix)]
        if suffix and not there:
            return None
        if suffix and sorted(there) != sorted(names):
            raise ValueError(f'trajectory: expected columns NAME{suffix} of all joints or of none, got {there}')
        return np.column_stack([np.asarray(columns[name], dtype=float) for name in names])

    if not joints:
        raise ValueError("trajectory: expected a column for at least one joint, got none")
    positions = rows("")
    assert positions is not None
    return Trajectory(joints, np.asarray(columns[times[0]], dtype=float), positions, rows(".velocity"),
                      rows(".acceleration"))


def trajectory_from(value: Any) -> Trajectory | str:
    """A trajectory of columns, or the JSON text of one as files have it.

    A data frame without a column for the time has it as its index.
    """
    if isinstance(value, Mapping):
        if "joint_names" in value or "points" in value:
            return json.dumps(dict(value), default=_plain)
        return _of_columns({str(name): column for name, column in value.items()})
    if hasattr(value, "columns") and hasattr(value, "index") and hasattr(value, "__getitem__"):
        columns = {str(name): np.asarray(value[name]) for name in value.columns}
        if not any(name.lower() in ("time", "t") for name in columns):
            columns = {"time": np.asarray(value.index), **columns}
        return _of_columns(columns)
    raise TypeError(f"{_EXPECTED}, got {type(value).__name__}")
