"""An attempt from its first question to its mark, recorded alike wherever it is taken."""

import secrets
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, date, datetime, timedelta

from course.catalog.questions import Question
from course.catalog.reading import Document
from course.errors import ContentError
from course.progress import quiz
from course.progress.quiz import Attempt, QuizHistory
from course.quizzing.bank import Bank, MarkedQuestion, PosedQuestion, Result, clashing, mark, pose_case

Record = Callable[[str, str, dict[str, object]], object]


def fits(bank: Bank, attempt: Attempt) -> bool:
    """Whether the questions still are the ones the attempt was begun with."""
    if attempt.questions != bank.ids:
        return False
    posed = {question.question: question for question in bank.pose(attempt.seed)}
    answers = attempt.answers.items()
    return all(name in posed and posed[name].choice(option) is not None for name, option in answers)


def begun(bank: Bank, seed: int, version: str, record: Record) -> Attempt:
    """Record the beginning of an attempt.

    Args:
        record: takes an event: kind, subject, data.
    """
    attempt = quiz.Attempt(
        id=secrets.token_hex(8), seed=seed, version=version, questions=bank.ids, started=datetime.now(UTC)
    )
    asked = {"seed": seed, "version": version, "questions": list(attempt.questions)}
    record(quiz.START, "", {"attempt": attempt.id, **asked})
    return attempt


def caught_up(attempt: Attempt, history: QuizHistory) -> Attempt | None:
    """Take over answers that were given elsewhere meanwhile; the attempt, if it was finished there."""
    recorded = next((one for one in history.attempts if one.id == attempt.id), attempt)
    attempt.answers.update(recorded.answers)
    return recorded if recorded.finished is not None else None


def answered(attempt: Attempt, question: str, option: str, record: Record) -> None:
    """Record one answer at once, so that nothing is lost however the program ends."""
    attempt.answers[question] = option
    record(quiz.ANSWER, question, {"attempt": attempt.id, "option": option})


def finished(attempt: Attempt, posed: Sequence[PosedQuestion], record: Record) -> Result:
    """Score an attempt that is answered, and record its end."""
    result = mark(posed, attempt.answers)
    right = {marked.posed.question: marked.right for marked in result.marked}
    score = {"right": right, "score": result.score, "passed": result.passed}
    record(quiz.DONE, "", {"attempt": attempt.id, **score})
    return result


def reviewed(posed: PosedQuestion, option: str, seed: int, record: Record) -> MarkedQuestion:
    """Mark one answer of a review, and record it."""
    (marked,) = mark([posed], {posed.question: option}).marked
    record(quiz.REVIEW, posed.question, {"seed": seed, "option": option, "right": marked.right})
    return marked


# ---
# When a missed question comes back.
#
# Spaced practice beats massed practice, and evenly spaced is as good as any schedule and the easiest to keep:
# a question that was missed is due every ``GAP_DAYS`` days until it was answered rightly ``ROUNDS`` times in
# a row. A wrong answer starts the count again. An answer before the day it was due changes nothing when it is
# right: repeating something while it is fresh is the massed practice that this is to avoid.
#
# Source: Latimier, Peyre, Ramus 2021, Educational Psychology Review 33 (a meta-analysis of spaced retrieval:
# 0.74 against massed; no difference found between expanding and uniform spacing).


GAP_DAYS = 2
ROUNDS = 3


@dataclass(frozen=True, slots=True)
class Due:
    """A question under review.

    Attributes:
        on: the day it is due, in the student's own time zone.
        rounds: right answers in a row, each on or after its day.
    """

    question: str
    on: date
    rounds: int


def schedule(
    outcomes: Mapping[str, Iterable[tuple[datetime, bool]]], known: Iterable[str]
) -> tuple[Due, ...]:
    """The questions under review, soonest first.

    Args:
        outcomes: by question id, when it was answered and whether rightly, oldest first.
        known: ids of the questions there are, in their order; others have gone from the quiz.
    """
    found = (due_after(name, outcomes[name]) for name in known if name in outcomes)
    return tuple(sorted((due for due in found if due is not None), key=lambda due: due.on))


def due_after(question: str, outcomes: Iterable[tuple[datetime, bool]]) -> Due | None:
    """The state of one question; None if it was never missed, or was brought back often enough."""
    due: Due | None = None
    for at, right in outcomes:
        day = at.astimezone().date()
        following = day + timedelta(days=GAP_DAYS)
        if not right:
            due = Due(question, following, 0)
        elif due is not None and day >= due.on:
            due = Due(question, following, due.rounds + 1) if due.rounds + 1 < ROUNDS else None
    return due


# ---
# Goes through every case of a question, for faults that reading its file cannot show.
#
# A variant draws its numbers from finite lists, so "no seed ever shows two options that are the same" is not
# a matter of sampling: each case is posed once.


def faults_in(document: Document[Question]) -> Iterator[ContentError]:
    """The first fault of each variant: a formula without a value, or options that cannot be told apart."""
    for index, variant in enumerate(document.value.variant):
        for case in range(variant.cases):
            try:
                posed = pose_case(document, index, case)
                if (clash := clashing(posed.choices)) is not None:
                    one, other = (posed.choices[place] for place in clash)
                    reads = f"option {other.id} reads {other.text!r}, and option {one.id} reads {one.text!r}"
                    document.fail(
                        ("variant", index, "option", clash[1], "text"),
                        f"variant {posed.variant}: {reads}; these numbers are too close to tell apart.",
                        fix="Change a formula, or the values it is computed from, so that options differ by "
                        "more than 2 %.",
                    )
            except ContentError as fault:
                yield fault
                break
