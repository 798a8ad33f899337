"""The catalogue: lessons and exercises of one course, each read when it is first needed.

Listing ids costs one small file or one folder listing, so that shell completion is instant; everything else
is read once and kept, after the rules that no type can express.
"""

import math
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from functools import cache, cached_property
from pathlib import Path
from typing import TypeVar

import msgspec

from course.catalog.locate import Content
from course.catalog.locate import content as current_content
from course.catalog.models import LONGEST, CourseRef, Exercise, Lesson, Rubric, Syllabus, Times, fields_of
from course.catalog.reading import Document, read_document, read_text, split_front_matter
from course.errors import ContentError, NotFoundError
from course.ids import SLUG, WARM_UPS, ExerciseId, LessonId
from course.printable import meant

# ---
# Rules for a course file beyond the right keys and types.
#
# Each rule raises the ContentError that points at the line. Rules about one file live here; what takes two
# files to see (links, points, signatures) is the audit's.


_MODULE = re.compile(r"[a-z][a-z0-9_]*\.py")
#: A warm-up is done within one sitting with its lesson. In minutes.
MOST_MINUTES = 15
#: Names that have a role in the exercise's folder.
_TAKEN_MODULES = {"checks.py", "questions.py", "report.py"}


def check_syllabus(document: Document[Syllabus]) -> None:
    """Ids are well formed and no lesson is listed twice."""
    syllabus = document.value
    if not SLUG.fullmatch(syllabus.id):
        document.fail(("id",), "`id` is not lower-case words joined by hyphens.", fix="Write: physics-sim")
    document.check_words(("title",), syllabus.title)
    for index, lesson_id in enumerate(syllabus.lessons):
        document.check_id(("lessons", index), lesson_id, LessonId)
        if lesson_id in syllabus.lessons[:index]:
            problem = f"lesson {lesson_id} is listed twice."
            document.fail(("lessons", index), problem, fix="Remove one of the two lines.")
    for pair in syllabus.split.items():
        for name in set(pair) - set(syllabus.lessons):
            document.fail(("split",), f"{name} is not in `lessons`.", fix="Write an id that is listed there.")


def check_lesson(document: Document[Lesson]) -> None:
    """The head of a lesson fits its file name and says something."""
    lesson = document.value
    document.check_own_id(lesson.id, LessonId)
    document.check_words(("title",), lesson.title)
    document.check_words(("summary",), lesson.summary)
    if lesson.minutes <= 0:
        document.fail(("minutes",), "`minutes` must be more than 0.", fix="Say how long reading it takes.")
    if not lesson.objectives:
        problem = "`objectives` is empty."
        document.fail(("objectives",), problem, fix="Say what a reader can do afterwards, one line each.")
    for index, objective in enumerate(lesson.objectives):
        document.check_words(("objectives", index), objective)
    for key, ids in (("before", lesson.before), ("exercises", lesson.exercises)):
        for index, name in enumerate(ids):
            if name in ids[:index]:
                document.fail((key, index), f"{name} is listed twice.", fix="Remove one of the two.")
            document.check_id((key, index), name, LessonId if key == "before" else ExerciseId)


def check_exercise(document: Document[Exercise]) -> None:
    """Names, marks and points of an exercise make sense by themselves."""
    exercise = document.value
    folder = document.path.parent.name
    document.check_id(("id",), exercise.id, ExerciseId)
    if exercise.id != folder:
        problem = f"`id` is {exercise.id}, and the folder is called {folder}."
        document.fail(("id",), problem, fix=f'Write `id = "{folder}"`, or rename the folder.')
    document.check_words(("title",), exercise.title)
    document.check_words(("summary",), exercise.summary)
    document.check_id(("lesson",), exercise.lesson, LessonId)
    _check_module(document, exercise.module)
    _check_kind(document)
    if exercise.order < 1:
        document.fail(("order",), "`order` must be 1 or more.", fix="Number the exercises from 1.")
    if not 0 < exercise.pass_mark <= 1:
        problem = "`pass_mark` must be a share of the points, above 0 and at most 1."
        document.fail(("pass_mark",), problem, fix="Write 0.70 for 70 %.")
    if not 1 <= exercise.time <= LONGEST:
        fix = "It says how many times as long as elsewhere checks may take. Leave it out for 1."
        document.fail(("time",), f"`time` must be from 1 to {LONGEST:g}.", fix=fix)
    for index, name in enumerate(exercise.imports):
        if not name.isidentifier():
            problem = f"{name!r} is not a top-level package."
            document.fail(("imports", index), problem, fix='Name packages alone: "numpy".')
        if name in sys.stdlib_module_names:
            problem = f"{name!r} is part of Python, all of which may be imported anyway."
            document.fail(("imports", index), problem, fix="Take it out.")
    _check_tasks(document)
    _check_hints(document)


def _check_kind(document: Document[Exercise]) -> None:
    """A warm-up lies with the warm-ups, and everything there is one."""
    exercise = document.value
    lies_there = document.path.parent.parent.name == WARM_UPS
    if exercise.is_warm_up is not lies_there:
        where, kind = ("lies", "exercise") if lies_there else ("does not lie", "warm-up")
        fix = f'Write `kind = "warm-up"` for what lies in {WARM_UPS}, and for nothing else.'
        document.fail(("kind",), f"`kind` is {kind}, and the folder {where} in {WARM_UPS}.", fix=fix)
    if exercise.is_warm_up and not 0 < exercise.minutes <= MOST_MINUTES:
        problem = f"`minutes` of a warm-up lie between 1 and {MOST_MINUTES}."
        document.fail(("minutes",), problem, fix="Say how long it takes; what takes longer is an exercise.")


def _check_module(document: Document[Exercise], module: str) -> None:
    if not _MODULE.fullmatch(module):
        fix = "Use lower-case letters, digits and underscores, then .py: sim_to_real.py"
        document.fail(("module",), f"`module` is {module!r}, which is not a plain Python file name.", fix=fix)
    if module in _TAKEN_MODULES:
        document.fail(("module",), f"{module} already has another role here.", fix="Choose another name.")


def _check_tasks(document: Document[Exercise]) -> None:
    exercise = document.value
    if not exercise.task:
        document.fail(("task",), "there is no task.", fix="Add a [[task]] for each function to write.")
    for index, task in enumerate(exercise.task):
        if not task.id.isidentifier():
            fix = "The id of a task is the name of the function the student writes."
            document.fail(("task", index, "id"), f"{task.id!r} is not a Python name.", fix=fix)
        if any(other.id == task.id for other in exercise.task[:index]):
            problem = f"task {task.id} is listed twice."
            document.fail(("task", index, "id"), problem, fix="Remove or rename one of them.")
        document.check_words(("task", index, "title"), task.title)
        if not (math.isfinite(task.points) and task.points > 0):
            problem = f"`points` of {task.id} must be a number above 0."
            fix = "Give the points of its public and hidden checks together."
            document.fail(("task", index, "points"), problem, fix=fix)
    _check_hidden(document)


def _check_hidden(document: Document[Exercise]) -> None:
    exercise = document.value
    if exercise.hidden_checks < 0:
        document.fail(("hidden_checks",), "`hidden_checks` is negative.", fix="Count the hidden checks.")
    if not 0 <= exercise.hidden_points <= exercise.max_points:
        problem = "`hidden_points` must lie between 0 and the sum of the tasks' points."
        document.fail(("hidden_points",), problem, fix="Add up the points of the hidden checks.")


def _check_hints(document: Document[Exercise]) -> None:
    """Hints are not empty, and what is said of one names one that there is."""
    for index, entry in enumerate(document.value.task):
        numbers = [str(number + 1) for number in range(len(entry.hints))]
        known = f"Its hints are 1 to {len(numbers)}" if numbers else "It has none yet"
        for number, hint in enumerate(entry.hints):
            document.check_words(("task", index, "hints", number), hint)
        for fitting in entry.fits:
            if fitting not in numbers:
                problem = f"task {entry.id} has no hint number {fitting}."
                document.fail(("task", index, "fits"), problem, fix=f"{known}.")
        for told, sentences in entry.yours.items():
            where = ("task", index, "yours", told)
            if told not in ("any", *numbers):
                document.fail(where, f"task {entry.id} has no hint number {told}.", fix=f"{known}, or any.")
            for sentence in sentences:
                if not fields_of(sentence):
                    problem = f"a sentence about the student's numbers has no field: {sentence!r}."
                    fix = "Name one, such as {got}, or make the sentence a part of the hint."
                    document.fail(where, problem, fix=fix)


def check_rubric(document: Document[Rubric]) -> None:
    """There is a question, something to grade by, and an answer that is long enough itself."""
    rubric = document.value
    document.check_words(("question",), rubric.question.strip())
    for index, point in enumerate(rubric.points):
        document.check_words(("points", index), point)
    if not rubric.points:
        document.fail(("points",), "there is nothing to grade an answer by.", fix="Add a sentence or more.")
    if len(rubric.good_answer.split()) < max(1, rubric.least_words):
        problem = f"the good answer has fewer than {max(1, rubric.least_words)} words."
        document.fail(("good_answer",), problem, fix="Make it longer, or `least_words` smaller.")


#: A number of an exercise or a lesson has fewer digits than this.
_DIGITS = 5
T = TypeVar("T")


class Catalog:
    """One course, as its files describe it.

    Args:
        content: where the files are; the course in use if None.

    Every method may raise ContentError, which names the file, the line and the fix, and one that takes an id
    or other words for one item NotFoundError.
    """

    def __init__(self, content: Content | None = None) -> None:
        self.content = content or current_content()
        self._lesson = cache(self.read_lesson)
        self._exercise = cache(self.read_exercise)

    # -- the course ------------------------------------------------------------------------------

    @cached_property
    def syllabus(self) -> Syllabus:
        """The course's own file."""
        document = read_document(self.content.syllabus, Syllabus)
        check_syllabus(document)
        return document.value

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
        """One lesson's head; its text is at ``lesson.path``."""
        if lesson_id not in self.lesson_ids():
            raise _not_found("lesson", lesson_id, self.lesson_ids(), "course lessons")
        return self._lesson(lesson_id)

    def lesson_called(self, words: str) -> Lesson:
        """One lesson, by its id or its place in the syllabus, "1" first."""
        return self.lesson(_numbered(words, self.lesson_ids) or words)

    def read_lesson(self, lesson_id: str) -> Lesson:
        """The head of ``<id>.md``, whether or not the syllabus lists it; not kept."""
        path = self.content.lessons / f"{lesson_id}.md"
        head = split_front_matter(read_text(path), path)
        document = read_document(path, Lesson, text=head.toml, first_line=2, reserved=("path",))
        check_lesson(document)
        return msgspec.structs.replace(document.value, path=str(path))

    # -- the quiz --------------------------------------------------------------------------------

    def question_ids(self) -> tuple[str, ...]:
        """Sorted by name; lists a folder and opens no file."""
        return tuple(sorted(path.stem for path in self.content.quiz.glob("*.toml")))

    # -- exercises -------------------------------------------------------------------------------

    def exercise_ids(self) -> tuple[str, ...]:
        """Sorted by name; lists a folder and opens no file."""
        return self._exercise_ids

    @cached_property
    def _exercise_ids(self) -> tuple[str, ...]:
        if not self.content.exercises.is_dir():
            problem = "the folder is missing."
            raise ContentError(self.content.exercises, None, problem, help="Install the course again.")
        return _declared_in(self.content.exercises)

    def warm_up_ids(self) -> tuple[str, ...]:
        """Sorted by name; lists a folder and opens no file."""
        return self._warm_up_ids

    @cached_property
    def _warm_up_ids(self) -> tuple[str, ...]:
        folder = self.content.exercises / WARM_UPS
        found = _declared_in(folder)
        if twice := sorted({*found} & {*self.exercise_ids()}):
            problem, fix = "an exercise has this id, too.", "Rename one of the folders."
            raise ContentError(folder / twice[0], None, problem, help=fix)
        return found

    def exercises(self) -> tuple[Exercise, ...]:
        """All exercises, in the order they are done."""
        found = (self._exercise(exercise_id) for exercise_id in self.exercise_ids())
        return tuple(sorted(found, key=lambda exercise: (exercise.order, exercise.id)))

    def warm_ups(self, lesson_id: str | None = None) -> tuple[Exercise, ...]:
        """All warm-ups, or those of one lesson, in the order of the lessons and then of their own."""
        found = (self._exercise(name) for name in self.warm_up_ids())
        return self._as_met(one for one in found if lesson_id in {None, one.lesson})

    def every_task(self) -> tuple[Exercise, ...]:
        """Warm-ups and exercises as the lessons lead to them: a lesson's warm-ups, then its exercise."""
        return self._as_met((*self.warm_ups(), *self.exercises()))

    def _as_met(self, tasks: Iterable[Exercise]) -> tuple[Exercise, ...]:
        lessons = {name: number for number, name in enumerate(self.lesson_ids())}
        rank = lambda one: (lessons.get(one.lesson, len(lessons)), not one.is_warm_up, one.order, one.id)  # noqa: E731
        return tuple(sorted(tasks, key=rank))

    def tasks(self, lesson_id: str) -> tuple[Exercise, ...]:
        """The tasks of a lesson: its warm-ups, and the exercises that it leads to."""
        led = (self.exercise(name) for name in self.lesson(lesson_id).exercises)
        return (*self.warm_ups(lesson_id), *(one for one in led if one.lesson == lesson_id))

    def exercise(self, exercise_id: str) -> Exercise:
        """One exercise, or one warm-up: their ids differ."""
        known = (*self.exercise_ids(), *self.warm_up_ids())
        if exercise_id not in known:
            raise _not_found("exercise", exercise_id, known, "course exercises")
        return self._exercise(exercise_id)

    def exercise_called(self, words: str) -> Exercise:
        """One exercise, by its id or its place among the exercises, "1" first.

        Raises:
            NotFoundError: nothing is called so.
        """
        return _numbered(words, self.exercises) or self.exercise(words)

    def warm_up_called(self, words: str) -> Exercise:
        """One warm-up, likewise; an exercise, if its id is given."""
        return _numbered(words, self.warm_ups) or self.exercise(words)

    def place_of(self, exercise: Exercise) -> int:
        """The number that it is called by: its place among the exercises, or the warm-ups, from 1."""
        every = self.warm_ups() if exercise.is_warm_up else self.exercises()
        return 1 + [one.id for one in every].index(exercise.id)

    def read_exercise(self, exercise_id: str) -> Exercise:
        """The declaration in the folder of this name; not kept."""
        folder = self.content.exercise_folder(exercise_id)
        document = read_document(folder / "exercise.toml", Exercise, reserved=("folder", "slow"))
        check_exercise(document)
        measured = self.times.exercises.get(exercise_id)
        slow = measured.slow if measured else {}
        return msgspec.structs.replace(document.value, folder=str(folder), slow=slow)

    @property
    def times_path(self) -> Path:
        """What ``course author build`` measured, of all exercises."""
        return self.content.exercises / "times.json"

    @cached_property
    def times(self) -> Times:
        """How long slow checks take."""
        try:
            return msgspec.json.decode(self.times_path.read_bytes(), type=Times)
        except FileNotFoundError:
            return Times()
        except (OSError, msgspec.DecodeError) as error:
            problem = f"what was measured cannot be read: {error}."
            fix = "Delete the file, then run `course author build`."
            raise ContentError(self.times_path, None, problem, help=fix) from None

    def rubric(self, exercise: Exercise) -> Rubric | None:
        """The question of an exercise that is answered in prose; None if it has none."""
        if not exercise.rubric_path.is_file():
            return None
        document = read_document(exercise.rubric_path, Rubric)
        check_rubric(document)
        return document.value


def _declared_in(folder: Path) -> tuple[str, ...]:
    """Names of the folders in ``folder`` that hold an exercise; none if it is not there."""
    if not folder.is_dir():
        return ()
    return tuple(sorted(one.name for one in folder.iterdir() if (one / "exercise.toml").is_file()))


def _numbered(words: str, among: Callable[[], Sequence[T]]) -> T | None:
    """What stands at the place that some words are the number of, "1" first; None if they are of none."""
    place = int(words) if words.isdecimal() and len(words) < _DIGITS else 0
    every = among() if place else ()
    return every[place - 1] if 1 <= place <= len(every) else None


def _not_found(kind: str, wanted: str, known: Iterable[str], command: str) -> NotFoundError:
    names = list(known)
    fix = f"`{command}` lists what there is." if names else f"This course has no {kind}s yet."
    said = f"There is no {kind} called {wanted[:80]!r}."
    return NotFoundError(said, help=meant(wanted, names, fix), code=f"{kind}_not_found")
