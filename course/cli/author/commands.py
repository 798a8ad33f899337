"""``course author``: write lessons and exercises, and prove that they are right. Needs a checkout."""

import hashlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from course.authoring import scaffold
from course.authoring.audit import audit
from course.authoring.coverage import as_markdown, check_coverage, read_coverage, written_to
from course.authoring.exercises import diagnosis
from course.authoring.exercises.files import find_blanks, write_points, write_times
from course.authoring.exercises.grading import write_pack
from course.authoring.exercises.proofs import MutantOutcome, run_mutants
from course.authoring.report import AuthorProblem, Findings
from course.catalog.load import Catalog
from course.catalog.locate import ENVIRONMENT_VARIABLE
from course.catalog.models import CourseRef, Exercise
from course.cli.author.pictures import pictures
from course.cli.author.trying import refused
from course.cli.frame import here
from course.cli.frame.console import Console, current, meter
from course.cli.frame.options import argument, exercise_ids, lesson_ids, option
from course.cli.frame.registry import COMMANDS, find, group
from course.cli.frame.replies import Envelope, filled
from course.errors import ContentError, UsageError
from course.printable import counted
from course.progress.workspace import write_atomically
from course.sandbox.scene.loading import scene_ids
from course.scoring.verdict import in_points
from course.simulations.registry import SIMULATIONS


class AuthorNew(Envelope, tag="course.author-new/1", frozen=True, kw_only=True):
    """``kind`` is "exercise", "warm-up", "lesson", "question" or "scene"."""

    kind: str
    id: str
    files: tuple[str, ...]


class AuthorBuild(Envelope, tag="course.author-build/1", frozen=True, kw_only=True):
    """The files that were computed, relative to the course."""

    files: tuple[str, ...]


class AuthorCheck(Envelope, tag="course.author-check/1", frozen=True, kw_only=True):
    """``graded`` counts the stubs, solutions, variants and mutants that were scored to find out."""

    course: CourseRef
    lessons: tuple[str, ...]
    exercises: tuple[str, ...]
    questions: tuple[str, ...]
    scenes: tuple[str, ...]
    checks: int
    graded: int
    isolation: str
    seconds: float
    problems: tuple[AuthorProblem, ...]


class CoverageRow(msgspec.Struct, frozen=True, kw_only=True):
    """A part of the chapter and the places of the course that have it."""

    section: str
    lines: str
    kind: str
    what: str
    word: str
    where: tuple[str, ...]


class AuthorCoverage(Envelope, tag="course.author-coverage/1", frozen=True, kw_only=True):
    """``written`` is the page that was made, if one was asked for."""

    source_lines: int
    parts: tuple[CoverageRow, ...]
    written: str | None
    problems: tuple[AuthorProblem, ...]


class MutantRow(msgspec.Struct, frozen=True, kw_only=True):
    """A wrong program, ``file`` its name, and what the student who wrote it would read.

    ``misconception`` says what the mistake looks like; "" where the words are the course's own.
    """

    exercise: str
    file: str
    task: str
    misconception: str
    check: str
    diagnosis: str | None
    caught_by: tuple[str, ...]
    lost: float
    message: str
    help: str
    faults: tuple[str, ...]


class AuthorMutants(Envelope, tag="course.author-mutants/1", frozen=True, kw_only=True):
    mutants: tuple[MutantRow, ...]


class AuthorPack(Envelope, tag="course.author-pack/1", frozen=True, kw_only=True):
    course: CourseRef
    output: str
    sha256: str
    solutions: dict[str, tuple[str, ...]]


# ---
# ``course author coverage``: where the course has each part of the chapter it grew out of.


def coverage(write: Annotated[bool, option("--write", "Write docs/coverage.md again.")] = False) -> int:
    """Show where the course covers each part of the chapter that it is based on.

    Lists the chapter's headings, objectives, examples, exercises and questions, each with its place in the
    course and one word on how it is covered. Exit code 1 if a part or a place is missing.
    """
    console, catalog = current(), load_catalog()
    document = read_coverage(catalog)
    problems = check_coverage(document, catalog, is_command)
    table, page = document.value, None
    if write and not problems:
        page = written_to(catalog)
        write_atomically(page, as_markdown(table).encode())
    for section in table.section:
        console.heading(section.title)
        rows = [(part.what, part.word, ", ".join(part.where)) for part in section.parts]
        console.table(("part", "word", "where"), rows)
        console.blank()
    for problem in problems:
        _show_problem(console, problem)
    found = counted(len(problems), "problem") if problems else "none is missing"
    console.line(f"{counted(len(table.parts), 'part')}, {table.source_lines} lines: {found}.")
    if page:
        console.note(f"Wrote {shown(page, catalog)}.")
    parts = tuple(
        filled(CoverageRow, part, section=section.title, kind=section.kind)
        for section in table.section
        for part in section.parts
    )
    code, written = 1 if problems else 0, shown(page, catalog) if page else None
    reply = filled(AuthorCoverage, table, exit_code=code, parts=parts, written=written, problems=problems)
    return console.answer(reply)


def _show_problem(console: Console, problem: AuthorProblem) -> None:
    console.line((problem.where, "bold"))
    console.line(problem.message, indent=2)
    console.line((problem.help, "dim"), indent=2)


def is_command(words: tuple[str, ...]) -> bool:
    """Whether ``course`` followed by these words is a command.

    Simulations count as words of ``sim run``, exercises that ask for prose as one of ``reflect``.
    """
    entry = COMMANDS.get(words[0]) if words else None
    if words[:1] == ("reflect",) and len(words) == 2:
        catalog = load_catalog()
        return words[1] in catalog.exercise_ids() and catalog.exercise(words[1]).rubric_path.is_file()
    if entry is None or len(words) == 1 or not entry.is_group:
        return entry is not None and len(words) == 1
    known = typer.main.get_group(find(entry.module, "app")).commands
    return words[1] in known and all(word in (*SIMULATIONS, "--all") for word in words[2:])


def load_catalog() -> Catalog:
    """The course in use, which is the one whose checkout one stands in."""
    catalog, folder = here.load_catalog(), Path.cwd()
    for above in (folder, *folder.parents):
        if (above / "course" / "authoring").is_dir() and (above / "exercises").is_dir():
            if above.resolve() != catalog.content.root.resolve() and ENVIRONMENT_VARIABLE not in os.environ:
                raise UsageError(
                    f"This program belongs to {catalog.content.root}, and you are in another one, {above}.",
                    help=f"In {above}, type `python -m course` instead of `course`: that is its own program.",
                    code="other_checkout",
                )
            break
    return catalog


def shown(path: Path, catalog: Catalog) -> str:
    root = catalog.content.root
    return path.relative_to(root).as_posix() if path.is_relative_to(root) else str(path)


app = group(COMMANDS["author"].summary)
_new = group("Write the files of something new.")
app.add_typer(_new, name="new", epilog="Example: course author new exercise pendulum-clock")


def _any_id(incomplete: str) -> list[str]:
    scenes = [name for name in scene_ids() if name.startswith(incomplete)]
    return [*lesson_ids(incomplete), *exercise_ids(incomplete), *scenes]


_EachExercise = Annotated[str | None, argument("ID", "An exercise; all of them if left out.", exercise_ids)]
_NewId = Annotated[str, argument("ID", "Lower-case words joined by hyphens.")]
#: Options of new content with functions, given before its files are written.
_Functions = Annotated[
    list[str] | None, option("--function 'NAME(ARGUMENTS)'", "A function for students to write; repeatable.")
]
_Title = Annotated[str, option("--title WORDS", "Its title, for readers.")]
_Summary = Annotated[str, option("--summary WORDS", "One line for lists.")]


@_new.command("exercise", epilog="Example: course author new exercise pendulum-clock")
def new_exercise(
    name: _NewId,
    function: _Functions = None,
    title: _Title = "",
    summary: _Summary = "",
    lesson: Annotated[
        str, option("--lesson ID", "The lesson to read first; the last one if left out.", lesson_ids)
    ] = "",
) -> int:
    """Write an exercise with blanks to fill in.

    In a terminal it asks for missing information: the functions, and a line about each. It fills them in
    everywhere, and leaves blank only what you alone can know. Nothing is overwritten. `course author check
    ID` names each blank that is left.
    """
    return _new_with_functions("exercise", name, function, title, summary, lesson)


@_new.command("warmup", epilog="Example: course author new warmup swing --lesson engines")
def new_warm_up(
    name: _NewId,
    lesson: Annotated[str, option("--lesson ID", "The lesson it belongs to.", lesson_ids)],
    function: _Functions = None,
    title: _Title = "",
    summary: _Summary = "",
) -> int:
    """Write a warm-up with blanks to fill in.

    Like `course author new exercise`, but smaller: six files, and all checks are public. Once the blanks are
    filled, `course author build ID` computes what the wrong programs answer.
    """
    return _new_with_functions("warm-up", name, function, title, summary, lesson)


def _new_with_functions(
    kind: str, name: str, function: list[str] | None, title: str, summary: str, lesson: str
) -> int:
    console, catalog = current(), load_catalog()
    asked = [scaffold.Function.parse(text) for text in function or ()]
    if not asked and console.interactive:
        title = title or console.ask("Title: ") or ""
        summary = summary or console.ask("What it is about, in one line: ") or ""
        asked = list(_ask_functions(console))
    written = scaffold.new_exercise(
        catalog, name, asked, title=title, summary=summary, lesson=lesson, warm_up=kind == "warm-up"
    )
    return _report_new(catalog, kind, name, written)


def _ask_functions(console: Console) -> Iterator[scaffold.Function]:
    """Functions and what they give, until an empty line."""
    console.line("Its functions, each as in the stub: swing_period(length, gravity). Enter ends the list.")
    while signature := console.ask("Function: "):
        try:
            found = scaffold.Function.parse(signature)
        except UsageError as error:
            console.line(f"{error.message} {error.help}")
            continue
        gives = console.ask(f"The result of {found.name}, with units: ") or ""
        yield scaffold.Function(found.signature, gives)


@_new.command("lesson", epilog="Example: course author new lesson contact-forces")
def new_lesson(name: _NewId) -> int:
    """Write a lesson with blanks to fill in.

    Nothing is overwritten. Put its id into syllabus.toml at the place where students should read it.
    """
    catalog = load_catalog()
    return _report_new(catalog, "lesson", name, scaffold.new_lesson(catalog, name))


@_new.command("question", epilog="Example: course author new question contact-forces")
def new_question(name: _NewId) -> int:
    """Write a quiz question with blanks to fill in.

    Nothing is overwritten. It has four variants, each with one right option and three wrong ones.
    """
    catalog = load_catalog()
    return _report_new(catalog, "question", name, scaffold.new_question(catalog, name))


@_new.command("scene", epilog="Example: course author new scene bouncing-ball")
def new_scene(name: _NewId) -> int:
    """Write a sandbox scene that runs, with blanks to fill in.

    In the checkout it becomes one of the course's scenes, and you play it with `course sandbox play ID`.
    Elsewhere it is a scene of your own: ID.toml in the folder you are in. Nothing is overwritten.
    """
    catalog = load_catalog()
    return _report_new(catalog, "scene", name, scaffold.new_scene(catalog, name))


def _report_new(catalog: Catalog, kind: str, name: str, files: tuple[Path, ...]) -> int:
    console = current()
    written = tuple(shown(path, catalog) for path in files)
    own = kind == "scene" and files[0].parent == Path.cwd()  # known by its file alone
    root = catalog.content.root
    elsewhere = "" if own or Path.cwd().is_relative_to(root) else f" in {root}"
    console.heading(f"Wrote {kind} {name}{elsewhere}.")
    for path in written:
        console.line(path, indent=2)
    if kind == "lesson":
        console.note("Put its id into syllabus.toml, at the place where it is read.")
    then = {
        # What the first writes, the second wants.
        "exercise": (f"author build {name} --accept", f"author check {name}"),
        "warm-up": (f"author build {name}", f"author check {name}"),
        "scene": (f"sandbox play {files[0].name if own else name}",),
    }.get(kind, (f"author check {name}",))
    commands = ", then ".join(f"course {command}" for command in then)
    console.note(f"Fill in the marked blanks, then run: {commands}")
    return console.answer(AuthorNew(kind=kind, id=name, files=written))


@app.command(epilog="Example: course author check integrators")
def check(
    name: Annotated[
        str | None,
        argument("ID", "A lesson, an exercise, a question or a scene; everything if left out.", _any_id),
    ] = None,
) -> int:
    """Prove that the course is right.

    Links work, hints and titles exist, points add up, stubs fail, solutions and accepted variants score full
    marks, and each mutant loses only its task's points, with the diagnosis it names. Generated files are up
    to date, and ruff finds nothing. Scenes are valid, and every formula in their texts has a value. Exit code
    1 if something is wrong.
    """
    console, catalog = current(), load_catalog()
    with meter(console) as on_progress:
        report = audit(catalog, name, on_progress=on_progress, refused=refused, is_command=is_command)
    blanks = [problem for problem in report.problems if problem.code == "blank"]
    for problem in blanks:
        console.line((problem.where, "bold"), f"  {problem.message}")
    if blanks:
        console.line((blanks[0].help, "dim"), indent=2)
    for problem in report.problems:
        if problem.code != "blank":
            _show_problem(console, problem)
    warm_ups = len({*report.exercises} & {*catalog.warm_up_ids()})
    among = f" ({counted(warm_ups, 'warm-up')} among them)" if warm_ups else ""
    looked = (
        f"{counted(len(report.lessons), 'lesson')}, {counted(len(report.exercises), 'exercise')}{among}, "
        f"{counted(len(report.questions), 'quiz question')}, {counted(len(report.scenes), 'scene')}, "
        f"{counted(report.checks, 'check')}, {counted(report.graded, 'submission')} graded"
    )
    level = f" at {report.isolation}" if report.isolation else ""
    found = ("All is well", "green") if report.ok else (counted(len(report.problems), "problem"), "red")
    console.line(found, f"{':' if report.ok else ' in'} {looked}{level} in {report.seconds:.1f} s.")
    try:
        course = catalog.ref
    except ContentError:
        course = CourseRef(id="", version="")  # the syllabus itself is what is wrong, and is reported
    code = 0 if report.ok else 1
    seconds = round(report.seconds, 3)
    return console.answer(filled(AuthorCheck, report, exit_code=code, course=course, seconds=seconds))


@app.command(epilog="Example: course author build collisions")
def build(
    name: _EachExercise = None,
    accept: Annotated[
        bool, option("--accept", "Grade every wrong program, and keep what comes of it; takes minutes.")
    ] = False,
) -> int:
    """Generate the files that follow from an exercise's sources.

    The points and counts in `exercise.toml`, which come from the checks' markers; `exercises/times.json`, how
    long slow public checks take, which decides when a loop counts as hung; `diagnoses.json`, the words of
    `mistakes.py` and the answers of its programs to the exercise's questions, as fingerprints, so that a
    diagnosis works at home, where there are no solutions. `course author check` refuses files that are out of
    date. With --accept each wrong program is graded, and `record.json` beside the solution keeps which check
    catches it and what it is told; each program that lost its check or its name is printed.
    """
    console, catalog = current(), load_catalog()
    catalog.content.instructors()
    every = (*catalog.exercises(), *catalog.warm_ups())
    chosen = every if name is None else (catalog.exercise(name),)
    made: list[Path | None] = []
    for exercise in chosen:
        try:
            made += [write_points(catalog, exercise), diagnosis.build(catalog, exercise)]
        except ContentError:  # a file with blanks is often no TOML either, and not for that reason
            blanks = Findings(catalog.content.root)
            if not find_blanks(catalog, exercise.id, blanks):
                raise
            first = blanks.problems[0]
            raise UsageError(
                f"{exercise.id} has {counted(len(blanks.problems), 'blank')} to fill in first, such as"
                f" {first.file}:{first.line}.",
                help=f"`course author check {exercise.id}` lists them.",
                code="unfinished_content",
            ) from None
    made.append(write_times(catalog, chosen))
    written = [shown(path, catalog) for path in dict.fromkeys(made) if path]
    for exercise in chosen if accept else ():
        if not exercise.is_warm_up:
            with meter(console) as on_progress:
                accepted = diagnosis.accept(catalog, exercise, on_progress=on_progress)
            written.append(shown(accepted.path, catalog))
            said = ", ".join(f"{name} {count}" for name, count in accepted.told.items())
            console.line(f"{exercise.id}, in a grading run: {said}.")
            for change in accepted.changes:
                console.line(change, indent=2)
    for file in written:
        console.line(f"Wrote {file}")
    older = [exercise.id for exercise in chosen if diagnosis.is_older(catalog, exercise)]
    for one in older:
        console.note(f"The record of {one} is older than its files: course author build {one} --accept")
    if not written and not older:
        console.note("All of it is up to date.")
    return console.answer(AuthorBuild(files=tuple(written)))


@app.command(epilog="Example: course author mutants integrators")
def mutants(name: _EachExercise = None) -> int:
    """Show the feedback for each wrong solution.

    Grades every mutant and shows the message, the advice and the diagnosis that its author would see. Exit
    code 1 if a mutant is not caught as it is on record.
    """
    console, catalog = current(), load_catalog()
    catalog.content.instructors()
    chosen = catalog.exercises() if name is None else (catalog.exercise(name),)
    rows = []
    for exercise in chosen:
        with meter(console) as on_progress:
            outcomes = run_mutants(catalog, exercise, on_progress=on_progress)
        _show_mutants(console, exercise, outcomes)
        for one in outcomes:
            faults = tuple(fault.message for fault in one.faults)
            named = {"exercise": exercise.id, "file": one.mutant.name, "misconception": one.looks_like}
            more = {"check": one.check or one.by, "faults": faults}
            rows.append(filled(MutantRow, one, one.mutant, **named, **more))
    wrong = sum(bool(row.faults) for row in rows)
    said = f"{wrong} not caught as they should be." if wrong else "each is caught as it says."
    console.line(f"{counted(len(rows), 'mutant')}: {said}")
    return console.answer(AuthorMutants(exit_code=1 if wrong else 0, mutants=tuple(rows)))


def _show_mutants(console: Console, exercise: Exercise, outcomes: tuple[MutantOutcome, ...]) -> None:
    for outcome in outcomes:
        mutant = outcome.mutant
        breaks = f"breaks {mutant.task}, loses {in_points(outcome.lost)}"
        console.heading(f"{exercise.id}: {mutant.name}", breaks)
        caught = f"{outcome.by} with {outcome.diagnosis}"
        told = {"mistake": outcome.looks_like, "caught by": caught, "reads": outcome.message}
        for label, text in (told | {"advice": outcome.help}).items():
            if text:
                console.item(label, text)
        for fault in outcome.faults:
            console.item("wrong", f"{fault.message} {fault.fix}", style="red")
        console.blank()


@app.command(epilog="Example: course author pack --solutions integrators -o solutions.coursepack")
def pack(
    solutions: Annotated[list[str], option("--solutions EXERCISE", "Pack its solution.", exercise_ids)],
    output: Annotated[Path, option("-o --output FILE", "What to write.")],
    more: Annotated[list[str] | None, argument("[EXERCISE]...", "More exercises.", exercise_ids)] = None,
) -> int:
    """Write the file that hands out solutions after the deadline.

    It holds each exercise's model solution and the prose that goes with it; `course solution` opens it. The
    same solutions give the same bytes. Nothing is overwritten.
    """
    console, catalog = current(), load_catalog()
    packed = write_pack(catalog, [*solutions, *(more or [])], output)
    digest = hashlib.sha256(output.read_bytes()).hexdigest()
    console.line(f"Wrote {output}.")
    for exercise_id, names in packed.items():
        console.item(exercise_id, ", ".join(names))
    console.note("A student puts it to use with `course solution`, after passing the exercise.")
    return console.answer(AuthorPack(course=catalog.ref, output=str(output), sha256=digest, solutions=packed))


app.command(epilog="Example: course author coverage --write")(coverage)
app.command(epilog="Example: course author pictures --check")(pictures)
