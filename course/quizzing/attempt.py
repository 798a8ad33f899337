"""One attempt at the quiz: its mark, its score, and a seed for the next one."""

from __future__ import annotations

import math
import secrets
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from course.errors import UsageError
from course.printable import counted
from course.quizzing.bank import MAX_SEED, Bank, Choice, PosedQuestion

#: The share of the questions that passes. A fraction: 0.7 as a float is a little less than 7/10.
PASS_SHARE = Fraction(7, 10)

#: How many seeds to try for one that changes every question: with four variants each, about one in four does.
_TRIES = 200
#: Times as many tries as all first variants take on average: they are missed once in 20,000 attempts.
_PATIENCE = 10


@dataclass(frozen=True, slots=True)
class MarkedQuestion:
    """A question and its answer."""

    posed: PosedQuestion
    chosen: Choice

    @property
    def right(self) -> bool:
        return self.chosen.right


@dataclass(frozen=True, slots=True)
class Result:
    """A scored attempt; one point a question."""

    marked: tuple[MarkedQuestion, ...]

    @property
    def score(self) -> int:
        return sum(marked.right for marked in self.marked)

    @property
    def total(self) -> int:
        return len(self.marked)

    @property
    def passed(self) -> bool:
        return self.score >= needed(self.total)

    @property
    def missed(self) -> tuple[MarkedQuestion, ...]:
        return tuple(marked for marked in self.marked if not marked.right)


def needed(total: int) -> int:
    """How many of ``total`` questions must be right: the smallest whole number that reaches the share."""
    return -(-total * PASS_SHARE.numerator // PASS_SHARE.denominator)


def mark_sentence(total: int) -> str:
    """The pass mark as it is shown: "You pass with 4 right answers out of 5"."""
    return f"You pass with {counted(needed(total), 'right answer')} out of {total}"


def mark(posed: Sequence[PosedQuestion], answers: Mapping[str, str]) -> Result:
    """Score answers: option ids (or letters) by question id.

    Raises:
        KeyError: a question is not answered, or with an option it has not.
    """
    marked = []
    for question in posed:
        chosen = question.choice(answers[question.question])
        if chosen is None:
            raise KeyError(answers[question.question])
        marked.append(MarkedQuestion(question, chosen))
    return Result(tuple(marked))


def check_seed(seed: int) -> int:
    """``seed`` itself.

    Raises:
        UsageError: it is out of range.
    """
    if not 0 <= seed <= MAX_SEED:
        raise UsageError(
            f"{seed} is not a seed.", help=f"Use a whole number from 0 to {MAX_SEED}.", code="invalid_seed"
        )
    return seed


def fresh_seed(
    bank: Bank, seen: Mapping[str, int], draw: Callable[[], int] = lambda: secrets.randbelow(MAX_SEED + 1)
) -> int:
    """A seed that asks a question's first variant the first time, and later on another one than last time.

    The first variants are the questions of the chapter that the course was made from. One seed decides all
    questions, so a seed that suits them all is looked for; the best one found is taken.

    Args:
        seen: by question id, the seed it was last asked with.
        draw: gives a random seed.
    """
    last = {name: bank.variant(name, seed) for name, seed in seen.items() if name in bank.ids}
    first = {document.value.id: document.value.variant[0].id for document in bank.documents}

    def misses(seed: int, least: int) -> int:
        """The number of questions for which a seed is unsuitable; stops counting at ``least``."""
        count = 0
        for name in bank.ids:
            variant = bank.variant(name, seed)
            count += variant == last[name] if name in last else variant != first[name]
            if count >= least:
                break
        return count

    new = [len(document.value.variant) for document in bank.documents if document.value.id not in last]
    best, least = draw(), len(bank.ids) + 1
    for _ in range(_TRIES + _PATIENCE * math.prod(new) * bool(new)):
        if (missed := misses(seed := draw(), least)) < least:
            best, least = seed, missed
        if not least:
            break
    return best
