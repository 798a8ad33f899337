"""Replies of the commands about lessons."""

from __future__ import annotations

from course.cli.frame.replies import Envelope, NextStep
from course.cli.home.replies import LessonState, WarmUpState

__all__ = ["LessonReply", "Lessons", "WarmUps"]


class WarmUps(Envelope, tag="course.warmup/1", frozen=True, kw_only=True):
    """The warm-ups, in the order of the lessons. With an id the reply is that of ``start`` or ``check``."""

    warm_ups: tuple[WarmUpState, ...]
    next: NextStep | None = None


class Lessons(Envelope, tag="course.lessons/1", frozen=True, kw_only=True):
    lessons: tuple[LessonState, ...]
    next: NextStep | None = None


class LessonReply(Envelope, tag="course.lesson/1", frozen=True, kw_only=True):
    """One lesson; ``text`` is what ``--plain`` shows, or with ``--code`` the code of one cell."""

    id: str
    title: str
    minutes: int
    objectives: tuple[str, ...]
    exercises: tuple[str, ...]
    text: str
    figures: tuple[str, ...] = ()
    next: NextStep | None = None
