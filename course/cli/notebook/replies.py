"""What ``course notebook ... --json`` prints, as types."""

from __future__ import annotations

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Backup, Check, Envelope

__all__ = ["Notebook", "NotebookCheck", "NotebookFile"]


class NotebookFile(msgspec.Struct, frozen=True, kw_only=True):
    """One notebook and what was done.

    ``action`` is "written" (there was none), "current" (nothing newer), "replaced" (nobody had written in
    it), "merged" (the newer one with the student's work in it) or "beside" (``new`` is the newer one,
    ``path`` as it was, ``reason`` why).
    """

    kind: str
    id: str
    path: str
    action: str
    new: str | None = None
    reason: str = ""
    backup: Backup | None = None


class Notebook(Envelope, tag="course.notebook/1", frozen=True, kw_only=True):
    """``build`` and ``update``."""

    course: CourseRef
    folder: str
    files: tuple[NotebookFile, ...]


class NotebookCheck(Envelope, tag="course.notebook-check/1", frozen=True, kw_only=True):
    """``check``: ``result`` is what ``course check`` gives, with cells for lines."""

    file: str
    result: Check
