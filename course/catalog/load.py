"""The catalogue: lessons, exercises, hints and mutants of one course, each read when it is first needed.

Listing ids costs one small file or one folder listing, so that shell completion is instant; everything else
is read once and kept. Facts that a type cannot express are checked in ``course.catalog.rules``.
"""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

import msgspec

from course.catalog import rules
from course.catalog.front_matter import split_front_matter
from course.catalog.locate import Content
from course.catalog.locate import content as current_content
from course.catalog.models import CourseRef, Exercise, Hints, Lesson, Mutant, MutantList, Rubric, Syllabus
from course.catalog.reading import (
    Document,
    read_document,
    read_text,
    read_toml,
)
from course.errors import ContentError, NotFoundError
from course.ids import WARM_UPS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

__all__ = ["Catalog", "read_toml"]

#: A number of an exercise or a lesson has fewer digits than this.
_DIGITS = 5


class Catalog:
    """One course, as its files describe it.

    Args:
        content: where the files are; the course in use if None.

    Every method may raise ContentError, which names the file, the line and the fix.
    """

    def __init__(self, content: Content | None = None) -> None:
        self.content = content or current_content()
        self._syllabus: Syllabus | None = None
        self._exercise_ids: tuple[str, ...] | None = None
        self._warm_up_ids: tuple[str, ...] | None = None
        self._lessons: dict[str, Lesson] = {}
        self._exercises: dict[str, Exercise] = {}
        self._hints: dict[str, Hints] = {}
        self._mutants: dict[str, tuple[Mutant, ...]] = {}

    # -- the course ------------------------------------------------------------------------------

    @property
    def syllabus(self) -> Syllabus:
        """The course's own file."""
        if self._syllabus is None:
            document = read_document(self.content.syllabus, Syllabus)
            rules.check_syllabus(document)
            self._syllabus = document.value
        return self._syllabus

    @property
    def course_id(self) -> str:
        return self.syllabus.id

    @property
    def title(self) -> str:
        return self.syllabus.title

    @property
    def ref(self) -> CourseRef:
        """Which course this is."""
        return CourseRef(self.course_id, self.version)

    @property
    def version(self) -> str:
        """The content's version: its own if it declares one, else the package's."""
        from course import __version__

        return self.syllabus.version or __version__

    # -- lessons ---------------------------------------------------------------------------------

    def lesson_ids(self) -> tuple[str, ...]:
        """In the order of the syllabus; reads nothing else."""
        return self.syllabus.lessons

    def lessons(self) -> tuple[Lesson, ...]:
        """The heads of all lessons, in the order of the syllabus."""
        return tuple(self._lesson(lesson_id) for lesson_id in self.lesson_ids())

    def lesson(self, lesson_id: str) -> Lesson:
        """One lesson's head; its text is at ``lesson.path``.

        Raises:
            NotFoundError: no lesson has this id.
        """
        if lesson_id not in self.lesson_ids():
            raise _not_found("lesson", lesson_id, self.lesson_ids(), "course lessons")
        return self._lesson(lesson_id)

    def lesson_called(self, words: str) -> Lesson:
        """One lesson, by its id or its place in the syllabus, "1" first.

        Raises:
            NotFoundError: no lesson is called so.
        """
        ids = self.lesson_ids()
        if words.isdecimal() and len(words) < _DIGITS and 1 <= int(words) <= len(ids):
            return self._lesson(ids[int(words) - 1])
        return self.lesson(words)

    def _lesson(self, lesson_id: str) -> Lesson:
        if lesson_id not in self._lessons:
            self._lessons[lesson_id] = self.read_lesson(lesson_id)
        return self._lessons[lesson_id]

    def read_lesson(self, lesson_id: str) -> Lesson:
        """The head of ``<id>.md``, whether or not the syllabus lists it; not kept."""
        path = self.content.lessons / f"{lesson_id}.md"
        head = split_front_matter(read_text(path), path)
        document = read_document(path, Lesson, text=head.toml, first_line=2, reserved=("path",))
        rules.check_lesson(document)
        return msgspec.structs.replace(document.value, path=str(path))

    # -- exercises -------------------------------------------------------------------------------

    def exercise_ids(self) -> tuple[str, ...]:
        """Sorted by name; lists a folder and opens no file."""
        if self._exercise_ids is None:
            if not self.content.exercises.is_dir():
                raise ContentError(
                    self.content.exercises, None, "the folder is missing.", help="Install the course again."
                )
            self._exercise_ids = _declared_in(self.content.exercises)
        return self._exercise_ids

    def warm_up_ids(self) -> tuple[str, ...]:
        """Sorted by name; lists a folder and opens no file."""
        if self._warm_up_ids is None:
            self._warm_up_ids = _declared_in(self.content.exercises / WARM_UPS)
        return self._warm_up_ids

    def exercises(self) -> tuple[Exercise, ...]:
        """All exercises, in the order they are done."""
        found = (self._exercise(exercise_id) for exercise_id in self.exercise_ids())
        return tuple(sorted(found, key=lambda exercise: (exercise.order, exercise.id)))

    def warm_ups(self, lesson_id: str | None = None) -> tuple[Exercise, ...]:
        """All warm-ups, or those of one lesson, in the order of the lessons and then of their own."""
        lessons = {name: number for number, name in enumerate(self.lesson_ids())}
        found = (self._exercise(name) for name in self.warm_up_ids())
        chosen = [one for one in found if lesson_id in {None, one.lesson}]
        return tuple(sorted(chosen, key=lambda one: (lessons.get(one.lesson, len(lessons)), one.order)))

    def tasks(self, lesson_id: str) -> tuple[Exercise, ...]:
        """The tasks of a lesson: its warm-ups, and the exercises that it leads to."""
        led = (self.exercise(name) for name in self.lesson(lesson_id).exercises)
        return (*self.warm_ups(lesson_id), *(one for one in led if one.lesson == lesson_id))

    def exercise(self, exercise_id: str) -> Exercise:
        """One exercise, or one warm-up: their ids differ.

        Raises:
            NotFoundError: nothing has this id.
        """
        known = (*self.exercise_ids(), *self.warm_up_ids())
        if exercise_id not in known:
            raise _not_found("exercise", exercise_id, known, "course exercises")
        return self._exercise(exercise_id)

    def exercise_called(self, words: str) -> Exercise:
        """One exercise, by its id or its number.

        Raises:
            NotFoundError: nothing is called so.
        """
        if words.isdecimal() and len(words) < _DIGITS and int(words) > 0:
            for exercise in self.exercises():
                if exercise.number == int(words):
                    return exercise
        return self.exercise(words)

    def _exercise(self, exercise_id: str) -> Exercise:
        if exercise_id not in self._exercises:
            self._exercises[exercise_id] = self.read_exercise(exercise_id)
        return self._exercises[exercise_id]

    def read_exercise(self, exercise_id: str) -> Exercise:
        """The declaration in the folder of this name; not kept."""
        folder = self.content.exercise_folder(exercise_id)
        document = read_document(folder / "exercise.toml", Exercise, reserved=("folder",))
        rules.check_exercise(document)
        return msgspec.structs.replace(document.value, folder=str(folder))

    def hints(self, exercise: Exercise) -> Hints:
        """The hints of an exercise."""
        if exercise.id not in self._hints:
            self._hints[exercise.id] = self.hints_document(exercise).value
        return self._hints[exercise.id]

    def hints_document(self, exercise: Exercise) -> Document[Hints]:
        """``hints.toml`` with its lines."""
        document = read_document(exercise.hints_path, Hints)
        rules.check_hints(document, exercise)
        return document

    def rubric(self, exercise: Exercise) -> Rubric | None:
        """The question of an exercise that is answered in prose; None if it has none."""
        if not exercise.rubric_path.is_file():
            return None
        document = read_document(exercise.rubric_path, Rubric)
        rules.check_rubric(document)
        return document.value

    def mutants(self, exercise: Exercise) -> tuple[Mutant, ...]:
        """The expected outcome of each wrong solution; empty where there are no solutions (a wheel)."""
        if self.content.solutions is None:
            return ()
        if exercise.id not in self._mutants:
            self._mutants[exercise.id] = self.mutant_document(exercise).value.mutant
        return self._mutants[exercise.id]

    def mutant_document(self, exercise: Exercise) -> Document[MutantList]:
        """``mutants.toml`` with its lines; needs a checkout."""
        folder = self.content.solution_folder(exercise.id) or self.content.root / "solutions" / exercise.id
        document = read_document(folder / "mutants.toml", MutantList)
        rules.check_mutants(document, exercise)
        return document


def _declared_in(folder: Path) -> tuple[str, ...]:
    """Names of the folders in ``folder`` that hold an exercise; none if it is not there."""
    if not folder.is_dir():
        return ()
    return tuple(sorted(one.name for one in folder.iterdir() if (one / "exercise.toml").is_file()))


def _not_found(kind: str, wanted: str, known: Iterable[str], command: str) -> NotFoundError:
    names = list(known)
    close = [name for name in names if wanted and name.startswith(wanted)]
    close += [name for name in difflib.get_close_matches(wanted, names, n=3, cutoff=0.5) if name not in close]
    if close:
        fix = f"Did you mean {' or '.join(close[:3])}?"
    elif names:
        fix = f"`{command}` lists what there is."
    else:
        fix = f"This course has no {kind}s yet."
    return NotFoundError(f"There is no {kind} called {wanted[:80]!r}.", help=fix, code=f"{kind}_not_found")
