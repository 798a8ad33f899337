"""Where a student is, by a record that is read once."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from datetime import datetime
from functools import cached_property
from types import MappingProxyType

from course.progress.history import History, Mistake, history_of, mistakes_of
from course.progress.quiz import QuizHistory, quiz_history
from course.progress.store import Event, Record, Store
from course.progress.workspace import Workspace


def lesson_events(store: Store | None, lesson: str, split: Mapping[str, str]) -> tuple[Event, ...]:
    """What is recorded about a lesson, oldest first; nothing outside of a workspace.

    Of a lesson that was part of another one: first what it keeps of that one's record. An end that was
    reached before the two were parted does not say how many blocks there were.

    Args:
        split: lessons that were part of another one, and that one.

    Raises:
        IntegrityError, MissingCapabilityError: the record cannot be read.
    """
    if store is None:
        return ()
    whole = store.events(subject=split[lesson]) if lesson in split else ()
    kept = [
        event
        for event in whole
        if event.kind in {"prediction", "cell"} or (event.kind == "lesson" and "blocks" not in event.data)
    ]
    return (*kept, *store.events(subject=lesson))


class Standing:
    """Where a student was at one moment; without a workspace, nowhere.

    Each question reads the events that it needs, and raises IntegrityError if one of them is spoilt.

    Args:
        record: None outside of a workspace.
        split: lessons that were part of another one, and that one.

    Attributes:
        started: ids of the exercises that something was handed out for.
    """

    def __init__(
        self,
        record: Record | None = None,
        started: Collection[str] = (),
        split: Mapping[str, str] = MappingProxyType({}),
        workspace: Workspace | None = None,
    ) -> None:
        self._record = record
        self._split = split
        self._workspace = workspace
        self.started = frozenset(started)
        self._histories: dict[str, History] = {}

    @classmethod
    def of(cls, workspace: Workspace, split: Mapping[str, str] = MappingProxyType({})) -> Standing:
        """As it is now.

        Raises:
            IntegrityError, MissingCapabilityError: the record cannot be read.
        """
        return cls(workspace.store.record(), workspace.started(), split, workspace)

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

    def has_file(self, place: str, module: str) -> bool:
        """Whether an exercise that was begun still has a file."""
        return self._workspace is None or self._workspace.has_file(place, module)

    def is_complete(self, exercise: str) -> bool:
        """Whether every check passed when all were last run."""
        last = self.history(exercise).last_graded
        return last is not None and last.all_pass

    @cached_property
    def read(self) -> dict[str, datetime]:
        """When each lesson was first read to its end, by its id."""
        ends = self.events("lesson")
        found = {event.subject: event.at for event in reversed(ends)}
        whole = {event.subject: event.at for event in reversed(ends) if "blocks" not in event.data}
        return {part: whole[old] for part, old in self._split.items() if old in whole} | found

    @cached_property
    def quiz(self) -> QuizHistory:
        """The attempts at the quiz, and the reviews."""
        return quiz_history(self.events())

    @cached_property
    def mistakes(self) -> tuple[Mistake, ...]:
        """The mistakes that checks recognised, in the order they were first made."""
        return mistakes_of(self.events())
