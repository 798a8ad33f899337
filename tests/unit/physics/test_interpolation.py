"""Between two samples: cubics are exact, and roots are found where the curve comes down."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.physics.integrators import falling_root, first_crossing, hermite

numbers = st.floats(-10, 10)


@given(numbers, numbers, numbers, numbers, st.floats(0, 1))
def test_a_cubic_is_interpolated_exactly(a: float, b: float, c: float, d: float, s: float) -> None:
    def value(x: float) -> float:
        return a + x * (b + x * (c + x * d))

    slopes = b, b + 2 * c + 3 * d
    ends = np.float64(value(0.0)), np.float64(value(1.0))
    assert hermite(s, *ends, *map(np.float64, slopes)) == pytest.approx(value(s), abs=1e-12)


@given(st.floats(0.01, 10), st.floats(-10, 10), st.floats(0.1, 50))
def test_a_fall_lands_when_the_closed_form_says(height: float, rate: float, g: float) -> None:
    due = (rate + math.sqrt(rate**2 + 2 * g * height)) / g
    span = 1.3 * due
    end, end_rate = height + rate * span - g * span**2 / 2, rate - g * span
    share = falling_root(*map(np.float64, (height, end, rate * span, end_rate * span)))
    assert share * span == pytest.approx(due, rel=1e-9)


def test_a_curve_that_does_not_end_below_zero_has_no_root() -> None:
    assert falling_root(*map(np.float64, (1.0, 0.5, -1.0, -1.0))) == np.inf


def test_starting_at_zero_and_rising_finds_the_way_down_and_falling_finds_the_start() -> None:
    # 2 s - 4 s² from 0: comes down at 1/2.
    assert falling_root(*map(np.float64, (0.0, -2.0, 2.0, -6.0))) == pytest.approx(0.5)
    assert falling_root(*map(np.float64, (-1e-12, -2.0, -2.0, -2.0))) == 0.0


def test_the_first_of_several_crossings_is_found_far_between_samples() -> None:
    t = np.linspace(0.0, 10.0, 101)
    assert first_crossing(t, np.cos(t), -np.sin(t)) == pytest.approx(math.pi / 2, abs=1e-7)
    assert math.isnan(first_crossing(t, np.ones_like(t), np.zeros_like(t)))
