"""The page of ``course grade similar``: one file, no script, nothing from elsewhere."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from course.grading.exports.html_report.rendering import render

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from course.grading.similar.compare import Document, Pair, Similar

    #: First and last line.
    Passage = tuple[int, int]

__all__ = ["page"]

#: Blank lines that style guides put between two functions.
_BLANK = 2


def page(found: Similar) -> str:
    """The whole page."""
    style = Path(__file__).with_name("similar.css").read_text("utf-8")
    return render("similar", scripted=False, more_style=style, found=found, sides=_sides)


def _sides(pair: Pair) -> Iterator[tuple[Document, list[tuple[int, str, bool, list[int]]]]]:
    """Both sources by line: number, text, whether the other has it too, the passages that begin there."""
    blocks = _blocks(pair.passages)
    for side, document in enumerate((pair.first, pair.second)):
        marked = {line for passage in pair.passages for line in _lines(passage[side])}
        begins: dict[int, list[int]] = {}
        for at, block in enumerate(blocks, 1):
            begins.setdefault(block[side][0], []).append(at)
        yield (
            document,
            [
                (number, line.expandtabs(4), number in marked and bool(line.strip()), begins.get(number, []))
                for number, line in enumerate(document.source.splitlines(), 1)
            ],
        )


def _lines(passage: Passage) -> range:
    return range(passage[0], passage[1] + 1)


def _blocks(passages: Iterable[tuple[Passage, Passage]]) -> list[tuple[Passage, Passage]]:
    """Passages that follow each other on both sides, joined into one, as a reader sees them."""
    found: list[tuple[Passage, Passage]] = []
    near: list[int] = []  # of ``found``, those that a passage further down can continue
    for first, second in sorted(passages):
        near = [at for at in near if first[0] <= found[at][0][1] + _BLANK + 1]
        for at in near:
            one, other = found[at]
            if _continues(one, first) and _continues(other, second):
                found[at] = (one[0], max(one[1], first[1])), (other[0], max(other[1], second[1]))
                break
        else:
            near.append(len(found))
            found.append((first, second))
    return found


def _continues(before: Passage, after: Passage) -> bool:
    """Whether one begins within the other, or with no more than blank lines between."""
    return before[0] <= after[0] <= before[1] + _BLANK + 1
