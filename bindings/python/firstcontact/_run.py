"""A whole run: its steps, arrays of them, and the page that plays it."""

import html
import os
import pathlib
from collections.abc import Callable, Iterable

import numpy as np
import numpy.typing as npt

from ._core import RunReader, RunStep, _fill_run_page, _start_of_run
from ._page import frame, template

_Doubles = npt.NDArray[np.float64]


class Run(list[RunStep]):
    """The steps of a simulation in order, with arrays of them and a page.

    k is the number of steps. Arrays over bodies have a row for each body of the scene, then for
    each geometry of robots' links, in the order of names; bodies that a step leaves out stay where
    they are. The files of the scene are read again for those, and for the page.
    """

    def __init__(self, header_json: str, steps: Iterable[RunStep] = ()) -> None:
        super().__init__(steps)
        self._header_json = header_json
        self._start: tuple[tuple[str, ...], _Doubles, _Doubles] | None = None

    @property
    def header_json(self) -> str:
        """The first line of the file of the run, without the line feed."""
        return self._header_json

    @property
    def names(self) -> tuple[str, ...]:
        """Of the bodies, in order."""
        return self._at_start()[0]

    @property
    def times(self) -> _Doubles:
        """[s] (k,), at the end of each step."""
        return self._column(lambda step: step.time)

    @property
    def kinetic_energies(self) -> _Doubles:
        """[J] (k,)"""
        return self._column(lambda step: step.kinetic_energy)

    @property
    def potential_energies(self) -> _Doubles:
        """[J] (k,)"""
        return self._column(lambda step: step.potential_energy)

    @property
    def clearances(self) -> _Doubles:
        """[m] (k,), proven of each step."""
        return self._column(lambda step: step.clearance)

    @property
    def positions(self) -> _Doubles:
        """[m] k×n×3, of the body frames' origins at the end of each step."""
        return self._rows(self._at_start()[1], lambda step: step.positions)

    @property
    def quaternions_wxyz(self) -> _Doubles:
        """[-] k×n×4, of the body frames at the end of each step."""
        return self._rows(self._at_start()[2], lambda step: step.quaternions_wxyz)

    @property
    def linear_velocities(self) -> _Doubles:
        """[m/s] k×n×3, of the centres of mass; 0 of bodies that rest."""
        return self._rows(np.zeros_like(self._at_start()[1]), lambda step: step.linear_velocities)

    @property
    def angular_velocities(self) -> _Doubles:
        """[rad/s] k×n×3, world axes; 0 of bodies that rest."""
        return self._rows(np.zeros_like(self._at_start()[1]), lambda step: step.angular_velocities)

    def to_html(self) -> str:
        """The page that plays this run: one file that needs nothing else.

        As ``firstcontact simulate --html`` makes it. FileNotFoundError where the package was built
        without it; ValueError where there is nothing to play.
        """
        return _fill_run_page(self._header_json, self, template())

    def save_html(self, path: str | os.PathLike[str]) -> None:
        """Writes to_html() to a file."""
        pathlib.Path(path).write_text(self.to_html(), encoding="utf-8")

    def _repr_html_(self) -> str:
        try:
            return frame("Run", self.to_html())
        except (FileNotFoundError, ValueError):
            return f"<code>{html.escape(repr(self))}</code>"

    def __repr__(self) -> str:
        return f"<Run of {len(self)} steps, {self[-1].time if self else 0.0:.6g} s>"

    def _at_start(self) -> tuple[tuple[str, ...], _Doubles, _Doubles]:
        if self._start is None:
            self._start = _start_of_run(self._header_json)
        return self._start

    def _column(self, of: Callable[[RunStep], float]) -> _Doubles:
        return np.array([of(step) for step in self], dtype=np.float64)

    def _rows(self, start: _Doubles, of: Callable[[RunStep], _Doubles]) -> _Doubles:
        all_rows = np.empty((len(self), *start.shape))
        now = start.copy()
        for row, step in zip(all_rows, self, strict=True):
            now[step.bodies] = of(step)
            row[:] = now
        return all_rows


def read_run(path: str | os.PathLike[str]) -> Run:
    """Reads a whole recorded run back; RunReader holds one step at a time.

    ParseError, one line that names file and line, where the file is no run.
    """
    reader = RunReader(path)
    return Run(reader.header_json, reader)
