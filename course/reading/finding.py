"""Words in one lesson, or in all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.reading.parts import words_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from course.reading.record import InProgress

__all__ = ["Hit", "find"]

#: Characters shown on each side of what was found.
_BEFORE, _AFTER = 24, 48


@dataclass(frozen=True, slots=True)
class Hit:
    """A block that holds the words: where it is, and what stands round them."""

    lesson: str
    block: int
    section: str
    excerpt: str


def find(progress: InProgress, wanted: str) -> Iterator[Hit]:
    """Where words occur in a lesson, a block at most once; capitals do not matter.

    Text that may answer an open prediction is not searched.
    """
    script = progress.script
    needle = " ".join(wanted.split()).casefold()
    if not needle:
        return
    for index, block in enumerate(script.blocks):
        if progress.closed_by(index) is not None and script.gives_away(index):
            continue
        text = " ".join(words_of(block).split())
        at = text.casefold().find(needle)
        if at >= 0:
            section = script.section_of(index)
            first, last = max(0, at - _BEFORE), at + len(needle) + _AFTER
            excerpt = ("…" if first else "") + text[first:last] + ("…" if last < len(text) else "")
            yield Hit(script.lesson.id, index, section.title if section else "", excerpt)
