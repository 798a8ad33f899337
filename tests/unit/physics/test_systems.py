"""Right-hand sides: what they answer, and that they survive being sent as a name and numbers."""

import ast
import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.physics import systems

EXAMPLES = [
    systems.FreeFall(9.81),
    systems.Oscillator(2.0),
    systems.DampedOscillator(2.0, 0.3),
    systems.ForcedOscillator(2.0, 1.5, 3.0),
    systems.Pendulum(9.81, 0.7),
    systems.DrivenPendulum(3.0, 0.4, 1.2, 2.0),
    systems.VanDerPol(0.8, 1.3),
    systems.Kepler(1.7),
]
VERLET_MAP = systems.LinearStep([1, 0, -0.5], [0, 1], [0, -1, 0, 0.25], [1, 0, -0.5])
STATISTIC = systems.AveragePolynomial([0.5, 0.0, 2.0])
Q, V = np.array([0.6, -1.1]), np.array([0.4, 0.9])


def name_of(system):
    return type(system).__name__


@pytest.mark.parametrize("system", [*EXAMPLES, VERLET_MAP, STATISTIC], ids=name_of)
def test_a_system_is_rebuilt_from_its_name_and_plain_parameters(system):
    params = json.loads(json.dumps(system.params()))
    assert systems.SYSTEMS[name_of(system)](**params) == system


def test_every_system_is_registered_under_its_own_name_and_has_an_example_here():
    assert {name_of(system) for system in [*EXAMPLES, VERLET_MAP, STATISTIC]} == set(systems.SYSTEMS)


@pytest.mark.parametrize("system", EXAMPLES, ids=name_of)
def test_an_acceleration_is_a_fresh_float_array_shaped_like_q(system):
    first, second = system(0.7, Q, V), system(0.7, Q, V)
    assert first.shape == Q.shape
    assert first.dtype == np.float64
    assert not np.shares_memory(first, second)
    assert not np.may_share_memory(first, Q)
    assert np.array_equal(Q, [0.6, -1.1])


@pytest.mark.parametrize("system", EXAMPLES, ids=name_of)
def test_lists_and_whole_numbers_give_the_acceleration_that_float_arrays_give(system):
    assert np.array_equal(
        system(1, [2, -1], [0, 3]), system(1.0, np.array([2.0, -1.0]), np.array([0.0, 3.0]))
    )


@pytest.mark.parametrize("system", EXAMPLES, ids=name_of)
def test_a_system_cannot_be_changed(system):
    with pytest.raises(AttributeError):
        setattr(system, next(iter(system.params())), 1.0)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_parameters_that_are_not_finite_are_refused(bad):
    with pytest.raises(ValueError, match="omega"):
        systems.Oscillator(bad)
    with pytest.raises(ValueError, match="qp"):
        systems.LinearStep([1.0], [bad], [0.0], [1.0])


def test_accelerations_are_those_of_the_formulae():
    t = 0.7
    assert np.allclose(systems.FreeFall(9.81)(t, np.zeros(3), np.zeros(3)), [0, 0, -9.81])
    assert np.allclose(systems.Oscillator(2.0)(t, Q, V), -4 * Q)
    assert np.allclose(systems.DampedOscillator(2.0, 0.3)(t, Q, V), -4 * Q - 0.3 * V)
    assert np.allclose(systems.ForcedOscillator(2.0, 1.5, 3.0)(t, Q, V), -4 * Q + 1.5 * math.cos(2.1))
    assert np.allclose(systems.Pendulum(9.81, 0.7)(t, Q, V), -9.81 / 0.7 * np.sin(Q))
    driven = systems.DrivenPendulum(3.0, 0.4, 1.2, 2.0)
    assert np.allclose(driven(t, Q, V), -3 * np.sin(Q) - 0.4 * V + 1.2 * math.cos(1.4))
    assert np.allclose(systems.VanDerPol(0.8, 1.3)(t, Q, V), 0.8 * (1 - Q**2) * V - 1.69 * Q)
    assert np.allclose(systems.Kepler(1.7)(t, Q, V), -1.7 * Q / np.linalg.norm(Q) ** 3)


coefficients = st.lists(st.floats(-2, 2), min_size=1, max_size=4)


@given(
    coefficients,
    coefficients,
    coefficients,
    coefficients,
    st.floats(0.1, 5),
    st.floats(0.01, 3),
    st.floats(-3, 3),
)
def test_a_linear_step_does_to_q_and_v_over_omega_what_its_matrix_says(qq, qp, pq, pp, omega, z, t):
    step = systems.LinearStep(qq, qp, pq, pp)
    q, v = step(systems.Oscillator(omega), t, Q, omega * V, z / omega)
    expected = step.matrix(z) @ np.stack([Q, V])
    assert np.allclose(q, expected[0], rtol=1e-9, atol=1e-9)
    assert np.allclose(v / omega, expected[1], rtol=1e-9, atol=1e-9)


def test_the_matrices_of_many_z_come_at_once():
    z = np.array([0.3, 1.7])
    assert np.allclose(VERLET_MAP.matrix(z), [VERLET_MAP.matrix(0.3), VERLET_MAP.matrix(1.7)])


def test_the_clock_term_shows_which_time_a_step_was_given():
    step = systems.LinearStep([1.0], [0.0], [0.0], [1.0], clock=2.0)
    q, v = step(systems.Oscillator(1.0), 3.0, np.array([5.0]), np.array([7.0]), 0.1)
    assert q == pytest.approx([5.0 + 2.0 * 0.1 * 3.0])
    assert v == pytest.approx([7.0])


def test_a_linear_step_refuses_an_acceleration_that_does_not_pull_back():
    with pytest.raises(ValueError, match="does not pull back"):
        VERLET_MAP(lambda t, q, v: 4.0 * q, 0.0, Q, V, 0.1)


def test_the_file_that_goes_beside_student_code_imports_only_the_standard_library_and_numpy():
    tree = ast.parse(Path(systems.__file__).read_text(encoding="utf-8"))
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            names.add((node.module or "").split(".")[0])
    assert names <= set(sys.stdlib_module_names) | {"numpy"}


def test_a_statistic_is_the_average_of_its_polynomial():
    assert STATISTIC(np.array([1.0, -2.0, 3.0])) == pytest.approx(0.5 + 2.0 * 14 / 3)
    assert systems.AveragePolynomial([1.5])([4, 5]) == 1.5


@pytest.mark.parametrize("samples", [[], [[1.0, 2.0]], 3.0], ids=["none", "two-dimensional", "a number"])
def test_a_statistic_refuses_what_are_no_samples(samples):
    with pytest.raises(ValueError, match="shape"):
        STATISTIC(samples)


@pytest.mark.parametrize(("q", "v"), [(1.0, np.zeros(1)), (np.zeros(1), 1.0)])
def test_a_step_refuses_single_numbers(q, v):
    with pytest.raises(TypeError, match="takes arrays"):
        VERLET_MAP(lambda t, q, v: -q, 0.0, q, v, 0.1)
