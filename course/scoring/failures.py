"""How a check ends when it does not pass.

``CheckFailed`` carries a finding: the check compared something and it was wrong. ``StudentFailure`` means
that there was nothing to compare, because the student's code raised, hung, died or is missing. Neither is a
fault of the grader; any other exception from a check is.
"""

from __future__ import annotations

import builtins
import os
import re
import traceback
from collections.abc import Callable, Mapping
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from course.catalog.locate import PLACES, content
from course.figures.described import Plot
from course.isolation.failures import StudentFailure
from course.isolation.session import LOOP
from course.printable import ended, one_line
from course.scoring.elsewhere import absent, cure, lacking, numpys, unread
from course.scoring.explain.story import Diagnosis
from course.scoring.verdict import NO_VALUE, Finding, Places, Status

#: A comparison along time: the times, the student's values, the right ones, quantity and units.
Comparison = tuple[Any, Any, Any, str, str]


#: Seconds that the submission being judged has used in this check; 0 where none is.
CLOCK: ContextVar[Callable[[], float]] = ContextVar("CLOCK", default=float)


class CheckFailed(AssertionError):  # noqa: N818 - it is an outcome, named for what it says
    """A check found something wrong; ``finding`` says what.

    Attributes:
        bare: message and advice of the check itself, without its probe's diagnosis.
        broke: where the probe raised, for the check's author; empty if it did not.
        comparison: along time, if there was one.
        looked: a search of the check's own for the mistake was made on these numbers.
        search_s: seconds of ``CLOCK`` that the search took.
        common: asks again for all that the check asks, and says what the wrong results share; or None.
    """

    def __init__(
        self,
        finding: Finding,
        broke: str = "",
        bare: tuple[str, str] | None = None,
        guess: Diagnosis | None = None,
        comparison: Comparison | None = None,
        *,
        looked: bool = False,
        search_s: float = 0.0,
    ) -> None:
        super().__init__(finding.message)
        self.finding = finding
        self.common: Callable[[], str] | None = None
        self.bare = bare or (finding.message, finding.help)
        self.guess = guess or (Diagnosis(finding.diagnosis, "", "") if finding.diagnosis else None)
        self.broke = broke
        self.comparison = comparison
        self.looked = looked
        self.search_s = search_s


#: The most of an exception's own message that a sentence repeats, in characters.
_SAID = 200
#: Beginning of the message of a check that breaks whatever it is given.
ON_THE_MODEL = "The check itself failed, on the model solution too: "


def broke_at(error: BaseException) -> str:
    """An exception raised in a check, and the place it comes from, in one line for the check's author."""
    place = place_of(error)
    if place is None and (frames := traceback.extract_tb(error.__traceback__)):
        place = Path(frames[-1].filename).name, frames[-1].lineno or 0
    return f"{reason_of(error)} ({place[0]}, line {place[1]})" if place else reason_of(error)


def reason_of(error: BaseException) -> str:
    """The kind of an exception and its words, with a missing file as its author knows it."""
    try:
        said = one_line(str(error).partition("\n")[0], _SAID)
    except Exception:  # noqa: BLE001 - an exception may carry a value that cannot even be printed
        said = ""
    if isinstance(error, FileNotFoundError):
        given = (one for one in (error.filename, *error.args) if isinstance(one, str | bytes | Path))
        missing = next(given, None)
        if missing is not None:
            said = f"{content().shown(Path(os.path.normpath(os.fsdecode(missing))))} is not there"
    return f"{type(error).__name__}: {said}" if said else type(error).__name__


def place_of(error: BaseException) -> tuple[str, int] | None:
    """The innermost of the course's own files that an exception went through, and the line there."""
    here = content()
    folders = [folder for folder in map(here.place, PLACES) if folder is not None]
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        path = Path(frame.filename)
        if any(path.is_relative_to(folder) for folder in folders):
            return here.shown(path), frame.lineno or 0
    return None


def opened_at(error: BaseException, otherwise: Path, line: int | None = None) -> tuple[Path, int | None]:
    """The file and the line of the course that an author opens for an exception, else the given ones."""
    if isinstance(error, SyntaxError) and error.filename:
        return Path(error.filename), error.lineno
    place = place_of(error)
    return (content().root / place[0], place[1]) if place else (otherwise, line)


def finding_of(failure: StudentFailure, *, shown: bool = False) -> Finding:
    """A failure as words: what happened and what to do, without any value of the check's.

    The exception's own message is in ``actual``, which hidden checks do not show.

    Args:
        shown: no input is hidden, so the message repeats the exception's own.
    """
    if failure.kind == "error":
        return _error_finding(failure, shown=shown)
    if failure.kind == "missing" and failure.why is not None:
        return _left_out(failure, failure.why)
    if failure.kind == "missing":
        advice = "Keep the names the stub gave: define it at the top level of the file, spelled exactly so."
        return Finding(f"Your file has no function `{failure.type}`.", advice, "MISSING_FUNCTION")
    if failure.kind == "protocol":
        return Finding(_NOT_PLAIN, _AS_ASKED, "NOT_PLAIN_DATA", actual=failure.message or None)
    code, _, advice = NO_VALUE[Status(failure.kind)]
    message = _ENDED[failure.kind]
    if failure.kind == "timeout" and failure.line:
        places: Places = failure.places or Places()
        loop = "in the loop that begins " if failure.type == LOOP else ""
        message += f" It was still {loop}{places.phrase(failure.line)}."
    return Finding(message, advice, code, actual=failure.message or None)


def _left_out(failure: StudentFailure, why: StudentFailure) -> Finding:
    """The finding for a function that is in the file and could not be loaded."""
    places: Places = failure.places or Places()
    where = f" {places.phrase(why.line)}" if why.line else ""
    said = f": {one_line(why.message, _SAID).rstrip(' .')}" if why.message else ""
    if "SyntaxError" in why.bases:
        message = ended(f"Python cannot read `{failure.type}`{where}{said}")
        advice = unread(why) or "Look at that line and the one above it: a bracket, a colon, the indentation?"
    else:
        message = ended(f"`{failure.type}` could not be made: {why.type}{where}{said}")
        advice = lacking(why) or "Make that line work when the file is loaded, before any function is called."
    return Finding(message, advice, "MISSING_FUNCTION")


def _error_finding(failure: StudentFailure, *, shown: bool) -> Finding:
    if failure.type == "NotImplementedError":
        message = "This function is not written yet: it still raises NotImplementedError."
        advice = "Replace each `raise` line with your code; the docstring above it says what to return."
        return Finding(message, advice, "NOT_IMPLEMENTED")
    places: Places = failure.places or Places()
    where = f" {places.phrase(failure.line)}" if failure.line else ""
    if failure.type == "ImportNotDeclaredError":
        message = f"Your code needs a module{where} that this exercise does not allow."
        advice = "Do without it. Plots and experiments belong in a file of your own that imports this one."
        advice = absent(failure, shown=shown) or advice
        return Finding(message, advice, "IMPORT_NOT_ALLOWED", actual=failure.message)
    # A student chooses class names, and one could spell out a hidden input, so only known names are shown.
    known = isinstance(getattr(builtins, failure.type, None), type)
    name = failure.type if known else "an exception"
    fitting = _apart(failure, places, shown=shown)
    # Where the advice is known, the first of several lines is enough.
    words = re.split(r"\n|\\n", failure.message, maxsplit=1)[0] if fitting else failure.message
    said = one_line(words, _SAID).rstrip(" .") if shown else ""
    begin = "Start at that line: print above it the values that it uses, or call" if where else "Call"
    advice = f"{begin} the function yourself and read the traceback from the bottom up."
    message = f"Your code raised {name}{where}{': ' if said else ''}{said}."
    actual = f"{failure.type}: {failure.message}" if failure.message else failure.type
    return Finding(message, fitting or advice, "RAISED", actual=actual)


def _apart(failure: StudentFailure, places: Places, *, shown: bool) -> str:
    """The advice that fits this exception and no other; "" where none is known."""
    return (
        _at_a_terminal(failure)
        or _by_a_star(failure, places, shown=shown)
        or lacking(failure, shown=shown)
        or (cure(failure) if shown else "")
    )


def _by_a_star(failure: StudentFailure, places: Places, *, shown: bool) -> str:
    """The advice where a name is missing that a line left out may have brought; "" for any other."""
    why = failure.why
    if why is None or not why.line:
        return ""
    if why.type == "ImportNotDeclaredError":
        name = failure.message.partition("'")[2].partition("'")[0]
        known = numpys(name) if shown else ""  # the name may spell out a hidden input
        advice = absent(why) or known or "Import each name from the module that has it."
        return f"The name may come from the import {places.phrase(why.line)}, which was left out. {advice}"
    return f"What was left out {places.phrase(why.line)} would have defined it. Make that line work first."


def _at_a_terminal(failure: StudentFailure) -> str:
    """The advice where code wants somebody at a terminal; "" where it does not."""
    for call, alone in (("input", "EOFError"), ("breakpoint", "BdbQuit")):
        if failure.type == alone:
            return (
                f"Nobody types while a check runs. Take `{call}()` out of the function, "
                "and use it in a file of your own that imports this one."
            )
    for name in ("exit", "quit"):
        if failure.type == "NameError" and f"'{name}'" in failure.message:
            return f"`{name}` belongs to Python's prompt. End a function with `return`, or let it raise."
    return ""


_ENDED = {
    "timeout": "Your code had not answered when the time was up.",
    "memory": "Your code asked for more memory than a check may use.",
    "crash": "The Python process that ran your code ended.",
}
_NOT_PLAIN = "Your function returned, or passed on, something that is not plain data, or far too much of it."
_AS_ASKED = (
    "Return, and hand over, what the README asks for as plain data: real numbers, texts, None, or lists, "
    "tuples, dicts and arrays of them. A generator is none, and an array of dtype object neither: make a "
    "list of it."
)


# ---
# An exercise's report on a student's own code: text, tables and figures on public data.
#
# An exercise that has something to show ships ``report.py`` with a function ``report(submission)``. It calls
# the student's functions through the same boundary as the checks do.


@dataclass(frozen=True)
class Section:
    """One part of a report.

    Attributes:
        text: paragraphs, separated by empty lines; lines that begin with "- " are items.
        columns, rows: a table; every cell is text with its unit.
    """

    title: str
    text: str = ""
    columns: tuple[str, ...] = ()
    rows: tuple[tuple[str, ...], ...] = ()
    plot: Plot | None = None


@dataclass(frozen=True)
class Report:
    """Everything a report shows.

    Attributes:
        streams: recorded sensor streams by kind, for a ROS 2 bag.
    """

    title: str
    sections: tuple[Section, ...]
    streams: Mapping[str, Any] = field(default_factory=dict)


def guarded_section(title: str, make: Callable[[], Section]) -> Section:
    """The section that ``make()`` returns, or what went wrong if the student's code fails."""
    try:
        return make()
    except (StudentFailure, CheckFailed) as failure:
        finding = finding_for(failure)
        return Section(title, "\n\n".join(part for part in (finding.message, finding.help) if part))


def finding_for(failure: StudentFailure | CheckFailed) -> Finding:
    """The failure in words; it names a function that is still to be written.

    A check does not name it, because a name could reveal hidden inputs. A report has no hidden inputs.
    """
    if isinstance(failure, CheckFailed):
        return failure.finding
    finding = finding_of(failure, shown=True)
    functions = _FRAME.findall(failure.traceback)
    if failure.is_a("NotImplementedError") and functions:
        return Finding(f"`{functions[-1]}` is not written yet.", finding.help, finding.diagnosis)
    return finding


#: The function of a line of a traceback, as ``StudentFailure`` has it: "file.py:12 in name".
_FRAME = re.compile(r"^\S+:\d+ in ([A-Za-z_]\w{0,60})$", re.MULTILINE)
