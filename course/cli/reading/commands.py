"""``course lessons``, ``lesson`` and ``warmup``: the lists, reading a lesson, doing a small task of one."""

import contextlib
import io
from collections.abc import Collection
from pathlib import Path
from typing import Annotated

from rich.console import Console as RichConsole

from course.browser import keep_closed
from course.catalog.load import Catalog
from course.catalog.markdown import read_task
from course.catalog.models import Exercise, Lesson
from course.cli.frame.console import MAX_WIDTH, Console, current
from course.cli.frame.here import Here, here_or_outside
from course.cli.frame.options import LessonName, Verbose, WarmUpName, option
from course.cli.frame.replies import Envelope, NextStep, filled
from course.cli.home.advice import after_lesson
from course.cli.home.overview import day, lesson_states, warm_up_states
from course.cli.home.replies import LessonState, WarmUpState
from course.cli.reading.lesson import Printer, printer
from course.cli.work.changing import Start, put
from course.cli.work.checking import check as check_work
from course.errors import CourseError, NotFoundError, UsageError
from course.printable import counted
from course.progress.history import Standing
from course.reading.parts import Script, Section, read_script

# ---
# Replies of the commands about lessons.


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


def lessons() -> int:
    """List the lessons, with what is read.

    In the order to read them; inside a workspace also which ones you have read.
    """
    console, (here, catalog) = current(), here_or_outside()
    states = lesson_states(catalog, here.standing() if here else Standing())
    rows: list[tuple[str, ...]] = []
    for state in states:
        read = day(state.read_at)[:10] if state.read_at else "" if here is None else "no"
        rows.append((state.id, str(len(rows) + 1), state.title, f"{state.minutes} min", read))
    console.table(("Id", "No.", "Lesson", "Time", "Read"), rows)
    unread = next((state.id for state in states if state.read_at is None), None)
    step = f"course lesson {unread}" if unread else None
    if step:
        console.next(step)
    return console.answer(Lessons(lessons=states, next=NextStep(step) if step else None))


def lesson(
    name: LessonName = None,
    page: Annotated[
        bool, option("--page", "A section at a time, by typed lines; with --plain for a screen reader.")
    ] = False,
    figures: Annotated[
        Path | None, option("--figures DIR", "Write the figures as PNG files into DIR.")
    ] = None,
    code: Annotated[
        int | None, option("--code N", "Print the code of cell N and nothing else.", min=1)
    ] = None,
    no_browser: Annotated[
        bool, option("--no-browser", "Open no page and no picture; say where each is.")
    ] = False,
) -> int:
    """Read one lesson.

    ID#SECTION is one of its sections, such as numerical-integration#swap-two-lines. On a terminal the lesson
    fills the screen: predict, run its cells, search; ? there lists the keys. With --page you do the same by
    typed lines. With --plain alone, or in a pipe, it is printed. Without an id: the next lesson you have not
    read. Inside a workspace your place and predictions are kept, and a lesson is read once you reach its end.
    """
    console, (here, catalog) = current(), here_or_outside()
    called, _, slug = (name or _next_unread(here, catalog)).partition("#")
    chosen = catalog.lesson_called(called)
    if no_browser:
        keep_closed()
    on_screen = code is None and not page and figures is None and console.fills_the_screen
    if on_screen and not slug:  # the first page need not wait for what is read here
        return _read_on_screen(console, here, catalog, chosen)
    script = read_script(chosen, catalog.warm_ups(chosen.id))
    section = _section(script, slug) if slug else None
    if code is not None:
        return _print_code(console, script, code)
    if on_screen:
        return _read_on_screen(console, here, catalog, chosen, slug)
    text = io.StringIO()
    shown = _printer(catalog, script, console, figures, text if console.json else None)
    paged, whole = page and console.interactive and section is None, section is None
    if section is not None:
        shown.blocks(script.blocks[section.start : section.end])
    elif paged:
        from course.cli.reading.by_line import LineReader
        from course.isolation.probe import kept_sandboxes

        with kept_sandboxes():  # its tasks are checked one after the other
            whole = LineReader(console, here, catalog, chosen, shown).read()
    else:
        shown.head()
        shown.blocks(script.blocks)
    # Printing is not reading: the student may never have seen the end.
    if here is not None and whole and paged:
        here.record("lesson", chosen.id, {"version": catalog.version})
    step = _after(here, chosen, read=paged) if whole else f"course lesson {chosen.id}"
    if paged and not whole:
        step += " --page"
    if paged:
        _say_unkept(console, here)
    if here is not None:
        here.tell()
    for picture in shown.pictures:
        console.note(f"Wrote {picture}")
    console.next(step)
    return console.answer(_reply(chosen, text.getvalue(), tuple(map(str, shown.pictures)), step))


def _reply(chosen: Lesson, text: str, figures: tuple[str, ...] = (), step: str = "") -> LessonReply:
    following = NextStep(step) if step else None
    return filled(LessonReply, chosen, text=text, figures=figures, next=following)


def _next_unread(here: Here | None, catalog: Catalog) -> str:
    """The first unread lesson; the first of all where nothing is recorded or everything was read."""
    read: Collection[str] = ()
    if here is not None:
        try:
            read = here.standing().read
        except CourseError as error:
            here.warnings.append(f"{error.message} {error.help}")
    ids = catalog.lesson_ids()
    if not ids:
        raise NotFoundError("This course has no lessons.", code="lesson_not_found")
    return next((item for item in ids if item not in read), ids[0])


def _printer(
    catalog: Catalog, script: Script, console: Console, figures: Path | None, text: io.StringIO | None
) -> Printer:
    """What prints a lesson on the console, or into ``text`` as ``--plain`` shows it."""
    shown_on = console.rich()
    if text is not None:
        shown_on = RichConsole(
            file=text, width=MAX_WIDTH, no_color=True, markup=False, emoji=False, highlight=False
        )
    return printer(catalog, script, shown_on, plain=console.plain, figures_dir=figures, wraps=console.wraps)


def _section(script: Script, slug: str) -> Section:
    found = next((section for section in script.sections if section.slug == slug), None)
    if found is None:
        known = ", ".join(section.slug for section in script.sections if section.level == 2)
        problem = f"{script.lesson.id} has no section {slug!r}."
        raise NotFoundError(problem, help=f"It has: {known}.", code="section_not_found")
    return found


def _read_on_screen(
    console: Console, here: Here | None, catalog: Catalog, chosen: Lesson, section: str = ""
) -> int:
    from course.cli.reading.screen.app import ReaderApp
    from course.cli.reading.screen.running import Drawer

    app = ReaderApp(catalog, chosen.id, section, here.workspace if here else None, Drawer())
    app.play()
    last, lesson = app.page.progress, app.page.progress.script.lesson
    for warning in dict.fromkeys(filter(None, (*(here.warnings if here else ()), app.page.trouble))):
        console.warn(warning)
    _say_unkept(console, here)
    console.next(_after(here, lesson, read=True) if last.read else f"course lesson {lesson.id}")
    return 0


def _say_unkept(console: Console, here: Here | None) -> None:
    if here is None:
        console.note("Your place and your predictions are kept in a workspace only: course init my-course")


def _print_code(console: Console, script: Script, number: int) -> int:
    cells = script.shown_cells
    if number > len(cells):
        problem = f"{script.lesson.id} has {counted(len(cells), 'cell')}."
        raise NotFoundError(problem, help="Name one of them.", code="cell_not_found")
    source = cells[number - 1].source
    console.raw(f"{source}\n")
    return console.answer(_reply(script.lesson, source))


def _after(here: Here | None, chosen: Lesson, *, read: bool) -> str:
    """The next step after a lesson that was read in a workspace, or that was printed."""
    if here is not None:
        with contextlib.suppress(CourseError):  # a record that cannot be read is warned about elsewhere
            return after_lesson(here.catalog, here.standing(), chosen, read=read)
    return f"course start {chosen.exercises[0]}" if chosen.exercises else "course lessons"


# ---
# ``course warmup``: lists the lessons' small tasks, starts one, checks one.


_MARKS = {"done": "✓", "started": "·", "new": " "}
_PLAIN_MARKS = {"done": "done", "started": "begun", "new": "to do"}


def warmup(
    name: WarmUpName = None,
    check: Annotated[bool, option("--check", "Check it, as `course check` does.")] = False,
    verbose: Verbose = False,
) -> int:
    """Do a lesson's small tasks.

    Without an id: all of them by lesson, with what is done; with a lesson's id, that lesson's. With the id or
    the number of one: its text, and the file to work in. Five minutes each, checked and explained as
    exercises are; they count for nothing.
    """
    console = current()
    if verbose and not check:
        raise UsageError("--verbose goes with --check.", help="Example: course warmup 3 --check --verbose")
    lesson = name if name and name in here_or_outside()[1].lesson_ids() else ""  # a number is a warm-up's
    if name is None or lesson:
        if check:
            raise UsageError("--check needs the id of a warm-up.", help="`course warmup` lists them.")
        return _list(console, lesson)
    here = Here.load()
    chosen = _warm_up(here.catalog, name)
    if check:
        return check_work(chosen.id, verbose=verbose)
    if not console.quiet and not console.json:
        show_text(console, here, chosen)
    files = put(console, here, chosen)
    step = f"course check {chosen.id}"
    about = f"about {counted(chosen.minutes, 'minute')}"
    console.note(f"Write in {chosen.place}/{chosen.module} with your own editor, {about}.")
    console.note(f"Check it:          {step}")
    console.note(f"On every save:     course watch {chosen.id}")
    console.note(f"Still failing:     course hint {chosen.id}")
    return here.answer(Start(exercise=chosen.id, files=files, next=NextStep(step)))


def _warm_up(catalog: Catalog, name: str) -> Exercise:
    """The warm-up of that id or number.

    Raises:
        NotFoundError: there is none, or it is an exercise.
    """
    try:
        chosen = catalog.warm_up_called(name.rstrip("/\\"))
    except NotFoundError as error:
        problem = f"There is no warm-up called {name!r}."
        fix = error.help.replace("course exercises", "course warmup")
        raise NotFoundError(problem, help=fix, code=error.code) from None
    if not chosen.is_warm_up:
        problem = f"{chosen.id} is an exercise, not a warm-up."
        fix = f"`course start {chosen.id}` puts it into the workspace."
        raise NotFoundError(problem, help=fix, code="not_a_warm_up")
    return chosen


def _list(console: Console, lesson: str = "") -> int:
    here, catalog = here_or_outside()
    try:
        standing = here.standing() if here else Standing()
        standing.events()  # an event that cannot be read is told of, whatever it is about
        states = warm_up_states(catalog, standing)
    except CourseError as error:
        console.warn(f"{error.message} {error.help}")
        states = warm_up_states(catalog, Standing())
    states = tuple(state for state in states if lesson in {"", state.lesson})
    if not states:
        console.line("This course has no warm-ups.")
    marks = _MARKS if console.fancy else _PLAIN_MARKS
    with console.paged():
        for one in catalog.lessons():
            ours = [state for state in states if state.lesson == one.id]
            if not ours:
                continue
            done = sum(state.state == "done" for state in ours)
            console.heading(one.title.partition(":")[0], f"{done} of {len(ours)} done")
            for state in ours:
                name = f"{state.number}. {state.title} ({state.id}), {state.minutes} min"
                console.item(marks[state.state], name, width=6)
    left = next((state for state in states if state.state != "done"), None)
    step = f"course warmup {left.id}" if left else ""
    if step:
        console.note(f"Next: {step}" if here else f"In a workspace (course init): {step}")
    return console.answer(WarmUps(warm_ups=states, next=NextStep(step) if step else None))


def show_text(console: Console, here: Here, chosen: Exercise) -> None:
    script = read_script(here.catalog.lesson(chosen.lesson), here.catalog.warm_ups(chosen.lesson))
    console.heading(chosen.title, counted(chosen.minutes, "minute"))
    _printer(here.catalog, script, console, None, None).blocks(read_task(chosen.readme_path))
    console.blank()
