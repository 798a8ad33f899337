"""What the inputs of wrong results have to do with it: where they are right, and what would make them so."""

import math

import pytest

from course.authoring.exercises.grading import grade_sources
from course.catalog.load import Catalog
from course.scoring.explain.inputs import other_inputs, where_right


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ([{"x": 2.0}, {"x": 3.0}], [{"x": -1.0}, {"x": -2.0}], ", and wrong where `x` is negative"),
        # Of one wrong result it is said as what it is, for another of its kind may be right.
        ([{"x": 2.0}, {"x": 3.0}], [{"x": -1.0}], "; the other is the only one where `x` is negative"),
        ([{"l": 1.0}], [{"l": 2.0}, {"l": 0.5}], ", where `l` is 1"),
        ([{"e": 0.5}], [{"e": 0}], "; the other is the only one where `e` is 0"),
        ([{"p": [1.0, 2.0]}], [{"p": [1.0]}, {"p": [3.0, 4.0, 5.0]}], ", where `p` has two values"),
        (
            [{"p": [1.0, 2.0]}],
            [{"p": [1.0, -2.0]}, {"p": [-1.0, 2.0]}],
            ", and wrong where `p` has a negative value",
        ),
        ([{"rule": "mean"}, {"rule": True}], [{"rule": "sum"}], ""),
        # Which of the two it is cannot be seen.
        ([{"x": 2.0, "v": 2.0}], [{"x": -1.0, "v": -1.0}], ""),
        # An argument that has a default is not always given.
        ([{"x": 2.0}], [{"x": 3.0, "g": 0.0}], ""),
        ([{"x": 2.0}, {"x": -3.0}], [{"x": -1.0}], ""),
        # Nobody writes a function for numbers below zero alone.
        ([{"x": -2.0}, {"x": -3.0}], [{"x": 1.0}], ""),
    ],
)
def test_right_and_wrong_results_are_told_apart_by_one_input(right, wrong, said):
    assert where_right(right, wrong) == said


def test_other_inputs_are_the_same_ones_exchanged_or_changed():
    calls = dict(other_inputs([{"a": 2.0, "b": 4.0, "p": [1.0]}, {"a": 3.0, "b": 9.0, "p": [2.0]}]))
    assert calls["`a` and `b` exchanged"] == [(4.0, 2.0, [1.0]), (9.0, 3.0, [2.0])]
    assert calls["the square of `a` in its place"] == [(4.0, 4.0, [1.0]), (9.0, 9.0, [2.0])]
    assert calls["`a` in degrees in its place"][0][0] == math.degrees(2.0)
    assert not any("`p`" in instead for instead in calls)


def test_a_change_that_some_input_does_not_allow_is_left_out():
    changes = [instead for instead, _ in other_inputs([{"a": 2.0}, {"a": 0.0}, {"a": -1.0}])]
    assert "one over `a` in its place" not in changes
    assert "the root of `a` in its place" not in changes
    assert "the other sign of `a` in its place" in changes


def test_an_argument_with_a_default_is_kept_as_it_was_given():
    calls = dict(other_inputs([{"m": 2.0, "l": 1.0}, {"m": 3.0, "l": 0.5, "g": 1.62}]))
    assert calls["`m` and `l` exchanged"] == [(1.0, 2.0), (0.5, 3.0, 1.62)]
    assert not any("`g`" in instead for instead in calls)


@pytest.mark.parametrize(
    ("exercise", "source", "said"),
    [
        (
            "where-is-the-hand",
            "from math import cos, sin\n\n\ndef hand(a2, a1, l1, l2):\n"
            "    return l1 * cos(a1) + l2 * cos(a1 + a2), l1 * sin(a1) + l2 * sin(a1 + a2)\n",
            "The position of the hand is wrong. With `a1` and `a2` exchanged every result is right.",
        ),
        (
            "clear-the-forces",
            "def final_speed(mass, force, h, n):\n    return max(force, 0.0) * h * n / mass\n",
            "The speed after n steps is wrong. For 2 of 3 inputs it is right; the other is the only one"
            " where `force` is negative.",
        ),
        (
            "equal-work",
            "def fair_step(h, iterations, other):\n    return round(h * other / iterations, 6)\n",
            "The step of the other engine is wrong. Each wrong result is the right one rounded to 6"
            " decimals.",
        ),
        (
            "inside-the-cone",
            "import math\ndef friction(wanted, normal, mu):\n"
            "    factor = min(1.0, mu * normal / math.hypot(*wanted))\n"
            "    return [factor * part for part in wanted]\n",
            "Your code raised ZeroDivisionError on line 3 of your file: float division by zero.",
        ),
    ],
)
def test_a_warm_up_says_it(exercise, source, said):
    ((_, verdict),) = grade_sources([(Catalog().exercise(exercise), source.encode())])
    (failed,) = [check for check in verdict.checks if check.points == 0]
    assert failed.message == said
