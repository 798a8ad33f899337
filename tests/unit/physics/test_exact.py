"""The reference that every order is measured against is itself compared with closed forms."""

import math

import numpy as np
import pytest

from course.physics import exact, systems

TIMES = [0.6, 1.1, 2.9, 5.0]
Q0, V0 = [0.8, -0.3], [-0.4, 1.1]


def test_the_reference_brings_an_eccentric_orbit_back_after_one_period():
    e = 0.6
    q0, v0 = [1 - e, 0.0], [0.0, math.sqrt((1 + e) / (1 - e))]
    q, v = exact.reference(systems.Kepler(1.0), q0, v0, [2 * math.pi])
    assert q[0] == pytest.approx(q0, abs=1e-10)
    assert v[0] == pytest.approx(v0, abs=1e-10)


@pytest.mark.parametrize(
    "system",
    [
        systems.Oscillator(2.3),
        systems.DampedOscillator(2.3, 0.7),
        systems.DampedOscillator(0.3, 0.7),
        systems.ForcedOscillator(2.3, 1.5, 3.1),
        systems.ForcedOscillator(2.3, 1.5, 2.3),
        systems.Pendulum(9.81, 1.2),
    ],
    ids=repr,
)
def test_the_solution_is_the_reference_with_and_without_a_closed_form(system):
    for found, expected in zip(
        exact.solution(system, Q0, V0, TIMES, 0.2), exact.reference(system, Q0, V0, TIMES, 0.2), strict=True
    ):
        assert found.shape == (4, 2)
        assert found == pytest.approx(expected, abs=1e-10)


def test_times_that_run_backwards_are_refused():
    with pytest.raises(ValueError, match="rise"):
        exact.reference(systems.Oscillator(1.0), [1.0], [0.0], [1.0, 0.5])


def test_a_solution_that_blows_up_is_refused_instead_of_returned():
    class Explosion:
        def __call__(self, t, q, v):
            return np.exp(np.minimum(q, 300.0))

        def params(self):
            return {}

    with np.errstate(all="ignore"), pytest.raises(ValueError, match="converge"):
        exact.reference(Explosion(), [1.0], [5.0], [3.0])


def test_closed_forms_refuse_parameters_they_do_not_cover():
    with pytest.raises(ValueError, match="omega"):
        exact.damped_oscillator(systems.DampedOscillator(1.0, 2.0), Q0, V0, 1.0)
    with pytest.raises(ValueError, match="resonance"):
        exact.forced_oscillator(systems.ForcedOscillator(2.0, 1.0, 2.0), Q0, V0, 1.0)
