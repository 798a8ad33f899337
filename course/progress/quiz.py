"""The quiz, by the record of progress.

Four kinds of events: ``quiz-start`` opens an attempt, each ``quiz-answer`` is one answer (so that an attempt
that is interrupted goes on where it was), ``quiz-done`` closes it with its score, and ``quiz-review`` is one
question answered in a review; the subject of these two is the question. Events hold ids and seeds only; the
questions follow from the seed. ``course.quizzing.desk`` records them.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from course.progress.store import Event

START, ANSWER, DONE, REVIEW = "quiz-start", "quiz-answer", "quiz-done", "quiz-review"

#: Attempts that travel in a submission at most; a grading run refuses more.
MAX_RECORDS = 100


@dataclass(slots=True)
class Attempt:
    """One attempt.

    Attributes:
        id: joins its events.
        seed, questions: the questions, in order.
        version: of the course it was asked from.
        answers: option id by question id; unanswered questions are missing.
        finished: when it was scored; None while it is open or was left.
        score: right answers, as scored then.
    """

    id: str
    seed: int
    version: str
    questions: tuple[str, ...]
    started: datetime
    answers: dict[str, str] = field(default_factory=dict)
    right: dict[str, bool] = field(default_factory=dict)
    finished: datetime | None = None
    score: int = 0
    passed: bool = False

    @property
    def total(self) -> int:
        return len(self.questions)


@dataclass(frozen=True, slots=True)
class Review:
    """One question answered in a review."""

    at: datetime
    question: str
    seed: int
    right: bool


@dataclass(frozen=True, slots=True)
class QuizHistory:
    """Everything recorded about the quiz, oldest first."""

    attempts: tuple[Attempt, ...]
    reviews: tuple[Review, ...]

    @property
    def open(self) -> Attempt | None:
        """The attempt to go on with: the newest one, if it is not finished."""
        newest = self.attempts[-1] if self.attempts else None
        return newest if newest is not None and newest.finished is None else None

    @property
    def finished(self) -> tuple[Attempt, ...]:
        return tuple(attempt for attempt in self.attempts if attempt.finished is not None)

    @property
    def counting(self) -> tuple[Attempt, ...]:
        """Finished attempts that count: the first one of each seed.

        A student who answers the same questions again has read their explanations.
        """
        first: dict[int, Attempt] = {}
        for attempt in self.finished:
            first.setdefault(attempt.seed, attempt)
        return tuple(first.values())

    @property
    def best(self) -> Attempt | None:
        """The counting attempt with the highest score, the earliest of equals."""
        return max(self.counting, key=lambda attempt: attempt.score, default=None)

    def last_seeds(self) -> dict[str, int]:
        """By question id, the seed it was last asked with."""
        asked = [(a.started, name, a.seed) for a in self.attempts for name in a.questions]
        asked += [(review.at, review.question, review.seed) for review in self.reviews]
        return {name: seed for _, name, seed in sorted(asked, key=lambda entry: entry[0])}

    def outcomes(self) -> dict[str, list[tuple[datetime, bool]]]:
        """By question id, when it was answered and whether rightly, oldest first."""
        found: dict[str, list[tuple[datetime, bool]]] = {}
        for attempt in self.finished:
            if attempt.finished is not None:
                for name, right in attempt.right.items():
                    found.setdefault(name, []).append((attempt.finished, right))
        for review in self.reviews:
            found.setdefault(review.question, []).append((review.at, review.right))
        return {name: sorted(entries) for name, entries in found.items()}


def quiz_history(events: Iterable[Event]) -> QuizHistory:
    """The history that events tell; other kinds are passed over."""
    attempts: dict[str, Attempt] = {}
    reviews: list[Review] = []
    for event in events:
        data: Mapping[str, Any] = event.data
        seed = int(data.get("seed", 0))
        if event.kind == START:
            name = str(data.get("attempt", event.id))
            questions = tuple(map(str, data.get("questions", ())))
            attempts[name] = Attempt(name, seed, str(data.get("version", "")), questions, event.at)
        elif event.kind == REVIEW:
            reviews.append(Review(event.at, event.subject, seed, bool(data.get("right", False))))
        elif event.kind in {ANSWER, DONE} and data.get("attempt") in attempts:
            _add(attempts[str(data["attempt"])], event)
    return QuizHistory(tuple(attempts.values()), tuple(reviews))


def records(history: QuizHistory) -> list[dict[str, object]]:
    """The attempts that travel in a submission, oldest first; see ``course.grading.quiz``.

    Where there are too many, those with the highest scores go.
    """
    best = sorted(history.counting, key=lambda attempt: -attempt.score)[:MAX_RECORDS]
    return [
        {
            "seed": attempt.seed,
            "version": attempt.version,
            "finished_at": attempt.finished.isoformat() if attempt.finished else "",
            "questions": list(attempt.questions),
            "answers": dict(attempt.answers),
            "score": attempt.score,
        }
        for attempt in history.counting
        if attempt in best
    ]


def _add(attempt: Attempt, event: Event) -> None:
    """An answer or the end of an attempt; the first of each counts, and nothing after the end."""
    if attempt.finished is not None:
        return
    if event.kind == ANSWER:
        attempt.answers.setdefault(event.subject, str(event.data.get("option", "")))
        return
    attempt.finished = event.at
    attempt.score = int(event.data.get("score", 0))
    attempt.passed = bool(event.data.get("passed", False))
    right = event.data.get("right")
    if isinstance(right, dict):
        attempt.right = {str(name): bool(value) for name, value in right.items()}
