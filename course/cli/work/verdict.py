"""A verdict on the screen: grouped by task; the message first, then advice, then numbers.

What a student can act on comes before the numbers behind it. Failed checks come after passed and unwritten
ones, and the summary is last, where the eye is when a terminal has finished scrolling.
"""

import os
import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from importlib.util import decode_source
from pathlib import Path

from course.catalog.models import Exercise, Task
from course.cli.frame.console import STATUS_STYLE, Console
from course.cli.frame.here import Here, cwd
from course.cli.work.chosen import StudentWork
from course.errors import CourseError
from course.isolation.inside.statements import line_of_bytes
from course.printable import counted, steady, unheeded
from course.scoring.verdict import CheckResult, Verdict, format_points, in_points, numbers_of

Tasks = Sequence[tuple[Task, Sequence[CheckResult]]]


# ---
# The student's printed output, which many use to find a mistake; shown in full only on request.


#: Lines that are shown by default: as many as leave room for the finding on 24 lines.
_MOST = 6
_INDENT = 2


def show_lines(console: Console, heading: str, text: str, *, whole: bool, indent: int = 0) -> None:
    """The first printed lines, and how many more there are."""
    lines = text.rstrip().splitlines()
    if not lines:
        return
    kept = lines if whole else lines[:_MOST]
    console.line(heading, indent=indent)
    console.block("\n".join(kept), indent=indent + _INDENT)
    if len(kept) < len(lines):
        left = len(lines) - len(kept)
        more = f"and {counted(left, 'more line')} with --verbose"
        console.line((more, "dim"), indent=indent + _INDENT)


def show_loading(console: Console, printed: str, *, whole: bool) -> None:
    """Show a file's output while it was loaded, if any."""
    if printed and not console.quiet:
        show_lines(console, "Loading your file printed:", printed, whole=whole)
        console.gap()


_DETAIL_INDENT = 4
_LABEL_WIDTH = 9
#: Columns beside a number: its indent, its label and the space between them.
_BESIDE = _DETAIL_INDENT + _LABEL_WIDTH + 2
#: Lines that a number may take where details are brief: the message must stay on the screen.
_SHORT = 2
#: Columns of a usual window.
_USUAL = 80


def show_verdict(
    console: Console,
    exercise: Exercise,
    verdict: Verdict,
    *,
    verbose: bool = False,
    whole: bool = True,
    brief: bool = False,
    focus: str = "",
    keyed: bool = False,
) -> None:
    """Show every task of a verdict, and the summary.

    Args:
        verbose: show tracebacks (the student's own lines) and what the student's code printed.
        whole: all public checks were run, so there is a summary.
        brief: show one failure in detail, the first one of the first function that fails, at the very end,
            and one line for everything else; students work on one at a time.
        focus: with ``brief``, the function to show instead.
        keyed: keys show what is kept back, and they are named below.
    """
    if not console.quiet:
        scored = not exercise.is_warm_up
        page = _Page(console=console, verbose=verbose, brief=brief, focus=focus, scored=scored)
        page.tasks([(task, [c for c in verdict.checks if c.task == task.id]) for task in exercise.task])
        # Checks of a task that the exercise does not list must not vanish.
        known = {task.id for task in exercise.task}
        for check in verdict.checks:
            if check.task not in known:
                page.check(check)
        page.close(keyed=keyed)
        unshown = sum(check.status == "pass" and bool(check.stdout) for check in verdict.checks)
        if unshown and not verbose:
            what = "a check that passes" if unshown == 1 else f"{unshown} checks that pass"
            console.note((f"Your code printed in {what}; --verbose shows it.", "dim"))
        for warning in verdict.warnings:
            console.line(f"Note: {warning}")
    passing, total = sum(check.status == "pass" for check in verdict.checks), len(verdict.checks)
    part = f"{passing} of {total} {'check passes' if passing == total == 1 else 'checks pass'}."
    for sentence in summary(exercise, verdict) if whole else [part]:
        console.line((sentence, "bold green" if verdict.all_pass else "bold"))


def show_changes(console: Console, broke: Sequence[str], fixed: Sequence[str]) -> None:
    """First what the last edit broke, and what it fixed: titles of functions or of checks."""
    for label, style, titles in (("broke", "bold red", broke), ("fixed", "bold green", fixed)):
        for title in titles:
            console.item(label, title, style=style, width=_LABEL_WIDTH)
    if broke or fixed:
        console.gap()


def show_everything(console: Console, exercise: Exercise, checks: Sequence[CheckResult]) -> None:
    """Every check of a grading run, hidden ones with their values: for the instructor."""
    page = _Page(console=console, verbose=True, brief=False, hidden=True)
    for task in exercise.task:
        page.task(task.title, [check for check in checks if check.task == task.id])


def summary(exercise: Exercise, verdict: Verdict) -> list[str]:
    """The result in one or two sentences."""
    total = len(verdict.checks)
    passing = sum(check.status == "pass" for check in verdict.checks)
    if exercise.is_warm_up:
        which = "The one check passes" if total == 1 else f"All {total} checks pass"
        some = f"{passing} of {total} checks {'passes' if passing == 1 else 'pass'}."
        return [f"{which}: this warm-up is done." if verdict.all_pass else some]
    score = f"Score {format_points(verdict.score)}/{format_points(verdict.max_score)}"
    hidden = exercise.hidden_checks
    run = "check runs" if hidden == 1 else "checks run"
    later = f"; {hidden} hidden {run} when it is graded" if hidden else ""
    if verdict.all_pass:
        everything = "The one public check passes" if total == 1 else f"All {total} public checks pass"
        return [f"{everything}{later}.", f"{score}."]
    points = verdict.max_score + exercise.hidden_points
    mark = f"a pass takes {format_points(exercise.pass_mark * points)} of {format_points(points)} points"
    return [
        f"{passing} of {total} public checks {'passes' if passing == 1 else 'pass'}{later}.",
        f"{score}; {mark}{', hidden checks included' if exercise.hidden_points else ''}.",
    ]


@dataclass(kw_only=True)
class _Page:
    """Shows one verdict; remembers what it has said, so as not to say it seven times."""

    console: Console
    verbose: bool
    brief: bool
    hidden: bool = False
    focus: str = ""
    scored: bool = True
    _said: set[str] = field(default_factory=set)
    _left_out: bool = False
    _kept_back: bool = False
    _shortened: bool = False
    _unscored: bool = False

    def tasks(self, tasks: Tasks) -> None:
        """The functions that pass, the unwritten ones, and last those that fail."""
        unwritten = [pair for pair in tasks if is_unwritten(pair[1])]
        begun = [pair for pair in tasks if pair[1] and pair not in unwritten]
        done = [pair for pair in begun if all(check.status == "pass" for check in pair[1])]
        failing = [pair for pair in begun if pair not in done]
        if self.brief and failing:
            failing = [self._but_one(done, unwritten, failing)]
        else:
            for task, checks in done:
                self.task(task.title, checks)
            if unwritten:
                self.unwritten(unwritten)
        for task, checks in failing:
            self.task(task.title, checks)

    def _but_one(self, done: Tasks, unwritten: Tasks, failing: Tasks) -> tuple[Task, Sequence[CheckResult]]:
        """A line for each function except the one to show in detail, which is returned."""
        for task, checks in done:
            self._label("pass", task.title, f"  {counted(len(checks), 'check')}")
        if unwritten:
            names = ", ".join(task.id for task, _ in unwritten)
            self.console.item("to do", names, style="yellow", width=_LABEL_WIDTH)
        chosen = next((pair for pair in failing if pair[0].id == self.focus), failing[0])
        for task, checks in failing:
            if task is not chosen[0]:
                self._left_out = True
                first = next(check for check in checks if check.status != "pass")
                self._label(first.status, task.title, f"  [{task.id}]")
        if done or unwritten or self._left_out:
            self.console.gap()
        return chosen

    def task(self, title: str, checks: Sequence[CheckResult]) -> None:
        """A heading with the points, and the task's checks."""
        self.console.heading(title, self._worth(checks))
        if _all_alike(checks) and not self.hidden:
            # The same thing keeps every check of the task from running: say it once.
            check = next(check for check in checks if check.status != "skip")
            self._label(check.status, check.message)
            self._details(check)
        elif self.brief and not self.verbose:
            # One check in detail, below a line for each other that does not pass.
            passing = [check for check in checks if check.status == "pass"]
            failing = sorted((c for c in checks if c.status != "pass"), key=lambda c: c.status == "skip")
            if passing:
                self._label("pass", counted(len(passing), "check"))
            for check in failing[1:]:
                why = f"  runs after {check.blocked_by} passes" if check.blocked_by else ""
                aside = why if check.status == "skip" else f"  [{check.id}]"
                self._label(check.status, self._title(check), aside)
            for check in failing[:1]:
                self.check(check)
        else:
            for check in checks:
                self.check(check)
        self.console.gap()

    def unwritten(self, tasks: Tasks) -> None:
        """The functions that are still the stub's, with each advice once; those of the rarer are named."""
        every = [check for _, checks in tasks for check in checks]
        self.console.heading("Still to do", self._worth(every))
        for task, _ in tasks:
            aside = (f"  [{task.id}]", "dim")
            self.console.item("to do", task.title, aside, style="yellow", width=_LABEL_WIDTH)
        of: dict[str, dict[str, None]] = {}
        for check in every:
            if check.unwritten:
                of.setdefault(check.help, {})[check.task] = None
        common = max(of, key=lambda advice: len(of[advice]))
        for advice, named in of.items():
            self._text(advice if advice == common else f"{', '.join(named)}: {advice}")
        self.console.gap()

    def _worth(self, checks: Sequence[CheckResult]) -> str:
        """The points of some checks; a warm-up has none."""
        return _points(checks) if self.scored else ""

    def check(self, check: CheckResult) -> None:
        """One check: its title, and everything about it if it did not pass."""
        aside = "" if check.status in {"pass", "skip"} else f"  [{check.id}]"
        if self.hidden:
            hidden = ", hidden" if check.visibility == "hidden" else ""
            aside = f"  [{check.id}{hidden}, {_points([check]) if check.max_points else 'no points'}]"
        self._label(check.status, self._title(check), aside)
        if check.status == "pass":
            if self.verbose:
                self._lines("Your code printed:", check.stdout)
            return
        if check.blocked_by:
            self._text(f"Runs once {check.blocked_by} passes.")
            return
        if check.message not in self._said:
            self._text(check.message)
        self._said.add(check.message)
        self._details(check)

    def _title(self, check: CheckResult) -> str:
        """The title; with a mark if the check gives no points in an exercise that has some."""
        if self.hidden or not self.scored or check.max_points:
            return check.title
        self._unscored = True
        return f"{check.title} *"

    def close(self, *, keyed: bool) -> None:
        """Say once what the mark means, and how to see what was kept back, unless keys do."""
        if self._unscored:
            self.console.line(("* No points here; the grading run judges it.", "dim"))
        if keyed:
            return
        if self._left_out:
            command = "`course check`" if self.scored else "--verbose"
            self.console.note((f"One function at a time in detail; {command} shows all.", "dim"))
        if self._shortened:
            self.console.note(("Long lists of numbers are left out; --verbose shows them.", "dim"))
        if self._kept_back:
            self.console.note(("--verbose shows tracebacks.", "dim"))

    def _details(self, check: CheckResult) -> None:
        if check.help and check.help not in self._said:
            self._text(check.help)
        # The name of a mistake tells its student nothing.
        named = [("diagnosis", check.diagnosis)] if check.diagnosis and self.verbose else []
        for label, text in (*numbers_of(check), *named):
            row = max(self.console.width, _USUAL) - _BESIDE  # a narrow window must not hide two numbers
            if self.brief and not self.verbose and len(text) > _SHORT * row:
                self._shortened = True
            else:
                self.console.item(label, text, style="dim", indent=_DETAIL_INDENT, width=_LABEL_WIDTH)
        self._said.add(check.help)
        self._lines("Your code printed:", check.stdout)
        if self.verbose:
            self._lines("Traceback, your lines only:", check.traceback)
        self._kept_back |= bool(check.traceback) and not self.verbose

    def _lines(self, heading: str, text: str | None) -> None:
        show_lines(self.console, heading, text or "", whole=self.verbose, indent=_DETAIL_INDENT)

    def _text(self, text: str) -> None:
        if text:
            self.console.line(text, indent=_DETAIL_INDENT)

    def _label(self, status: str, text: str, aside: str = "") -> None:
        """A status as a word, upper case where something is wrong, so that colour only repeats it."""
        word = status if status in {"pass", "skip"} else status.upper()
        self.console.item(word, text, (aside, "dim"), style=STATUS_STYLE.get(status, ""), width=_LABEL_WIDTH)


def is_unwritten(checks: Sequence[CheckResult]) -> bool:
    """True if the task's function is as the stub has it."""
    ran = [check for check in checks if check.status != "skip"]
    return bool(ran) and all(check.unwritten for check in ran)


def _all_alike(checks: Sequence[CheckResult]) -> bool:
    """True if one thing keeps all of several checks from running, such as a missing function."""
    ran = [check for check in checks if check.status != "skip"]
    if len(checks) < 2 or len({(check.status, check.message) for check in ran}) != 1:
        return False
    return ran[0].status not in {"pass", "fail"}


def _points(checks: Sequence[CheckResult]) -> str:
    points = format_points(sum(check.points for check in checks))
    return f"{points}/{in_points(sum(check.max_points for check in checks))}"


# ---
# Findings as lines that other programs read: annotations on GitHub, and the ``file:line:`` of compilers.


FORMATS = ("text", "github", "lines")

#: How a student's frame begins in a traceback, as ``StudentFailure`` has it.
_FRAME = re.compile(r"^\S+\.py:(\d+) in ", re.MULTILINE)
#: How a function that Python cannot read is told of in a file, by ``course.scoring.failures``.
_UNREAD = re.compile(r"Python cannot read `\w+` on line (\d+) of your file")


def annotate(console: Console, here: Here, work: StudentWork, verdict: Verdict, form: str) -> None:
    """One line for each cause of a failed check; a cause of several is said once."""
    said = set()
    for check in verdict.checks:
        if check.status in {"pass", "skip"}:
            continue
        line = line_of(work.data.decode("utf-8", "replace"), check, traced=work.notebook is None)
        if (line, check.message) in said:
            continue
        said.add((line, check.message))
        level = "warning" if check.status == "grader_error" else "error"
        title = f"{check.title} [{check.id}]"
        words = [check.message or f"This check ended in: {check.status}.", check.help]
        words += [f"{label}: {text}" for label, text in numbers_of(check)]
        console.raw(_shown(form, level, _path(here, work, form), line, title, "\n".join(filter(None, words))))


def annotate_error(console: Console, here: Here, work: StudentWork, error: CourseError, form: str) -> None:
    """One line for the error that keeps the whole file from being checked."""
    text = f"{error.message}\n{error.help}".strip()
    line = unread_line(work.source) if work.notebook is None else 1
    title = f"{work.exercise.title} [{error.code}]"
    console.raw(_shown(form, "error", _path(here, work, form), line, title, text))


def github(level: str, file: str, line: int, title: str, message: str) -> str:
    """A workflow command of GitHub's, which puts a message beside a line of a file.

    ``::error file={name},line={line},title={title}::{message}``, as "Workflow commands for GitHub Actions"
    in GitHub's documentation has it. The escaped characters are those that the runner un-escapes
    (``_escapeDataMappings`` and ``_escapePropertyMappings`` in ``actions/runner``,
    src/Runner.Common/ActionCommand.cs): a percent sign and line ends everywhere, colon and comma in
    properties, which they would end.
    """
    return f"::{level} file={_property(file)},line={line},title={_property(title)}::{_data(message)}\n"


def _shown(form: str, level: str, file: str, line: int, title: str, message: str) -> str:
    # Text from a student's exception must not control a terminal that shows the log.
    title, message = steady(title), steady(message)
    if form == "github":
        return github(level, file, line, title, message)
    return unheeded(f"{file}:{line}: {level}: {' '.join(f'{title}: {message}'.split())}\n")


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")


def unread_line(source: bytes | str) -> int:
    """The line where Python stops parsing a file; 1 if it parses all of it."""
    try:
        text = decode_source(source) if isinstance(source, bytes) else source
        compile(text, "", "exec", dont_inherit=True)
    except (SyntaxError, ValueError, LookupError) as problem:  # the last: a codec of no text
        source = source if isinstance(source, bytes) else source.encode(errors="replace")
        return getattr(problem, "lineno", None) or line_of_bytes(source, problem) or 1
    return 1


def line_of(text: str, check: CheckResult, *, traced: bool = True) -> int:
    """The line where the student's code raised, or Python stopped reading it; else where the function begins.

    Args:
        text: the file.
        traced: the lines of a traceback are lines of this file; those of a notebook's cells are none of its
            JSON.
    """
    if traced and (frames := _FRAME.findall(check.traceback or "")):
        return int(frames[-1])
    if traced and (unread := _UNREAD.match(check.message)):
        return int(unread[1])
    defined = re.compile(rf"""^[\s"]*def\s+{re.escape(check.task)}\s*\(""", re.MULTILINE)
    # The last definition of a name is the one that counts.
    found = [match.end() for match in defined.finditer(text)]
    return text.count("\n", 0, found[-1]) + 1 if found else 1


def _path(here: Here, work: StudentWork, form: str) -> str:
    """A path relative to the folder of the lines' reader, with slashes on every system."""
    path = here.workspace.path(work.exercise.place, work.name)
    top = os.environ.get("GITHUB_WORKSPACE") if form == "github" else None
    with suppress(ValueError):
        return path.resolve().relative_to(Path(top).resolve() if top else cwd().resolve()).as_posix()
    return path.as_posix()
