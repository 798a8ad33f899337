"""Where a student is, by a record that is read once."""

from __future__ import annotations

from collections.abc import Collection
from datetime import datetime
from functools import cached_property

from course.progress.history import History, Mistake, history_of, mistakes_of
from course.progress.quiz import QuizHistory, quiz_history
from course.progress.store import Event, Record
from course.progress.workspace import Workspace


class Standing:
    """Where a student was at one moment; without a workspace, nowhere.

    Each question reads the events that it needs, and raises IntegrityError if one of them is spoilt.

    Args:
        record: None outside of a workspace.

    Attributes:
        started: ids of the exercises that something was handed out for.
    """

    def __init__(self, record: Record | None = None, started: Collection[str] = ()) -> None:
        self._record = record
        self.started = frozenset(started)
        self._histories: dict[str, History] = {}

    @classmethod
    def of(cls, workspace: Workspace) -> Standing:
        """As it is now.

        Raises:
            IntegrityError, MissingCapabilityError: the record cannot be read.
        """
        return cls(workspace.store.record(), workspace.started())

    def events(self, kind: str = "", subject: str = "") -> tuple[Event, ...]:
        """What was recorded of a kind and about a subject, oldest first; an empty string stands for any."""
        return self._record.events(kind, subject) if self._record is not None else ()

    def history(self, exercise: str) -> History:
        """What was recorded about an exercise or a warm-up."""
        if exercise not in self._histories:
            self._histories[exercise] = history_of(self.events(subject=exercise))
        return self._histories[exercise]

    def is_begun(self, exercise: str) -> bool:
        """Whether it was started, or checked: a notebook needs no start."""
        return exercise in self.started or self.history(exercise).last is not None

    def is_complete(self, exercise: str) -> bool:
        """Whether every check passed when all were last run."""
        last = self.history(exercise).last_graded
        return last is not None and last.all_pass

    @cached_property
    def read(self) -> dict[str, datetime]:
        """When each lesson was first read to its end, by its id."""
        return {event.subject: event.at for event in reversed(self.events("lesson"))}

    @cached_property
    def quiz(self) -> QuizHistory:
        """The attempts at the quiz, and the reviews."""
        return quiz_history(self.events())

    @cached_property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The mistakes that checks recognised, in the order they were first made."""
        return mistakes_of(self.events())
