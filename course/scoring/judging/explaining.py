"""Failed checks of a submission, with one common diagnosis for each task; see ``course.scoring.explain``."""

from __future__ import annotations

import copy
import math
import types
from collections.abc import Callable, Mapping, Sequence
from types import ModuleType
from typing import Any, Self

import msgspec
import numpy as np

from course.isolation.failures import StudentFailure
from course.isolation.levels import SEARCH_S
from course.isolation.session import LoadRefusedError
from course.scoring.explain.fingerprint import (
    calls_between,
    fingerprint,
    in_range,
    may_remember,
    numbers_of,
    read,
)
from course.scoring.explain.story import (
    Diagnosis,
    Failure,
    Story,
    Table,
    Words,
    is_right,
    matching,
    said_once,
    story_of,
)
from course.scoring.failures import CheckFailed
from course.scoring.remote import Heard, RemoteSubmission
from course.scoring.values import leaves
from course.scoring.verdict import CheckResult, Status

#: Diagnosis of a function that calls another function of the exercise, which is wrong itself.
CASCADE = "CALLS_A_WRONG_FUNCTION"
Calls = list[tuple[Any, ...]]
Past = tuple[float, "list[Heard]"]
#: Seconds of CPU time of the checks whose calls are made again, together. They are made once, or twice where
#: they show something; a step, an impact or a summary takes milliseconds, and a search for gains is left out.
_PATIENCE = 0.5
_GONE = frozenset({Status.TIMEOUT, Status.MEMORY, Status.CRASH})
#: Exceptions from reading an unexpected value: they identify no mistake, and are not a fault of the grader.
_STRANGE = (TypeError, ValueError, ArithmeticError, LookupError, AttributeError, RecursionError, CheckFailed)


class Explainer:
    """Diagnoses of one exercise. Without a table, each check keeps its own diagnosis.

    Args:
        table: what is known about its mistakes.
        questions: its ``questions.py``; see ``answer_numbers``. Where one function returns several things,
            ``PARTS`` names the thing that each check is about. A mistake in one thing says nothing about
            another, so each thing has its own story.
    """

    def __init__(self, table: Table, questions: ModuleType) -> None:
        self._words, self._table = Words(table.words), table
        self._questions = questions
        self._parts: Mapping[str, str] = getattr(questions, "PARTS", {})

    def listened(self, source: bytes) -> frozenset[str]:
        """The functions whose calls ``explain`` wants to know: those that could keep something."""
        return may_remember(source, tasks_asked(self._questions))

    def explain(
        self,
        results: dict[str, CheckResult],
        failed: Mapping[str, CheckFailed],
        remote: RemoteSubmission,
        source: bytes,
        heard: Mapping[str, Past] = types.MappingProxyType({}),
        again: Again | None = None,
    ) -> None:
        """Put the story of each task into the results of its failed checks.

        Args:
            heard: of failed checks, the CPU time they took, s, and the calls that were listened to.
            again: asks the submission again, in workers of its own.
        """
        fine = {Status.PASS, Status.SKIP}
        wrong = {result.task for result in results.values() if result.status not in fine}
        callers = calls_between(source, tasks_asked(self._questions))
        for task in sorted(wrong):
            of_task = [result for result in results.values() if result.task == task]
            checks = [result for result in of_task if result.id in failed]
            if not checks:
                continue
            gone = any(result.status in _GONE for result in of_task)
            names = frozenset(self._parts.get(check.id, task) for check in checks)
            said = {} if gone else self._answer_sums(task, remote, names)
            # The wrong functions that it calls: those that call no wrong one themselves, if there are any.
            called = [name for name in callers.get(task, ()) if name in wrong]
            culprits = [name for name in called if wrong.isdisjoint(callers.get(name, ()))] or called
            past = [heard[check.id] for check in checks if check.id in heard]
            kept = bool(again and not gone and not culprits and _kept(past, task, again))
            for name in dict.fromkeys(self._parts.get(check.id, task) for check in checks):
                part = [check for check in checks if self._parts.get(check.id, task) == name]
                mine = {check.id: failed[check.id] for check in part}
                story = self._story(name, mine, said.get(name), kept)
                for check in part:
                    if check.id not in story.own:
                        results[check.id] = _retold(check, failed[check.id], story, task, culprits)

    def _answer_sums(
        self, task: str, remote: RemoteSubmission, names: frozenset[str]
    ) -> dict[str, tuple[float, ...]]:
        remote.begin_check(task)
        within = self._table.within.get(task)
        try:
            return answer_numbers(
                self._questions, task, lambda calls: answers(remote, task, calls), within, names
            )
        except _STRANGE:
            return {}

    def _story(
        self, name: str, failed: Mapping[str, CheckFailed], sums: tuple[float, ...] | None, kept: bool
    ) -> Story:
        failures = [
            # Finite, or not where finite numbers were expected.
            Failure(check, one.guess, not _odd(one.finding.actual) or _odd(one.finding.expected), one.looked)
            for check, one in failed.items()
        ]
        wrong = sums and not is_right(self._table, name, sums)
        fits = matching(self._table, name, sums) if sums and wrong else ()
        return story_of(failures, fits, self._words, kept=kept)


def _kept(past: list[Past], task: str, again: Again) -> bool:
    """Whether calls of failed checks, of those that took least, give something else in another order."""
    calls: list[Heard] = []
    total = 0.0
    for took, heard in sorted(past, key=lambda item: item[0]):
        total += took
        if total <= _PATIENCE:
            calls += heard
    return bool(calls) and again.depends_on_the_past(calls, task, _PATIENCE)


def tasks_asked(questions: ModuleType) -> frozenset[str]:
    """The tasks that a ``questions.py`` has questions for."""
    return frozenset(questions.QUESTIONS) | frozenset(getattr(questions, "ASK", {}))


def answer_numbers(
    questions: ModuleType,
    task: str,
    answer: Callable[[Calls], list[Any]],
    within: float | None = None,
    names: frozenset[str] | None = None,
) -> dict[str, tuple[float, ...]]:
    """A program's answers to the questions of a task, as the numbers that are compared.

    Args:
        questions: ``questions.py`` of an exercise. ``QUESTIONS`` has the arguments of calls by task, and
            ``READ`` a function that picks the part of an answer that counts. Where that is not enough,
            ``ASK`` has a function of ``answer`` and ``names`` that makes the calls itself and returns numbers
            by name, of the task or of its parts. Numbers no more than ``SAME`` apart count as equal.
        answer: gives the program's answers to a list of calls; ``{"raised": name}`` where it raises.
        within: relative tolerance, if answers are compared as they are.
        names: of the parts that are of interest; None for all.
    """
    own = getattr(questions, "ASK", {}).get(task)
    if own is not None:
        return {name: tuple(numbers) for name, numbers in own(answer, names).items()}
    calls = questions.QUESTIONS.get(task)
    if not calls:
        return {}
    reader = getattr(questions, "READ", {}).get(task)
    said = [read(one, reader) for one in answer(calls)]
    return {task: fingerprint(said) if within is None else tuple(_number(x) for x in said)}


def answers(remote: RemoteSubmission, task: str, questions: Calls) -> list[Any]:
    """A function's answer to each question; ``{"raised": name}`` where it raises."""
    questions = copy.deepcopy(questions)  # generators start anew each time
    try:
        return list(remote.call_each(task, questions))
    except (StudentFailure, CheckFailed):
        return [_answer(remote, task, args) for args in questions]


def _answer(remote: RemoteSubmission, task: str, args: tuple[Any, ...]) -> Any:
    try:
        return remote.call(task, *args)
    except StudentFailure as failure:
        return {"raised": failure.type}
    except CheckFailed:
        return {"raised": "refused"}


def _number(value: Any) -> float:
    """An answer that is compared directly; -1 if it is not a number."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    return in_range(value) if isinstance(value, int | float) and not isinstance(value, bool) else -1.0


def _retold(
    check: CheckResult, failure: CheckFailed, story: Story, task: str, culprits: list[str]
) -> CheckResult:
    message, advice = failure.bare
    diagnosis: Diagnosis | None = None if check.id in story.bare else story.diagnosis
    if diagnosis is not None:
        message, advice = said_once(message, diagnosis.looks_like), diagnosis.advice or advice
    code = diagnosis.code if diagnosis is not None else None
    if culprits:
        # Whether this check's number comes from one of them is not known: they may be right where it calls.
        code = CASCADE
        names = " and ".join(", ".join(f"`{name}`" for name in culprits).rsplit(", ", 1))
        are = "are" if len(culprits) > 1 else "is"
        calls, left = f"`{task}` calls your {names}, in which other checks found a mistake.", ""
        if diagnosis is not None:
            calls = (
                f"That may come from your {names}, which `{task}` calls: other checks found a mistake there."
            )
            left = f" If this is left: {advice}"
        message = f"{message} {calls}"
        advice = f"Check again when {names} {are} right; what is left then is `{task}`'s own.{left}"
    return msgspec.structs.replace(check, diagnosis=code, message=message, help=advice)


def _odd(value: Any) -> bool:
    """Whether a number in it is nan or infinite."""
    return any(isinstance(item, float) and not math.isfinite(item) for item in leaves(value))


# ---
# Whether a function answers the same question the same way, whatever it was asked before.
#
# The calls of failed checks are made again in a worker of its own, the last one first. Only functions that
# could keep something are listened to (``fingerprint.may_remember``), so most submissions pay nothing.


#: Calls that are made again, at most: mistakes of this kind show within a few.
_MOST = 100
#: Rounding may depend on where in memory an array lies.
_SAME = {"rtol": 1e-9, "atol": 1e-12}


class Again:
    """Asks a submission again, in two workers of its own that all of its tasks share.

    Args:
        anew: loads the submission in another worker.
    """

    def __init__(self, anew: Callable[[], RemoteSubmission]) -> None:
        self._anew = anew
        self._workers: dict[int, RemoteSubmission] = {}
        self._left = SEARCH_S  # of CPU time, loading included: each worker has a budget of its own

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        while self._workers:
            self._workers.popitem()[1].close()

    def depends_on_the_past(self, heard: Sequence[Heard], task: str, patience: float) -> bool:
        """Whether calls give something else in the opposite order.

        A function that draws numbers of its own, or measures a time, gives something else every time: it is
        asked twice, and nothing is said of it.

        Args:
            heard: calls of functions, in order.
            patience: seconds of CPU time for each of the two times.
        """
        asked = heard[: -_MOST - 1 : -1]
        first = self._values(0, asked, task, patience)
        if first is None or _alike(first, [call.value for call in asked]):
            return False
        second = self._values(1, asked, task, patience)
        return second is not None and _alike(first, second)

    def _values(self, which: int, asked: Sequence[Heard], task: str, patience: float) -> list[Any] | None:
        """The values of the calls in one of the workers; None if one of them fails, or time is up."""
        if self._left <= 0.0:
            return None
        try:
            if which not in self._workers:
                self._workers[which] = self._anew()
                self._left -= self._workers[which].used
            remote = self._workers[which]
            remote.begin_check(task, min(patience, max(self._left, 0.0)))
            try:
                return [getattr(remote, call.method)(*copy.deepcopy(call.args)) for call in asked]
            finally:
                self._left -= remote.used
        except LoadRefusedError:  # it was loaded before, so it is not loaded the same way every time
            self._left = 0.0
            return None
        except (StudentFailure, CheckFailed):
            self._workers.pop(which).close()  # it may have died, or stopped halfway
            return None


def _alike(one: list[Any], other: list[Any]) -> bool:
    """Whether two lists of results are the same."""
    a, b = numbers_of(one), numbers_of(other)
    return a.shape == b.shape and bool(np.allclose(a, b, equal_nan=True, **_SAME))
