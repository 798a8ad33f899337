"""Invariants, and the instruments that measure methods."""

import math

import numpy as np
import pytest

from course.physics import exact, systems
from course.physics.invariants import (
    angular_momentum,
    convergence_order,
    energy,
    jacobian,
    relative_change,
    spectral_radius,
    symplecticity_defect,
)


@pytest.mark.parametrize(
    ("system", "q0", "v0"),
    [
        (systems.FreeFall(9.81), [0.0, 10.0], [3.0, 1.0]),
        (systems.Oscillator(2.0), [1.0, 0.2], [0.0, -1.0]),
        (systems.Pendulum(9.81, 1.3), [1.2], [0.5]),
        (systems.Kepler(1.0), [0.8, 0.1], [0.2, 1.1]),
    ],
    ids=lambda value: type(value).__name__,
)
def test_the_energy_of_the_true_motion_is_constant(system, q0, v0):
    q, v = exact.reference(system, q0, v0, np.linspace(0.0, 3.0, 7))
    assert energy(system, q, v) == pytest.approx(float(energy(system, q0, v0)), rel=1e-11)


def test_a_driven_or_damped_system_has_no_energy_to_conserve():
    with pytest.raises(TypeError, match="DampedOscillator"):
        energy(systems.DampedOscillator(1.0, 0.1), [1.0], [0.0])


def test_the_angular_momentum_of_an_orbit_is_constant():
    q, v = exact.reference(systems.Kepler(1.3), [0.8, 0.1], [0.2, 1.1], np.linspace(0.0, 3.0, 7))
    assert angular_momentum(q, v) == pytest.approx(0.8 * 1.1 - 0.1 * 0.2, rel=1e-11)


def test_relative_change_is_signed_and_starts_at_zero():
    assert relative_change([-2.0, -1.0, -3.0]) == pytest.approx([0.0, 0.5, -0.5])


def test_the_order_of_scattered_points_is_the_least_squares_slope():
    hs, errors = [0.1, 0.05, 0.025, 0.01], [0.9, 0.3, 0.2, 0.04]
    assert convergence_order(hs, errors) == pytest.approx(np.polyfit(np.log(hs), np.log(errors), 1)[0])


@pytest.mark.parametrize(("hs", "errors"), [([0.1], [1.0]), ([0.1, 0.2], [1.0]), ([0.1, 0.2], [1.0, 0.0])])
def test_points_that_have_no_slope_are_refused(hs, errors):
    with pytest.raises(ValueError):
        convergence_order(hs, errors)


def test_the_jacobian_of_a_smooth_map_is_found_to_ten_digits():
    found = jacobian(lambda y: np.array([math.sin(y[0]) * y[1], y[0] ** 3]), [0.7, 2.0])
    assert found == pytest.approx(np.array([[2 * math.cos(0.7), math.sin(0.7)], [3 * 0.49, 0.0]]), abs=1e-9)


def test_preserving_volume_is_not_enough_to_be_symplectic_in_two_degrees_of_freedom():
    stretch = np.diag([2.0, 0.5, 1.0, 1.0])  # determinant one, yet q1 and its own velocity do not match
    assert np.linalg.det(stretch) == pytest.approx(1.0)
    assert symplecticity_defect(stretch) == pytest.approx(1.0)
    assert symplecticity_defect(np.diag([2.0, 3.0, 0.5, 1 / 3.0])) == pytest.approx(0.0, abs=1e-15)


def test_the_spectral_radius_takes_the_modulus_of_negative_and_complex_eigenvalues():
    assert spectral_radius([[0.2, 5.0], [0.0, -1.4]]) == pytest.approx(1.4)
    assert spectral_radius([[0.0, 2.0], [-2.0, 0.0]]) == pytest.approx(2.0)
