"""``course grade``: an instructor's commands for a class. They need a checkout."""

import secrets
from pathlib import Path
from typing import Annotated

import msgspec

from course.cli.frame.console import Console, current
from course.cli.frame.here import cwd, load_catalog
from course.cli.frame.options import argument, option
from course.cli.frame.registry import COMMANDS, group
from course.cli.frame.replies import Envelope, filled
from course.cli.grade.changing import assign, late, log, override
from course.cli.grade.options import Exercises, Missing, Out, Share, moved_scores, one_of, show_roster
from course.cli.grade.running import explain, rerun, run, show_listed
from course.errors import CourseError, UsageError
from course.grading.container import write_autograder
from course.grading.exports.formats import AUTOGRADER, FORMATS
from course.grading.exports.formats import export as write
from course.grading.exports.grades import STDOUT, grade_line, write_bytes
from course.grading.exports.selection import ExportOptions, Written, select
from course.grading.gradebook.book import Gradebook
from course.grading.gradebook.records import Decision
from course.grading.gradebook.salvage import Salvaged, back_up
from course.grading.gradebook.salvage import salvage as rescue
from course.grading.results.effective import Results, ScoreChange, counting, moved
from course.grading.results.merge import Merged, merged
from course.grading.results.roster import Roster, read_roster
from course.grading.running.folder import export_all, make_folder, open_results, remember
from course.grading.similar import Similar, compare, page
from course.isolation.launch import private_folder, remove_tree
from course.printable import command, counted, one_line, some
from course.scoring.verdict import LARGEST_SEED

#: Rows of a list; of what is lost, all but what no terminal keeps.
_SHOWN, _MOST_LOST = 20, 200
_LEFT_OUT = "left out, without a row or an id in the roster"


class GradeExport(Envelope, tag="course.grade-export/1", frozen=True, kw_only=True):
    """The export. ``unmatched`` are students without a row in the roster, left out with ``--partial``.

    ``moved`` are the scores that a second roster changed, ``dropped`` the students whom it does not have,
    ``kept`` rows of the platform's file that have a teacher's grade, feedback or excuse.
    """

    format: str
    paths: tuple[str, ...]
    rows: int
    unmatched: tuple[str, ...]
    without_grade: tuple[str, ...]
    notes: tuple[str, ...]
    moved: tuple[ScoreChange, ...] = ()
    dropped: tuple[str, ...] = ()
    kept: tuple[str, ...] = ()


def export(
    out: Annotated[Path | None, argument("OUT", "Folder of a grading run; an autograder needs none.")] = None,
    format: Annotated[str, one_of("--format", *FORMATS, AUTOGRADER)] = "csv",  # noqa: A002 - its name
    output: Annotated[
        Path | None, option("-o --output PATH", "File to write; in OUT if left out. - is standard output.")
    ] = None,
    roster: Annotated[
        Path | None, option("--roster FILE", "Who is enrolled; merged into the stored roster.")
    ] = None,
    assignment: Annotated[
        list[str] | None, option("--assignment EXERCISE=ID", "The assignment on the platform.")
    ] = None,
    partial: Annotated[bool, option("--partial", "Leave out students who are not on the roster.")] = False,
    missing: Missing = "blank",
    accept_zeros: Annotated[
        bool, option("--accept-zeros", "Write 0 for ungraded submissions without a decision.")
    ] = False,
    overwrite: Annotated[
        bool,
        option(
            "--overwrite",
            "Replace what is in the file already: Moodle's grades and feedback; Canvas' EX, and its scores"
            " where nothing was graded.",
        ),
    ] = False,
    exercise: Exercises = None,
    seed: Annotated[
        int | None, option("--seed", "For an autograder, if no OUT is given.", min=0, max=LARGEST_SEED)
    ] = None,
    timeout: Annotated[
        float, option("--timeout S", "CPU seconds per check, for an autograder.", min=0.1, max=60.0)
    ] = 10.0,
) -> int:
    """Write the grades in the format of another program.

    Overrides and the late policy are applied each time. Students who are not on the roster are listed and
    stop the export, unless --partial leaves them out. An ungraded submission stops an export to a platform,
    unless it has a score by hand or --accept-zeros makes it 0.
    """
    console = current()
    if output == Path("/dev/stdout"):
        output = STDOUT
    if output == STDOUT and (console.json or format in {"gradescope", "html"}):
        answer = "The answer of --json and the file do not" if console.json else f"--format {format} does not"
        raise UsageError(f"{answer} fit on standard output.", help="Name a place with -o PATH.")
    exercises = tuple(exercise or ())
    found = Merged(Roster(()))
    if format == AUTOGRADER:
        written: Written | None = _autograder(out, output, exercises, seed, timeout)
    elif out is None:
        problem = "This format needs OUT."
        raise UsageError(problem, help="Name the folder that `course grade run --out` wrote.")
    else:
        people = read_roster(roster) if roster else None
        if missing not in {"blank", "zero"}:
            raise UsageError(f"--missing is {missing!r}.", help="It takes blank or zero.")
        sheet = roster if format == "moodle-worksheet" else None
        given = _assignments(assignment or [])
        columns = people.assignments if people else {}
        options = ExportOptions(exercises, given, partial, missing, accept_zeros, sheet, overwrite, columns)
        written, found = _from_gradebook(console, out, format, output, people, options)
    if written is not None:
        _show(console, format, written, out, found)
    return 0


def _from_gradebook(
    console: Console, out: Path, name: str, output: Path | None, people: Roster | None, options: ExportOptions
) -> tuple[Written | None, Merged]:
    """Write it, and say first what the roster changes; nothing is written if it was printed."""
    with open_results(out) as opened:
        found, results = Merged(opened.roster or Roster(())), opened
        if people is not None:
            found = merged(opened, people)
            results = Results(opened.book, found.roster)
            found.moved = moved(counting(opened), counting(results))
        if not console.json and output != STDOUT:
            show_roster(console, found.roster.file, found.moved, found.dropped)
        if console.json and name == "jsonl" and output is None:
            for line in moved_scores(found.moved):
                console.warn(f"With {found.roster.file}, a score changes: {line}")
            for student in found.dropped:
                console.warn(f"Not in {found.roster.file}, leaves the roster: {one_line(student)}")
            selection = select(results, options)
            for effective in selection.each():  # with --json, JSON Lines are the answer itself
                console.emit_line(grade_line(effective, results.course))
            for student in selection.written.unmatched:
                console.warn(f"{one_line(student)}: {_LEFT_OUT}")
            return None, found
        written = write(results, name, out, output, options)
        is_new = people is not None and opened.book.meta().get("roster") != found.roster.dump()
    if people is not None and is_new:
        try:
            # Its extensions count, so the files beside the gradebook are written again.
            with open_results(out, writing=True) as opened:
                remember(opened.book, people)
        except CourseError as error:  # the export itself is complete
            console.warn(f"The roster was not remembered: {error.message}")
    return written, found


def _assignments(given: list[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for text in given:
        name, equals, number = text.partition("=")
        if not (name and equals and number) or name in found:
            problem = f"--assignment is {text!r}."
            raise UsageError(problem, help="It takes EXERCISE=ID, once for each exercise.")
        found[name] = number
    return found


def _autograder(
    out: Path | None, output: Path | None, exercises: tuple[str, ...], seed: int | None, timeout: float
) -> Written:
    catalog = load_catalog()
    chosen = tuple(catalog.exercise(name) for name in exercises) or catalog.exercises()
    if out is not None and seed is None:
        with open_results(out) as results:
            seed = results.seed
            noted = {item.id for item in results.exercises()}
        if not exercises:
            chosen = tuple(item for item in chosen if item.id in noted)
    drawn = secrets.randbits(31) if seed is None else seed
    target = output or (out or cwd()) / "gradescope-autograder.zip"
    return write_autograder(target, catalog, chosen, seed=drawn, timeout=timeout, asked=bool(exercises))


def _show(console: Console, name: str, written: Written, out: Path | None, found: Merged) -> None:
    if console.json:
        paths = tuple(map(str, written.paths))
        console.emit(filled(GradeExport, written, found, format=name, paths=paths))
        return
    if STDOUT in written.paths:  # what else there is to say must not get into the file
        for text in (*written.notes, *(f"{one_line(one)}: {_LEFT_OUT}" for one in written.unmatched)):
            console.warn(text)
        return
    for path in written.paths:
        console.line((f"Wrote {path}.", "bold"))
    broken = f"without a score, by a fault of the grader; {command('grade', 'rerun', out)} grades these"
    show_listed(console, written.unmatched, _LEFT_OUT)
    show_listed(console, written.without_grade, broken)
    for note in written.notes:
        console.note(note)


# ---
# ``similar`` and ``salvage``.


class SimilarPair(msgspec.Struct, frozen=True, kw_only=True):
    """Two submissions of one exercise; ``share`` of the smaller one is in the other."""

    exercise: str
    first: str
    second: str
    share: float
    lines: int


class SimilarGroup(msgspec.Struct, frozen=True, kw_only=True):
    """Submissions of one exercise that similar pairs link; ``share`` is that of the weakest pair."""

    exercise: str
    members: tuple[str, ...]
    share: float


class GradeSimilar(Envelope, tag="course.grade-similar/1", frozen=True, kw_only=True):
    """Pairs, the most alike first, and groups, the largest first; the page shows the pairs side by side."""

    compared: int
    pairs: tuple[SimilarPair, ...]
    groups: tuple[SimilarGroup, ...]
    unreadable: tuple[str, ...]
    page: str


def similar(
    out: Out,
    exercise: Exercises = None,
    # The right solutions in solutions/*/accepted share 0.39 at most with the model solution, by weight; a
    # copy whose names were changed shares 1.
    share: Share = 0.6,
    output: Annotated[Path | None, option("-o --output FILE", "Page; OUT/similar.html if left out.")] = None,
) -> int:
    """Find submissions that are alike.

    Writes a page that shows them side by side. Everything happens on this machine. Names, comments and
    layout do not count, and neither does the stub. Similarity is a reason to talk with students, not a proof.
    """
    console, catalog = current(), load_catalog()
    with open_results(out) as results, console.working("Comparing"):
        found = compare(results, catalog, tuple(exercise or ()), at_least=share)
    target = output or out / "similar.html"
    write_bytes(target, page(found).encode("utf-8"))
    if not console.json:
        _show_similar(console, found)
        console.note(f"Side by side: {target}")
    pairs = []
    for one in found.pairs:
        labels = {"first": one.first.label, "second": one.second.label}
        pairs.append(filled(SimilarPair, one, **labels, share=round(one.share, 4)))
    groups = tuple(filled(SimilarGroup, one, share=round(one.share, 4)) for one in found.groups)
    return console.answer(filled(GradeSimilar, found, pairs=tuple(pairs), groups=groups, page=str(target)))


def _show_similar(console: Console, found: Similar) -> None:
    for one in found.groups[:_SHOWN]:
        names = some([one_line(name) for name in one.members], 8)
        words = f"{one.exercise}, weakest pair {one.share:.0%}: {names}"
        console.item(f"group of {len(one.members)}", words)
    if found.groups[_SHOWN:]:
        console.line(f"and {counted(len(found.groups) - _SHOWN, 'more group')}", indent=2)
    for pair in found.pairs[:_SHOWN]:
        both = f"{one_line(pair.first.label)} and {one_line(pair.second.label)}, {pair.exercise}"
        console.item(f"{pair.share:.0%}", f"{both}, {counted(pair.lines, 'line')} alike", width=5)
    if len(found.pairs) > _SHOWN:
        console.line(f"and {counted(len(found.pairs) - _SHOWN, 'more pair')}", indent=2)
    among = counted(found.compared, "submission")
    console.line((f"{counted(len(found.pairs), 'pair')} among {among}.", "bold"))
    if found.left_out:
        console.note(f"{counted(found.left_out, 'more pair')} not listed; raise --share.")
    if found.unreadable:
        names = some(found.unreadable, _MOST_LOST)
        console.note(f"{len(found.unreadable)} not compared (not Python, or over 200 kB): {names}.")


class GradeSalvage(Envelope, tag="course.grade-salvage/1", frozen=True, kw_only=True):
    """Rows by table, the number that only a backup had, and the known losses."""

    dry_run: bool
    rows: dict[str, int]
    from_backup: dict[str, int]
    lost: tuple[str, ...]
    out: str


def salvage(
    out: Out,
    to: Annotated[Path, option("--to NEW", "Folder for the intact rows; must be new.")],
    dry_run: Annotated[bool, option("--dry-run", "Report what can be recovered; write nothing.")] = False,
) -> int:
    """Recover the intact parts of a damaged gradebook and its backups.

    Everything goes into a new folder; the damaged file and its backups stay unchanged. The exit code is 0
    if nothing is known to be lost, else 6 with a list; `course grade run --resume` grades what is missing.
    """
    console = current()
    if to.exists():
        problem = f"{to} exists already; nothing was changed."
        raise UsageError(problem, help="Name a new folder.", code="out_exists")
    folder = private_folder() if dry_run else to
    make_folder(folder)
    try:
        path = folder / "gradebook.sqlite"
        told = rescue(out / path.name, path)
        with Gradebook(path, writing=True) as book:
            lost = "; ".join(told.lost) or "nothing known to be lost"
            book.note(Decision("", "", "salvage", "", "", f"from {one_line(str(out))}", "", lost))
            if not dry_run:
                export_all(folder, Results(book))
        if not dry_run:
            back_up(path)
    finally:
        if dry_run:
            remove_tree(folder)
        elif not any(folder.iterdir()):
            folder.rmdir()
    if not console.json:
        _show_salvaged(console, told, to, dry_run=dry_run)
    code = 6 if told.lost else 0
    return console.answer(filled(GradeSalvage, told, exit_code=code, dry_run=dry_run, out=str(to)))


def _show_salvaged(console: Console, told: Salvaged, to: Path, *, dry_run: bool) -> None:
    for name in ("results", "submissions", "overrides", "journal", "snapshots"):
        backed = told.from_backup[name]
        words = f"{told.rows[name]}" + (f", {backed} of them from a backup" if backed else "")
        console.item(name, words, width=12)
    for entry in told.lost[:_MOST_LOST]:
        console.line(f"lost: {one_line(entry)}")
    console.line((f"{len(told.lost) or 'Nothing is'} known to be lost.", "bold"))
    if not dry_run:
        with open_results(to) as results:
            only = [word for one in results.exercises() for word in ("--exercise", one.id)]
        rest = command("grade", "run", "SUBMISSIONS", *only, "--out", to, "--resume")
        console.note(
            f"Written: {to}. With the folder that counts now for SUBMISSIONS, {rest} grades what is missing."
        )


app = group(COMMANDS["grade"].summary)


for _command, _example in (
    (run, "run submissions --exercise integrators --out grades -j 2"),
    (explain, "explain grades ada integrators"),
    (assign, "assign grades ada homework.py --reason 'she named it so'"),
    (rerun, "rerun grades --dry-run"),
    (override, "override grades ada integrators --score 80 --reason 'oral exam'"),
    (late, "late grades --policy late.toml"),
    (log, "log grades"),
    (similar, "similar grades"),
    (export, "export grades --format canvas --roster class.csv --assignment integrators=4711"),
    (salvage, "salvage grades --to grades-salvaged"),
):
    app.command(_command.__name__, epilog=f"Example: course grade {_example}")(_command)
