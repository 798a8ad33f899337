"""What the figures of the integrators show is what their titles and the lesson say."""

from __future__ import annotations

import math

import numpy as np
import pytest

from course.figures import integrators
from course.figures.style import METHODS
from course.physics.invariants import convergence_order


@pytest.mark.parametrize(
    ("method", "limit"),
    [("semi_implicit_euler", 2.0), ("velocity_verlet", 2.0), ("rk4", 2.0 * math.sqrt(2.0))],
)
def test_growth_passes_one_at_the_stability_limit(method: str, limit: float) -> None:
    # The maps have a double eigenvalue at the limit, where round-off shows as its square root.
    assert integrators._growth(method, limit - 0.01) <= 1.0 + 1e-7
    assert integrators._growth(method, limit + 0.01) > 1.0 + 1e-3


def test_explicit_euler_grows_at_every_step() -> None:
    assert integrators._growth("explicit_euler", 0.01) > 1.0 + 1e-5


@pytest.mark.parametrize(
    ("method", "order"),
    [("explicit_euler", 1), ("semi_implicit_euler", 1), ("velocity_verlet", 2), ("rk4", 4)],
)
def test_errors_drawn_have_the_slopes_written_beside_them(method: str, order: int) -> None:
    hs, errors = integrators._errors_at_end(method, np.array([640, 1280, 2560]), 5.0)
    assert convergence_order(hs, errors) == pytest.approx(order, abs=0.05)


def test_every_curve_of_the_energy_figure_rises_and_runge_kutta_crosses_verlet_where_marked() -> None:
    (axes,) = integrators.energy_error().axes
    curves = {line.get_color(): line for line in axes.lines if len(line.get_xdata()) > 1}
    assert all(np.all(np.diff(line.get_ydata()) >= 0) for line in curves.values())
    verlet = np.asarray(curves[METHODS["velocity_verlet"].color].get_ydata())
    rk4 = np.asarray(curves[METHODS["rk4"].color].get_ydata())
    crossing = int(np.argmax(rk4 > verlet)) + 1
    # 18/z^4 is the leading term; at z = 0.5 the next ones are worth a few per cent.
    assert crossing == pytest.approx(18.0 / integrators.ENERGY_Z**4, rel=0.1)
