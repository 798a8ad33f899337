"""``course reflect``: a question that no check can judge, answered in prose and graded by the student.

The good answer and the points to grade by appear after the student has written. The answer is kept in the
record of progress; it is not scored and not handed in.
"""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - typer reads annotations at run time
from typing import TYPE_CHECKING, Annotated

import typer

from course.cli.frame.arguments import ExerciseName  # noqa: TC001 - typer reads annotations at run time
from course.cli.frame.completion import grade_lists
from course.cli.frame.here import MAX_FILE_BYTES, Here, cwd
from course.cli.frame.replies import NextStep
from course.cli.frame.terminal.console import Console, current
from course.cli.work.replies import Reflect, ReflectPoint
from course.errors import NotFoundError, UsageError

if TYPE_CHECKING:
    from course.catalog.models import Exercise, Rubric

__all__ = ["reflect"]

KIND = "reflection"
GRADES = ("yes", "partly", "no")


def reflect(
    exercise: ExerciseName = None,
    answer: Annotated[
        Path | None, typer.Option("--answer", metavar="FILE", help="Your answer, as a text file.")
    ] = None,
    grades: Annotated[
        str | None,
        typer.Option(
            "--grades",
            metavar="yes,partly,no,…",
            help="Your grade for each point.",
            autocompletion=grade_lists,
        ),
    ] = None,
) -> int:
    """Answer in prose, and grade your answer.

    It is open once the exercise's checks pass. You write first; then you see a good answer and the points to
    grade yours by. Your answer is kept with your progress. It is not scored and not handed in.
    """
    console, here = current(), Here.load()
    chosen = here.exercise(exercise)
    rubric = _rubric(here, chosen)
    console.heading(chosen.title, chosen.id)
    console.line(_flowing(rubric.question))
    kept, graded = _recorded(here, chosen, rubric)
    said = kept
    if answer is not None:
        said = _read(answer)
    elif not said and console.interactive:
        said = _typed(console)
    if said:
        _long_enough(said, rubric)
        if said != kept:
            graded = ()
            here.record(KIND, chosen.id, {"text": said})
        graded = _judged(console, here, chosen, rubric, grades, graded)
    elif grades is not None:
        raise UsageError("There is no answer to grade yet.", help="Give it with --answer FILE.")
    step = f"course reflect {chosen.id}" + ("" if graded else " --grades …" if said else " --answer FILE")
    if not graded:
        console.next(step)
    for warning in here.warnings:
        console.warn(warning)
    console.emit(
        Reflect(
            exercise=chosen.id,
            question=_flowing(rubric.question),
            answer=said or None,
            good_answer=rubric.good_answer.strip() if said else None,
            points=tuple(
                ReflectPoint(point, graded[index] if graded else None)
                for index, point in enumerate(rubric.points)
            )
            if said
            else (),
            next=None if graded else NextStep(step),
        )
    )
    return 0


def _rubric(here: Here, chosen: Exercise) -> Rubric:
    """The question of an exercise that was passed.

    Raises:
        NotFoundError: it has none, or its checks do not pass yet.
    """
    rubric = here.catalog.rubric(chosen)
    if rubric is None:
        having = [one.id for one in here.catalog.exercises() if here.catalog.rubric(one) is not None]
        raise NotFoundError(
            f"{chosen.id} has no question to answer in prose.",
            help=f"These have one: {', '.join(having)}." if having else "This course has none.",
            code="nothing_to_reflect_on",
        )
    if here.history(chosen).first_pass is None:
        raise NotFoundError(
            f"The question of {chosen.id} comes once its checks reach the pass mark.",
            help=f"Work on it first: course watch {chosen.id}",
            code="not_passed_yet",
        )
    return rubric


def _recorded(here: Here, chosen: Exercise, rubric: Rubric) -> tuple[str, tuple[str, ...]]:
    """The newest answer and the newest grades."""
    said = ""
    graded: tuple[str, ...] = ()
    for event in here.workspace.store.events(KIND, chosen.id):
        if "text" in event.data and event.data["text"] != said:
            said, graded = str(event.data["text"]), ()
        held = event.data.get("grades")
        if isinstance(held, list) and len(held) == len(rubric.points):
            graded = tuple(map(str, held))
    return said, graded


def _read(path: Path) -> str:
    full = cwd() / path.expanduser()
    try:
        data = full.read_bytes()
    except OSError as error:
        raise UsageError(f"{path} cannot be read ({error.strerror or error}).", code="unreadable") from error
    if len(data) > MAX_FILE_BYTES:
        raise UsageError(f"{path} is larger than {MAX_FILE_BYTES:,} bytes.", code="too_large")
    return data.decode("utf-8", errors="replace").strip()


def _typed(console: Console) -> str:
    console.note("Write your answer; an empty line ends it.")
    lines = []
    while line := console.ask("> "):
        lines.append(line)
    return "\n".join(lines)


def _long_enough(said: str, rubric: Rubric) -> None:
    words = len(said.split())
    if words < rubric.least_words:
        raise UsageError(
            f"Your answer has {words} words; a good one is shown once yours has {rubric.least_words}.",
            help="Write it as you would explain it to a colleague.",
            code="too_short",
        )


def _judged(
    console: Console,
    here: Here,
    chosen: Exercise,
    rubric: Rubric,
    grades: str | None,
    before: tuple[str, ...],
) -> tuple[str, ...]:
    """Show the good answer and the points, with grades from the command line, the student or the record."""
    console.blank()
    console.heading("A good answer")
    for paragraph in rubric.good_answer.strip().split("\n\n"):
        console.line(_flowing(paragraph))
        console.blank()
    console.heading("What to grade yours by", "yes, partly or no")
    if grades is not None:
        chosen_grades = _parsed(grades, rubric)
    elif console.interactive and not before:
        chosen_grades = _asked(console, rubric)
    else:
        chosen_grades = before
    for number, point in enumerate(rubric.points, 1):
        grade = f"  {chosen_grades[number - 1]}" if chosen_grades else ""
        console.line(f"{number}. {point}", (grade, "bold"), indent=2)
    if chosen_grades and chosen_grades != before:
        here.record(KIND, chosen.id, {"grades": list(chosen_grades)})
    return chosen_grades


def _parsed(grades: str, rubric: Rubric) -> tuple[str, ...]:
    given = tuple(word.strip().lower() for word in grades.split(","))
    if len(given) != len(rubric.points) or not set(given) <= set(GRADES):
        raise UsageError(
            f"--grades takes {len(rubric.points)} of yes, partly and no, joined by commas.",
            help=f"For example: --grades {','.join(['yes'] * len(rubric.points))}",
        )
    return given


def _asked(console: Console, rubric: Rubric) -> tuple[str, ...]:
    """A grade for each point; none if the input ends before."""
    found: list[str] = []
    for number, point in enumerate(rubric.points, 1):
        while True:
            said = console.ask(f"{number}. {point} [yes/partly/no] ")
            if said is None:
                return ()
            meant = [grade for grade in GRADES if said and grade.startswith(said.lower())]
            if meant:
                found += meant
                break
    return tuple(found)


def _flowing(text: str) -> str:
    return " ".join(text.split())
