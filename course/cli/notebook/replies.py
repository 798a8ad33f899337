"""The replies of ``course notebook ... --json``, as types."""

from __future__ import annotations

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Backup, Envelope
from course.cli.work.replies import Check

__all__ = ["Notebook", "NotebookCheck", "NotebookFile", "NotebookOpen"]


class NotebookFile(msgspec.Struct, frozen=True, kw_only=True):
    """One notebook and what was done.

    ``action`` is "written" (there was none), "current" (nothing newer), "replaced" (the student had written
    nothing in it), "merged" (the newer one with the student's work in it), "beside" (``new`` is the newer
    one, ``path`` as it was, ``reason`` why) or, from ``course open``, "kept" (there was one; it was not
    opened).
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


class NotebookOpen(Envelope, tag="course.open/1", frozen=True, kw_only=True):
    """``course open``, printed once ``address`` works; the command goes on until it is ended."""

    course: CourseRef
    folder: str
    files: tuple[NotebookFile, ...]
    address: str


class NotebookCheck(Envelope, tag="course.notebook-check/1", frozen=True, kw_only=True):
    """``check``: ``result`` is what ``course check`` gives, with cells for lines."""

    file: str
    result: Check
