"""``course hint``, ``solution`` and ``reflect``: as much help as the student has worked for.

Hints come one at a time, and each needs an attempt since the last one: a failed check of changed code. The
next hint fits that check's diagnosis, or else is the mildest one left. The number left is never shown,
because students who see a countdown click through it.
"""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec.structs import replace

from course.catalog.models import Exercise, Rubric
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, named
from course.cli.frame.options import ExerciseName, grade_lists, option, task_ids
from course.cli.frame.replies import Envelope, NextStep
from course.cli.home.advice import after_warm_up
from course.cli.work.chosen import asked_for, chosen_work
from course.errors import CourseError, IntegrityError, MissingCapabilityError, NotFoundError, UsageError
from course.handed_in.limits import MAX_FILE
from course.printable import counted
from course.progress.history import History, fingerprint

PACKS = "*.coursepack"


class Hint(Envelope, tag="course.hint/1", frozen=True, kw_only=True):
    """``given`` is True if a new hint was shown; ``reason`` says why not otherwise.

    ``reason`` is one of "", "not_checked", "ungradable", "passing", "unchanged", "exhausted". ``hint`` is the
    new hint, or the last one again while the next is not due.
    """

    exercise: str
    given: bool
    reason: str
    task: str | None
    hint: str | None
    message: str
    next: NextStep


class Solution(Envelope, tag="course.solution/1", frozen=True, kw_only=True):
    """``source`` is the place of the solution; ``files`` maps file names to their text."""

    exercise: str
    source: str
    files: dict[str, str]


def hint(
    exercise: ExerciseName = None,
    task: Annotated[
        str | None, option("--task FUNCTION", "About this function, not the first that fails.", task_ids)
    ] = None,
) -> int:
    """Show the next hint.

    A new hint is due after a check that failed on changed code; comments and layout do not count as a change.
    Until then the last hint is shown again.
    """
    console, here = current(), Here.load()
    chosen, named = asked_for(here, exercise)
    reply = give_hint(console, here, chosen, task, named)
    console.next(reply.next.command)
    return here.answer(reply)


def give_hint(
    console: Console, here: Here, exercise: Exercise, task: str | None = None, named: str | None = None
) -> Hint:
    """Show the next hint that is due, or why none is.

    Args:
        task: about this function, not the first that fails.
        named: the file that was named, to be called by its name.
    """
    reply = _next_hint(here, exercise, task, named)
    if reply.task is not None and not console.quiet:
        console.heading(exercise.task_called(reply.task).title, reply.task)
    if reply.hint is not None:
        console.line(reply.hint)
    if reply.message:
        console.line(reply.message)
    return reply


def _next_hint(here: Here, exercise: Exercise, wanted: str | None, named: str | None) -> Hint:
    """Decide what to show, and record it if it is new; arguments as of ``give_hint``."""
    history = here.history(exercise)
    started = exercise.id in here.workspace.begun()
    again = NextStep(f"course check {exercise.id}" if started else f"course start {exercise.id}")
    task = _task(exercise, history, wanted)
    last = history.last
    reply = Hint(exercise=exercise.id, given=False, reason="", task=None, hint=None, message="", next=again)
    if last is None:
        message = "Hints follow a check that failed. Check your work first."
        return replace(reply, reason="not_checked", message=message)
    if started and not here.workspace.has_file(exercise.place, exercise.module):
        here.source(exercise)  # raises, and says how to get it back
    if last.state != "graded":
        message = "Your file could not be run at the last check; what that check said is the hint for now."
        return replace(reply, reason="ungradable", message=message)
    if task is None:
        which = f"Every public check of {wanted} passes" if wanted else "Every public check passes"
        done = after_warm_up(here, exercise) if exercise.is_warm_up else "course submit"
        step = again if wanted else NextStep(done)
        message = f"{which}: there is nothing to hint at."
        return replace(reply, reason="passing", message=message, next=step)
    reply = replace(reply, task=task)
    entry, shown, failed = exercise.task_called(task), history.hints_for(task), history.diagnosed(task)
    begun = task not in history.unwritten_tasks()
    handed_out = fingerprint(here.stub(exercise))
    if not begun or not history.hint_is_due(handed_out):
        shown_last = next((index for index in reversed(shown) if index < len(entry.hints)), None)
        file = named or _file_name(here, exercise)
        step = NextStep(f"course check {exercise.id}")
        words = None if shown_last is None else entry.said(shown_last, failed)
        message = (
            f"The first hint follows an attempt at this function. Write something in {file}, however rough, "
            "and check it; then ask again."
            if words is None and (not begun or last.fingerprint == handed_out)
            else f"Each check that fails on changed code in {file} has one hint, and this one's was about "
            f"{history.hints[-1].task}. Ask with --task before the others."
            if words is None and history.hints
            else f"The first hint follows a check that fails on changed code in {file}."
            if words is None
            else f"You have had that one already. The next one follows a check that fails on changed code in "
            f"{file}."
        )
        return replace(reply, reason="unchanged", hint=words, message=message, next=step)
    following = entry.following({code for code, _ in failed}, shown)
    if following is None:
        message = (
            f"Every hint for this function has been given; you have worked for all of them. "
            f"Read the lesson again with this function beside it: course lesson {exercise.lesson}. "
            "A solution can be shown after a pass, where one was released."
        )
        step = NextStep(f"course lesson {exercise.lesson}")
        return replace(reply, reason="exhausted", message=message, next=step)
    here.record("hint", exercise.id, {"task": task, "index": following, "fingerprint": last.fingerprint})
    codes = {code for code, _ in failed if code}
    about = {code for fitting in entry.fits.values() for code in fitting}
    message = (
        "No hint is about the mistake that this check named; this one is about the function as a whole."
        if codes and not codes & about
        else ""
    )
    return replace(reply, given=True, hint=entry.said(following, failed), message=message)


def _task(exercise: Exercise, history: History, wanted: str | None) -> str | None:
    """The task to hint at: the one asked for if it fails, or the first that does and was begun."""
    failing, new = history.failing_tasks(), history.unwritten_tasks()
    known = [task.id for task in exercise.task]
    if wanted is not None and wanted not in known:
        problem = f"{exercise.id} has no function called {wanted!r}."
        raise NotFoundError(problem, help=f"It has: {', '.join(known)}.", code="task_not_found")
    candidates = known if wanted is None else [wanted]
    found = [task for task in candidates if task in failing]
    return next((task for task in found if task not in new), found[0] if found else None)


def _file_name(here: Here, exercise: Exercise) -> str:
    """The file that the student works in, as far as it is known."""
    with suppress(CourseError):
        return chosen_work(here, exercise).name
    return exercise.module


def solution(exercise: ExerciseName = None) -> int:
    """Show a released solution, after a pass.

    Once a check of yours has reached the pass mark, this shows the solution if your instructor has handed
    one out: put the .coursepack file into the workspace.
    """
    console, here = current(), Here.load()
    chosen = here.exercise(exercise)
    if here.history(chosen).first_pass is None:
        raise NotFoundError(
            f"No check of {chosen.id} has reached the pass mark yet, and a solution read before that "
            "teaches little.",
            help=f"Go on with `course check {chosen.id}` and `course hint {chosen.id}`.",
            code="not_passed",
        )
    source, files = _released(here, chosen)
    console.note(f"From {source}")
    for name, text in files.items():
        if not console.quiet:
            console.heading(name)
        console.block(text, language="python" if Path(name).suffix == ".py" else "")
    here.record("solution", chosen.id, {"source": source})
    return here.answer(Solution(exercise=chosen.id, source=source, files=dict(files)))


def _released(here: Here, exercise: Exercise) -> tuple[str, Mapping[str, str]]:
    """A solution's source, and its files.

    Raises:
        NotFoundError: none was released to this machine.
        IntegrityError: a pack that may hold it is damaged.
    """
    problem: IntegrityError | MissingCapabilityError | None = None
    for path in sorted(here.workspace.root.glob(PACKS)):
        from course.catalog.pack import read_pack

        try:
            pack = read_pack(path)
        except (IntegrityError, MissingCapabilityError) as error:
            problem = error
            continue
        if exercise.id in pack.solutions and pack.course_id == here.catalog.course_id:
            return str(path), _texts(pack.solutions[exercise.id])
    folder = here.catalog.content.solution_folder(exercise.id)
    if folder is not None and (folder / exercise.module).is_file():
        found = [folder / name for name in (exercise.module, "README.md")]
        return str(folder), _texts({p.name: p.read_bytes() for p in found if p.is_file()})
    if problem is not None:
        raise problem
    said = f"No solution of {exercise.id} has been released to this machine."
    fix = f"Your instructor hands one out as a .coursepack file; put it into {here.workspace.root}."
    raise NotFoundError(said, help=fix, code="no_solution")


def _texts(files: Mapping[str, bytes]) -> dict[str, str]:
    return {name: data.decode("utf-8", "replace") for name, data in sorted(files.items())}


# ---
# ``course reflect``: a question that no check can judge, answered in prose and graded by the student.
#
# The good answer and the points to grade by appear after the student has written. The answer is kept in the
# record of progress; it is not scored and not handed in.


KIND = "reflection"
GRADES = ("yes", "partly", "no")


class ReflectPoint(msgspec.Struct, frozen=True):
    """A point to grade an answer by. ``grade`` is "yes", "partly", "no" or None."""

    text: str
    grade: str | None


class Reflect(Envelope, tag="course.reflect/1", frozen=True, kw_only=True):
    """A question for prose. ``good_answer`` and ``points`` come once there is an answer."""

    exercise: str
    question: str
    answer: str | None
    good_answer: str | None
    points: tuple[ReflectPoint, ...]
    next: NextStep | None = None


def reflect(
    exercise: ExerciseName = None,
    answer: Annotated[Path | None, option("--answer FILE", "Your answer, as a text file.")] = None,
    grades: Annotated[
        str | None, option("--grades yes,partly,no,…", "Your grade for each point.", grade_lists)
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
    kept, graded, draft = _recorded(here, chosen, rubric)
    said = kept
    if answer is not None:
        said = _read(answer)
    elif not said and console.interactive:
        said = _typed(console, here, chosen, rubric.least_words, draft)
    if said:
        words = len(said.split())
        if words < rubric.least_words:
            least = f"a good one is shown once yours has {rubric.least_words}"
            fix = "Write it as you would explain it to a colleague."
            problem = f"Your answer has {counted(words, 'word')}; {least}."
            raise UsageError(problem, help=fix, code="too_short")
        if said != kept:
            graded = ()
            here.record(KIND, chosen.id, {"text": said})
        graded = _judged(here, chosen, rubric, grades, graded)
    elif grades is not None:
        raise UsageError("There is no answer to grade yet.", help="Give it with --answer FILE.")
    points = tuple(map(ReflectPoint, rubric.points, graded or [None] * len(rubric.points)))
    step = f"course reflect {chosen.id}" + ("" if graded else " --grades …" if said else " --answer FILE")
    if not graded:
        console.next(step)
    return here.answer(
        Reflect(
            exercise=chosen.id,
            question=_flowing(rubric.question),
            answer=said or None,
            good_answer=rubric.good_answer.strip() if said else None,
            points=points if said else (),
            next=None if graded else NextStep(step),
        )
    )


def _rubric(here: Here, chosen: Exercise) -> Rubric:
    """The question of an exercise that was passed.

    Raises:
        NotFoundError: it has none, or its checks do not pass yet.
    """
    rubric = here.catalog.rubric(chosen)
    if rubric is None:
        having = [one.id for one in here.catalog.exercises() if here.catalog.rubric(one) is not None]
        problem = f"{chosen.id} has no question to answer in prose."
        fix = f"These have one: {', '.join(having)}." if having else "This course has none."
        raise NotFoundError(problem, help=fix, code="nothing_to_reflect_on")
    if here.history(chosen).first_pass is None:
        problem = f"The question of {chosen.id} comes once its checks reach the pass mark."
        fix = f"Work on it first: course watch {chosen.id}"
        raise NotFoundError(problem, help=fix, code="not_passed_yet")
    return rubric


def _recorded(here: Here, chosen: Exercise, rubric: Rubric) -> tuple[str, tuple[str, ...], str]:
    """The answer, its grades, and what was typed of an answer that was left half-way."""
    said = draft = ""
    graded: tuple[str, ...] = ()
    for event in here.workspace.store.events(KIND, chosen.id):
        draft = str(event.data.get("draft", ""))
        if "text" in event.data and event.data["text"] != said:
            said, graded = str(event.data["text"]), ()
        held = event.data.get("grades")
        if isinstance(held, list) and len(held) == len(rubric.points):
            graded = tuple(map(str, held))
    return said, graded, draft


def _read(path: Path) -> str:
    full = named(path)
    try:
        data = full.read_bytes()
    except OSError as error:
        raise UsageError(f"{path} cannot be read ({error.strerror or error}).", code="unreadable") from error
    if len(data) > MAX_FILE:
        raise UsageError(f"{path} is larger than {MAX_FILE:,} bytes.", code="too_large")
    return data.decode("utf-8", errors="replace").strip()


def _typed(console: Console, here: Here, chosen: Exercise, least: int, draft: str) -> str:
    """What is typed after a draft; each line is kept at once, for whoever is interrupted."""
    console.note(f"Write your answer; an empty line ends it, once it has {least} words. Each line is kept.")
    if draft:
        console.line(f"You began:\n{draft}\nGo on from there.")
    while (line := console.ask("> ")) or (line is not None and len(draft.split()) < least):
        draft = f"{draft}\n{line}".lstrip()
        here.record(KIND, chosen.id, {"draft": draft})
    return draft.strip()


def _judged(
    here: Here, chosen: Exercise, rubric: Rubric, grades: str | None, before: tuple[str, ...]
) -> tuple[str, ...]:
    """Show the good answer and the points, with grades from the command line, the student or the record."""
    console = current()
    console.blank()
    console.heading("A good answer")
    for paragraph in rubric.good_answer.strip().split("\n\n"):
        console.line(_flowing(paragraph))
        console.blank()
    console.heading("What to grade yours by", "yes, partly or no")
    chosen_grades = before
    if grades is not None:
        chosen_grades = tuple(word.strip().lower() for word in grades.split(","))
        if len(chosen_grades) != len(rubric.points) or not set(chosen_grades) <= set(GRADES):
            problem = f"--grades takes {len(rubric.points)} of yes, partly and no, joined by commas."
            raise UsageError(problem, help=f"For example: --grades {','.join(['yes'] * len(rubric.points))}")
    elif console.interactive and not before:
        chosen_grades = _asked(console, rubric)
    for number, point in enumerate(rubric.points, 1):
        grade = f"  {chosen_grades[number - 1]}" if chosen_grades else ""
        console.line(f"{number}. {point}", (grade, "bold"), indent=2)
    if chosen_grades and chosen_grades != before:
        here.record(KIND, chosen.id, {"grades": list(chosen_grades)})
    return chosen_grades


def _asked(console: Console, rubric: Rubric) -> tuple[str, ...]:
    """A grade for each point; none if the input ends before."""
    found: list[str] = []
    for number, point in enumerate(rubric.points, 1):
        meant: list[str] = []
        while not meant:
            said = console.ask(f"{number}. {point} [yes/partly/no] ")
            if said is None:
                return ()
            meant = [grade for grade in GRADES if said and grade.startswith(said.lower())]
        found += meant
    return tuple(found)


def _flowing(text: str) -> str:
    return " ".join(text.split())
