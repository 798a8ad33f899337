"""One-step formulas, right and wrong, that the checks of ``integrators`` compare a submission with.

Each is called as the exercise's steps are: ``step(accel, t, q, v, h) -> (q_next, v_next)``.
"""

from __future__ import annotations

import numpy as np

from course.physics.integrators import RK4, ExplicitEuler, SemiImplicitEuler, State, VelocityVerlet


def _textbook(stepper):
    def step(accel, t, q, v, h):
        end = stepper.advance(accel, State(t, q, v), h)
        return end.q, end.v

    return step


_EULER = _textbook(ExplicitEuler())
_KICK_DRIFT = _textbook(SemiImplicitEuler())
_DRIFT_KICK = _textbook(SemiImplicitEuler(position_first=True))
_KDK = _textbook(VelocityVerlet())
_DKD = _textbook(VelocityVerlet(drift_first=True))
_RK4 = _textbook(RK4())


def _at(step, shift):
    """The same step with every acceleration taken at time t + shift * h."""
    return lambda accel, t, q, v, h: step(lambda _t, q, v: accel(t + shift * h, q, v), t, q, v, h)


def _verlet(drift, kick_old, kick_new):
    """q + h v + drift h² a_old and v + h (kick_old a_old + kick_new a_new)."""

    def step(accel, t, q, v, h):
        a_old = accel(t, q, v)
        q_next = q + h * v + drift * h * h * a_old
        return q_next, v + h * (kick_old * a_old + kick_new * accel(t + h, q_next, v))

    return step


def _runge_kutta(
    weights=(1 / 6, 1 / 3, 1 / 3, 1 / 6), reach=(0, 0.5, 0.5, 1), times=None, source=(0, 0, 1, 2), view=None
):
    """The family around RK4: stage i is ``reach[i] * h`` along slope ``source[i]``, at ``times[i]``.

    ``view(q, v, q_i, v_i)`` is what accel and dq see of stage i: position, velocity, slope of q.
    """
    times = reach if times is None else times
    view = view or (lambda _q, _v, q_i, v_i: (q_i, v_i, v_i))

    def step(accel, t, q, v, h):
        slopes = [(np.zeros_like(q), np.zeros_like(v))]
        for i in range(4):
            dq, dv = slopes[source[i] + 1] if i else slopes[0]
            q_i, v_i, slope = view(q, v, q + reach[i] * h * dq, v + reach[i] * h * dv)
            slopes.append((slope, accel(t + times[i] * h, q_i, v_i)))
        sums = [sum(w * k[part] for w, k in zip(weights, slopes[1:], strict=True)) for part in (0, 1)]
        return q + h * sums[0], v + h * sums[1]

    return step


def _averaged(accel, t, q, v, h):
    v_next = v + h * accel(t, q, v)
    return q + h * (v + v_next) / 2, v_next


#: Per task: the right formulas, then wrong ones by their code.
RIGHT = {
    "explicit_euler_step": [_EULER],
    "semi_implicit_euler_step": [_KICK_DRIFT, _DRIFT_KICK],
    "velocity_verlet_step": [_KDK, _DKD],
    "rk4_step": [_RK4],
}
WRONG = {
    "explicit_euler_step": [
        ("EULER_IS_SEMI_IMPLICIT", _KICK_DRIFT),
        ("EULER_IS_SEMI_IMPLICIT", _DRIFT_KICK),
        ("EULER_IS_SEMI_IMPLICIT", _at(_DRIFT_KICK, 0)),
        ("STAGE_TIMES_AHEAD", _at(_EULER, 1)),
    ],
    "semi_implicit_euler_step": [
        ("SEMI_IMPLICIT_IS_EULER", _EULER),
        ("STAGE_TIMES_FROZEN", _at(_DRIFT_KICK, 0)),
        ("STAGE_TIMES_AHEAD", _at(_KICK_DRIFT, 1)),
        ("AVERAGED_VELOCITY", _averaged),
    ],
    "velocity_verlet_step": [
        ("VERLET_IS_EULER", _EULER),
        ("VERLET_IS_SEMI_IMPLICIT", _KICK_DRIFT),
        ("VERLET_IS_SEMI_IMPLICIT", _DRIFT_KICK),
        ("USES_OLD_ACCELERATION", _verlet(0.5, 1, 0)),
        ("USES_NEW_ACCELERATION", _verlet(0.5, 0, 1)),
        ("HALF_MISSING", _verlet(1, 0.5, 0.5)),
        ("QUADRATIC_TERM_MISSING", _verlet(0, 0.5, 0.5)),
        ("KICKS_TOO_LARGE", _verlet(0.5, 1, 1)),
        ("KICKS_TOO_LARGE", _verlet(1, 1, 1)),
        ("SECOND_KICK_MISSING", _verlet(0.5, 0.5, 0)),
        ("POSITION_TERM_SUBTRACTED", _verlet(-0.5, 0.5, 0.5)),
        ("KICK_SUBTRACTED", _verlet(0.5, -0.5, -0.5)),
        ("KICK_SUBTRACTED", _verlet(0.5, 0.5, -0.5)),
        ("KICK_SUBTRACTED", _verlet(0.5, -0.5, 0.5)),
        ("KICK_SUBTRACTED", _verlet(-0.5, -0.5, 0.5)),
        ("STAGE_TIMES_FROZEN", _at(_KDK, 0)),
        ("STAGE_TIMES_FROZEN", _at(_DKD, 0)),
    ],
    "rk4_step": [
        ("RK4_IS_EULER", _EULER),
        ("RK4_IS_MIDPOINT", _runge_kutta(weights=(0, 1, 0, 0))),
        ("RK4_IS_HEUN", _runge_kutta(weights=(0.5, 0, 0, 0.5), reach=(0, 0, 0, 1), source=(0, 0, 0, 0))),
        ("RK4_IS_VERLET", _KDK),
        ("EQUAL_WEIGHTS", _runge_kutta(weights=(0.25,) * 4)),
        ("WEIGHTS_MISPLACED", _runge_kutta(weights=(1 / 3, 1 / 6, 1 / 6, 1 / 3))),
        ("WEIGHTS_DO_NOT_ADD_UP", _runge_kutta(weights=(1, 2, 2, 1))),
        ("WEIGHTS_DO_NOT_ADD_UP", _runge_kutta(weights=(1 / 6,) * 4)),
        ("WEIGHTS_DO_NOT_ADD_UP", _runge_kutta(weights=(0.25, 0.5, 0.5, 0.25))),
        ("STAGE_TIMES_FROZEN", _runge_kutta(times=(0, 0, 0, 0))),
        ("HALF_STEP_MISSING", _runge_kutta(reach=(0, 1, 1, 1))),
        ("HALF_STEP_MISSING", _runge_kutta(reach=(0, 1, 1, 1), times=(0, 0.5, 0.5, 1))),
        ("LAST_STAGE_AT_HALF", _runge_kutta(reach=(0, 0.5, 0.5, 0.5))),
        ("LAST_STAGE_AT_HALF", _runge_kutta(reach=(0, 0.5, 0.5, 0.5), times=(0, 0.5, 0.5, 1))),
        ("STAGES_NOT_CHAINED", _runge_kutta(source=(0, 0, 0, 0))),
        ("STAGES_NOT_CHAINED", _runge_kutta(source=(0, 0, 0, 2))),
        ("STAGES_NOT_CHAINED", _runge_kutta(source=(0, 0, 1, 1))),
        ("STAGE_VELOCITY_IGNORED", _runge_kutta(view=lambda _q, v, q_i, v_i: (q_i, v, v_i))),
        ("STAGE_POSITION_IGNORED", _runge_kutta(view=lambda q, _v, _q_i, v_i: (q, v_i, v_i))),
        ("POSITION_SLOPES_FROZEN", _runge_kutta(view=lambda _q, v, q_i, v_i: (q_i, v_i, v))),
    ],
}
