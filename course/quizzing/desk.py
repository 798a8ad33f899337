"""An attempt from its first question to its mark, recorded alike wherever it is taken."""

from __future__ import annotations

import secrets
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from course.progress import quiz
from course.quizzing.attempt import mark

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from course.progress.quiz import Attempt
    from course.quizzing.attempt import Result
    from course.quizzing.bank import Bank, PosedQuestion

    Record = Callable[[str, str, dict[str, object]], None]

__all__ = ["answered", "begun", "finished", "fits"]


def fits(bank: Bank, attempt: Attempt) -> bool:
    """Whether the questions still are the ones the attempt was begun with."""
    if attempt.questions != bank.ids:
        return False
    posed = {question.question: question for question in bank.pose(attempt.seed)}
    return all(
        name in posed and posed[name].choice(option) is not None for name, option in attempt.answers.items()
    )


def begun(bank: Bank, seed: int, version: str, record: Record) -> Attempt:
    """Record the beginning of an attempt.

    Args:
        version: of the course's content.
        record: takes an event: kind, subject, data.
    """
    attempt = quiz.Attempt(
        id=secrets.token_hex(8), seed=seed, version=version, questions=bank.ids, started=datetime.now(UTC)
    )
    record(quiz.START, "", quiz.start_data(attempt.id, seed, attempt.version, attempt.questions))
    return attempt


def answered(attempt: Attempt, question: str, option: str, record: Record) -> None:
    """Record one answer at once, so that nothing is lost however the program ends."""
    attempt.answers[question] = option
    record(quiz.ANSWER, question, quiz.answer_data(attempt.id, option))


def finished(attempt: Attempt, posed: Sequence[PosedQuestion], record: Record) -> Result:
    """Score an attempt that is answered, and record its end."""
    result = mark(posed, attempt.answers)
    right = {marked.posed.question: marked.right for marked in result.marked}
    record(quiz.DONE, "", quiz.done_data(attempt.id, right, passed=result.passed))
    return result
