"""The history of one exercise, and where a student is with all, from the events.

The record only lists events; this module answers the commands' questions about them: which checks fail
now, is another hint due, was it ever passed, which lessons were read.
"""

import ast
import hashlib
import math
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from types import MappingProxyType
from typing import Any

from course.progress.quiz import QuizHistory, quiz_history
from course.progress.store import Event, Store
from course.progress.workspace import Workspace

_PASS, _SKIP = "pass", "skip"
_UNWRITTEN = "NOT_IMPLEMENTED"


@dataclass(frozen=True, slots=True)
class CheckKept:
    """What is kept of a check that ran.

    Attributes:
        diagnosis: "" for none.
        numbers: of a failed one, the fields that a hint may name.
        raised: the exception that ended it, in its own words; "" if none did.
    """

    id: str
    task: str
    status: str
    diagnosis: str
    numbers: Mapping[str, str]
    raised: str

    @property
    def passed(self) -> bool:
        return self.status == _PASS

    @property
    def wrong(self) -> bool:
        """It ran and did not pass."""
        return self.status not in {_PASS, _SKIP}

    @property
    def unwritten(self) -> bool:
        """It found its function as it was handed out."""
        return self.diagnosis == _UNWRITTEN


@dataclass(frozen=True, slots=True)
class CheckRun:
    """One run of the public checks.

    Attributes:
        id: of its event.
        at: when, in UTC.
        state: "graded" or "ungradable".
        only: the one requested check or function; empty for a run of all public checks.
        score, max_score: points.
        passed: the pass mark was reached.
        all_pass: every check passed.
        seconds: how long it took.
        fingerprint: of the file that was checked.
        checks: in the order they ran.
    """

    id: int
    at: datetime
    state: str
    only: str
    score: float
    max_score: float
    passed: bool
    all_pass: bool
    seconds: float
    fingerprint: str
    checks: tuple[CheckKept, ...]

    @property
    def wrong_tasks(self) -> frozenset[str]:
        """Tasks with a check that ran and did not pass."""
        return frozenset(check.task for check in self.checks if check.wrong)

    @property
    def right_tasks(self) -> frozenset[str]:
        """Tasks whose every check passed."""
        tasks = {check.task for check in self.checks}
        return frozenset(tasks - {check.task for check in self.checks if not check.passed})


@dataclass(frozen=True, slots=True)
class HintGiven:
    """A hint that was shown, and the file it was shown for."""

    id: int
    task: str
    index: int
    fingerprint: str


@dataclass(frozen=True, slots=True)
class History:
    """Everything recorded about one exercise, oldest first."""

    runs: tuple[CheckRun, ...]
    hints: tuple[HintGiven, ...]
    started: datetime | None

    @property
    def last(self) -> CheckRun | None:
        """The newest run, with or without a score."""
        return self.runs[-1] if self.runs else None

    @property
    def last_graded(self) -> CheckRun | None:
        """The newest run of all public checks that gave a score."""
        return next(reversed(self._whole), None)

    @property
    def best(self) -> CheckRun | None:
        """The run of all public checks with the most points, the earliest of equals."""
        return max(self._whole, key=lambda run: run.score, default=None)

    @property
    def first_pass(self) -> CheckRun | None:
        """The first run of all public checks that reached the pass mark."""
        return next((run for run in self._whole if run.passed), None)

    @property
    def done(self) -> CheckRun | None:
        """The first run of all public checks that every one of them passed."""
        return next((run for run in self.runs if run.all_pass and not run.only), None)

    @property
    def _whole(self) -> list[CheckRun]:
        return [run for run in self.runs if run.state == "graded" and not run.only]

    def changed_tasks(self) -> tuple[frozenset[str], frozenset[str]]:
        """Tasks that the newest whole run found wrong and then right, and right and then wrong.

        It is compared with the whole run before, if that checked another file. A function that was not
        written then was not wrong.
        """
        if len(self._whole) < 2 or self._whole[-2].fingerprint == self._whole[-1].fingerprint:
            return frozenset(), frozenset()
        before, now = self._whole[-2:]
        fixed, broke = before.wrong_tasks & now.right_tasks, before.right_tasks & now.wrong_tasks
        return fixed - {check.task for check in before.checks if check.unwritten}, broke

    def failing_tasks(self) -> frozenset[str]:
        """Tasks with a check that does not pass, as far as is known.

        The newest run of all checks counts, corrected by checks that were run alone after it.
        """
        return frozenset(check.task for check in self._known() if not check.passed)

    def unwritten_tasks(self) -> frozenset[str]:
        """Failing tasks whose function is as it was handed out, or was never reached by a check."""
        begun = {check.task for check in self._known() if check.wrong and not check.unwritten}
        return self.failing_tasks() - begun

    def _known(self) -> Iterable[CheckKept]:
        """Every check, as it was when it last ran."""
        found: dict[str, CheckKept] = {}
        for run in self.runs:
            if run.state == "graded":
                if not run.only:
                    found.clear()
                found |= {check.id: check for check in run.checks}
        return found.values()

    def hints_for(self, task: str) -> tuple[int, ...]:
        """Which hints of a task were shown, in that order."""
        return tuple(dict.fromkeys(hint.index for hint in self.hints if hint.task == task))

    def diagnosed(self, task: str) -> tuple[tuple[str, Mapping[str, str]], ...]:
        """The findings about a task in the newest run that had one of its checks.

        Returns:
            diagnosis, "" for none, and numbers of each check of the task that did not pass, in their order.
        """
        about = ([check for check in run.checks if check.task == task] for run in reversed(self.runs))
        last = next((checks for checks in about if checks), [])
        return tuple((check.diagnosis, check.numbers) for check in last if not check.passed)

    def hint_is_due(self, stub: str) -> bool:
        """True if a check failed on a file that changed since the last hint (since the stub, for the first).

        A function that is not begun fails, too, and does not count as an attempt.

        Args:
            stub: fingerprint of the file as it was handed out.
        """
        hint = self.hints[-1] if self.hints else None
        if self.failing_tasks() == self.unwritten_tasks():
            return False
        before = hint.fingerprint if hint else stub
        since = hint.id if hint else 0
        attempts = (run for run in self.runs if run.id > since and run.fingerprint != before)
        return any(not check.passed for run in attempts for check in run.checks)


def history_of(events: Iterable[Event]) -> History:
    """The history that the events of one exercise tell; other kinds of events are passed over."""
    runs: list[CheckRun] = []
    hints: list[HintGiven] = []
    started: datetime | None = None
    for event in events:
        if event.kind == "check":
            runs.append(_run(event))
        elif event.kind == "hint":
            task, known = (str(event.data.get(key, "")) for key in ("task", "fingerprint"))
            hints.append(HintGiven(event.id, task, int(event.data.get("index", 0)), known))
        elif event.kind == "start" and started is None:
            started = event.at
    return History(runs=tuple(runs), hints=tuple(hints), started=started)


def fingerprint(source: bytes) -> str:
    """A digest of a file's statements, without comments and layout; another one is another attempt.

    The same code in a notebook is the same attempt. There a module's docstring is a text cell, and a ``pass``
    replaces each magic; so neither of these counts, nor does the order of functions. That of all other
    statements does. A file that does not parse is known by its bytes, line endings aside.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about escapes in the student's strings; not our business here
            tree = ast.parse(source)
            body = tree.body[1:] if ast.get_docstring(tree, clean=False) is not None else tree.body
            functions = {node.name: ast.dump(node) for node in body if isinstance(node, ast.FunctionDef)}
            others = [node for node in body if not isinstance(node, ast.FunctionDef | ast.Pass)]
            statements = [*sorted(functions.values()), *map(ast.dump, others)]
            code = "\n".join(statements).encode("utf-8", "surrogatepass")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        code = source.replace(b"\r\n", b"\n")
    return hashlib.sha256(code).hexdigest()


def _number(value: object) -> float:
    """The recorded number, or 0 if an edited file has something else there: no command may fail over that."""
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else 0.0


def _run(event: Event) -> CheckRun:
    data: Mapping[str, Any] = event.data
    return CheckRun(
        id=event.id,
        at=event.at,
        state=str(data.get("state", "graded")),
        only=str(data.get("only") or ""),
        score=_number(data.get("score")),
        max_score=_number(data.get("max_score")),
        passed=bool(data.get("passed", False)),
        all_pass=bool(data.get("all_pass", False)),
        seconds=_number(data.get("seconds")),
        fingerprint=str(data.get("fingerprint", "")),
        checks=tuple(_check(check) for check in data.get("checks", ()) if isinstance(check, dict)),
    )


def _check(kept: Mapping[str, Any]) -> CheckKept:
    numbers = kept.get("numbers")
    return CheckKept(
        id=str(kept.get("id")),
        task=str(kept.get("task")),
        status=str(kept.get("status")),
        diagnosis=str(kept.get("diagnosis") or ""),
        numbers={str(k): str(words) for k, words in numbers.items()} if isinstance(numbers, dict) else {},
        raised=str(kept.get("raised", "")),
    )


# ---
# Which mistakes a student made, and when each was mended, from the recorded checks.
#
# A mistake is a diagnosis of one function. It is mended when every check that showed it has passed since;
# checks that now fail for another reason do not mend it.


#: Diagnoses that are not mistakes of their own: unwritten work, and consequences of another mistake.
NO_MISTAKE = frozenset({"NOT_IMPLEMENTED", "MISSING_FUNCTION", "MEASURED_AS_NONE", "CALLS_A_WRONG_FUNCTION"})


@dataclass(slots=True)
class Mistake:
    """One mistake in one function.

    Attributes:
        exercise, task: where.
        diagnosis: its code.
        first, last: the first and the last run that showed it, in UTC.
        runs: how many runs showed it.
        raised: the exception that the last of them ended in; "" if it was none.
        mended: the run after which every check that showed it had passed; None while one has not.
        open: ids of the checks that showed it and have not passed since.
        showing: ids of those that showed it when they were last run.
    """

    exercise: str
    task: str
    diagnosis: str
    first: datetime
    last: datetime
    runs: int = 0
    raised: str = ""
    mended: datetime | None = None
    open: set[str] = field(default_factory=set)
    showing: set[str] = field(default_factory=set)

    @property
    def named(self) -> bool:
        """Whether the newest checks of its function still name it; a half-saved file's is soon not."""
        return bool(self.showing)


def mistakes_of(events: Iterable[Event]) -> tuple[Mistake, ...]:
    """The mistakes that events of kind "check" tell of, in the order they were first made.

    Runs that were recorded before diagnoses were kept tell of none.
    """
    found: dict[tuple[str, str, str], Mistake] = {}
    for event in events:
        if event.kind != "check" or event.data.get("state") != "graded":
            continue
        run = _run(event)
        shown: dict[tuple[str, str, str], list[CheckKept]] = {}
        for check in run.checks:
            if check.diagnosis and check.diagnosis not in NO_MISTAKE:
                shown.setdefault((event.subject, check.task, check.diagnosis), []).append(check)
        for key, checks in shown.items():
            one = found.setdefault(key, Mistake(*key, run.at, run.at))
            one.last, one.mended, one.raised = run.at, None, checks[0].raised
            one.runs += 1
            one.open |= {check.id for check in checks}
        ran = {check.id for check in run.checks if check.status != _SKIP}
        passed = {check.id for check in run.checks if check.passed}
        for key, one in found.items():
            if one.exercise == event.subject and one.open:
                one.showing -= ran
                one.showing |= {check.id for check in shown.get(key, ())}
                one.open -= passed
                one.mended = one.mended if one.open else run.at
    return tuple(found.values())


# ---
# Where a student is with everything, by a record that is read once.


def lesson_events(store: Store | None, lesson: str, split: Mapping[str, str]) -> tuple[Event, ...]:
    """What is recorded about a lesson, oldest first; nothing outside of a workspace.

    Of a lesson that was part of another one: first what it keeps of that one's record. An end that was
    reached before the two were parted does not say how many blocks there were.

    Args:
        split: lessons that were part of another one, and that one.

    Raises:
        IntegrityError, MissingCapabilityError: the record cannot be read.
    """
    if store is None:
        return ()
    whole = store.events(subject=split[lesson]) if lesson in split else ()
    kinds = {"prediction", "cell", "lesson"}
    kept = [one for one in whole if one.kind in kinds and not (one.kind == "lesson" and "blocks" in one.data)]
    return (*kept, *store.events(subject=lesson))


class Standing:
    """Where a student was at one moment; without a workspace, nowhere.

    Each question reads the events that it needs, and raises IntegrityError if one of them is spoilt.

    Args:
        workspace: as it is now; its IntegrityError and MissingCapabilityError are raised.
        split: lessons that were part of another one, and that one.

    Attributes:
        started: ids of the exercises that something was handed out for, or that have a file.
    """

    def __init__(
        self, workspace: Workspace | None = None, split: Mapping[str, str] = MappingProxyType({})
    ) -> None:
        self._workspace = workspace
        self._split = split
        self._record = workspace.store.record() if workspace is not None else None
        self.started = frozenset(workspace.begun() if workspace is not None else ())
        self._histories: dict[str, History] = {}

    def events(self, kind: str = "", subject: str = "") -> tuple[Event, ...]:
        """What was recorded of a kind and about a subject, oldest first; an empty string stands for any."""
        return self._record.events(kind, subject) if self._record is not None else ()

    def history(self, exercise: str) -> History:
        if exercise not in self._histories:
            self._histories[exercise] = history_of(self.events(subject=exercise))
        return self._histories[exercise]

    def is_begun(self, exercise: str) -> bool:
        """Whether it was started, or checked: a notebook needs no start."""
        return exercise in self.started or self.history(exercise).last is not None

    def has_file(self, place: str, module: str) -> bool:
        """Whether an exercise that was begun still has a file."""
        return self._workspace is None or self._workspace.has_file(place, module)

    def is_complete(self, exercise: str) -> bool:
        """Whether every check passed when all were last run."""
        last = self.history(exercise).last_graded
        return last is not None and last.all_pass

    @cached_property
    def read(self) -> dict[str, datetime]:
        """When each lesson was first read to its end, by its id."""
        ends = self.events("lesson")
        found = {event.subject: event.at for event in reversed(ends)}
        whole = {event.subject: event.at for event in reversed(ends) if "blocks" not in event.data}
        return {part: whole[old] for part, old in self._split.items() if old in whole} | found

    @cached_property
    def quiz(self) -> QuizHistory:
        return quiz_history(self.events())

    @cached_property
    def mistakes(self) -> tuple[Mistake, ...]:
        return mistakes_of(self.events())
