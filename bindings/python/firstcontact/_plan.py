"""Paths that are proven edge by edge."""

from collections.abc import Callable

from ._check import SceneLike, load_scene
from ._core import EdgeChecker, StopSource
from ._core import plan as _plan
from ._numbers import whole_number
from ._tuples import PlanAnswer

_SEEDS = 2**53
"""Path files hold smaller seeds only: whole numbers that JSON keeps."""
_COUNTS = 2**31
_THREADS = 1025
"""As the tool: at most 1024."""


def plan(scene: SceneLike, *, planner: str | None = None, contacts: str | None = None,
         seed: int | None = None, time: float | None = None, margin: float | None = None,
         tolerance: float | None = None, shortcuts: int = 100, approximate: bool = False,
         threads: int = 0, progress: Callable[[float, int, float | None], object] | None = None,
         stop: StopSource | None = None) -> PlanAnswer:
    """Plans a path of a robot or body to a goal and proves it edge by edge.

    The same path as the tool's ``firstcontact plan``. scene: with ``"plan"``: what moves, from
    where, to where. planner: ``rrt_connect`` or ``lazy_prm_star``; contacts: motion in contact of
    ``rrt_connect`` where an edge is blocked: ``none``, ``sample``, ``slide`` or ``both``; seed: of
    the random numbers, a whole number below 2**53; time: [s] at most; margin, tolerance: [m]; each
    replaces the scene's. progress: called from time to time with the seconds that have passed, the
    number of configurations in the trees, and the length of the best path or None. shortcuts: tries
    to shorten the path. approximate: without a path, one that ends as near to a goal as was
    reached. threads: at most, of the proof; 0 for one on each core; the path does not depend on it.
    stop: ends the search with the best path so far. Other threads run meanwhile. Ctrl-C raises
    KeyboardInterrupt.

    ValueError where a start or all goals are not free, with the pair, its depth and the nearest free
    place that was found.
    """
    if seed is not None:
        seed = whole_number(seed, "seed", _SEEDS)
    return _plan(load_scene(scene), planner=planner, contacts=contacts, seed=seed, time=time,
                 margin=margin, tolerance=tolerance, progress=progress,
                 shortcuts=whole_number(shortcuts, "shortcuts", _COUNTS), approximate=approximate,
                 threads=whole_number(threads, "threads", _THREADS), stop=stop)


__all__ = ["EdgeChecker", "plan"]
