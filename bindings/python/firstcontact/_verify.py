"""Second proofs of results and paths, by other code than that which made them."""

import os
import pathlib
from collections.abc import Callable

from ._core import Result, StopSource, verify_path_text, verify_result_text
from ._numbers import whole_number
from ._tuples import PathVerification, PlanAnswer, ResultVerification

_THREADS = 1025
"""As the tool: at most 1024."""
_WORK = 2_000_000_000


def verify_result(result: Result | str | os.PathLike[str], *, lenient: bool = False, work: int = _WORK,
                  threads: int = 0, progress: Callable[[float], object] | None = None,
                  stop: StopSource | None = None) -> ResultVerification:
    """Proves the result of a check a second time, by other code.

    As the tool's ``firstcontact verify``. result: an answer of ``check``, or a file with one.
    lenient: unknown names in files are warnings. work: tests of two boxes or triangles for one pair
    and one window of time. threads: at most; 0 for one on each core; the answer does not depend on
    it. progress: called with the share of the time that is proven. stop: ends it ``not_proven``.
    Ctrl-C raises KeyboardInterrupt. ParseError where the file is no result, or where the scene in it
    or a file of that has changed.
    """
    text, source = (result.to_json(), "result") if isinstance(result, Result) else _read(result)
    return verify_result_text(text, source, lenient=lenient, work=whole_number(work, "work", 2**63),
                              threads=whole_number(threads, "threads", _THREADS), progress=progress,
                              stop=stop)


def verify_path(path: PlanAnswer | str | os.PathLike[str], *, lenient: bool = False, work: int = _WORK,
                threads: int = 0, progress: Callable[[float], object] | None = None,
                stop: StopSource | None = None) -> PathVerification:
    """Proves a planned path a second time, edge by edge, by other code.

    path: an answer of ``plan``, or a file with a path. ValueError where the answer has none. The
    rest as of ``verify_result``.
    """
    if isinstance(path, PlanAnswer):
        if path.json is None:
            raise ValueError('path: expected an answer with a path, this one has the verdict "none"')
        text, source = path.json, "path"
    else:
        text, source = _read(path)
    return verify_path_text(text, source, lenient=lenient, work=whole_number(work, "work", 2**63),
                            threads=whole_number(threads, "threads", _THREADS), progress=progress,
                            stop=stop)


def _read(path: str | os.PathLike[str]) -> tuple[str, str]:
    """The text of a file, and its name. What is no UTF-8 is left to the reader to refuse."""
    return pathlib.Path(path).read_text(encoding="utf-8", errors="replace"), os.fspath(path)
