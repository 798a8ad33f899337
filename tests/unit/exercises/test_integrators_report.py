"""``course report integrators`` measures the student's steps, whatever they do, against closed forms."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

from course.figures.plots import render
from course.scoring import kit

report = kit.companion("integrators", "report")
formulas = kit.reference("integrators", "formulas")
HERE = Path(report.__file__)


class Steps:
    """A submission of some steps; those that are missing raise what the sandbox raises."""

    def __init__(self, **steps):
        self._steps = steps

    def march_each(self, name, marches):
        if name not in self._steps:
            raise kit.StudentFailure("error", type="NotImplementedError", message="")
        return [self._march(self._steps[name], *march) for march in marches]

    def _march(self, step, system, q0, v0, h, n, t0):
        q, v = [np.array(q0, float)], [np.array(v0, float)]
        with np.errstate(all="ignore"):
            for i in range(n):
                q_next, v_next = step(system, t0 + i * h, q[-1], v[-1], h)
                q.append(q_next)
                v.append(v_next)
        return t0 + h * np.arange(n + 1), np.array(q), np.array(v)


RIGHT = {task: formulas.RIGHT[task][0] for task in report.STEPS}


@pytest.fixture(scope="module")
def right():
    return report.report(Steps(**RIGHT)).sections


def test_right_steps_show_their_orders_and_their_limits(right):
    _, energy, order, stability = right
    slopes = [float(row[1]) for row in order.rows]
    assert slopes == pytest.approx([1, 1, 2, 4], abs=0.1)
    # Closed forms: none, 2, 2 and 2 sqrt(2); the steps tried are 0.02 apart.
    limits = [row[1] for row in stability.rows]
    assert limits[0] == "the smallest tried"
    assert [float(limit) for limit in limits[1:]] == pytest.approx([2, 2, 2 * 2**0.5], abs=0.02)
    # From rest Verlet's energy swings by z^2/4, semi-implicit Euler's by z/(2 - z), at z = 0.5.
    ends = {row[0]: float(row[-1]) for row in energy.rows}
    assert ends["velocity Verlet"] == pytest.approx(0.0625, rel=0.01)
    assert ends["semi-implicit Euler"] == pytest.approx(1 / 3, rel=0.01)


def test_it_is_the_student_s_own_step_that_is_measured(right):
    swapped = RIGHT | {"rk4_step": RIGHT["velocity_verlet_step"]}
    order = report.report(Steps(**swapped)).sections[2]
    assert float(order.rows[3][1]) == pytest.approx(2, abs=0.1)
    assert float(right[2].rows[3][1]) == pytest.approx(4, abs=0.1)


def test_what_is_missing_is_named_and_the_rest_is_shown():
    for section in report.report(Steps(rk4_step=RIGHT["rk4_step"])).sections:
        assert [row[0] for row in section.rows] == ["Runge-Kutta 4"]
        assert section.text.count("\n- ") == 3
        assert "velocity Verlet: " in section.text
    assert all(section.plot is None for section in report.report(Steps()).sections)


@pytest.mark.parametrize(
    "step",
    [
        lambda accel, t, q, v, h: (q, v),
        lambda accel, t, q, v, h: (q * np.nan, v),
        lambda accel, t, q, v, h: (q * 1e200, v),
        lambda accel, t, q, v, h: (0 * q, 0 * v),
    ],
    ids=["still", "nan", "explodes", "vanishes"],
)
def test_any_step_can_be_drawn(step):
    for section in report.report(Steps(explicit_euler_step=step)).sections:
        assert section.rows
        assert render(section.plot).startswith(b"\x89PNG")


def test_it_knows_none_of_the_four_steps():
    """What is compared with comes from closed forms: a student who reads the report finds no solution."""
    imported = [
        f"{node.module}.{name.name}"
        for node in ast.walk(ast.parse(HERE.read_text()))
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    ]
    assert sorted(name for name in imported if name.startswith("course.")) == [
        "course.physics.exact",
        "course.physics.invariants",
        "course.physics.systems",
        "course.scoring.kit",
    ]
