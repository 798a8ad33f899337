"""Which graders these are: a digest of everything that decides a score."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from course.catalog.load import Catalog
    from course.catalog.models import Exercise

__all__ = ["grader_version"]


def grader_version(exercise: Exercise, catalog: Catalog) -> str:
    """A digest of the exercise's checks and their helpers, and of the machinery that runs them."""
    package = Path(__file__).resolve().parents[1]
    folders = [Path(exercise.folder), package / "scoring", package / "isolation", package / "physics"]
    if catalog.content.graders is not None:
        folders.append(catalog.content.graders / exercise.id)
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted(folder.rglob("*")):
            if path.suffix in {".py", ".toml", ".ini"} and "__pycache__" not in path.parts:
                digest.update(
                    path.relative_to(folder).as_posix().encode() + b"\0" + path.read_bytes() + b"\0"
                )
    return digest.hexdigest()[:16]
