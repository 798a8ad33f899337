"""The version of the graders: a digest of everything that decides a score."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["grader_version"]


def grader_version(exercise: Exercise, catalog: Catalog, package: Path | None = None) -> str:
    """A digest of the exercise's checks, their helpers and their reference, and of what runs them.

    Args:
        package: the folder of ``course``; None for the one that is running.
    """
    package = package or Path(__file__).resolve().parents[1]
    folders = [Path(exercise.folder), package / "scoring", package / "isolation", package / "physics"]
    content = catalog.content
    theirs = content.grader_folder(exercise.id), content.solution_folder(exercise.id)
    folders += [folder for folder in theirs if folder is not None]
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if path.relative_to(folder).parts[0] in {"mutants", "accepted"}:
                continue
            if path.suffix in {".py", ".toml", ".ini", ".json"} and "__pycache__" not in path.parts:
                digest.update(
                    path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes() + b"\0"
                )
    return digest.hexdigest()[:16]
