"""Values as a person reads them."""

from __future__ import annotations

import math

import pytest

from course.scoring.verdict import (
    CheckResult,
    Tolerance,
    format_input,
    format_pair,
    format_points,
    format_tolerance,
    format_value,
    in_points,
    numbers_of,
)


@pytest.mark.parametrize(
    ("points", "text"), [(31.0, "31"), (2.5, "2.5"), (0.0, "0"), (1 / 3, "0.33"), (100, "100")]
)
def test_points_have_no_decimals_that_say_nothing(points, text):
    assert format_points(points) == text


def test_values_that_differ_late_are_told_apart():
    actual, expected = format_pair(1.00000001, 1.0)
    assert (actual, expected) == ("1.00000001", "1")
    assert format_pair(1.0, 1.0) == ("1", "1")
    assert format_pair([0.1 + 0.2], [0.3]) == ("[0.30000000000000004]", "[0.29999999999999999]")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (math.nan, "nan"),
        (-math.inf, "-inf"),
        (True, "True"),
        (None, "None"),
        ([1.5, [2, "x"]], "[1.5, [2, x]]"),
        ({"q": 1e-9}, "{q: 1e-09}"),
        (3, "3"),
    ],
)
def test_plain_values_are_readable(value, text):
    assert format_value(value) == text


def test_an_input_reads_like_a_sentence():
    assert format_input({"omega": 2.0, "h": 0.05}) == "omega = 2, h = 0.05"


@pytest.mark.parametrize(
    ("tolerance", "units", "text"),
    [
        (Tolerance(rel=0.02, source="closed form"), "1", "within 2 % (closed form)"),
        (Tolerance(abs=1e-9, source="rounding"), "m", "within 1e-09 m (rounding)"),
        (Tolerance(rel=1e-12), "s", "within 1e-12 of it"),
        (Tolerance(rel=0.5, abs=0.1), "", "within 50 % or 0.1"),
        (Tolerance(source="theory"), "", "theory"),
    ],
)
def test_a_tolerance_says_how_much_and_why(tolerance, units, text):
    assert format_tolerance(tolerance, units) == text


def test_one_point_is_singular() -> None:
    assert [in_points(value) for value in (1.0, 2, 0, 0.5, 1.004)] == [
        "1 point", "2 points", "0 points", "0.5 points", "1 point",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("actual", "shown"),
    [(0.5, "0.5 m"), (3, "3 m"), ([1.0, 2.0], "[1, 2] m"), (None, "None"), (False, "False"), ("no", "no")],
)
def test_only_numbers_have_a_unit(actual, shown):
    check = CheckResult(
        id="c", title="A check", task="t", status="fail", visibility="public", points=0.0, max_points=1.0,
        actual=actual, expected=2.0, units="m",
    )  # fmt: skip
    assert numbers_of(check) == [("measured", shown), ("expected", "2 m")]
