"""What a seed makes of the questions: the mark, the next seed, and when a missed question comes back."""

import random
from collections import Counter
from datetime import datetime, timedelta
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.catalog.questions import read_questions
from course.errors import ContentError
from course.quizzing.bank import MAX_SEED, Bank, draw, fresh_seed, mark, needed, same_answer, significant
from course.quizzing.desk import GAP_DAYS, ROUNDS, due_after, faults_in, schedule


def test_a_seed_means_the_same_questions_for_ever(bank):
    """Written down: an attempt of last year is posed again from its seed alone."""
    sums, colours = bank.pose(2026)
    assert draw(2026, "sums", "variant") == 15473829709646471922
    assert (sums.variant, sums.prompt) == ("numbers", "What is 30 and 4.5?")
    assert [choice.id for choice in sums.choices] == ["next", "none", "total", "less"]
    assert [choice.id for choice in colours.choices] == ["grey", "black", "white", "dark"]


def test_options_are_shuffled_evenly(bank):
    places = Counter(bank.pose(seed, only=["colours"])[0].key.letter for seed in range(1000))
    assert all(200 < places[letter] < 300 for letter in "abcd")


def test_options_that_round_to_the_same_are_refused_where_they_are_posed(quiz):
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
def test_every_case_is_gone_through(quiz, formula, said, line):
    """Only one case of six clashes, a = 20, b = 3, or fails; sampling might miss it."""
    path = quiz / "sums.toml"
    path.write_text(path.read_text().replace('formula = "a + 1"', f'formula = "{formula}"'))
    (fault,) = faults_in(read_questions(quiz)[0])
    assert said in fault.problem
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
def test_the_same_answer_in_another_form_is_the_same(one, other):
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
def test_different_answers_are_different(one, other):
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
def test_a_computed_number_is_shown_with_its_digits(value, digits, shown):
    assert significant(value, digits) == shown


@given(st.floats(1e-9, 1e12), st.integers(1, 6))
def test_a_shown_number_is_as_near_as_its_digits_allow(value, digits):
    shown = float(significant(value, digits).replace(",", ""))
    assert abs(shown - value) <= 0.5000001 * 10 ** (1 - digits) * value


def test_the_mark_is_the_smallest_number_that_reaches_seventy_per_cent():
    """In floats 0.7 times 10 is exact, and 0.7 times 30 is not: it must still be 21."""
    for total in range(1, 101):
        least = needed(total)
        assert Fraction(least, total) >= Fraction(7, 10) > Fraction(least - 1, total)
        assert 0 < least <= total


def test_an_answer_that_is_no_option_is_an_error(bank):
    with pytest.raises(KeyError):
        mark(bank.pose(4), {"sums": "z", "colours": "a"})


def fresh(bank, asked, chance):
    """A seed for who was asked these, drawn by that chance."""
    dice = random.Random(chance)
    return fresh_seed(bank, asked, lambda: dice.randrange(MAX_SEED + 1))


def test_a_first_attempt_asks_the_first_variant_of_each_question(bank):
    first = {document.value.id: document.value.variant[0].id for document in bank.documents}
    for start in range(50):
        seed = fresh(bank, {}, start)
        assert {name: bank.variant(name, seed) for name in bank.ids} == first


def test_a_question_that_is_new_to_a_student_starts_with_its_first_variant(bank):
    seed = fresh(bank, {"sums": 4}, 3)
    assert bank.variant("sums", seed) != bank.variant("sums", 4)
    assert (
        bank.variant("colours", seed) == bank.documents[list(bank.ids).index("colours")].value.variant[0].id
    )


def test_a_retake_asks_everything_otherwise(bank):
    for seed in range(100):
        again = fresh(bank, dict.fromkeys(bank.ids, seed), seed)
        assert all(bank.variant(name, again) != bank.variant(name, seed) for name in bank.ids)


def test_a_retake_repeats_as_little_as_it_can(bank):
    """Where no seed asks everything otherwise, the one with the fewest repeats is taken."""
    seen = {"sums": 1, "colours": 1}
    few = [seed for seed in range(50) if sum(bank.variant(n, seed) == bank.variant(n, 1) for n in seen) == 1]
    many = [seed for seed in range(50) if sum(bank.variant(n, seed) == bank.variant(n, 1) for n in seen) == 2]
    draws = iter([many[0], many[1], few[0], *[many[2]] * 1000])
    assert fresh_seed(bank, seen, lambda: next(draws)) == few[0]


def test_a_seed_for_questions_that_went_is_drawn_all_the_same(bank):
    assert fresh_seed(bank, {"gone": 3}, lambda: 77) == 77


START = datetime(2026, 3, 2, 12).astimezone()


def on(days, right):
    return START + timedelta(days=days), right


@pytest.mark.parametrize(
    ("answers", "due", "rounds"),
    [
        ([on(0, False)], 2, 0),
        ([on(0, False), on(2, True), on(4, True)], 6, 2),
        ([on(0, False), on(0.01, True), on(1, True), on(1.1, True)], 2, 0),
        ([on(0, False), on(2, True), on(3, False)], 5, 0),
        ([on(0, False), on(9, True)], 11, 1),
        # Missed in the evening, it is due from the morning of its day.
        ([on(0.49, False), on(2 - 0.49, True)], 4, 1),
    ],
    ids=["missed", "in time", "before its day", "wrong again", "late", "other times of day"],
)
def test_what_was_missed_is_due_two_days_after_it_counted_last(answers, due, rounds):
    found = due_after("q", answers)
    assert (found.question, found.on, found.rounds) == ("q", START.date() + timedelta(days=due), rounds)


def test_the_soonest_comes_first_and_gone_questions_are_passed_over():
    outcomes = {"b": [on(1, False)], "a": [on(0, False)], "gone": [on(0, False)], "fine": [on(0, True)]}
    assert [due.question for due in schedule(outcomes, ("b", "a", "fine"))] == ["a", "b"]


@given(st.lists(st.tuples(st.floats(0, 40), st.booleans()), max_size=12))
def test_a_question_is_never_due_sooner_than_the_gap_after_it_was_last_missed(entries):
    answers = sorted(on(days, right) for days, right in entries)
    due = due_after("q", answers)
    missed = [at for at, right in answers if not right]
    if not missed:
        assert due is None
    elif due is not None:
        assert due.on >= missed[-1].date() + timedelta(days=GAP_DAYS)
        assert 0 <= due.rounds < ROUNDS
    else:
        after = sum(at > missed[-1] for at, right in answers if right)
        assert after >= ROUNDS
