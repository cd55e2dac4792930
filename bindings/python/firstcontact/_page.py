"""The page that plays a result: what the methods of Result call."""

import errno
import html
import os
import pathlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._core import Result

TEMPLATE = pathlib.Path(__file__).with_name("viewer.html")


def to_html(result: "Result") -> str:
    """The page as text."""
    if not TEMPLATE.is_file():
        raise FileNotFoundError(
            errno.ENOENT, "the package was built without its page; build it with "
            "CMAKE_ARGS=-DFIRSTCONTACT_BUILD_VIEWER=ON (needs npm)", str(TEMPLATE))
    return result._fill_page(TEMPLATE.read_text(encoding="utf-8"))


def save_html(result: "Result", path: str | os.PathLike[str]) -> None:
    """The page as a file."""
    pathlib.Path(path).write_text(to_html(result), encoding="utf-8")


def notebook_view(result: "Result") -> str:
    """The page inside a notebook; a line of text where the package has no page."""
    if not TEMPLATE.is_file():
        return f"<code>{html.escape(repr(result))}</code>"
    title = html.escape(result.id or "Result")
    return (f'<iframe title="{title}" style="width: 100%; height: 600px; border: 0" '
            f'allow="fullscreen" srcdoc="{html.escape(to_html(result))}"></iframe>')
