"""The kit: what a student may return becomes a value or a finding, never an exception of ours."""

import json
import math
from pathlib import Path
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from course.physics import exact, systems
from course.scoring import failures, kit
from course.scoring.kit import CheckFailed, Diagnosis, Inspected, StudentFailure
from course.scoring.values import as_march, plain
from course.scoring.verdict import Divergence

WORDS = {"message": "It is wrong.", "help": "Mend it."}
#: What every comparison of numbers is told beside them.
HOW = {"source": "test", "quantity": "x", **WORDS}


def finding_of(fn, *args, **kwargs):
    with pytest.raises(CheckFailed) as caught:
        fn(*args, **kwargs)
    return caught.value.finding


plain_values = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats()
    | st.text(max_size=5)
    | hnp.arrays(
        st.sampled_from([np.float64, np.int64, np.bool_, np.complex128]),
        hnp.array_shapes(min_dims=0, max_dims=3),
    ),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)
READERS = [
    kit.as_number,
    kit.as_integer,
    kit.as_bool,
    kit.as_text,
    kit.as_list,
    kit.as_vector,
    lambda value: kit.as_vector(value, 2),
    lambda value: kit.as_matrix(value, (2, None)),
    lambda value: kit.as_pair(value, 2),
    lambda value: kit.as_record(value, ("a", "b")),
    lambda value: kit.as_tuple(value, ("t", "q", "v")),
    lambda value: as_march(value, 2, 1),
    lambda value: kit.expect_close(value, 1.0, rel=0.1, **HOW),
    lambda value: kit.expect_array(value, [1.0, 2.0], rel=0.1, **HOW),
    lambda value: kit.expect_equal(value, "x", **WORDS),
    lambda value: kit.expect_length(value, 2, **WORDS),
    lambda value: kit.expect_true(value, "It is wrong."),
]


@given(value=plain_values)
def test_any_plain_value_is_read_or_becomes_a_finding_that_can_be_written_down(value):
    for reader in READERS:
        try:
            reader(value)
        except CheckFailed as failed:
            written = json.loads(msgspec.json.encode(failed.finding))
            if not written["message"]:
                pytest.fail("a finding without words")


@pytest.mark.parametrize("value", [math.nan, -math.inf, None, "1", [1.0], True, np.array([1.0]), 1 + 0j])
def test_only_the_expected_number_is_close_to_it(value):
    assert finding_of(kit.expect_close, value, 1.0, rel=0.5, **HOW).message


def test_an_infinite_expectation_is_met_by_infinity_alone():
    kit.expect_close(math.inf, math.inf, rel=0.01, **HOW)
    for value in (1e308, -math.inf, math.nan):
        finding_of(kit.expect_close, value, math.inf, rel=0.01, **HOW)
    finding_of(kit.expect_close, math.inf, 1.0, rel=0.01, **HOW)


def test_a_tolerance_includes_its_edge_and_nothing_beyond():
    kit.expect_close(1.5, 1.0, abs=0.5, **HOW)
    kit.expect_close(3.0, 2.0, rel=0.25, abs=0.5, **HOW)
    finding_of(kit.expect_close, 1.5000001, 1.0, abs=0.5, **HOW)


def test_a_finding_says_what_was_measured_expected_and_allowed():
    given_input = {"h": np.float64(0.1), "q": np.array([1.0, 2.0])}
    finding = finding_of(kit.expect_close, 3, 1.0, rel=0.1, units="m", input=given_input, **HOW)
    assert (finding.actual, finding.expected, finding.units) == (3.0, 1.0, "m")
    assert (finding.tolerance.rel, finding.tolerance.abs, finding.tolerance.source) == (0.1, None, "test")
    assert finding.input == {"h": 0.1, "q": [1.0, 2.0]}
    assert (finding.message, finding.help) == ("It is wrong.", "Mend it.")


@pytest.mark.parametrize(("bad", "code"), [(math.nan, "NOT_A_NUMBER"), (-math.inf, "NOT_FINITE")])
def test_a_number_that_is_not_finite_is_called_so_unless_a_check_knows_better(bad, code):
    for compare, actual, expected in (
        (kit.expect_close, bad, 1.0),
        (kit.expect_array, [bad, 2.0], [1.0, 2.0]),
    ):
        finding = finding_of(compare, actual, expected, abs=0.5, **HOW)
        assert (finding.diagnosis, finding.message[:12]) == (code, "It is wrong.")
        assert finding_of(compare, actual, expected, abs=0.5, diagnose="OURS", **HOW).diagnosis == "OURS"
        nothing = finding_of(compare, actual, expected, abs=0.5, diagnose=lambda: None, **HOW)
        assert nothing.diagnosis == code
    assert finding_of(kit.expect_bounded, bad, low=0.0, high=1.0, **HOW).diagnosis == code


def test_a_trajectory_is_reported_at_the_first_sample_that_is_off():
    t = np.arange(5) * 0.5
    expected = np.zeros((5, 2))
    actual = expected.copy()
    actual[3:, 1] = 1.0
    finding = finding_of(kit.expect_array, actual, expected, abs=0.1, t=t, **HOW)
    assert finding.first_divergence == Divergence(t=1.5, step=3, quantity="x[1]")
    assert finding.actual == {"x[3][1]": 1.0}


def test_an_order_is_the_slope_and_needs_positive_finite_errors():
    hs = [0.1, 0.05, 0.025]
    words = {**WORDS, "source": "test"}
    kit.expect_order(hs, np.array([4.0, 1.0, 0.25]), 2, abs=0.1, **words)
    finding = finding_of(kit.expect_order, hs, np.array([4.0, 2.0, 1.0]), 2, abs=0.1, input={"a": 1}, **words)
    assert finding.actual == pytest.approx(1.0)
    assert finding.input == {
        "a": 1,
        "error at h = 0.1 s": 4.0,
        "error at h = 0.05 s": 2.0,
        "error at h = 0.025 s": 1.0,
    }
    for bad in (0.0, math.nan, math.inf):
        finding_of(kit.expect_order, hs, np.array([4.0, 1.0, bad]), 2, abs=100.0, **words)


def test_a_conserved_quantity_may_not_stray_or_become_nan():
    kit.expect_conserved([2.0, 2.1, 1.9], rel=0.06, **HOW)
    finding = finding_of(kit.expect_conserved, [2.0, 2.5], rel=0.06, **HOW)
    assert finding.actual == pytest.approx(0.25)
    finding_of(kit.expect_conserved, [2.0, math.nan], rel=10.0, **HOW)


def test_a_bounded_number_lies_between_its_bounds():
    kit.expect_bounded(1.0, low=1.0, high=2.0, **HOW)
    for value in (0.99, 2.01, math.nan, None):
        finding_of(kit.expect_bounded, value, low=1.0, high=2.0, **HOW)


def test_equality_asks_for_the_same_type_and_truth_for_true_itself():
    kit.expect_equal(["a", 1], ["a", 1], **WORDS)
    finding_of(kit.expect_equal, 1, True, **WORDS)
    finding_of(kit.expect_equal, 1.0, 1, **WORDS)
    kit.expect_true(np.bool_(True), "It is wrong.")
    finding_of(kit.expect_true, "yes", "It is wrong.")
    finding_of(kit.expect_true, 1, "It is wrong.")


def test_no_finding_is_without_advice_whatever_becomes_of_its_diagnosis():
    for diagnose in (None, "A_CODE", Diagnosis("A_CODE", "It is so.", "")):
        with pytest.raises(CheckFailed) as caught:
            kit.fail("It is wrong.", diagnose=diagnose)
        assert caught.value.finding.help
        assert caught.value.bare[1]


def test_evaluations_outside_the_allowed_numbers_fail():
    kit.expect_evaluations(2, (1, 2), **WORDS)
    assert finding_of(kit.expect_evaluations, 3, (1, 2), **WORDS).expected == [1, 2]


# -- what the student's code raises -------------------------------------------------------------------


def raising(failure):
    def call():
        raise failure

    return call


def test_a_required_exception_may_be_a_subclass_and_nothing_else():
    own = StudentFailure("error", type="StepError", bases=["StepError", "ValueError", "Exception"])
    kit.expect_raises(raising(own), "ValueError", **WORDS)
    assert finding_of(kit.expect_raises, lambda: 3.0, "ValueError", **WORDS).actual == 3.0
    with pytest.raises(StudentFailure):
        kit.expect_raises(raising(StudentFailure("error", type="NotImplementedError")), "ValueError", **WORDS)
    with pytest.raises(StudentFailure):
        kit.expect_raises(raising(StudentFailure("timeout")), "ValueError", **WORDS)


def test_a_refusal_that_is_not_due_is_a_finding_and_other_failures_stay_what_they_are():
    assert kit.expect_accepts(lambda: 7, "ValueError", **WORDS) == 7
    failure = StudentFailure("error", type="ValueError", message="no")
    assert finding_of(kit.expect_accepts, raising(failure), "ValueError", **WORDS).actual == "ValueError: no"
    with pytest.raises(StudentFailure):
        kit.expect_accepts(raising(StudentFailure("error", type="KeyError")), "ValueError", **WORDS)


@pytest.mark.parametrize(
    ("failure", "code"),
    [
        (StudentFailure.missing("rk4_step"), "MISSING_FUNCTION"),
        (StudentFailure("error", type="NotImplementedError"), "NOT_IMPLEMENTED"),
        (StudentFailure("error", type="ZeroDivisionError", message="secret 0.29", line=12), "RAISED"),
        (StudentFailure("timeout"), "TIMEOUT"),
        (StudentFailure("memory"), "OUT_OF_MEMORY"),
        (StudentFailure("crash"), "CRASHED"),
        (StudentFailure("protocol", message="a set"), "NOT_PLAIN_DATA"),
    ],
)
def test_every_failure_of_student_code_has_words_and_advice(failure, code):
    finding = failures.finding_of(failure)
    assert finding.diagnosis == code
    assert finding.message.endswith(".")
    assert finding.help


def test_the_words_of_an_error_hold_nothing_that_the_student_could_smuggle_out():
    finding = failures.finding_of(StudentFailure("error", type="Q0_IS_0_29", message="h = 0.01", line=3))
    assert "0_29" not in finding.message + finding.help
    assert "0.01" not in finding.message + finding.help
    assert "line 3" in finding.message
    known = failures.finding_of(StudentFailure("error", type="ZeroDivisionError", message="division by zero"))
    assert "ZeroDivisionError" in known.message


@pytest.mark.parametrize(
    ("type_", "message", "said"),
    [
        ("EOFError", "EOF when reading a line", "`input()`"),
        ("BdbQuit", "", "`breakpoint()`"),
        ("NameError", "name 'exit' is not defined", "`exit` belongs to Python's prompt"),
        ("NameError", "name 'quit' is not defined", "`quit` belongs to Python's prompt"),
        ("NameError", "name 'exits' is not defined", "read the traceback"),
    ],
)
def test_what_wants_somebody_at_the_keyboard_is_told_that_nobody_is_there(type_, message, said):
    failure = StudentFailure("error", type=type_, message=message, line=3)
    assert said in failures.finding_of(failure).help


@pytest.mark.parametrize("value", [1j, np.complex128(1j), np.array([1j, 2.0]), [1j, 2.0]])
def test_a_complex_result_is_told_where_it_may_come_from(value):
    for read in (kit.as_number, lambda value: kit.as_vector(value, 2)):
        finding = finding_of(read, value)
        assert "fractional power of a negative number" in finding.help
        assert isinstance(value, list) or "complex number" in finding.message


# -- diagnosis ----------------------------------------------------------------------------------------


def test_a_diagnosis_adds_its_sentence_and_its_place_and_replaces_the_advice():
    where = Divergence(t=0.1, step=1, quantity="q[0]")
    diagnosis = Diagnosis("SWAPPED", "Two values are swapped.", "Swap them.", where)
    finding = finding_of(kit.fail, "It is wrong.", help="Mend it.", diagnose=lambda: diagnosis)
    assert finding.message == "It is wrong. Two values are swapped."
    assert (finding.help, finding.diagnosis, finding.first_divergence) == ("Swap them.", "SWAPPED", where)


def test_a_diagnosis_that_student_code_breaks_leaves_the_finding_as_it_was():
    for broken in (raising(StudentFailure("timeout")), raising(CheckFailed(kit.Finding("other")))):
        finding = finding_of(kit.fail, "It is wrong.", help="Mend it.", diagnose=broken)
        assert (finding.message, finding.help, finding.diagnosis) == ("It is wrong.", "Mend it.", None)


def test_a_bug_in_a_diagnosis_leaves_the_finding_and_is_told_to_the_author():
    with pytest.raises(kit.CheckFailed) as failed:
        kit.fail("It is wrong.", diagnose=lambda: 1 / 0)
    assert (failed.value.finding.message, failed.value.finding.diagnosis) == ("It is wrong.", None)
    assert failed.value.broke.startswith("ZeroDivisionError: division by zero (test_kit.py, line")


def test_a_diagnosis_is_not_looked_for_while_all_is_well():
    kit.expect_close(1.0, 1.0, **HOW, diagnose=raising(AssertionError()))


# -- values -------------------------------------------------------------------------------------------


def test_sequences_count_as_arrays_and_tuples():
    q, v = kit.as_pair([[1, 2], np.array([3.0, 4.0])], 2)
    assert q.dtype == v.dtype == np.float64
    kit.as_pair(np.array([[1.0, 2.0], [3.0, 4.0]]), 2)
    assert kit.as_number(np.array(3)) == 3.0
    assert kit.as_integer(4.0) == 4
    assert math.isnan(kit.as_number(math.nan))


@pytest.mark.parametrize(
    "value", [None, 1.0, [[1.0], [2.0], [3.0]], [[1.0, 2.0], [3.0]], ["a", "b"], {"q": 1}]
)
def test_what_is_not_a_pair_of_vectors_is_a_finding(value):
    assert finding_of(kit.as_pair, value, 1).diagnosis in ("RETURNS_NOTHING", "WRONG_TYPE", "WRONG_SHAPE")


def test_a_wrong_shape_is_named_in_the_fields_and_not_in_the_words():
    finding = finding_of(kit.as_vector, np.zeros(29), 30, "t")
    assert finding.diagnosis == "WRONG_SHAPE"
    assert (finding.expected, finding.actual) == ("shape (30,)", "shape (29,)")
    assert "29" not in finding.message + finding.help
    assert "30" not in finding.message + finding.help


def test_a_number_in_place_of_an_array_is_said_to_be_one():
    finding = finding_of(kit.as_vector, 10.0, 2, "position and velocity")
    assert finding.message == "`position and velocity` is a single number."
    assert "[x, v]" in finding.help
    assert finding.diagnosis == "WRONG_SHAPE"


def test_missing_keys_are_named_and_extra_ones_reported():
    finding = finding_of(kit.as_record, {"bias": 1.0, "extra": 2.0}, ("bias", "variance"))
    assert "variance" in finding.message
    assert "extra" not in finding.message
    assert finding.actual == ["bias", "extra"]
    assert finding_of(kit.as_record, {"a": 1, "b": 2}, ("a",)).diagnosis == "WRONG_KEYS"
    assert kit.as_record({"b": 1, "a": 2}, ("a", "b")) == {"b": 1, "a": 2}


def test_a_march_that_went_wrong_says_what_the_step_returned():
    finding = finding_of(as_march, {"bad": "NoneType: cannot unpack", "step": 0}, 3, 1)
    assert finding.diagnosis == "RETURNS_NOTHING"
    finding = finding_of(as_march, {"bad": "shapes (2,) and (2,)", "step": 0}, 3, 1)
    assert (finding.diagnosis, finding.actual) == ("NOT_A_PAIR", "shapes (2,) and (2,)")
    finding_of(as_march, [np.zeros((3, 1)), np.zeros((4, 1))], 3, 1)


def test_long_and_strange_values_are_cut_and_named_before_they_enter_a_finding():
    assert plain(np.zeros(1000)) == "array of shape (1000,)"
    assert plain(list(range(30)))[-1] == "… 6 more"
    assert plain({"f": len}) == {"f": "(builtin_function_or_method)"}
    json.dumps(plain([np.float64(1.0), np.int64(2), np.array([True]), (1, 2)]))


# -- callbacks ----------------------------------------------------------------------------------------


def test_a_counted_callback_remembers_its_calls_as_they_were():
    seen = kit.counted(lambda a, b: b)
    q = np.array([1.0])
    seen(1.0, q)
    q[0] = 9.0
    assert seen.count == 1
    assert seen.calls[0][1][0] == 1.0


def test_an_acceleration_takes_keywords_and_lists():
    accel = kit.acceleration(lambda t, q, v: -q, 2)
    assert accel(0.0, [1, 2], v=[0.0, 0.0]) == pytest.approx([-1.0, -2.0])


@pytest.mark.parametrize(
    "args",
    [(), (1.0,), ([1.0], [2.0]), (0.0, [1.0], [2.0], [3.0]), (None, [1.0], [1.0]), (0.0, [1.0, 2.0], [1.0])],
)
def test_an_acceleration_called_wrongly_becomes_the_finding_even_if_student_code_swallows_it(args):
    accel = kit.acceleration(lambda t, q, v: -q, 1)

    def swallowing():
        try:
            accel(*args)
        except AssertionError:
            return 1.0

    assert finding_of(accel.during, swallowing).diagnosis == "ACCEL_MISUSED"


def test_a_refused_argument_says_more_than_the_error_it_causes():
    accel = kit.acceleration(lambda t, q, v: -q, 1)

    def dying():
        try:
            accel("now", [1.0], [1.0])
        except AssertionError:
            raise StudentFailure("error", type="CallbackError") from None

    assert finding_of(accel.during, dying).diagnosis == "ACCEL_MISUSED"
    calm = kit.acceleration(lambda t, q, v: -q, 1)
    with pytest.raises(StudentFailure):
        calm.during(raising(StudentFailure("error", type="KeyError")))
    assert calm.during(lambda: 5) == 5


def test_untouched_arguments_pass_and_changed_or_shared_ones_are_told_apart():
    q, v = np.array([1.0]), np.array([2.0])
    names = ("", "q", "v")
    given_args = [None, q, v]
    codes = {"mutated": "MUTATED", "shared": "SHARED"}
    kit.expect_untouched(given_args, Inspected(None, [None, q.copy(), v.copy()], False), names=names, **codes)
    changed = Inspected(None, [None, q + 1, v], False)
    assert finding_of(kit.expect_untouched, given_args, changed, names=names, **codes).diagnosis == "MUTATED"
    shared = Inspected(None, [None, q, v], True)
    assert finding_of(kit.expect_untouched, given_args, shared, names=names, **codes).diagnosis == "SHARED"


def test_the_first_divergence_is_the_earliest_of_all_quantities():
    t = [0.0, 0.1, 0.2]
    zero = np.zeros((3, 1))
    late, early = np.array([[0.0], [0.0], [1.0]]), np.array([[0.0], [math.nan], [0.0]])
    found = kit.first_divergence(t, {"q": late, "v": early}, {"q": zero, "v": zero}, 0.5)
    assert found == Divergence(t=0.1, step=1, quantity="v[0]")
    assert kit.first_divergence(t, {"q": zero}, {"q": zero}, 0.0) is None


# -- marching -----------------------------------------------------------------------------------------


def spoiled(spoil):
    """A submission whose path is the true one, but for what ``spoil(h)`` adds to q and v."""

    def march(system, q0, v0, h, n, t0):
        t = t0 + h * np.arange(n + 1)
        q, v = exact.reference(system, q0, v0, t, t0)
        dq, dv = spoil(h)
        return t, q + dq, v + dv

    return SimpleNamespace(march_each=lambda _, marches: [march(*one) for one in marches])


@pytest.mark.parametrize(
    ("spoil", "expected"),
    [
        (lambda h: (h, 0.0), lambda h: h),
        (lambda h: (0.0, 2.0 * h**2), lambda h: h**2),
        (lambda h: (3.0 * h, 2.0 * 4.0 * h), lambda h: 5.0 * h),
    ],
    ids=["position", "velocity", "both"],
)
def test_errors_along_a_march_are_distances_in_position_and_velocity_over_rate(spoil, expected):
    problem = kit.Problem("a spring", systems.Oscillator(2.0), [0.8], [-0.3], rate=2.0, span=1.2, t0=0.4)
    hs, errors = kit.march_errors(spoiled(spoil), "step", problem, [4, 8, 16])
    assert hs == pytest.approx([0.3, 0.15, 0.075])
    assert errors == pytest.approx([expected(h) for h in hs], rel=1e-9)


def test_a_problem_says_in_plain_values_what_reproduces_it():
    problem = kit.Problem("a spring", systems.Oscillator(2.0), [0.8], [-0.3], rate=2.0, span=1.2, t0=0.4)
    assert problem.input == {
        "problem": "a spring",
        "omega": 2.0,
        "q0": [0.8],
        "v0": [-0.3],
        "t0": 0.4,
        "span": 1.2,
    }
    assert problem.run(12) == (problem.system, [0.8], [-0.3], pytest.approx(0.1), 12, 0.4)


# -- modules beside the checks ------------------------------------------------------------------------


@pytest.mark.parametrize("folder", ["exercises/e", "exercises/e/checking"])
def test_a_companion_comes_from_the_course_in_use(tmp_path, monkeypatch, folder):
    for name, value in (("one", 1), ("two", 2)):
        for part in ("exercises/e/checking", "lessons", "quiz"):
            (tmp_path / name / part).mkdir(parents=True)
        (tmp_path / name / folder / "help.py").write_text(f"VALUE = {value}\n", encoding="utf-8")
        monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / name))
        assert value == kit.companion("e", "help").VALUE
    with pytest.raises(FileNotFoundError):
        kit.companion("e", "absent")


def test_a_sibling_is_loaded_once_from_beside_the_file_that_asks(tmp_path):
    (tmp_path / "bundles.py").write_text("VALUE = []\n", encoding="utf-8")
    asking = str(Path(tmp_path) / "checks.py")
    assert kit.sibling(asking, "bundles") is kit.sibling(asking, "bundles")
