"""The submissions that prove an exercise: its stub, its solution, and the variants of the solution.

A file in ``accepted/`` or ``mutants/`` holds only the definitions that differ. It is appended to the model
solution, so that its definitions win.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.catalog.reading import read_text
from course.errors import ContentError

if TYPE_CHECKING:
    from pathlib import Path

    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = [
    "accepted_files",
    "compose",
    "exercise_graders",
    "instructors",
    "mutant_files",
    "solution_path",
    "solutions_folder",
]


def instructors(catalog: Catalog) -> tuple[Path, Path]:
    """The folders of solutions and of hidden graders.

    Raises:
        MissingCapabilityError: this installation is a student's and has none.
    """
    return catalog.content.instructors()


def solutions_folder(catalog: Catalog, exercise: Exercise) -> Path:
    """Where the solutions of an exercise lie."""
    return instructors(catalog)[0] / exercise.place


def exercise_graders(catalog: Catalog, exercise: Exercise) -> Path:
    """Where the hidden checks of an exercise lie; a warm-up has none."""
    return instructors(catalog)[1] / exercise.place


def solution_path(catalog: Catalog, exercise: Exercise) -> Path:
    """The model solution."""
    return solutions_folder(catalog, exercise) / exercise.module


def accepted_files(catalog: Catalog, exercise: Exercise) -> tuple[Path, ...]:
    """Correct but unusual variants, by name."""
    return tuple(sorted((solutions_folder(catalog, exercise) / "accepted").glob("*.py")))


def mutant_files(catalog: Catalog, exercise: Exercise) -> tuple[Path, ...]:
    """Wrong variants, by name."""
    return tuple(sorted((solutions_folder(catalog, exercise) / "mutants").glob("*.py")))


def compose(solution: Path, variant: Path) -> bytes:
    """The model solution with a variant's definitions put after it.

    Raises:
        ContentError: a file is missing, or the two together are not Python.
    """
    model, own = read_text(solution), read_text(variant)
    if not own.lstrip().startswith(('"""', "#")):
        raise ContentError(
            variant, 1, "the file does not say what is unusual about it.", help="Start it with a docstring."
        )
    whole = f"{model.rstrip()}\n\n\n{own}"
    try:
        compile(whole, str(variant), "exec")
    except (SyntaxError, ValueError) as error:
        above = model.rstrip().count("\n") + 3
        line = getattr(error, "lineno", None)
        raise ContentError(
            variant,
            line - above if line and line > above else None,
            f"the model solution with this appended is not valid Python: {getattr(error, 'msg', error)}.",
            help="Keep only plain definitions in the file; __future__ imports belong into the solution.",
        ) from None
    return whole.encode("utf-8")
