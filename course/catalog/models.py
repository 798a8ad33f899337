"""The parts of a course as frozen types.

These are the shapes of the files under ``exercises/`` and ``course/lessons/``; ``course.catalog.load`` reads
the files into them and says which file and line is wrong when one does not fit.
"""

import re
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Literal

import msgspec

from course.ids import WARM_UPS

#: Files that declare a newer format are refused: an older program must not half-understand them.
FORMAT_VERSION = 1


class CourseRef(msgspec.Struct, frozen=True):
    """Which course something is about."""

    id: str
    version: str


#: Of the failed checks of a task: diagnosis, "" for none, and fields by name.
Found = Iterable[tuple[str, Mapping[str, str]]]
_FIELD = re.compile(r"\{([^{}]*)\}")


def fields_of(sentence: str) -> frozenset[str]:
    """The fields that a hint's sentence about the student's numbers names."""
    return frozenset(_FIELD.findall(sentence))


class Task(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One function of an exercise; the unit that points belong to.

    Attributes:
        id: the name of the function the student writes.
        points: public and hidden points together.
        read: the section that explains it, as "lesson#section"; "" for the exercise's lesson as a whole.
        fault: the diagnosis of the function as it is handed out; "" where the student writes it.
        hints: mildest first.
        fits: by number of a hint, counted from 1, the diagnoses after which it is the one to give.
        yours: by number of a hint, "any" for all that have none of their own, what it goes on to say of the
            student's own numbers. ``{name}`` stands for a field of the failed check; of several sentences
            the first is said whose fields are all there.
    """

    id: str
    title: str
    points: float
    read: str = ""
    fault: str = ""
    hints: tuple[str, ...] = ()
    fits: dict[str, tuple[str, ...]] = {}
    yours: dict[str, tuple[str, ...]] = {}

    def said(self, index: int, failed: Found) -> str:
        """A hint, from 0, with the student's numbers where it has a sentence for them.

        Args:
            failed: diagnosis and fields of each failed check; one whose diagnosis the hint fits goes first.
        """
        fitting = self.fits.get(str(index + 1), ())
        sentences = self.yours.get(str(index + 1), self.yours.get("any", ()))
        for _, fields in sorted(failed, key=lambda check: check[0] not in fitting):
            for sentence in sentences:
                if fields.keys() >= fields_of(sentence):
                    parts = _FIELD.split(sentence)  # words and names of fields, in turn
                    parts[1::2] = [fields[name] for name in parts[1::2]]
                    return f"{self.hints[index]} {''.join(parts)}"
        return self.hints[index]

    def following(self, diagnoses: Collection[str], given: Collection[int]) -> int | None:
        """The next hint, from 0: one that fits a diagnosis, else the mildest; None if all are given."""
        left = [index for index in range(len(self.hints)) if index not in given]
        fitting = [int(number) - 1 for number, codes in self.fits.items() if set(codes) & set(diagnoses)]
        return next((index for index in fitting if index in left), left[0] if left else None)


#: At home a check may take so many times what it takes at most of a right solution, and so many once another
#: check of its function ran out of time: what hangs has been told by then.
_PATIENCE, _LESS = 20.0, 5.0
#: The longest time of a check that is not in ``slow``, in s. A file's own run takes at most 6 ms of CPU time:
#: measured of every model solution, accepted variant and stub at every protection level.
QUICK = 0.1


#: How many times the usual time an exercise may ask for.
LONGEST = 2.0


class Exercise(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """An exercise, as ``exercise.toml`` declares it.

    Attributes:
        module: file name of the stub, and of the student's file.
        lesson: the lesson to read first.
        order: position in lists, 1 first: the order in which the lessons lead to them.
        number: the number it has in the chapter that the course is based on; 0 if it has none. Commands call
            it by its place among the exercises.
        task: the tasks, in the order a student does them.
        pass_mark: share of the maximum that passes.
        imports: top-level packages a submission may import beside the standard library.
        time: how many times as long as in other exercises its checks may take, 1 to 2.
        hidden_checks, hidden_points: how much is scored only in the grading run. Declared, so that a
            wheel, which has no hidden checks, can say so; the audit compares it with the graders.
        kind: "warm-up" for a small one that counts for nothing and has public checks only.
        minutes: how long a warm-up takes.
        slow: public checks that take more than ``QUICK`` of a right solution, and how long at most, in s of
            CPU time; from ``times.json``, which ``course author build`` writes.
        after: slug of the section of its lesson that a warm-up follows; "" for the end of the lesson.
        folder: where the files are; set by the loader, like ``slow``.
    """

    format_version: int
    id: str
    title: str
    module: str
    lesson: str
    order: int
    summary: str
    task: tuple[Task, ...]
    number: int = 0
    pass_mark: float = 0.70
    imports: tuple[str, ...] = ("numpy",)
    time: float = 1.0
    hidden_checks: int = 0
    hidden_points: float = 0.0
    kind: Literal["exercise", "warm-up"] = "exercise"
    minutes: int = 0
    after: str = ""
    slow: dict[str, float] = {}
    folder: str = ""

    def __hash__(self) -> int:
        return hash((self.id, self.folder))  # ``slow`` is a dict

    @property
    def is_warm_up(self) -> bool:
        return self.kind == "warm-up"

    @property
    def place(self) -> str:
        """Where it lies among the exercises, and in a workspace."""
        return f"{WARM_UPS}/{self.id}" if self.is_warm_up else self.id

    @property
    def given(self) -> tuple[Path, ...]:
        """The files that a student gets: the README, other files it mentions, the stub."""
        found = (Path(self.folder) / name for name in ("README.md", "boxes.py"))
        return (*(path for path in found if path.is_file()), self.stub_path)

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
    def rubric_path(self) -> Path:
        return Path(self.folder) / "rubric.toml"

    @property
    def max_points(self) -> float:
        """Public and hidden points together."""
        return sum(task.points for task in self.task)

    def patience(self, check: str = "", hung: bool = False) -> float:
        """How long a check is waited for at home, in s of CPU time.

        Args:
            check: its id; empty for what the file itself runs while it is loaded.
            hung: another check of the same function ran out of time before.
        """
        return (_LESS if hung else _PATIENCE) * self.slow.get(check, QUICK)

    def where_to_read(self, task_id: str) -> str:
        """The section that explains a task, as "lesson#section", or a lesson alone."""
        return self.task_called(task_id).read or (
            f"{self.lesson}#{self.after}" if self.after else self.lesson
        )

    def task_called(self, task_id: str) -> Task:
        """A task; where there is none of that id, an empty one that is called so."""
        return next((task for task in self.task if task.id == task_id), Task(task_id, task_id, 0.0))


class Measured(msgspec.Struct, frozen=True):
    """How long an exercise's slow checks take, see ``Exercise.slow``, and a digest of what was measured."""

    made_from: str
    slow: dict[str, float]


class Times(msgspec.Struct, frozen=True):
    """``times.json`` among the exercises: by exercise."""

    format_version: int = 1
    exercises: dict[str, Measured] = {}


class Rubric(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``rubric.toml`` of an exercise: a question for prose, which its author grades.

    Attributes:
        question: asked once the checks pass.
        least_words: an answer of fewer is not one.
        points: criteria for grading an answer, a sentence each.
        good_answer: shown after one was written; paragraphs with an empty line between them.
    """

    format_version: int
    question: str
    least_words: int
    points: tuple[str, ...]
    good_answer: str


class Objective(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A learning objective, and where the evidence for it comes from.

    Attributes:
        title: after "You can …".
    """

    title: str
    lessons: tuple[str, ...]
    exercises: tuple[str, ...] = ()
    quiz: tuple[str, ...] = ()


class Syllabus(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``syllabus.toml``: which course this is, and its lessons in the order they are read.

    Attributes:
        version: version of the content; empty where it goes with the package and has the package's.
        objective: what the course is to bring about; each lesson belongs to one.
        split: lessons that were part of another one, and that one: whoever read it then has read both.
    """

    format_version: int
    id: str
    title: str
    lessons: tuple[str, ...]
    version: str = ""
    split: dict[str, str] = {}
    objective: tuple[Objective, ...] = ()


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
