"""One student's submission for one exercise, and the terms on which a grading run judges all of them."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

import msgspec

from course.scoring.verdict import Places


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


class Terms(msgspec.Struct, frozen=True):
    """How submissions are judged; made once and passed on unchanged, also over pipes and networks.

    Attributes:
        level: protection level to insist on; None takes the best one not below ``at_least``.
        at_least: the weakest level to accept when ``level`` is None.
        timeout: seconds of CPU time per check.
        seed: of the run, for checks that draw their inputs.
        graders: digest of the snapshot that judges; empty for the course as it is here.
        home: a student checks their own file: a check that hangs, or the file itself while it is loaded, has
            the patience of ``Exercise.patience``, and is told by its line.
    """

    level: str | None = None
    at_least: str = "L1"
    timeout: float = 10.0
    seed: int = 0
    graders: str = ""
    home: bool = False
