"""Which hint comes next, and what it says of the student's numbers."""

from __future__ import annotations

import pytest

from course.catalog.models import Task

TASK = Task(
    id="throw",
    title="Throw",
    points=1.0,
    hints=("Look up.", "Count.", "Square it."),
    fits={"2": ("ONE_SHORT",), "3": ("NOT_SQUARED",)},
    yours={
        "any": ("It is {got}.",),
        "3": ("At t = {t s} it is {got}, {ratio} times as far.", "It is {got}, not {expected}."),
    },
)
FAR = {"t s": "2", "got": "4", "expected": "8", "ratio": "0.5"}
NEAR = {"got": "3", "expected": "9"}


@pytest.mark.parametrize(
    ("index", "failed", "words"),
    [
        (0, [("", FAR)], "Look up. It is 4."),
        (1, [("", {}), ("", NEAR)], "Count. It is 3."),
        (1, [("", FAR), ("ONE_SHORT", NEAR)], "Count. It is 3."),
        (2, [("NOT_SQUARED", FAR)], "Square it. At t = 2 it is 4, 0.5 times as far."),
        (2, [("NOT_SQUARED", NEAR)], "Square it. It is 3, not 9."),
        (2, [("NOT_SQUARED", {"got": "3"})], "Square it."),
        (2, [], "Square it."),
    ],
)
def test_a_hint_says_the_first_sentence_whose_fields_the_failed_check_has(index, failed, words):
    assert TASK.said(index, failed) == words


def test_braces_in_a_students_value_stay_as_they_are():
    assert TASK.said(0, [("", {"got": "{expected}"})]) == "Look up. It is {expected}."


@pytest.mark.parametrize(
    ("diagnoses", "given", "following"),
    [
        ((), (), 0),
        (("NOT_SQUARED",), (), 2),
        (("NOT_SQUARED",), (2,), 0),
        (("OTHER",), (0, 1), 2),
        ((), (0, 1, 2), None),
    ],
)
def test_the_hint_that_fits_comes_before_the_mildest(diagnoses, given, following):
    assert TASK.following(diagnoses, given) == following
