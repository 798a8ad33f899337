"""The history of one exercise, from its events.

The record only lists events; this module answers the commands' questions about them: which checks fail
now, is another hint due, was it ever passed.
"""

from __future__ import annotations

import ast
import hashlib
import math
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import TYPE_CHECKING, Any, Protocol

from course.printable import one_line

if TYPE_CHECKING:
    from course.progress.store import Event

    class Finding(Protocol):
        """What is read of a check's result."""

        @property
        def status(self) -> str: ...
        @property
        def visibility(self) -> str: ...
        @property
        def input(self) -> Mapping[str, Any] | None: ...
        @property
        def expected(self) -> Any: ...
        @property
        def actual(self) -> Any: ...

    class _Check(Finding, Protocol):
        """The record of one check."""

        @property
        def id(self) -> str: ...
        @property
        def task(self) -> str: ...
        @property
        def diagnosis(self) -> str | None: ...

    class _Verdict(Protocol):
        """The record of a verdict."""

        @property
        def state(self) -> str: ...
        @property
        def score(self) -> float: ...
        @property
        def max_score(self) -> float: ...
        @property
        def passed(self) -> bool: ...
        @property
        def all_pass(self) -> bool: ...
        @property
        def checks(self) -> Sequence[_Check]: ...


# ---
# The numbers of a failed check as words, which a hint may use: what went in, what came back, what is right.
#
# Public checks only: what a student may not see in a finding is not in a hint either.


#: Longest list and longest text that a sentence can hold.
_ITEMS, _LETTERS = 8, 40
#: The most of an exception that is kept, in characters.
_RAISED = 120
#: Numbers beyond it are not compared: they come from a program that ran away.
_HUGE = 1e150


def numbers_of(check: Finding) -> dict[str, str]:
    """The fields that a hint may name.

    Returns:
        each input by its name; ``expected`` and ``got``; where they are numbers, ``off``, which is got minus
        expected, and ``ratio``, got over expected; where one entry of an array was compared, ``at``, which
        names it. None, a ratio of 0 or 1 and values too long for a sentence are left out, and all of them
        where the check passed or is a hidden one.
    """
    if check.status != "fail" or check.visibility != "public":
        return {}
    # The entries of a list may be told apart by a late digit only.
    fields = {k: _words(x, 10 if isinstance(x, list) else 4) for k, x in (check.input or {}).items()}
    expected, got, fields["at"] = _compared(check.expected, check.actual)
    right, own = _apart(expected, got)
    fields["expected"], fields["got"] = "" if expected is None else right, "" if got is None else own
    if _is_number(expected) and _is_number(got):
        fields["off"] = f"{'+' * (got > expected)}{_words(got - expected)}"
        ratio = _words(got / expected) if expected and got else ""
        fields["ratio"] = "" if ratio == "1" else ratio
    return {name: words for name, words in fields.items() if words}


def raised_by(check: Finding) -> str:
    """The exception that ended a public check, in its own words; "" if none did."""
    if check.status != "error" or check.visibility != "public" or not isinstance(check.actual, str):
        return ""
    return one_line(check.actual, _RAISED)


def _compared(expected: Any, got: Any) -> tuple[Any, Any, str]:
    """What was expected, what came, and of which entry: that of {"q[2]": 0.5} and {"q[2]": 0.4} is q[2]."""
    if not isinstance(expected, dict) or len(expected) != 1:
        return expected, got, ""
    ((name, value),) = expected.items()
    if name in {"at least", "at most"}:
        return f"{name} {_words(value)}", got, ""
    if isinstance(got, dict) and got.keys() == expected.keys():
        return value, got[name], str(name)
    return expected, got, ""


def _apart(expected: Any, got: Any) -> tuple[str, str]:
    """Both with four digits, or with so many that they differ."""
    pairs = ((_words(expected, digits), _words(got, digits)) for digits in (4, 8, 16))
    return next(((right, own) for right, own in pairs if right != own), ("", ""))


def _words(value: Any, digits: int = 4) -> str:
    """The value for a sentence; "" if it is too long for one."""
    if isinstance(value, bool | None):
        return str(value)
    if isinstance(value, int):
        return str(value) if abs(value) < _HUGE else ""
    if isinstance(value, float):
        return f"{value + 0.0:.{digits}g}"  # no "-0"
    if isinstance(value, list | tuple) and 0 < len(value) <= _ITEMS:
        items = [_words(item, digits) for item in value]
        return f"[{', '.join(items)}]" if all(items) else ""
    return value if isinstance(value, str) and len(value) <= _LETTERS else ""


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _HUGE


_PASS, _SKIP = "pass", "skip"
_UNWRITTEN = "NOT_IMPLEMENTED"


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
        statuses: status by check id, in the order the checks ran.
        diagnoses: diagnosis by check id, of those that have one.
        tasks: task by check id.
        unwritten: checks that found a function as it was handed out.
        numbers: of failed checks, by check id, as ``numbers_of`` gives them.
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
    statuses: Mapping[str, str]
    diagnoses: Mapping[str, str]
    tasks: Mapping[str, str]
    unwritten: frozenset[str]
    numbers: Mapping[str, Mapping[str, str]]

    @property
    def wrong_tasks(self) -> frozenset[str]:
        """Tasks with a check that ran and did not pass."""
        wrong = (name for name, status in self.statuses.items() if status not in {_PASS, _SKIP})
        return frozenset(self.tasks[name] for name in wrong)

    @property
    def right_tasks(self) -> frozenset[str]:
        """Tasks whose every check passed."""
        not_passed = {self.tasks[name] for name, status in self.statuses.items() if status != _PASS}
        return frozenset(self.tasks.values()) - not_passed

    @property
    def failed(self) -> bool:
        """True if a check ran and did not pass."""
        return any(status != _PASS for status in self.statuses.values())


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
        return fixed - {before.tasks.get(check, "") for check in before.unwritten}, broke

    def failing_tasks(self) -> frozenset[str]:
        """Tasks with a check that does not pass, as far as is known.

        The newest run of all checks counts, corrected by checks that were run alone after it.
        """
        return frozenset(task for task, status, _ in self._known() if status != _PASS)

    def unwritten_tasks(self) -> frozenset[str]:
        """Failing tasks whose function is as it was handed out, or was never reached by a check."""
        begun = {task for task, status, new in self._known() if status not in {_PASS, _SKIP} and not new}
        return self.failing_tasks() - begun

    def _known(self) -> list[tuple[str, str, bool]]:
        """Of every check last run: task, status, and whether it found the function not written yet."""
        found: dict[str, tuple[str, str, bool]] = {}
        for run in self.runs:
            if run.state == "graded":
                if not run.only:
                    found.clear()
                for check, status in run.statuses.items():
                    found[check] = (run.tasks.get(check, ""), status, check in run.unwritten)
        return list(found.values())

    def hints_for(self, task: str) -> tuple[int, ...]:
        """Which hints of a task were shown, in that order."""
        return tuple(dict.fromkeys(hint.index for hint in self.hints if hint.task == task))

    def diagnosed(self, task: str) -> tuple[tuple[str, Mapping[str, str]], ...]:
        """The findings about a task in the newest run that had one of its checks.

        Returns:
            diagnosis, "" for none, and numbers of each check of the task that did not pass, in their order.
        """
        run = next((run for run in reversed(self.runs) if task in run.tasks.values()), None)
        if run is None:
            return ()
        return tuple(
            (run.diagnoses.get(check, ""), run.numbers.get(check, {}))
            for check, status in run.statuses.items()
            if run.tasks.get(check) == task and status != _PASS
        )

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
        return any(run.id > since and run.failed and run.fingerprint != before for run in self.runs)


def history_of(events: Iterable[Event]) -> History:
    """The history that the events of one exercise tell; other kinds of events are passed over."""
    runs: list[CheckRun] = []
    hints: list[HintGiven] = []
    started: datetime | None = None
    for event in events:
        if event.kind == "check":
            runs.append(_run(event))
        elif event.kind == "hint":
            data = event.data
            hints.append(
                HintGiven(
                    event.id,
                    str(data.get("task", "")),
                    int(data.get("index", 0)),
                    str(data.get("fingerprint", "")),
                )
            )
        elif event.kind == "start" and started is None:
            started = event.at
    return History(runs=tuple(runs), hints=tuple(hints), started=started)


def check_data(
    verdict: _Verdict,
    source: bytes,
    seconds: float,
    version: str,
    *,
    only: str = "",
    one_of_many: bool = False,
) -> dict[str, object]:
    """The data of an event of kind "check": the attempt, in the form that ``history_of`` reads.

    Args:
        source: the module that was checked.
        seconds: how long it took.
        version: of the course's content.
        only: the one requested check or function.
        one_of_many: every exercise was checked, so the student did not choose this one.
    """
    return {
        "state": verdict.state,
        "only": only,
        "all": one_of_many,
        "score": verdict.score,
        "max_score": verdict.max_score,
        "passed": verdict.passed,
        "all_pass": verdict.all_pass,
        "seconds": round(seconds, 3),
        "fingerprint": fingerprint(source),
        "sha256": hashlib.sha256(source).hexdigest(),
        "version": version,
        "checks": [_kept(check) for check in verdict.checks],
    }


def _kept(check: _Check) -> dict[str, object]:
    kept = {"id": check.id, "task": check.task, "status": str(check.status)}
    more = {"diagnosis": check.diagnosis, "numbers": numbers_of(check), "raised": raised_by(check)}
    return kept | {key: value for key, value in more.items() if value}


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
    checks = [check for check in data.get("checks", ()) if isinstance(check, dict)]
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
        statuses={str(check.get("id")): str(check.get("status")) for check in checks},
        diagnoses={
            str(check["id"]): str(check["diagnosis"])
            for check in checks
            if check.get("diagnosis") and "id" in check
        },
        tasks={str(check.get("id")): str(check.get("task")) for check in checks},
        unwritten=frozenset(str(check.get("id")) for check in checks if check.get("diagnosis") == _UNWRITTEN),
        numbers={
            str(check.get("id")): {str(name): str(words) for name, words in check["numbers"].items()}
            for check in checks
            if isinstance(check.get("numbers"), dict)
        },
    )


# ---
# Which mistakes a student made, and when each was mended, from the recorded checks.
#
# A mistake is a diagnosis of one function. It is mended when every check that showed it has passed since;
# checks that now fail for another reason do not mend it.


#: Diagnoses that are not mistakes of their own: unwritten work, and consequences of another mistake.
NO_MISTAKE = frozenset({"NOT_IMPLEMENTED", "MISSING_FUNCTION", "MEASURED_AS_NONE", "CALLS_A_WRONG_FUNCTION"})


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake in one function.

    Attributes:
        exercise, task: where.
        diagnosis: its code.
        first, last: the first and the last run that showed it, in UTC.
        runs: how many runs showed it.
        raised: the exception that the last of them ended in; "" if it was none.
        mended: the run after which every check that showed it had passed; None while one has not.
    """

    exercise: str
    task: str
    diagnosis: str
    first: datetime
    last: datetime
    runs: int
    mended: datetime | None
    raised: str = ""


@dataclass(slots=True)
class _Open:
    first: datetime
    last: datetime
    runs: int = 0
    checks: set[str] = field(default_factory=set)
    mended: datetime | None = None
    raised: str = ""


def mistakes_of(events: Iterable[Event]) -> tuple[Mistake, ...]:
    """The mistakes that events of kind "check" tell of, in the order they were first made.

    Runs that were recorded before diagnoses were kept tell of none.
    """
    found: dict[tuple[str, str, str], _Open] = {}
    for event in events:
        if event.kind == "check" and event.data.get("state") == "graded":
            _take(found, event)
    return tuple(
        Mistake(*key, one.first, one.last, one.runs, one.mended, one.raised) for key, one in found.items()
    )


def _take(found: dict[tuple[str, str, str], _Open], event: Event) -> None:
    checks = [check for check in event.data.get("checks", ()) if isinstance(check, dict)]
    shown: dict[tuple[str, str, str], set[str]] = {}
    raised: dict[tuple[str, str, str], str] = {}
    for check in checks:
        code = check.get("diagnosis")
        if isinstance(code, str) and code not in NO_MISTAKE:
            key = (event.subject, str(check.get("task")), code)
            shown.setdefault(key, set()).add(str(check.get("id")))
            raised.setdefault(key, str(check.get("raised", "")))
    for key, ids in shown.items():
        one = found.setdefault(key, _Open(event.at, event.at))
        one.last, one.mended = event.at, None
        one.runs += 1
        one.raised = raised[key]
        one.checks |= ids
    passed = {str(check.get("id")) for check in checks if check.get("status") == "pass"}
    for (exercise, _, _), one in found.items():
        if exercise == event.subject and one.checks:
            one.checks -= passed
            if not one.checks:
                one.mended = event.at
