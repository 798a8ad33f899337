"""What is kept of a verdict, what of it a student may read, and its values as a person reads them."""

import math

import msgspec
import pytest

from course.scoring import kit
from course.scoring.failures import CheckFailed
from course.scoring.verdict import (
    MAX_VERDICT,
    CheckResult,
    Status,
    Tolerance,
    Verdict,
    Visibility,
    bounded,
    for_student,
    format_input,
    format_pair,
    format_points,
    format_tolerance,
    format_value,
    in_points,
    numbers_of,
)


def _check(**fields):
    given = {
        "id": "a", "title": "It is so", "task": "integrate", "status": Status.FAIL, "points": 0.0,
        "max_points": 1.0, "visibility": Visibility.HIDDEN, "message": "It is not.", "help": "Do.",
        "diagnosis": "NOT_SO", "duration_ms": 123.4, "actual": 5.0, "quantity": "slip", "stdout": "printed",
        "traceback": "a.py:1 in f",
    }  # fmt: skip
    return CheckResult(**{**given, **fields})


def _verdict(*checks):
    return Verdict(
        exercise="e",
        scope="full",
        state="graded",
        score=0.0,
        max_score=1.0,
        passed=False,
        checks=checks,
        isolation="L3",
    )


def test_a_hidden_check_that_looked_keeps_its_words_and_nothing_else():
    seen = for_student(_check())
    assert (seen.status, seen.message, seen.help, seen.diagnosis) == ("fail", "It is not.", "Do.", "NOT_SO")
    assert (seen.actual, seen.stdout, seen.traceback, seen.duration_ms) == (None, None, None, 0.0)
    assert seen.quantity == ""
    public = _check(visibility=Visibility.PUBLIC)
    assert for_student(public) is public


@pytest.mark.parametrize(
    ("status", "said", "told"),
    [
        (Status.ERROR, "RAISED", "RAISED"),
        (Status.ERROR, "NOT_IMPLEMENTED", "RAISED"),
        (Status.ERROR, "IMPORT_NOT_ALLOWED", "RAISED"),
        (Status.TIMEOUT, "TIMEOUT", "TIMEOUT"),
        (Status.MEMORY, "OUT_OF_MEMORY", "OUT_OF_MEMORY"),
        (Status.CRASH, "CRASHED", "CRASHED"),
        (Status.ERROR, "NOT_PLAIN_DATA", "OTHER_FORM"),
        (Status.CRASH, "NOT_PLAIN_DATA", "OTHER_FORM"),
        (Status.FAIL, "WRONG_KEYS", "OTHER_FORM"),
        (Status.FAIL, "WRONG_SHAPE", "OTHER_FORM"),
        (Status.FAIL, "RETURNS_NOTHING", "OTHER_FORM"),
    ],
)
def test_without_a_value_one_of_five_things_is_said_of_a_hidden_check(status, said, told):
    results = [
        for_student(
            _check(status=status, diagnosis=said, message=f"ValueError on line {line}.", help=str(line))
        )
        for line in (7, 8)
    ]
    assert results[0] == results[1]
    assert results[0].diagnosis == told
    assert "`integrate`" in results[0].message


def test_a_function_that_is_not_there_is_told_as_such():
    """It was known before any input was."""
    missing = _check(
        status=Status.ERROR, diagnosis="MISSING_FUNCTION", message="Your file has no function `f`."
    )
    assert for_student(missing).message == missing.message


def test_a_verdict_has_its_bound_whatever_is_in_it():
    long = {"stdout": "\U0001f600" * 4000, "traceback": "\\" * 9000, "actual": ["x" * 200] * 20}
    small, large = _verdict(_check()), _verdict(*[_check(**long)] * 40)
    assert bounded(small) is small
    assert len(msgspec.json.encode(large)) > MAX_VERDICT
    kept = bounded(large)
    assert len(msgspec.json.encode(kept)) <= MAX_VERDICT
    assert [(check.status, check.message) for check in kept.checks] == [("fail", "It is not.")] * 40
    assert kept.checks[0].actual == large.checks[0].actual, "what is needed most goes last"


# -- values -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("write", "value", "text"),
    [
        # No decimals that say nothing, and one point is singular.
        (format_points, 31.0, "31"),
        (format_points, 2.5, "2.5"),
        (format_points, 0.0, "0"),
        (format_points, 1 / 3, "0.33"),
        (format_points, 100, "100"),
        (in_points, 1.0, "1 point"),
        (in_points, 2, "2 points"),
        (in_points, 0, "0 points"),
        (in_points, 0.5, "0.5 points"),
        (in_points, 1.004, "1 point"),
        (format_value, math.nan, "nan"),
        (format_value, -math.inf, "-inf"),
        (format_value, math.inf, "inf"),
        (format_value, True, "True"),
        (format_value, None, "None"),
        (format_value, [1.5, [2, "x"]], "[1.5, [2, x]]"),
        (format_value, {"q": 1e-9}, "{q: 1e-09}"),
        (format_value, 3, "3"),
        # What only looks round has more digits.
        (format_value, 2.9999995764, "2.999999576"),
        (format_value, 3.0, "3"),
        (format_value, 0.1 + 0.2, "0.3"),
        (format_value, 1e300, "1e+300"),
        # An input reads like a sentence, and different numbers not as if they were equal.
        (format_input, {"omega": 2.0, "h": 0.05}, "omega = 2, h = 0.05"),
        (format_input, {"e": [1e7 + 0.3, 1e7 + 1.1, "… 3 more"]}, "e = [10000000.3, 10000001.1, … 3 more]"),
        (format_input, {"e": [1e7, 1e7]}, "e = [1e+07, 1e+07]"),
        # These are different, and no digits tell them apart.
        (format_input, {"e": [math.nan, math.nan]}, "e = [nan, nan]"),
    ],
)
def test_values_are_written_for_a_reader(write, value, text):
    assert write(value) == text


def test_values_that_differ_late_are_told_apart():
    actual, expected = format_pair(1.00000001, 1.0)
    assert (actual, expected) == ("1.00000001", "1")
    assert format_pair(1.0, 1.0) == ("1", "1")
    assert format_pair([0.1 + 0.2], [0.3]) == ("[0.30000000000000004]", "[0.29999999999999999]")


@pytest.mark.parametrize(
    ("tolerance", "units", "text"),
    [
        (Tolerance(rel=0.02, source="closed form"), "1", "within 2 %"),
        (Tolerance(rel=5e-5), "1", "within 5e-05 of it"),
        (Tolerance(rel=1e-9, abs=0.01, source="of 200 programs"), "m", "within 0.01 m"),
        (Tolerance(abs=1e-9, source="rounding"), "m", ""),
        (Tolerance(rel=1e-12), "s", ""),
        (Tolerance(rel=0.5, abs=0.1), "", "within 50 % or 0.1"),
        (Tolerance(source="theory"), "", ""),
    ],
)
def test_a_tolerance_says_how_much_unless_it_is_only_for_rounding(tolerance, units, text):
    assert format_tolerance(tolerance, units) == text


def compared(actual, expected, tolerance=None, units="", quantity=""):
    """The numbers of a failed check by their labels."""
    check = _check(actual=actual, expected=expected, tolerance=tolerance, units=units, quantity=quantity)
    return dict(numbers_of(check))


@pytest.mark.parametrize(
    ("actual", "shown"),
    [(0.5, "0.5 m"), (3, "3 m"), ([1.0, 2.0], "[1, 2] m"), (None, "None"), (False, "False"), ("no", "no")],
)
def test_only_numbers_have_a_unit(actual, shown):
    assert compared(actual, 2.0, units="m") == {"measured": shown, "expected": "2 m"}


def test_limits_are_said_in_words_and_where_none_can_be_met_the_one_that_is_broken():
    limits = Tolerance(source="theory")
    assert compared(3.0, [0.9, 1.1], limits, "m")["expected"] == "from 0.9 to 1.1 m"
    assert compared(3.0, [2.18494, 0.03], limits)["expected"] == "at most 0.03"
    assert compared(0.0, [2.18494, 0.03], limits)["expected"] == "at least 2.18494"
    assert compared(3.0, {"at most": 0.5}, limits, "s")["expected"] == "at most 0.5 s"
    assert compared([1.0, 2.0], [0.9, 1.1], Tolerance(abs=0.01))["expected"] == "[0.9, 1.1], within 0.01"
    assert compared(3, [1, 2], Tolerance(abs=0.0), "evaluations")["expected"] == "[1, 2] evaluations"


def test_a_measured_number_is_named_unless_the_message_names_it():
    def said(message):
        with pytest.raises(CheckFailed) as failed:
            kit.expect_bounded(2.0, high=1.0, source="x", quantity="slip", units="m", message=message)
        return failed.value.finding

    finding = said("It slides too far.")
    numbers = compared(finding.actual, finding.expected, quantity=finding.quantity, units="m")
    assert list(numbers.items()) == [("measured", "2 m (slip)"), ("expected", "at most 1 m")]
    assert said("The `slip` is too large.").quantity == ""


def test_a_number_of_the_wrong_type_does_not_look_like_the_right_one():
    assert compared(3.0, 3) == {"measured": "3.0", "expected": "3"}
    assert compared("None", None) == {"measured": "None"}
