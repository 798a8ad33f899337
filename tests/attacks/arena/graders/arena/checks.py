"""Hidden checks of the arena. FILE-CANARY-7f3a must never leave this folder, INPUT-CANARY-52a9 never reach a student."""

import numpy as np
import pytest
from course.scoring import kit
from course.physics import systems

SECRET = 7919.104729


@pytest.mark.task("scale")
@pytest.mark.points(3)
def test_scale_hidden(submission):
    """Other numbers are multiplied too"""
    kit.expect_array(
        submission.call("scale", np.array([1.0, 2.0]), SECRET),
        [SECRET, 2 * SECRET],
        source="exact",
        quantity="product",
        input={"values": [1.0, 2.0], "factor": SECRET, "note": "INPUT-CANARY-52a9"},
        message="The numbers are not multiplied.",
        help="Multiply each.",
    )


@pytest.mark.task("scale")
@pytest.mark.points(1)
def test_scale_untouched(submission):
    """The argument is left alone and the result is a new array"""
    found = submission.call_inspect("scale", np.array([1.0, 2.0]), 2.0)
    kit.expect_true(not found.shared, "The result shares memory with the argument.")
    kit.expect_array(
        found.args_after[0],
        [1.0, 2.0],
        source="exact",
        quantity="argument",
        message="The argument was changed.",
        help="Copy first.",
    )


@pytest.mark.task("advance")
@pytest.mark.points(2)
def test_advance_march(submission):
    """A hundred steps of free fall end where a stone does"""
    _, _, v = submission.march("advance", systems.FreeFall(SECRET), [0.0], [0.0], 0.01, 100)
    kit.expect_close(
        v[-1, 0], -SECRET, rel=1e-9, source="exact", quantity="speed", message="The speed is wrong.", help="Add."
    )


@pytest.mark.task("sample")
@pytest.mark.points(2)
def test_sample_counts(submission):
    """The function is evaluated once per point"""
    square = kit.counted(lambda x: kit.as_number(x, "x") ** 2 + SECRET)
    points = [1.0, 2.0, 3.5]
    values = square.during(lambda: submission.call("sample", square, points))
    kit.expect_evaluations(square.count, [3], message="It is not evaluated once per point.")
    kit.expect_array(
        values,
        [x**2 + SECRET for x in points],
        source="exact",
        quantity="values",
        message="The values are wrong.",
        help="Keep them in order.",
    )


@pytest.mark.task("compose")
@pytest.mark.points(2)
def test_compose_callbacks(submission):
    """Functions of both sides can be composed"""
    plus = kit.counted(lambda x: kit.as_number(x, "x") + SECRET)
    double = submission.call("compose", plus, plus, 1.0)
    kit.expect_close(
        double, 1 + 2 * SECRET, rel=1e-12, source="exact", quantity="value", message="The value is wrong.", help=""
    )
    values = kit.as_vector(submission.call("compose", submission.ref("double"), plus, 2.0), None, "the value")
    kit.expect_array(
        values, [4 + 2 * SECRET], rel=1e-12, source="exact", quantity="value", message="The value is wrong.", help=""
    )


@pytest.mark.task("draw")
@pytest.mark.points(1)
def test_draw_seeded(submission, rng):
    """Numbers come from the generator that was given"""
    seed = int(rng.integers(1000))
    values = submission.call("draw", np.random.default_rng(seed), 3)
    same = submission.call("draw", np.random.default_rng(seed), 3)
    drawn = np.random.default_rng(int(np.random.default_rng(seed).integers(2**62))).random(3)
    for found in (values, same):
        kit.expect_array(
            found, drawn, source="exact", quantity="numbers", message="They are other numbers.", help="Use rng."
        )
