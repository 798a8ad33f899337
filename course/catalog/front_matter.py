"""The head of a lesson file: TOML between two ``+++`` lines, the Markdown below it."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from course.errors import ContentError

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["FrontMatter", "split_front_matter"]

_FENCE = "+++"


class FrontMatter(NamedTuple):
    """A lesson file in its two parts.

    Attributes:
        toml: the front matter, without its fences.
        body: the Markdown below it.
        body_line: the line of the file that the body starts on, counted from 1.
    """

    toml: str
    body: str
    body_line: int


def split_front_matter(text: str, file: Path) -> FrontMatter:
    """Part a lesson's TOML head from its Markdown body.

    Args:
        text: the whole file.
        file: where it came from, for the message.

    Raises:
        ContentError: the file does not start with a front matter between two ``+++`` lines.
    """
    lines = text.splitlines()
    help_ = f"Start the file with {_FENCE}, the TOML keys of a lesson, and {_FENCE} on a line of its own."
    if not lines or lines[0].rstrip() != _FENCE:
        raise ContentError(
            file, 1, f"the front matter is missing: the first line is not {_FENCE}", help=help_
        )
    end = next((i for i, line in enumerate(lines[1:], start=1) if line.rstrip() == _FENCE), None)
    if end is None:
        raise ContentError(file, 1, f"the front matter has no closing {_FENCE}", help=help_)
    return FrontMatter("\n".join(lines[1:end]), "\n".join(lines[end + 1 :]) + "\n", end + 2)
