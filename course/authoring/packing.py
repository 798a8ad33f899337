"""Puts model solutions into the file that an instructor hands out."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path

from course.authoring.exercises.grading import instructors, solution_path, solutions_folder
from course.catalog.load import Catalog
from course.catalog.pack import pack_bytes
from course.errors import ContentError, UsageError


def write_pack(catalog: Catalog, exercise_ids: Sequence[str], output: Path) -> dict[str, tuple[str, ...]]:
    """Write a pack with the model solution, and its prose if there is any, of each exercise.

    Args:
        exercise_ids: at least one; one that is named twice goes in once.
        output: must not exist; it appears whole or not at all.

    Returns:
        The names of the files that went in, by exercise.

    Raises:
        NotFoundError: there is no such exercise.
        UsageError: no exercise is named, or ``output`` cannot be written.
        MissingCapabilityError: this installation has no solutions.
    """
    instructors(catalog)
    if output.exists():
        raise UsageError(
            f"{output} exists, and nothing is overwritten.", help="Name another file with -o.", code="exists"
        )
    solutions = {exercise_id: _files(catalog, exercise_id) for exercise_id in exercise_ids}
    data = pack_bytes(catalog.course_id, catalog.version, solutions)
    _write_whole(output, data)
    return {exercise_id: tuple(sorted(files)) for exercise_id, files in solutions.items()}


def _files(catalog: Catalog, exercise_id: str) -> dict[str, bytes]:
    exercise = catalog.exercise(exercise_id)
    paths = [solution_path(catalog, exercise), solutions_folder(catalog, exercise) / "README.md"]
    if not paths[0].is_file():
        raise ContentError(paths[0], None, "the model solution is missing.", help="Write it first.")
    return {path.name: path.read_bytes() for path in paths if path.is_file()}


def _write_whole(output: Path, data: bytes) -> None:
    """Write beside the target, then move into place: a half-written pack must never look like one."""
    try:
        handle, name = tempfile.mkstemp(dir=output.parent, prefix=f".{output.name}.")
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            Path(name).chmod(0o644)
            Path(name).replace(output)
        finally:
            with contextlib.suppress(OSError):
                Path(name).unlink()
    except OSError as error:
        raise UsageError(
            f"{output} cannot be written: {error.strerror}.", help="Name a file in a folder you can write to."
        ) from None
