"""What a wrong answer has in common with the right one, and what a function's own text shows."""

import math

import numpy as np
import pytest

from course.authoring.exercises.grading import grade_sources
from course.catalog.load import Catalog
from course.isolation.failures import StudentFailure
from course.scoring import kit
from course.scoring.elsewhere import cure
from course.scoring.explain.likeness import likeness, names_of, of_cases, return_in_a_loop, why_none
from course.scoring.failures import CheckFailed, finding_of
from course.scoring.judging.outcomes import told_more
from course.scoring.verdict import CheckResult, Places, Status, Visibility
from tests.growth import LIMIT, growth

PLACES = Places(module="work.py")


@pytest.mark.parametrize(
    ("actual", "expected", "given", "said"),
    [
        (-2.4, 2.4, {}, "Here your result is right but for its sign."),
        (4.8, 2.4, {}, "Here your result is twice the right one."),
        (-4.8, 2.4, {}, "Here your result is twice the right one, with the other sign."),
        (2.4 * 180 / math.pi, 2.4, {}, "times 180/pi, as if it were in degrees"),
        (124.0, 1.24, {"resolution": 0.01}, "100 times the right one (`resolution` is 0.01)"),
        (2.4, 0.24 * 0.07, {"x": 3.0, "y": 0.07, "z": 0.1}, ""),
        (4.8, 2.4, {"m": 2.0}, "Here your result is twice the right one."),
        (4.8, 2.4, {"values": [0.5, 3.1]}, "Here your result is twice the right one."),
        (0.48, 2.4, {"e": 0.2, "v": 3.7}, "the right one times `e`"),
        (2.4 * 0.07, 2.4, {"h": 0.07}, "the right one times `h`"),
        (2.4 / 0.07**2, 2.4, {"h": 0.07}, "the right one over `h` squared"),
        (3.7, 2.4, {"v": 3.7}, "the same as `v`"),
        (3.1, 5.0, {"errors": [3.1, 4.0]}, "the same as the first of `errors`"),
        (2.0, 5.0, {"height": 2.0}, ""),  # too many things are two
        (1.0, 5.3, {"errors": [1.0, 4.0]}, ""),
        (2.7, 2.0, {"left": 0.7}, "too large by `left`"),
        (12.0, 9.0, {"va": 3.0}, ""),
        (6, 7, {}, "too small by 1"),
        (1 / 2.4, 2.4, {}, "one over the right one"),
        (2.43**2, 2.43, {}, "the square of the right one"),
        (2.43, 2.43**2, {}, "the square root of the right one"),
        (2.25, 1.5, {}, ""),  # three halves of it as well
        (math.atan(0.43), 0.43, {}, "the arctangent of the right one"),
        (1.7 * math.log(2.0), 1.7, {}, "the right one times ln 2, as of logarithms with two bases"),
        (1241.0, 1241.4, {}, "the right one without its decimals"),
        (2.1, 2.06387, {}, ""),
        (1.0, 1.41, {}, ""),
        (-1.0, -0.98, {}, ""),
        (12.35, 12.3456, {}, "the right one rounded to 2 decimals"),
        (2.35, 2.3456, {}, ""),  # what leaves something out came to such a number, too
        (3.0, 3, {}, "its type is float, and int is asked for"),
        (math.inf, "None", {}, "give None, not inf"),
        (6.5, "None", {"values": [5.0, 6.5]}, "the same as the last of `values`"),
        (6.5, "None", {"values": [5.0, 6.0]}, ""),
        ("Mean ", "mean", {}, "Only capitals or spaces"),
        (1.7, 2.4, {"m": 3.0}, ""),
        (0.0, 2.4, {"h": 0.0}, ""),
        (2.4, 0.0, {}, ""),
        ("text", 2.4, {}, ""),
        (True, 1.0, {}, ""),
        ([], [1.0, 2.0], {}, ""),
        (None, 2.4, {}, ""),
        ([3.0, -4.0], [0.6, -0.9], {"wanted": [3.0, -4.0]}, "Your result is `wanted`, unchanged."),
        # A wall's mass was once said to be the factor between two velocities.
        ([-1.5, 1.9], [-1.5, 0.1], {"mb": math.inf}, "Only the second of these numbers is wrong."),
    ],
)
def test_an_answer_is_compared_with_the_right_one_and_with_what_went_in(actual, expected, given, said):
    found = likeness(actual, expected, given)
    assert found == said if not said or said.endswith(".") else said in found


@pytest.mark.parametrize(
    ("pairs", "said"),
    [
        ([(1.7, 2.7), (0.9, 1.9)], "Each wrong result is too small by 1."),
        ([(4.8, 2.4), (7.0, 3.5)], "Each wrong result is twice the right one."),
        ([(2.4, 1.2), (4.8, 2.5)], ""),  # twice by chance
        ([(1.2345, 1.0), (2.469, 2.0)], "Each wrong result is 1.2345 times the right one."),
        ([(1.25, 1.0), (3.25, 3.0)], "Each wrong result is too large by 0.25."),
        ([([1.0, -2.0], [1.0, 2.0]), ([3.0, 4.0], [3.0, 5.0])], "Only the sign of the second of these"),
        ([(4.8, 2.4)], "Here your result is twice the right one."),
        ([(True, 2.4), (True, 3.5)], ""),
        ([(0.0, 0.2), (0.0, 0.3)], "Each wrong result is 0."),
        ([(0.0, 0.2), (2.0, 2.9)], "Each wrong result is the right one without its decimals."),
        ([(0.123, 0.12345), (0.679, 0.67894)], ""),  # of few digits others are rounded, too
        (
            [(0.1235, 0.123456), (0.6789, 0.678912)],
            "Each wrong result is the right one rounded to 4 decimals.",
        ),
    ],
)
def test_of_one_check_s_results_is_said_what_all_have_in_common(pairs, said):
    found = of_cases([(actual, expected, {}) for actual, expected in pairs])
    assert said in found
    assert bool(said) == bool(found)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("energies.sort()", "Your code changes `energies`, the list that it is given."),
        ("return 0.25", "Each wrong result is 0.25."),
        ("return len(energies) / 7", "For 1 of 5 inputs it is right."),
    ],
)
def test_a_warm_up_says_what_its_results_show(body, said):
    exercise = Catalog().exercise("worst-drift")
    source = f"""
def worst_drift(energies):
    if energies[0] == 2.0 and energies[1] == 2.2:
        return 0.15
    {body}
    return max(abs(energy - energies[0]) for energy in energies) / abs(energies[0])
"""
    ((_, verdict),) = grade_sources([(exercise, source.encode())])
    assert verdict.checks[0].message == f"The worst drift is wrong. {said}"


@pytest.mark.parametrize(
    ("actual", "expected", "said"),
    [
        ([4.0, 1.0], [1.0, 4.0], "Each of the two stands in the other's place."),
        ([-1.0, 1.0], [1.0, -1.0], "Only the signs are wrong."),
        ([4.0, 2.0, 1.0], [1.0, 2.0, 4.0], "The values are right, in reverse order."),
        ([2.0, 4.0, 1.0], [1.0, 2.0, 4.0], "The values are right, in another order."),
        ([[1.0, 3.0], [2.0, 4.0]], [[1.0, 2.0], [3.0, 4.0]], "rows and columns exchanged"),
        ([0.0, 1.0, 2.0, 4.0, 7.0], [1.0, 2.0, 4.0, 7.0, 9.0], "one place late"),
        ([2.0, 4.0, 7.0, 9.0, 0.0], [1.0, 2.0, 4.0, 7.0, 9.0], "one place early"),
        ([2.0, 4.0, 7.0], [1.0, 2.0, 4.0, 7.0], "The first is missing"),
        ([1.0, 2.0, 4.0], [1.0, 2.0, 4.0, 7.0], "The last is missing"),
        ([0.0, 1.0, 2.0], [1.0, 2.0], "one too many, at the beginning"),
        ([1.0, 2.0, 9.0], [1.0, 2.0], "one too many, at the end"),
        ([-1.0, -2.0], [1.0, 2.0], "Only the signs are wrong."),
        ([1.0, -2.0], [1.0, 2.0], "Only the sign of the second of these numbers is wrong."),
        ([1.0, -2.0, 1e-17], [1.0, 2.0, -1e-17], "Only the sign of the second of these numbers is wrong."),
        (
            [[1.0, -2.0], [-3.0, 4.0]],
            [[1.0, 2.0], [3.0, 4.0]],
            "Only the signs of [0, 1] and [1, 0] are wrong.",
        ),
        (
            [-1.0, -2.0, -3.0, 4.0],
            [1.0, 2.0, 3.0, 4.0],
            "Only signs are wrong: 3 of these 4 numbers have the other one.",
        ),
        ([1.0, 4.0], [1.0, 2.0], "Only the second of these numbers is wrong: it is twice the right one."),
        ([1.5, 2.0, 4.0], [1.0, 2.0, 4.0], "Only the first of these numbers is wrong."),
        ([3 / 7, -4 / 7], [0.6, -0.8], "Every value is 0.714286 times the right one."),
        ([2.0, 4.0], [1.0, 2.0], "Every value is twice the right one."),
        ([1.5, 2.5, 4.5], [1.0, 2.0, 4.0], "Every value is too large by the same 0.5."),
        ([2.5, 2.5, 2.5], [1.0, 2.0, 4.0], "All your values are the same: 2.5."),
        ([1.0, 2.0, math.nan], [1.0, 2.0, 4.0], "The first nan is at [2]."),
        ([1.0, 5.0, 3.0], [2.0, 7.0, 4.0], ""),
        ([0.0, 0.0], [1.0, 2.0], ""),
        ({"q[9]": 2.0}, {"q[9]": 4.0}, "Here your result is half the right one."),
        ([[1.0], [2.0, 3.0]], [1.0, 2.0], ""),
    ],
)
def test_several_numbers_are_compared_with_the_right_ones(actual, expected, said):
    found = likeness(actual, expected)
    assert said in found
    assert bool(said) == bool(found)


@pytest.mark.parametrize("size", [400, pytest.param(4000, marks=pytest.mark.soak)])
def test_what_is_said_of_random_numbers_is_nothing(size):
    drawn = np.random.default_rng(1).uniform(0.1, 10.0, (size, 6))
    said = [likeness(a, e, {"x": x, "list": [y, z]}) for a, e, x, y, z, _ in drawn.tolist()]
    said += [likeness(row[:3], row[3:], {"x": row[0] + 1.0}) for row in drawn.tolist()]
    assert not any(said)


def judged(**fields):
    usual = {"status": Status.FAIL, "visibility": Visibility.PUBLIC, "message": "It is wrong."}
    usual |= {"id": "c", "title": "c", "task": "total", "points": 0.0, "max_points": 1.0}
    return CheckResult(**(usual | fields))


LOOPS = b"""
def total(errors):
    for error in errors:
        return error
"""


def test_a_fact_is_said_of_a_public_check_without_a_name_and_of_no_other():
    numbers = {"actual": 4.0, "expected": 2.0}
    told = told_more(judged(**numbers), b"", PLACES)
    assert told.message == "It is wrong. Here your result is twice the right one."
    assert told_more(judged(**numbers, diagnosis="NAMED"), b"", PLACES).message == "It is wrong."
    length = judged(**numbers, quantity="entries in angles")
    assert told_more(length, b"", PLACES).message == "It is wrong."  # not of what they hold
    hidden = judged(**numbers, visibility=Visibility.HIDDEN)
    assert told_more(hidden, b"", PLACES).message == "It is wrong."


def test_a_return_that_ends_a_loop_in_its_first_pass_is_named():
    told = told_more(judged(), LOOPS, PLACES)
    assert told.diagnosis == "RETURN_IN_LOOP"
    assert "on line 4 of your file" in told.message
    helper = b"def total(e):\n    return one(e)\n\ndef one(e):\n    for x in e:\n        return x\n"
    assert return_in_a_loop(helper, "total", PLACES)


@pytest.mark.parametrize(
    "code",
    [
        b"def total(e):\n    for x in e:\n        if x:\n            return x\n    return 0\n",
        b"def total(e):\n    for x in e:\n        if not x:\n            continue\n        return x\n",
        b"def total(e):\n    while True:\n        return 0\n",
        b"def other(e):\n    for x in e:\n        return x\n\ndef total(e):\n    return 0\n",
        b"def total(e: not Python",
    ],
)
def test_a_return_that_may_belong_where_it_stands_is_not_blamed(code):
    assert return_in_a_loop(code, "total", PLACES) is None


def test_a_function_that_gives_none_is_told_the_condition_or_the_print_and_not_a_missing_return():
    bounce = b"def after(v, e):\n    if v < 0:\n        return -e * v\n    return None\n"
    assert "condition on line 2 of your file" in why_none(bounce, "after", PLACES)
    assert "`print`" in why_none(b"def after(v):\n    print(2 * v)\n", "after", PLACES)
    assert "is None here" in why_none(b"def after(v):\n    x = None\n    return x\n", "after", PLACES)
    assert why_none(b"def after(v):\n    2 * v\n", "after", PLACES) == ""
    merged = b"def after(v):\n    if v < 0:\n        return {}\n    return {**part(v)}\n"
    assert "`rmse` is None here" in why_none(merged, "after", PLACES, "rmse")
    part = b"def after(v):\n    if v:\n        return {'rmse': None}\n"
    assert "A dict is returned, and `rmse` is None." in why_none(part, "after", PLACES, "rmse")
    assert "condition on line 2" in why_none(part, "after", PLACES, "The result")
    pair = b"def after(v):\n    if v:\n        return v, None\n"
    assert "`w` is None" in why_none(pair, "after", PLACES, "w")
    assert "condition on line 2" in why_none(pair, "after", PLACES, "The result")
    nothing = judged(diagnosis="RETURNS_NOTHING", task="after", help="Is a `return` missing?")
    assert "condition" in told_more(nothing, bounce, PLACES).help


def _returns_and_ifs(n):
    return b"def total(e):\n    return None\n" + n * 20 * b"    return 1\n    if e: 0\n"


def _loops_in_loops(n):
    inside = [b" " * at + b"for x in e:\n" for at in range(1, n + 1)]
    after = [b" " * at + b"return x\n" for at in range(n, 0, -1)]
    deepest = b" " * (n + 1) + n * 200 * b"e;" + b"continue\n"
    return b"def total(e):\n" + b"".join(inside) + deepest + b"".join(after)


@pytest.mark.soak
@pytest.mark.parametrize(
    ("look", "text"), [(why_none, _returns_and_ifs), (return_in_a_loop, _loops_in_loops)]
)
def test_the_text_of_a_function_is_looked_through_in_time_that_grows_with_it(look, text):
    """18 kB of such text held the grader, which has no deadline, for 43 s of CPU."""

    def make(n):
        source = text(n)
        names_of(source, "total")  # parsed
        return lambda: look(source, "total", PLACES)

    assert growth(make, 11) < LIMIT


def test_the_call_that_raised_is_shown_with_its_arguments():
    raised = judged(status=Status.ERROR, diagnosis="RAISED")
    assert names_of(LOOPS, "total") == ("errors",)
    assert told_more(raised, LOOPS, PLACES, ([3.0, 4.0],)).input == {"errors": [3.0, 4.0]}
    assert told_more(judged(visibility=Visibility.HIDDEN), LOOPS, PLACES, ([3.0],)).input is None


def test_a_value_of_another_kind_is_told_with_its_input():
    words = {"message": "It is wrong.", "source": "exact", "quantity": "x", "input": {"v": 2.0}}
    calls = (
        lambda: kit.expect_close(None, 1.0, rel=1e-9, **words),
        lambda: kit.expect_array("text", [1.0], rel=1e-9, **words),
        lambda: kit.expect_bounded([1.0], low=0.0, **words),
        lambda: kit.expect_length(3.0, 2, message="It is wrong.", input={"v": 2.0}),
    )
    for call in calls:
        with pytest.raises(CheckFailed) as failed:
            call()
        assert failed.value.finding.input == {"v": 2.0}


def test_none_as_the_right_answer_is_shown_and_nothing_said_is_not():
    with pytest.raises(CheckFailed) as failed:
        kit.expect_equal(5.0, None, message="It is wrong.")
    assert (failed.value.finding.expected, failed.value.finding.actual) == ("None", 5.0)
    with pytest.raises(CheckFailed) as failed:
        kit.fail("It is wrong.")
    assert failed.value.finding.expected is None


@pytest.mark.parametrize(
    ("code", "advice"),
    [
        ("math.sqrt(2.0)", "Add `import math`"),
        ("np.sqrt(2.0)", "Add `import numpy as np`"),
        ("sqrt(2.0)", "write `math.sqrt`"),
        ("totl + 1", "Is `totl` spelled"),
        ("[1.0] - [2.0]", "lists do not subtract"),
        ("[1.0] / 2.0", "lists do not divide"),
        ("[1.0] / 2", "lists do not divide"),
        ("len([1.0] - 1)", "`len(a) - 1`"),
        ("1 - [1.0]", "lists do not subtract"),
        ("[1.0] ** 2", "lists do not have powers"),
        ("[1.0] * 2.0", "does not multiply its values"),
        ("[1.0].mean()", "Only arrays have `mean`; this is a list"),
        ("None + 1.0", "is None"),
        ("2.0 * 3.0(1.0)", "Is a `*` missing"),
        ("2.0 ^ 2", "write `**`"),
        ("__import__('numpy').ones(2) ^ 2", "write `**`"),
        ("[1.0][1]", "0 to n - 1"),
        ("[1.0][0.5]", "An index is an int"),
        ("[[1.0]][0, 0]", "indexed twice"),
        ("(1.0)[0]", "no [index]"),
        ("sum(1.0)", "a list is needed"),
        ("1 / 0", "divided by is zero"),
        ("__import__('math').sqrt(-1.0)", "negative number"),
        ("(lambda x: x)()", "Pass every argument"),
        ("(lambda: 0)(1)", "Keep the stub's arguments"),
        ("int('x')", ""),
    ],
)
@pytest.mark.filterwarnings("ignore::SyntaxWarning")
def test_pythons_commonest_errors_have_their_own_cure(code, advice):
    with pytest.raises(Exception) as raised:
        eval(code, {})
    failure = StudentFailure(kind="error", type=type(raised.value).__name__, message=str(raised.value))
    assert advice in cure(failure)
    assert bool(advice) == bool(cure(failure))


@pytest.mark.parametrize(
    ("line", "advice"),
    [
        ("a = 2 \N{MINUS SIGN} 1", "pasted"),
        ("\N{NO-BREAK SPACE}a = 2", "pasted"),
        ("a = 2h", "Is a `*` missing"),
        ("a = (2", "the one above"),
    ],
)
def test_a_line_that_python_cannot_read_has_the_advice_that_fits_it(line, advice):
    with pytest.raises(SyntaxError) as raised:
        compile(line, "", "exec")
    why = StudentFailure("error", type="SyntaxError", message=raised.value.msg, bases=("SyntaxError",))
    failure = StudentFailure("missing", type="f")
    failure.why = why
    assert advice in finding_of(failure).help


def test_of_an_exception_in_several_lines_the_first_is_repeated_where_the_advice_is_known():
    lines = "module 'numpy' has no attribute 'float'.\n`np.float` was a deprecated alias for `float`."
    finding = finding_of(StudentFailure("error", type="AttributeError", message=lines), shown=True)
    assert finding.message == "Your code raised AttributeError: module 'numpy' has no attribute 'float'."
    assert finding.help.endswith("has no `np.float`. Use `float`.")
    whole = finding_of(StudentFailure("error", type="ValueError", message="a\nb"), shown=True)
    assert whole.message == "Your code raised ValueError: a\\nb."
    assert "README" not in whole.help, "a warm-up's has no example"
