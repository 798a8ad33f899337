"""What a course consists of, as frozen types.

These are the shapes of the files under ``exercises/`` and ``course/lessons/``; ``course.catalog.load`` reads
the files into them and says which file and line is wrong when one does not fit.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from course.ids import ExerciseId, LessonId

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = [
    "FORMAT_VERSION",
    "CourseRef",
    "Exercise",
    "Hints",
    "Lesson",
    "Mutant",
    "MutantList",
    "Syllabus",
    "Task",
    "TaskHints",
]

#: Files that declare a newer format are refused: an older program must not half-understand them.
FORMAT_VERSION = 1


class CourseRef(msgspec.Struct, frozen=True):
    """Which course something is about."""

    id: str
    version: str


class Task(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One function of an exercise; the unit that points belong to.

    Attributes:
        id: the name of the function the student writes.
        title: what a person calls it.
        points: public and hidden points together.
    """

    id: str
    title: str
    points: float


class Exercise(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An exercise, as ``exercise.toml`` declares it.

    Attributes:
        module: file name of the stub, and of the student's file.
        lesson: the lesson to read first.
        order: position in lists, 1 first.
        summary: one line for lists.
        task: the tasks, in the order a student does them.
        pass_mark: share of the maximum that passes.
        imports: top-level packages a submission may import beside the standard library.
        hidden_checks, hidden_points: how much is scored only in the grading run. Declared, so that a
            wheel, which has no hidden checks, can say so; the audit compares it with the graders.
        folder: where the files are; set by the loader.
    """

    format_version: int
    id: str
    title: str
    module: str
    lesson: str
    order: int
    summary: str
    task: tuple[Task, ...]
    pass_mark: float = 0.70
    imports: tuple[str, ...] = ("numpy",)
    hidden_checks: int = 0
    hidden_points: float = 0.0
    folder: str = ""

    @property
    def exercise_id(self) -> ExerciseId:
        return ExerciseId(self.id)

    @property
    def lesson_id(self) -> LessonId:
        return LessonId(self.lesson)

    @property
    def stub_path(self) -> Path:
        return Path(self.folder) / self.module

    @property
    def readme_path(self) -> Path:
        return Path(self.folder) / "README.md"

    @property
    def checks_path(self) -> Path:
        return Path(self.folder) / "checks.py"

    @property
    def hints_path(self) -> Path:
        return Path(self.folder) / "hints.toml"

    @property
    def max_points(self) -> float:
        """Public and hidden points together."""
        return sum(task.points for task in self.task)

    def task_titled(self, task_id: str) -> str:
        """The title of a task; the id itself when there is none of that id."""
        return next((task.title for task in self.task if task.id == task_id), task_id)


class TaskHints(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The hints of one task, mildest first."""

    id: str
    hints: tuple[str, ...]


class Hints(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``hints.toml`` of an exercise."""

    format_version: int
    task: tuple[TaskHints, ...]

    def of(self, task_id: str) -> Sequence[str]:
        return next((task.hints for task in self.task if task.id == task_id), ())


class Mutant(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One deliberately wrong solution and what must happen to it.

    Attributes:
        file: its file under ``solutions/<id>/mutants``; it holds only what it gets wrong and is appended
            to the model solution.
        task: the task whose points it loses, and the only one.
        misconception: what the author of such code believes.
        check: id of the check that must catch it.
        diagnosis: the code that check's finding must carry.
    """

    file: str
    task: str
    misconception: str
    check: str
    diagnosis: str


class MutantList(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``mutants.toml`` of an exercise."""

    format_version: int
    mutant: tuple[Mutant, ...]


class Syllabus(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``syllabus.toml``: which course this is, and its lessons in the order they are read.

    Attributes:
        version: version of the content; empty where it goes with the package and has the package's.
    """

    format_version: int
    id: str
    title: str
    lessons: tuple[str, ...]
    version: str = ""


class Lesson(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The head of a lesson; the text below it is parsed by ``course.catalog.markdown``."""

    format_version: int
    id: str
    title: str
    minutes: int
    summary: str
    objectives: tuple[str, ...]
    before: tuple[str, ...] = ()
    exercises: tuple[str, ...] = ()
    path: str = ""
