"""What one student handed in for one exercise, and its digest."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["Submission"]


@dataclass(frozen=True)
class Submission:
    """What one student handed in for one exercise.

    Attributes:
        files: file name to content, exactly as handed in.
    """

    files: Mapping[str, bytes]

    @property
    def sha256(self) -> str:
        """Over names and contents, in a fixed order."""
        digest = hashlib.sha256()
        for name in sorted(self.files):
            digest.update(f"{len(name)}:{name}:{len(self.files[name])}:".encode())
            digest.update(self.files[name])
        return digest.hexdigest()
