"""Which notebooks there are, and how each is generated."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import PurePosixPath
from typing import TYPE_CHECKING

from course.errors import NotFoundError
from course.notebooks.building.layout import FOLDERS, Layout

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from course.catalog.load import Catalog

    Makers = dict[tuple[str, str], tuple[PurePosixPath, Callable[[], bytes]]]

__all__ = ["QUIZ", "SANDBOX", "Generated", "generate"]

QUIZ, SANDBOX = "quiz", "sandbox"


@dataclass(frozen=True)
class Generated:
    """One notebook.

    Attributes:
        kind: "lesson", "exercise", "quiz" or "sandbox".
        id: of the lesson or exercise; else the kind again.
        path: relative to the folder that notebooks go into.
        data: the file.
    """

    kind: str
    id: str
    path: PurePosixPath
    data: bytes


def generate(catalog: Catalog, ids: Sequence[str] = (), layout: Layout = FOLDERS) -> Iterator[Generated]:
    """The notebooks of a course.

    Args:
        ids: of lessons and exercises, "quiz" or "sandbox"; an id shared by a lesson and an exercise gives
            both; none gives everything.

    Raises:
        NotFoundError: there is nothing of that id.
        ContentError: a file of the course is wrong.
    """
    makers = _makers(catalog, layout)
    for wanted in ids:
        if not any(wanted == name for _, name in makers):
            raise _unknown(wanted, [name for _, name in makers])
    for (kind, name), (path, make) in makers.items():
        if not ids or name in ids:
            yield Generated(kind, name, path, make())


def _makers(catalog: Catalog, layout: Layout) -> Makers:
    """By kind and id: where a notebook lies and what makes it. Content is read only when asked for."""
    from course.notebooks.building.exercises import exercise_notebook
    from course.notebooks.quiz import quiz_notebook
    from course.notebooks.sandbox import sandbox_notebook

    makers: Makers = {}
    for name in catalog.lesson_ids():
        make = partial(_lesson, catalog, name, layout)
        makers["lesson", name] = layout.lesson(name), make
    for exercise in catalog.exercises():
        make = partial(exercise_notebook, catalog, exercise)
        makers["exercise", exercise.id] = layout.exercise(exercise), make
    if any(catalog.content.quiz.glob("*.toml")):
        makers[QUIZ, QUIZ] = PurePosixPath("quiz.ipynb"), partial(quiz_notebook, catalog)
    makers[SANDBOX, SANDBOX] = PurePosixPath("sandbox.ipynb"), partial(sandbox_notebook, catalog)
    return makers


def _lesson(catalog: Catalog, lesson_id: str, layout: Layout) -> bytes:
    from course.notebooks.building.lessons import lesson_notebook

    return lesson_notebook(catalog, catalog.lesson(lesson_id), layout)


def _unknown(wanted: str, known: Sequence[str]) -> NotFoundError:
    import difflib

    names = list(dict.fromkeys(known))
    close = difflib.get_close_matches(wanted, names, n=3, cutoff=0.5)
    return NotFoundError(
        f"There is no lesson and no exercise called {wanted[:80]!r}.",
        help=f"Did you mean {' or '.join(close)}?" if close else f"There are: {', '.join(names)}.",
        code="notebook_not_found",
    )
