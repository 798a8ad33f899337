"""A student's side of the quiz: the questions, the record, and the present attempt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.cli.frame.here import Here
from course.errors import CourseError
from course.progress.quiz import quiz_history
from course.quizzing.attempt import fresh_seed
from course.quizzing.bank import Bank
from course.quizzing.desk import answered, begun, fits
from course.quizzing.review import schedule

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.cli.frame.terminal.console import Console
    from course.progress.quiz import Attempt, QuizHistory
    from course.quizzing.review import Due

__all__ = ["Desk", "agrees", "answer", "open_or_new", "start"]


@dataclass
class Desk:
    """A student's side of the quiz."""

    here: Here
    bank: Bank
    history: QuizHistory

    @classmethod
    def load(cls) -> Desk:
        """Raises what finding the workspace, reading the questions and reading the record raise."""
        here = Here.load()
        return cls(here, Bank.of(here.catalog), quiz_history(here.workspace.store.events()))

    def new_seed(self) -> int:
        """A seed that asks no question in the same way as last time."""
        return fresh_seed(self.bank, self.history.last_seeds())

    def reviews(self) -> tuple[Due, ...]:
        """The questions under review, from the record as it is now."""
        try:
            self.history = quiz_history(self.here.workspace.store.events())
        except CourseError as error:
            self.here.warnings.append(f"{error.message} {error.help}")
        return schedule(self.history.outcomes(), self.bank.ids)


def open_or_new(console: Console, desk: Desk, seed: int | None) -> tuple[Attempt, bool]:
    """The attempt to go on with, or a new one; and whether it was begun before."""
    open_one = desk.history.open
    if open_one is not None and seed in (None, open_one.seed):
        if fits(desk.bank, open_one):
            return open_one, bool(open_one.answers)
        console.line("The questions have changed since you left your last attempt, so a new one begins.")
    elif open_one is not None and open_one.answers:
        left = f"{len(open_one.answers)} of {len(open_one.questions)} answered"
        console.line(f"This is another attempt; the one you left (seed {open_one.seed}, {left}) ends here.")
    return start(desk, desk.new_seed() if seed is None else seed), False


def printed_seed(console: Console, desk: Desk, seed: int | None) -> int:
    """Which questions to print: they are the same until they are answered.

    An attempt with at least one answer stays open, whatever is printed.
    """
    open_one = desk.history.open
    if seed is not None and open_one is not None and open_one.answers:
        return seed
    return open_or_new(console, desk, seed)[0].seed


def start(desk: Desk, seed: int) -> Attempt:
    """Record the beginning of an attempt."""
    return begun(desk.bank, seed, desk.here.catalog.version, desk.here.record)


def answer(desk: Desk, attempt: Attempt, question: str, option: str) -> None:
    """Record one answer at once."""
    answered(attempt, question, option, desk.here.record)


def agrees(bank: Bank, attempt: Attempt, seed: int, answers: Mapping[str, str]) -> bool:
    """Whether a file completes an open attempt and does not contradict it."""
    same = attempt.seed == seed and fits(bank, attempt)
    return same and all(answers[name] == option for name, option in attempt.answers.items())
