"""Calls that tell wrong programs of ``integrators`` apart; a task with a failed check is asked them besides.

The same at home and in a grading run. What they should give is not here.
"""

from __future__ import annotations

import numpy as np

from course.physics.systems import DrivenPendulum, FreeFall, LinearStep, Oscillator

_T, _H = 0.6, 0.31
_Q, _V = np.array([0.7, -0.4]), np.array([0.3, 1.1])
_DAMPED, _DRIVEN = DrivenPendulum(3.1, 0.7, 1.9, 2.3), DrivenPendulum(3.1, 0.0, 1.9, 2.3)
_FALL = FreeFall(7.0), 0.4, np.array([0.2, -0.5, 1.3]), np.array([0.7, 0.1, -0.9]), 0.37

#: A turn that shrinks, with a clock: where it leads depends on every argument of a step.
_TURN = LinearStep([0.9], [0.35, 0.04], [-0.4], [0.85, -0.03], clock=0.3)


def _loops():
    """Durations: exact ones, quotients just beside a whole number, sums of h that fall short, none."""
    starts = np.array([1.0, -0.5]), np.array([0.5, 2.0])
    for t_end, h in (
        (2.0, 0.25),
        (0.29, 0.01),
        (0.8, 0.1),
        (1.1, 0.1),
        (0.063, 0.009),
        (0.6, 0.1),
        (0.0, 0.1),
    ):
        yield (_TURN, Oscillator(1.7), *starts, t_end, h)
    yield (_TURN, Oscillator(1.7), np.array([2, -1]), np.array([1, 3]), 1.0, 0.25)
    yield (_TURN, Oscillator(1.7), *starts, 1.1, 0.2)
    yield (_TURN, Oscillator(1.7), *starts, 1.0002, 0.2)


def _points():
    hs = np.array([0.2, 0.11, 0.05, 0.027, 0.012])
    scattered = 3.0 * hs**2.3 * np.array([1.2, 0.8, 1.1, 0.9, 1.3])
    yield hs, scattered
    yield hs[[2, 0, 4, 1, 3]], scattered[[2, 0, 4, 1, 3]]
    yield hs[::-1], scattered[::-1]
    yield np.array([0.3, 0.04]), np.array([0.5, 0.002])
    yield np.array([0.3, 0.21, 0.14, 0.1]), np.array([0.2, 0.5, 0.07, 0.11])  # not all grow with the step
    yield 0.5 * 0.3 ** np.arange(7), np.array([2e-3, 9e-6, 3e-8, 5e-9, 2e-11, 6e-13, 3e-15])


def _maps():
    """Maps with a limit at h omega = 2, at 1.5 by -1, spiralling out, with a pocket, with none, and of slow
    growth."""
    verlet = LinearStep([1, 0, -0.5], [0, 1], [0, -1, 0, 0.25], [1, 0, -0.5])
    flipped = LinearStep([0.6, 0, -1.6 / 1.5**2], [2.0], [0.0], [0.3])
    spiral = LinearStep([0.3, 0, 0.02], [0.75, 0, 0.05], [-0.75, 0, -0.05], [0.3, 0, 0.02])
    growth = [1 - 0.5 * 1.2 * 2.0, 0.5 * (1.2 + 2.0), -0.5]  # above one between 1.2 and 2
    pocket = LinearStep(growth, [0.0], [0.0], [0.2])
    small = LinearStep([0.1], [0.0], [0.3], [0.7, 0.3 / 2.7])
    euler = LinearStep([1.0], [0.0, 1.0], [0.0, -1.0], [1.0])
    calm = LinearStep([0.5, 0.02], [0.1], [0.0], [0.4])
    slow = LinearStep([1 - 1e-5, 1e-5 / 2.4], [0.0], [0.0], [0.2])
    yield from ((verlet, 3.7), (flipped, 4.0), (spiral, 0.6), (pocket, 1.7), (small, 2.3))
    yield from ((euler, 2.9), (calm, 1.3), (verlet, 50.0), (slow, 1.1), (small, 0.2))


QUESTIONS = {
    "explicit_euler_step": [(_DAMPED, _T, _Q, _V, _H), _FALL],
    "semi_implicit_euler_step": [(_DAMPED, _T, _Q, _V, _H), _FALL],
    "velocity_verlet_step": [(_DRIVEN, _T, _Q, _V, _H), _FALL],
    "rk4_step": [(_DAMPED, _T, _Q, _V, _H), _FALL],
    "integrate": list(_loops()),
    "observed_order": list(_points()),
    "max_stable_step": list(_maps()),
}

#: Tasks whose right answers differ by more than rounding: the README's 1 % for each of two answers.
WITHIN = {"max_stable_step": 0.02}

#: So many programs with two mistakes are known for a task: here all of them.
PAIRS = 1000
