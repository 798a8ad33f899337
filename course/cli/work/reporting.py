"""``course report``: the student's own code on public data, in words, tables and figures."""

import re
import shlex
from pathlib import Path
from typing import Annotated

from course.cli.frame import here
from course.cli.frame.console import Console, current
from course.cli.frame.here import Here, named
from course.cli.frame.options import ExerciseName, option
from course.cli.frame.replies import filled
from course.cli.home.advice import after_report
from course.cli.work.checking import report_source_file
from course.cli.work.chosen import asked_for, chosen_work
from course.cli.work.replies import ReportReply, SectionReply
from course.errors import UsageError
from course.scoring.failures import Report, Section


def report(
    exercise: ExerciseName = None,
    out: Annotated[
        Path | None, option("--out -o DIR", "Where figures go; default: report/ beside your file.")
    ] = None,
    bag: Annotated[
        Path | None, option("--bag DIR", "Write the sensor streams as a ROS 2 bag (extra ros).")
    ] = None,
) -> int:
    """Show what your code does, with figures.

    Runs your functions on public data, as the checks do, and draws the results. Parts whose functions are not
    written yet say so.
    """
    from course.scoring.judging.session import report_of

    console, here = current(), Here.load()
    work = chosen_work(here, *asked_for(here, exercise))
    chosen = work.exercise
    report_source_file(console, here, work)
    with console.working(f"Running {work.name}"):
        made = report_of(chosen, here.catalog, work.submission)
    folder = here.workspace.path(chosen.place, "report") if out is None else named(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        problem = f"The folder {folder} cannot be made ({error.strerror or error})."
        raise UsageError(problem, help="Name another one with --out.", code="not_writable") from error
    console.heading(made.title, chosen.id)
    names = (re.sub(r"[^a-z0-9]+", "-", one.title.lower()).strip("-")[:40] for one in made.sections)
    files = (folder / f"{number}-{name or 'section'}.png" for number, name in enumerate(names, 1))
    sections = tuple(_shown(console, *both) for both in zip(made.sections, files, strict=True))
    written = _write_bag(console, made, bag) if bag is not None else None
    console.next(after_report(here, chosen))
    named_so = {"course": here.course, "exercise": chosen.id}
    return here.answer(filled(ReportReply, made, **named_so, sections=sections, bag=written))


def _shown(console: Console, section: Section, path: Path) -> SectionReply:
    """Print one section, draw its figure, and give both for scripts."""
    console.blank()
    console.line((section.title, "bold"))
    for paragraph in section.text.split("\n\n"):
        if not paragraph.lstrip().startswith("- "):
            console.line(" ".join(paragraph.split()))
            continue
        for item in paragraph.strip().split("\n"):
            console.line(item.strip(), indent=2)
    if section.rows:
        console.table_or_facts(section.columns, section.rows)
    if (plot := section.plot) is None:
        return filled(SectionReply, section, figure=None, description="")
    from course.figures.plots import draw, render

    with console.working("Drawing"):
        picture = render(plot)
    console.figure(lambda: draw(plot))
    if plot.description:
        console.line(("Figure: " + plot.description, "dim"))
    # An unchanged figure needs no copy of the old one.
    path.unlink(missing_ok=True)
    figure = here.write_told(path, picture, why="report")
    return filled(SectionReply, section, figure=figure, description=plot.description)


def _write_bag(console: Console, made: Report, bag: Path) -> str:
    if not made.streams:
        problem = "This report has no sensor streams to write."
        fix = "Its sensors are not written yet, or the exercise has none."
        raise UsageError(problem, help=fix, code="no_streams")
    from course.simulations.bags import KINDS, VIEW, streams_from, write_bag

    path, streams = named(bag), streams_from(made.streams)
    write_bag(path, streams)
    kinds = {kind: name for name, kind in KINDS.items()}
    counts = [f"{len(stream.t)} of {kinds[type(stream)]}" for stream in streams]
    console.blank()
    console.line(f"Wrote {path}: messages {', '.join(counts)}.")
    console.note(f"With ROS 2: ros2 bag play {shlex.quote(str(path))}")
    console.note(f"Beside it: rviz2 -d {shlex.quote(str(path / VIEW))} --ros-args -p use_sim_time:=true")
    return str(path)
