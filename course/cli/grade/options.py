"""The options of ``course grade`` that need more than a line, or that several commands take."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, TypeVar

import msgspec

from course.cli.frame.console import Console
from course.cli.frame.options import argument, choice_of, exercise_ids, option, run_numbers
from course.errors import UsageError
from course.grading.intake.downloads import LAYOUTS
from course.grading.results.effective import ScoreChange
from course.grading.running.rerun import Change
from course.grading.running.snapshot import FOREIGN, ForeignGradersError
from course.printable import one_line, quoted, some
from course.scoring.verdict import format_points

T = TypeVar("T")

_LEVELS = {"auto": (None, "L2"), "strict": ("L3", "L3"), "process": ("L1", "L1")}


def levels(isolation: str) -> tuple[str | None, str]:
    """The level to insist on, if any, and the weakest one to accept."""
    if isolation not in _LEVELS:
        raise UsageError(f"--isolation is {isolation!r}.", help="It takes auto, strict or process.")
    return _LEVELS[isolation]


def one_of(name: str, *values: str, help: str | None = None) -> Any:  # noqa: A002 - the option's name
    """An option that takes one of these values, which the shell completes."""
    return option(f"{name} {'|'.join(values)}", help, choice_of(*values))


def _share(text: str | float) -> float:
    """A part of a whole, as 0.6 or as 60%."""
    number, percent, rest = str(text).strip().partition("%")
    try:
        share = float(number) / (100 if percent else 1)
    except ValueError:
        share = -1.0
    if rest or not 0 <= share <= 1:
        problem = f"--share is {text!r}."
        raise UsageError(problem, help="It takes a number from 0 to 1, or a percentage: 0.6 or 60%.")
    return share


Against = Annotated[
    str, option("--against RUN|SNAPSHOT", "Use the graders of that run; `log` lists them.", run_numbers)
]
Exercises = Annotated[list[str] | None, option("--exercise ID", "These only.", exercise_ids)]
Isolation = Annotated[str, one_of("--isolation", *_LEVELS, help="As for `course grade run`.")]
Jobs = Annotated[int, option("-j", "Grader processes.", min=1, max=256)]
Layout = Annotated[
    str,
    one_of(
        "--layout",
        *LAYOUTS,
        help="The kind of folder; auto finds out, and refuses a folder that fits two kinds.",
    ),
]
LocalCluster = Annotated[
    int | None, option("--local-cluster N", "On N Dask workers started here.", min=1, max=256)
]
Missing = Annotated[
    str, one_of("--missing", "blank", "zero", help="What an enrolled student who handed in nothing gets.")
]
Out = Annotated[Path, argument("OUT", "Folder of a grading run.")]
Protection = Annotated[
    str,
    one_of(
        "--isolation",
        *_LEVELS,
        help="auto: the best level, L2 at least. strict: L3. process: L1, which does not protect your files.",
    ),
]
Reason = Annotated[str, option("--reason TEXT", "Kept with the change.")]
RosterFile = Annotated[
    Path | None,
    option("--roster FILE", "Who is enrolled: an export from Canvas, Moodle or Gradescope, or your own CSV."),
]
Scheduler = Annotated[
    str | None, option("--scheduler ADDRESS", "On the Dask cluster whose scheduler is there.")
]
Share = Annotated[
    float,
    option(
        "--share SHARE", "Show pairs with at least this much in common, such as 0.6 or 60%.", parser=_share
    ),
]


Yes = Annotated[bool, option("--yes -y", "Run the graders that are kept there; do not ask.")]


def agreed(console: Console, attempt: Callable[[str], T], *, yes: bool) -> T:
    """Do what runs the graders in a gradebook; if they are not this checkout's, only once a person agrees.

    Args:
        attempt: is given the digest of the graders that may run though they are somebody else's.
        yes: they may, whoever made them.
    """
    try:
        return attempt("")
    except ForeignGradersError as error:
        if yes:
            console.warn(error.message)
        elif not console.interactive:
            raise
        else:
            console.line(f"{error.message} {FOREIGN}")
            if not console.confirm("Do you trust whoever made this gradebook, and run them?"):
                problem = "Nothing was run, and nothing was changed."
                raise UsageError(problem, code="foreign_graders") from None
        return attempt(error.sha256)


def show_first(
    console: Console, rows: Sequence[T], show: Callable[[T], object], most: int = 20, where: str = "."
) -> None:
    """Show the first rows, and say how many more there are, and where."""
    for row in rows[:most]:
        show(row)
    if len(rows) > most:
        console.line(f"and {len(rows) - most} more{where}", indent=2)


# ---
# A change of a student's result, and what was kept about it, as a terminal shows them.


#: Characters of what a decision keeps, and scores of a class, that one line names; students in a list.
_SHOWN, _FEW, _MOST = 200, 5, 20


def show_change(console: Console, change: Change) -> None:
    """Scores and states before and after, and the checks with another outcome."""
    old, new = change.max_before, change.max_after
    scores = f"{points(change.raw_before, old)} -> {points(change.raw_after, new)}"
    if change.state_before != change.state_after:
        scores += f", {change.state_before} -> {change.state_after}"
    if change.overridden:
        scores += f"; the override stands at {points(change.score_after, new)}"
    elif (change.score_before, change.score_after) != (change.raw_before, change.raw_after):
        scores += f"; counting {points(change.score_before, old)} -> {points(change.score_after, new)}"
    console.item(f"{one_line(change.student)} {change.exercise}", scores)
    if change.raw_before is None or change.raw_after is None:
        return  # of what no check judged, none has changed
    for check in change.checks:
        became = f"{check.before or 'no such check'} -> {check.after or 'gone'}"
        delta = f"{check.points_after - check.points_before:+g} points"
        console.item(check.id, f"{became}, {delta}", indent=4)


def moved_scores(moved: Sequence[ScoreChange]) -> Iterator[str]:
    """Whose score changes, and how, one line each."""
    for one in moved[:_MOST]:
        scores = f"{points(one.before, one.max_before)} -> {points(one.after, one.max_after)}"
        yield f"{one_line(one.student)} {one.exercise}: {scores}"
    if len(moved) > _MOST:
        yield f"and {len(moved) - _MOST} more"


def show_roster(console: Console, file: str, moved: Sequence[ScoreChange], dropped: Sequence[str]) -> None:
    """What a roster changes, if anything: scores, and who is enrolled."""
    if moved:
        scores = "1 score changes" if len(moved) == 1 else f"{len(moved)} scores change"
        console.line((f"With {file}, {scores}:", "bold"))
    for line in moved_scores(moved):
        console.line(line, indent=2)
    if dropped:
        one = len(dropped) == 1
        who = f"{len(dropped)} student{' is' if one else 's are'} not in {file}"
        names = some([one_line(name) for name in dropped], _MOST)
        console.line(f"{who} and {'leaves' if one else 'leave'} the roster: {names}")


def points(score: float | None, most: float | None = None) -> str:
    """A score in words, beside the points there are where that is known; None is none."""
    if score is None:
        return "no score"
    return format_points(score) + ("" if most is None else f" of {format_points(most)}")


class _Counted(msgspec.Struct):
    """What counted for one student."""

    score: float | None = None
    of: float | None = None
    reason: str | None = None
    state: str | None = None
    file: str = ""


def in_words(text: str, student: str | None = None, exercise: str | None = None) -> str:
    """What counted, as a decision keeps it, for a person: a score, and why there was none.

    Args:
        student, exercise: of a decision about the class, show these alone.
    """
    with suppress(msgspec.MsgspecError, RecursionError):
        kept = msgspec.json.decode(text, type=_Counted)
        why = kept.reason or (kept.state if kept.score is None else "")
        words = (points(kept.score, kept.of), why or "", quoted(kept.file) if kept.file else "")
        return one_line(", ".join(filter(None, words)))
    with suppress(msgspec.MsgspecError, RecursionError):
        rows = msgspec.json.decode(text, type=list[tuple[str, str, float | None]])
        about = [one for one in rows if student in {None, one[0]} and exercise in {None, one[1]}]
        shown = [f"{who} {what} {points(score)}" for who, what, score in about]
        return one_line("; ".join(shown[:_FEW] + ["..."] * (len(shown) > _FEW)))
    return one_line(text[:_SHOWN])
