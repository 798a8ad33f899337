"""Failed checks of a submission told as one story for each task; see ``course.scoring.explain``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from course.scoring.explain import Failure, Story, fingerprint, read_table, read_words, tell
from course.scoring.explain.calls import calls_between
from course.scoring.explain.fingerprint import in_range
from course.scoring.explain.table import FILE as TABLE
from course.scoring.explain.table import Row, is_right, matching
from course.scoring.explain.words import FILE as WORDS
from course.scoring.failures import CheckFailed, StudentFailure
from course.scoring.verdict import CheckResult, Finding, Status

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from course.scoring.explain import Diagnosis, Table, Words
    from course.scoring.remote import RemoteSubmission

__all__ = ["CASCADE", "Explainer", "answers"]

#: Diagnosis of a function that calls another one of the exercise's which is wrong itself.
CASCADE = "CALLS_A_WRONG_FUNCTION"
_GONE = frozenset({Status.TIMEOUT, Status.MEMORY, Status.CRASH})


class Explainer:
    """Diagnoses of one exercise. Where it has no ``diagnoses.toml``, checks speak for themselves.

    Args:
        folder: of the exercise.
        questions: arguments of the calls that tell programs apart, by task.
    """

    def __init__(self, folder: Path, questions: Mapping[str, list[tuple[Any, ...]]]) -> None:
        self._words: Words = read_words(folder / WORDS)
        self._table: Table = read_table(folder / TABLE)
        self._questions = questions

    def explain(
        self,
        results: dict[str, CheckResult],
        failed: Mapping[str, CheckFailed],
        remote: RemoteSubmission,
        source: bytes,
    ) -> None:
        """Put the story of each task into the results of its failed checks."""
        wrong = {
            result.task for result in results.values() if result.status not in {Status.PASS, Status.SKIP}
        }
        callers = calls_between(source, frozenset(self._questions))
        for task in sorted(wrong):
            of_task = [result for result in results.values() if result.task == task]
            checks = [result for result in of_task if result.id in failed]
            if not checks:
                continue
            asked = not any(result.status in _GONE for result in of_task)
            story = self._story(
                task, {check.id: failed[check.id] for check in checks}, remote if asked else None
            )
            culprit = next((name for name in callers.get(task, ()) if name in wrong), None)
            for check in checks:
                if check.id not in story.own:
                    results[check.id] = _retold(check, failed[check.id], story, task, culprit)

    def _story(self, task: str, failed: Mapping[str, CheckFailed], remote: RemoteSubmission | None) -> Story:
        failures = [
            Failure(check, failure.guess, _finite(failure.finding)) for check, failure in failed.items()
        ]
        return tell(failures, self._fits(task, remote) if remote else (), self._words)

    def _fits(self, task: str, remote: RemoteSubmission) -> tuple[Row, ...]:
        questions = self._questions.get(task, [])
        if not questions:
            return ()
        remote.begin_check(task)
        said = answers(remote, task, questions)
        sums = tuple(_number(x) for x in said) if task in self._table.within else fingerprint(said)
        return () if is_right(self._table, task, sums) else matching(self._table, task, sums)


def answers(remote: RemoteSubmission, task: str, questions: list[tuple[Any, ...]]) -> list[Any]:
    """What a function answers to each question; ``{"raised": name}`` where it raises."""
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
    """An answer that is compared as it is; -1 if it is no number."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    return in_range(value) if isinstance(value, int | float) and not isinstance(value, bool) else -1.0


def _retold(
    check: CheckResult, failure: CheckFailed, story: Story, task: str, culprit: str | None
) -> CheckResult:
    message, advice = failure.bare
    if culprit is not None:
        return msgspec.structs.replace(
            check,
            diagnosis=CASCADE,
            message=f"{message} `{task}` calls your `{culprit}`, which is wrong: mend that first.",
            help=f"Check again when `{culprit}` is right; what is left then is `{task}`'s own.",
        )
    diagnosis: Diagnosis | None = story.diagnosis
    if diagnosis is None:
        return msgspec.structs.replace(check, diagnosis=None, message=message, help=advice)
    return msgspec.structs.replace(
        check,
        diagnosis=diagnosis.code,
        message=f"{message} {diagnosis.looks_like}".strip(),
        help=diagnosis.advice or advice,
        first_divergence=check.first_divergence or diagnosis.divergence,
    )


def _finite(finding: Finding) -> bool:
    """Whether what a check compared was numbers, where it expected numbers."""
    return not _odd(finding.actual) or _odd(finding.expected)


def _odd(value: Any) -> bool:
    if isinstance(value, float):
        return not math.isfinite(value)
    if isinstance(value, dict):
        return any(map(_odd, value.values()))
    return isinstance(value, list | tuple) and any(map(_odd, value))
