"""What an answer is about: its files and its pairs."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ._tuples import Mesh

_SUSPICIOUS = 100.0  # [m]


@dataclass(frozen=True)
class LeftOut:
    """Something that a reader passed over, and why it can make no contact."""

    name: str
    """As the file has it."""
    reason: str
    count: int


class FileReport(NamedTuple):
    """What became of a file. Nothing of it that could make a contact is missing here."""

    path: str
    format: str
    contents: Mapping[str, int]
    """What was taken: of each kind how many, such as {"triangles": 12}."""
    unit: str
    """Of lengths; empty where the format has none: metres are taken."""
    left_out: tuple[LeftOut, ...]
    warnings: tuple[str, ...]
    also_read: tuple[str, ...]
    """Paths of files that belong to it."""


@dataclass(frozen=True)
class UntestedPairs:
    """Pairs that are not looked at for one reason."""

    why: str
    """Ignored: "joined_links", "srdf", "allowed_collisions", "held", "rule". Left out: "both_rest",
    "both_scripted"."""
    count: int
    first: tuple[tuple[str, str], ...]
    """The first few."""


class PairCounts(NamedTuple):
    """Which pairs of bodies and links an answer is about; each counts once."""

    tested: int
    ignored: int
    """By what the scene and its robots say."""
    left_out: int
    """By the kind of question."""
    untested: tuple[UntestedPairs, ...]


class MeshReading(NamedTuple):
    """A mesh and what became of its file."""

    mesh: Mesh
    report: FileReport

    def __repr__(self) -> str:
        return _describe(self.report, self.mesh.vertices)


class PointReading(NamedTuple):
    """The points of a cloud, [m] n×3, and what became of their file."""

    points: npt.NDArray[np.float64]
    report: FileReport

    def __repr__(self) -> str:
        return _describe(self.report, self.points)


def _describe(report: FileReport, points: npt.NDArray[np.float64]) -> str:
    contents = ", ".join(f"{count} {what}" for what, count in report.contents.items())
    size = float(np.max(np.ptp(points, axis=0))) if len(points) else 0.0
    question = ("; is its unit right? scale=0.001 reads it in millimetres"
                if size >= _SUSPICIOUS else "")
    warnings = f"; {len(report.warnings)} warnings" if report.warnings else ""
    return (f"<{report.format} {report.path!r}: {contents}, {size:.6g} m across"
            f"{question}{warnings}>")


def file_reports(text: str) -> tuple[FileReport, ...]:
    """From "files" of a result."""
    return tuple(_file_report(report) for report in json.loads(text))


def _file_report(report: Mapping[str, Any]) -> FileReport:
    return FileReport(
        path=report["path"], format=report["format"],
        contents={content["what"]: content["count"] for content in report["contents"]},
        unit=report.get("unit", ""),
        left_out=tuple(LeftOut(**left_out) for left_out in report.get("left_out", ())),
        warnings=tuple(report.get("warnings", ())), also_read=tuple(report.get("also_read", ())))


def pair_counts(text: str) -> PairCounts:
    """From "pair_counts" of a result."""
    counts = json.loads(text)
    untested = tuple(
        UntestedPairs(pairs["why"], pairs["count"], tuple((one, other) for one, other in pairs["first"]))
        for pairs in counts["untested"])
    return PairCounts(counts["tested"], counts["ignored"], counts["left_out"], untested)


def mesh_reading(mesh: Mesh, text: str) -> MeshReading:
    return MeshReading(mesh, file_reports(text)[0])


def point_reading(points: npt.NDArray[np.float64], text: str) -> PointReading:
    return PointReading(points, file_reports(text)[0])
