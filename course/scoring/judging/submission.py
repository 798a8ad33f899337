"""One student's submission for one exercise, and its digest."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.scoring.places import Places

__all__ = ["Submission"]


@dataclass(frozen=True)
class Submission:
    """One student's submission for one exercise.

    Attributes:
        files: file name to content, exactly as handed in.
        places: how its lines are named; None if the student wrote the module itself.
        notes: parts left out, and assumptions, one sentence each.
    """

    files: Mapping[str, bytes]
    places: Places | None = None
    notes: tuple[str, ...] = ()

    @property
    def sha256(self) -> str:
        """Over names and contents, in a fixed order."""
        digest = hashlib.sha256()
        for name in sorted(self.files):
            digest.update(f"{len(name)}:{name}:{len(self.files[name])}:".encode())
            digest.update(self.files[name])
        return digest.hexdigest()
