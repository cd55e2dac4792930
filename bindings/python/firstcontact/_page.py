"""The page that plays a result or a run: what their methods call."""

import errno
import html
import os
import pathlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._core import Result

TEMPLATE = pathlib.Path(__file__).with_name("viewer.html")


def template() -> str:
    """The page without its data."""
    if not TEMPLATE.is_file():
        raise FileNotFoundError(
            errno.ENOENT, "the package was built without its page; build it with "
            "CMAKE_ARGS=-DFIRSTCONTACT_BUILD_VIEWER=ON (needs npm)", str(TEMPLATE))
    return TEMPLATE.read_text(encoding="utf-8")


def frame(title: str, page: str) -> str:
    """A page inside a notebook."""
    return (f'<iframe title="{html.escape(title)}" style="width: 100%; height: 600px; border: 0" '
            f'allow="fullscreen" srcdoc="{html.escape(page)}"></iframe>')


def to_html(result: "Result") -> str:
    """The page as text."""
    return result._fill_page(template())


def save_html(result: "Result", path: str | os.PathLike[str]) -> None:
    """The page as a file."""
    pathlib.Path(path).write_text(to_html(result), encoding="utf-8")


def notebook_view(result: "Result") -> str:
    """The page inside a notebook; a line of text where the package has no page."""
    if not TEMPLATE.is_file():
        return f"<code>{html.escape(repr(result))}</code>"
    return frame(result.id or "Result", to_html(result))
