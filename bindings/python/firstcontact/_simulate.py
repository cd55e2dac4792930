"""A whole simulation by one call."""

import contextlib
import os
from collections.abc import Callable

from ._check import SceneLike
from ._core import Simulator, StopSource
from ._run import Run


def _refuse_to_overwrite(scene: SceneLike, record: str | os.PathLike[str]) -> None:
    if (isinstance(scene, (str, os.PathLike)) and os.path.exists(record)
            and os.path.samefile(scene, record)):
        raise ValueError(f"record: {os.fspath(record)} is the scene, which this would overwrite")


def simulate(scene: SceneLike, duration: float | None = None, *, step: float | None = None,
             record: str | os.PathLike[str] | None = None, lenient: bool = False,
             progress: Callable[[float], object] | None = None,
             stop: StopSource | None = None) -> Run:
    """Moves the bodies of a scene under forces and contacts; returns every step, in order, as a Run.

    The same steps as the tool's ``firstcontact simulate``, bit for bit. scene: as Simulator takes
    it. duration, step: [s] in place of the scene's. record: path of a file that grows with every
    step, for ``verify_run``, ``RunReader`` and the tool; what it held before is lost. lenient: as
    of load_scene. progress:
    called after each step with the part that is done, in [0, 1]. stop: ends it early, with the
    steps that are done. Other threads run meanwhile. Ctrl-C raises KeyboardInterrupt; the file
    keeps what is done.
    """
    simulator = Simulator(scene, duration=duration, step=step, lenient=lenient)
    if record is not None:
        _refuse_to_overwrite(scene, record)
    steps = Run(simulator.header_json)
    with contextlib.ExitStack() as stack:
        file = None if record is None else stack.enter_context(open(record, "wb"))

        def keep(line: str) -> None:
            if file:
                file.write(f"{line}\n".encode())
                file.flush()

        keep(simulator.header_json)
        while simulator.step_count < simulator.steps_of_duration:
            done = simulator.step(stop)
            if done is None:
                break
            keep(done.to_json())
            steps.append(done)
            if progress:
                progress(simulator.step_count / simulator.steps_of_duration)
    return steps
