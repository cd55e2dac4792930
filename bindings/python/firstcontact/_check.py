"""Scenes from wherever they come, and questions about them."""

import json
import os
import uuid
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor, Future
from typing import Any, Literal, TypeAlias

import numpy as np

from . import _core
from ._core import (FirstContactResult, ManyBodiesWorkspace, Motion, Result, Scene, SceneSource,
                    Shape, ShapeCache, StopSource)
from ._tuples import MovingShape
from ._words import ContactState

SceneLike: TypeAlias = Scene | str | os.PathLike[str] | Mapping[str, Any]
"""A scene: loaded; the path of its file; or as a dict, whose relative paths begin in the working
directory, and which may hold arrays."""

Pair: TypeAlias = tuple[MovingShape | tuple[Shape, Motion], MovingShape | tuple[Shape, Motion]]
"""Two moving shapes."""

Answer: TypeAlias = Result | FirstContactResult

_CHUNKS_PER_WORKER = 8  # So that a slow chunk at the end keeps few waiting.
_GREATEST_CHUNK = 512


def _plain(value: object) -> object:
    """What JSON has no word for, but people put into scenes."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"scene: expected numbers, text, lists and dicts, got {type(value).__name__}")


def _source(scene: str | os.PathLike[str] | Mapping[str, Any], lenient: bool) -> SceneSource:
    if isinstance(scene, Mapping):
        return SceneSource(json.dumps(scene, default=_plain), "scene", lenient)
    return SceneSource(None, scene, lenient)


def load_scene(scene: SceneLike, shapes: ShapeCache | None = None, *,
               lenient: bool = False) -> Scene:
    """Reads a scene and its meshes.

    shapes: a ShapeCache to share meshes with other scenes. lenient: names in files that no reader
    knows become warnings, even where they could hold or place geometry; by default such names are
    errors. A scene may ask for the same itself. What is loaded already stays as it is.

    FileNotFoundError where there is no such file. ParseError, one line that names file, line and
    key, where it cannot be used.
    """
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, Mapping):
        return _core.parse_scene(json.dumps(scene, default=_plain), "scene", shapes, lenient)
    return _core.read_scene(scene, shapes, lenient)


def load_simulation_scene(scene: SceneLike, *, lenient: bool = False) -> Scene:
    """As load_scene, but a path may be that of a fixture of Rigid IPC."""
    if isinstance(scene, (Scene, Mapping)):
        return load_scene(scene, lenient=lenient)
    return _core.read_simulation_scene(scene, lenient=lenient)


def check(scene: SceneLike, workspace: ManyBodiesWorkspace | None = None, *,
          all_pairs: bool = False, closest: bool = False, all_contacts_in_time: bool = False,
          margin: float | None = None, tolerance: float | None = None,
          deadline: float | None = None, contacts: ContactState | str | int | None = None,
          sample_rate: float | None = None, strict: bool = False, lenient: bool = False, threads: int = 0,
          progress: Callable[[float], object] | None = None,
          stop: StopSource | None = None) -> Result:
    """Finds the first contact in a scene: when, where, or proven never.

    The same answer as the tool's ``firstcontact check``. all_pairs: also the answer of every pair.
    closest: also the closest approach. all_contacts_in_time: also from when to when each pair is in
    contact. margin, tolerance [m], deadline [s], contacts (which are
    listed of each two bodies: a word of ContactState, or so many at most): in place of the scene's.
    sample_rate: [1/s] also what sampling at this rate would have seen. strict: ValueError where a
    robot leaves its joint limits. lenient: as of load_scene. threads: at most; 0 for one on each core; the answer does not
    depend on it. progress: called now and then with the part that is done, in [0, 1]. Other threads
    run meanwhile. Ctrl-C raises KeyboardInterrupt.
    """
    return _core.check(load_scene(scene, lenient=lenient), workspace, all_pairs=all_pairs, closest=closest,
                       all_contacts_in_time=all_contacts_in_time, margin=margin,
                       tolerance=tolerance, deadline=deadline, contacts=contacts,
                       sample_rate=sample_rate, strict=strict, threads=threads, progress=progress, stop=stop)


def _prepared(job: SceneLike | Pair, lenient: bool) -> Scene | SceneSource | Pair:
    """Light to send: a worker reads what there is to read."""
    if isinstance(job, (Scene, tuple)):
        return job
    return _source(job, lenient)


_shapes_of_batch: tuple[uuid.UUID | None, ShapeCache] = (None, ShapeCache())


def _answer_chunk(batch: uuid.UUID, jobs: Sequence[Scene | SceneSource | Pair],
                  question: Mapping[str, Any], stop: StopSource) -> list[Any]:
    """Runs in a worker, by one thread. The chunks of a batch share their meshes."""
    global _shapes_of_batch
    if _shapes_of_batch[0] != batch:
        _shapes_of_batch = (batch, ShapeCache())
    return _core.answer_jobs(jobs, threads=1, shapes=_shapes_of_batch[1], stop=stop, **question)


def _answer_by(executor: Executor, jobs: Sequence[Scene | SceneSource | Pair],
               question: Mapping[str, Any],
               progress: Callable[[float], object] | None) -> list[Any]:
    workers = getattr(executor, "_max_workers", None) or os.cpu_count() or 1
    size = max(1, min(len(jobs) // (_CHUNKS_PER_WORKER * workers), _GREATEST_CHUNK))
    batch = uuid.uuid4()
    stop = StopSource()
    futures: list[Future[list[Any]]] = []
    try:
        for begin in range(0, len(jobs), size):
            futures.append(executor.submit(_answer_chunk, batch, jobs[begin:begin + size], question,
                                           stop))
        answers: list[Any] = []
        for future in futures:
            answers.extend(future.result())
            if progress is not None:
                progress(len(answers) / len(jobs))
        return answers
    except BaseException:
        stop.request_stop()
        for future in futures:
            future.cancel()
        raise


def check_many(jobs: Iterable[SceneLike | Pair], executor: Executor | None = None, *,
               threads: int = 0, all_pairs: bool = False, closest: bool = False,
               all_contacts_in_time: bool = False, margin: float | None = None,
               tolerance: float | None = None, deadline: float | None = None,
               contacts: ContactState | str | int | None = None, strict: bool = False, lenient: bool = False,
               errors: Literal["raise", "return"] = "raise",
               progress: Callable[[float], object] | None = None) -> list[Any]:
    """Answers many jobs, in order: scenes with a Result, pairs with a FirstContactResult.

    jobs: scenes as check takes them, and pairs of moving shapes as first_contact takes them, in any
    mixture. executor: anything with the ``submit`` of concurrent.futures, such as a
    ProcessPoolExecutor or ``dask.distributed.Client.get_executor()``; None for threads of its own,
    at most `threads`, 0 for one on each core. The rest is asked of every job, as by check.

    errors: "raise" raises the first error in the order of jobs, after all of them; "return" puts
    errors in the place of their answers. Mesh files are read once. progress: called now and then
    with the part that is done, in [0, 1]. Ctrl-C raises KeyboardInterrupt.
    """
    if errors not in ("raise", "return"):
        raise ValueError(f'errors: expected "raise" or "return", got {errors!r}')
    prepared = [_prepared(job, lenient) for job in jobs]
    question: dict[str, Any] = {"all_pairs": all_pairs, "closest": closest,
                "all_contacts_in_time": all_contacts_in_time, "margin": margin,
                "tolerance": tolerance, "deadline": deadline, "contacts": contacts, "strict": strict}
    if executor is None:
        answers = _core.answer_jobs(prepared, threads=threads, progress=progress, **question)
    else:
        answers = _answer_by(executor, prepared, question, progress)
    if errors == "raise":
        for answer in answers:
            if isinstance(answer, Exception):
                raise answer
    return answers
