"""Where each notebook lies, and how one links to another."""

from __future__ import annotations

import posixpath
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import TYPE_CHECKING
from urllib.parse import quote

from course.catalog import blocks as b
from course.catalog.markdown import read_blocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["FOLDERS", "NBGRADER", "WORKSPACE", "Layout"]


@dataclass(frozen=True)
class Layout:
    """Where notebooks lie below the folder they are generated into.

    Attributes:
        of_exercise: a path with ``{id}`` and ``{module}`` in it.
    """

    of_exercise: str

    def lesson(self, lesson_id: str) -> PurePosixPath:
        """Where a lesson lies."""
        return PurePosixPath("lessons", f"{lesson_id}.ipynb")

    def exercise(self, exercise: Exercise) -> PurePosixPath:
        """Where an exercise lies."""
        module = exercise.module.removesuffix(".py")
        return PurePosixPath(self.of_exercise.format(id=exercise.id, module=module))

    def links(self, catalog: Catalog, lesson_id: str) -> Callable[[str], str]:
        """A function that turns a lesson's link targets into addresses that work from its notebook."""

        def link(target: str) -> str:
            kind, _, rest = target.partition(":")
            name, _, slug = rest.partition("#")
            if kind == "exercise":
                return _between(self.lesson(lesson_id), self.exercise(catalog.exercise(name)))
            if kind == "lesson":
                return _between(self.lesson(lesson_id), self.lesson(name)) + _anchor(catalog, name, slug)
            if target.startswith("#"):
                return _anchor(catalog, lesson_id, target[1:]) or target
            return target

        return link


#: One folder for lessons and one for exercises, below ``--out``.
FOLDERS = Layout("exercises/{id}.ipynb")
#: In a workspace an exercise's notebook lies beside its module, where it can be handed in.
WORKSPACE = Layout("{id}/{module}.ipynb")
#: Where nbgrader looks for an assignment's source.
NBGRADER = Layout("source/{id}/{module}.ipynb")


def _between(start: PurePosixPath, target: PurePosixPath) -> str:
    return posixpath.relpath(str(target), str(start.parent))


def _anchor(catalog: Catalog, lesson_id: str, slug: str) -> str:
    """JupyterLab's anchor of a heading: its words, joined by hyphens."""
    if not slug:
        return ""
    for block in read_blocks(catalog.content.lessons / f"{lesson_id}.md"):
        if isinstance(block, b.Heading) and b.slug(block) == slug:
            return "#" + quote(b.plain_text(block.inlines).replace(" ", "-"))
    return ""
