"""What a seed makes of the questions."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.catalog.questions import read_questions
from course.errors import ContentError
from course.quizzing.bank import Bank, draw, same_answer, significant
from course.quizzing.desk import faults_in


def test_a_seed_means_the_same_questions_for_ever(bank: Bank) -> None:
    """Written down: an attempt of last year is posed again from its seed alone."""
    sums, colours = bank.pose(2026)
    assert draw(2026, "sums", "variant") == 15473829709646471922
    assert (sums.variant, sums.prompt) == ("numbers", "What is 30 and 4.5?")
    assert [choice.id for choice in sums.choices] == ["next", "none", "total", "less"]
    assert [choice.id for choice in colours.choices] == ["grey", "black", "white", "dark"]


def test_numbers_are_drawn_computed_and_shown(bank: Bank) -> None:
    seen = set()
    for seed in range(60):
        (posed,) = bank.pose(seed, only=["sums"])
        if posed.variant == "numbers":
            a, b = posed.prompt.removeprefix("What is ").removesuffix("?").split(" and ")
            assert posed.key.text == f"{float(a) + float(b):.1f} in all"
            assert posed.key.explanation == f"{a} and {b} are {float(a) + float(b):.1f}."
            seen.add((a, b))
    assert len(seen) == 6


def test_options_are_shuffled_evenly(bank: Bank) -> None:
    places = Counter(bank.pose(seed, only=["colours"])[0].key.letter for seed in range(1000))
    assert all(200 < places[letter] < 300 for letter in "abcd")


def test_options_that_round_to_the_same_are_refused_where_they_are_posed(quiz: Path) -> None:
    path = quiz / "sums.toml"
    path.write_text(path.read_text().replace('formula = "a + 1"', 'formula = "a + b + 0.001"'))
    bank = Bank(read_questions(quiz))
    seed = next(seed for seed in range(60) if bank.variant("sums", seed) == "numbers")
    with pytest.raises(ContentError, match=r"options total and next are too close to tell apart") as caught:
        bank.pose(seed)
    line = path.read_text().split("\n").index('text = "{next} in all"') + 1
    assert (caught.value.file, caught.value.line) == (path, line)


@pytest.mark.parametrize(
    ("formula", "said", "line"),
    [
        ("43 - a", "option next reads '23 in all'", 'text = "{next} in all"'),
        ("1 / (a - 30)", "fails for a = 30", '  { name = "next", formula = "1 / (a - 30)" },'),
    ],
)
def test_every_case_is_gone_through(quiz: Path, formula: str, said: str, line: str) -> None:
    """Only one case of six clashes, a = 20, b = 3, or fails; sampling might miss it."""
    path = quiz / "sums.toml"
    path.write_text(path.read_text().replace('formula = "a + 1"', f'formula = "{formula}"'))
    (fault,) = faults_in(read_questions(quiz)[0])
    assert said in fault.message
    assert fault.line == path.read_text().split("\n").index(line) + 1


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("0.10 m", "0.1 m"),
        ("Two apples", "two  apples."),
        ("1,000 steps", "1000 steps"),
        ("0.0980 m", "0.0981 m"),
        ("0 m", "0.0 m"),
        ("3 of 10", "3.0 of 10.1"),
        ("50 cm", "0.5 m"),
        ("0.5 s", "500 ms"),
        ("2 metres", "2 m"),
        ("5 %", "5 per cent"),
        ("About 0.5 s", "0.5 s"),
        ("1e3 N", "1000 N"),
        ("0.5 s", "0.5 s, because the two errors cancel"),
        ("-0.5 m", "−0.50 m"),
    ],
)
def test_the_same_answer_in_another_form_is_the_same(one: str, other: str) -> None:
    assert same_answer(one, other)
    assert same_answer(other, one)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("0.10 m", "0.11 m"),
        ("0.10 m too low", "0.10 m too high"),
        ("-1 m", "1 m"),
        ("3 of 10", "3 of 11"),
        ("0 m", "0.01 m"),
        ("one", "two"),
        ("2", "2 sqrt(m/k)"),
        ("2 m", "2 m/s"),
        ("5 mm/s", "0.005 m"),
        ("0.5 s too early", "0.5 s too late"),
        ("0.5 m", "0.5 s"),
    ],
)
def test_different_answers_are_different(one: str, other: str) -> None:
    assert not same_answer(one, other)


@pytest.mark.parametrize(
    ("value", "digits", "shown"),
    [
        (0.0981, 3, "0.0981"),
        (0.09996, 3, "0.100"),
        (2.0, 3, "2.00"),
        (999.6, 3, "1,000"),
        (12345.6, 3, "12,300"),
        (1234567, 3, "1,234,567"),
        (-0.5, 1, "-0.5"),
        (0.0, 3, "0"),
        (1.5e-7, 2, "0.00000015"),
    ],
)
def test_a_computed_number_is_shown_with_its_digits(value: float, digits: int, shown: str) -> None:
    assert significant(value, digits) == shown


@given(st.floats(1e-9, 1e12), st.integers(1, 6))
def test_a_shown_number_is_as_near_as_its_digits_allow(value: float, digits: int) -> None:
    shown = float(significant(value, digits).replace(",", ""))
    assert abs(shown - value) <= 0.5000001 * 10 ** (1 - digits) * value
