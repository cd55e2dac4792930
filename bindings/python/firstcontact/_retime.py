"""Times for paths, proven as a controller executes them."""

import json
import os
from collections.abc import Mapping
from typing import Any, TypeAlias

from ._check import _plain
from ._core import Scene, StopSource
from ._core import retime as _retime
from ._tuples import PlanAnswer, RetimeAnswer

PathOfRobots: TypeAlias = PlanAnswer | Scene | str | os.PathLike[str] | Mapping[str, Any]
"""A path: the answer of ``plan``; a path file, or a scene whose robot has waypoints as its
trajectory, by its name or as a dict; such a scene, loaded."""

JointLimits: TypeAlias = str | os.PathLike[str] | Mapping[str, Mapping[str, float]]
"""Limits of joints: MoveIt's file; or its ``joint_limits`` as a dict, such as
``{"elbow": {"max_velocity": 1, "max_acceleration": 4, "max_jerk": 200}}``."""


def retime(path: PathOfRobots, *, mode: str = "stop", limits: JointLimits | None = None,
           max_velocity: float | None = None, max_acceleration: float | None = None,
           max_jerk: float | None = None, velocity_scaling: float = 1.0,
           acceleration_scaling: float = 1.0, tracking_error: float | None = None,
           tolerance: float | None = None, blend_deviation: float | None = None,
           which: str | None = None, lenient: bool = False, threads: int = 0,
           stop: StopSource | None = None) -> RetimeAnswer:
    """Times a path of robots within joint limits, and proves what a controller makes of it.

    The same trajectory as that of the tool's ``firstcontact retime``. path: the answer of ``plan``;
    a path file, or a scene whose robot has waypoints as its trajectory; either also as a dict, and
    a scene also loaded. mode: ``stop``: rest at every waypoint, exactly on the path; ``blend``:
    passes waypoints on blends that are proven free; ``time_optimal``: so too, in nearly the least
    time. limits: MoveIt's file of joint limits, or what it has of each joint as a dict. Joints of
    several robots are ROBOT/NAME. max_velocity, max_acceleration, max_jerk: [rad or m; per s, s^2,
    s^3] of joints that have no other limit. velocity_scaling, acceleration_scaling: factors of all
    limits, in (0, 1], as a PlanningRequest of MoveIt has them. tracking_error: [rad or m] of the
    controller, of every joint, in place of the scene's. tolerance: [m] in place of the scene's.
    blend_deviation: [rad or m] how far each joint may leave the path in ``blend`` and
    ``time_optimal``; by default as far as blends gain time. which: the robot, in a scene with
    several. lenient: as load_scene. threads: at most; 0 for one on each core; the answer does not
    depend on it. stop: ends the work, with an undecided answer. Other threads run meanwhile. Ctrl-C
    raises KeyboardInterrupt.

    ValueError where a path, a limit or an option cannot be used; it names the field. A motion that
    is not proven is no error: the answer has the pair and the time in place of the trajectory.
    """
    scene, text, file = None, None, os.fspath("path")
    if isinstance(path, PlanAnswer):
        if path.json is None:
            raise ValueError(f'path: expected a plan with a path, got one whose verdict is "{path.verdict}"')
        text = path.json
    elif isinstance(path, Scene):
        scene = path
    elif isinstance(path, Mapping):
        text = json.dumps(path, default=_plain)
    else:
        file = os.fspath(path)
    is_dict = isinstance(limits, Mapping)
    limits_text = json.dumps({"joint_limits": limits}, default=_plain) if is_dict else None
    limits_file = None if limits is None or isinstance(limits, Mapping) else os.fspath(limits)
    return _retime(scene, text, file, mode=mode, limits_text=limits_text, limits_file=limits_file,
                   max_velocity=max_velocity, max_acceleration=max_acceleration, max_jerk=max_jerk,
                   velocity_scaling=velocity_scaling, acceleration_scaling=acceleration_scaling,
                   tracking_error=tracking_error, tolerance=tolerance,
                   blend_deviation=blend_deviation, which=which, lenient=lenient,
                   threads=threads, stop=stop)


__all__ = ["retime"]
