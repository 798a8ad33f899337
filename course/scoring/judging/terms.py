"""The terms of a grading run, the same for every submission in it."""

from __future__ import annotations

import msgspec

__all__ = ["Terms"]


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
