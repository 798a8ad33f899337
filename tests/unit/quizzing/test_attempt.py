"""The mark, the score and the next seed."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from course.quizzing.bank import MAX_SEED, Bank, fresh_seed, mark, needed


def test_the_mark_is_the_smallest_number_that_reaches_seventy_per_cent() -> None:
    """In floats 0.7 times 10 is exact, and 0.7 times 30 is not: it must still be 21."""
    for total in range(1, 101):
        least = needed(total)
        assert Fraction(least, total) >= Fraction(7, 10) > Fraction(least - 1, total)
        assert 0 < least <= total


def test_an_answer_that_is_no_option_is_an_error(bank: Bank) -> None:
    with pytest.raises(KeyError):
        mark(bank.pose(4), {"sums": "z", "colours": "a"})


def test_a_first_attempt_asks_the_first_variant_of_each_question(bank: Bank) -> None:
    first = {document.value.id: document.value.variant[0].id for document in bank.documents}
    for start in range(50):
        chance = random.Random(start)
        seed = fresh_seed(bank, {}, lambda: chance.randrange(MAX_SEED + 1))  # noqa: B023
        assert {name: bank.variant(name, seed) for name in bank.ids} == first


def test_a_question_that_is_new_to_a_student_starts_with_its_first_variant(bank: Bank) -> None:
    chance = random.Random(3)
    seed = fresh_seed(bank, {"sums": 4}, lambda: chance.randrange(MAX_SEED + 1))
    assert bank.variant("sums", seed) != bank.variant("sums", 4)
    assert (
        bank.variant("colours", seed) == bank.documents[list(bank.ids).index("colours")].value.variant[0].id
    )


def test_a_retake_asks_everything_otherwise(bank: Bank) -> None:
    for seed in range(100):
        chance = random.Random(seed)
        again = fresh_seed(bank, dict.fromkeys(bank.ids, seed), lambda: chance.randrange(MAX_SEED + 1))  # noqa: B023
        assert all(bank.variant(name, again) != bank.variant(name, seed) for name in bank.ids)


def test_a_retake_repeats_as_little_as_it_can(bank: Bank) -> None:
    """Where no seed asks everything otherwise, the one with the fewest repeats is taken."""
    seen = {"sums": 1, "colours": 1}
    few = [seed for seed in range(50) if sum(bank.variant(n, seed) == bank.variant(n, 1) for n in seen) == 1]
    many = [seed for seed in range(50) if sum(bank.variant(n, seed) == bank.variant(n, 1) for n in seen) == 2]
    draws = iter([many[0], many[1], few[0], *[many[2]] * 1000])
    assert fresh_seed(bank, seen, lambda: next(draws)) == few[0]


def test_a_seed_for_questions_that_went_is_drawn_all_the_same(bank: Bank) -> None:
    assert fresh_seed(bank, {"gone": 3}, lambda: 77) == 77
