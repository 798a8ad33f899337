"""One-step formulas of ``integrators``, right and wrong: the right one with a term in another form.

Each is called as the exercise's steps are: ``step(accel, t, q, v, h) -> (q_next, v_next)``. ``TERMS`` lists
families, what they take for granted, and for each form of a term the code of the mistake; ``OTHERS`` are
wrong in another way. A step that has several right forms has several families.
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


def _euler(
    first="velocity",
    moves="old",
    move=lambda h: h,
    kick=lambda h: h,
    time=0.0,
    sees=None,
    signs=(1.0, 1.0),
    gives=lambda q, v, dq, dv: (q + dq, v + dv),
):
    """Both Euler methods. ``moves``: with which velocity q moves; ``sees``: what accel is given of the state;

    ``gives``: what is made of the two changes; ``time``: of the acceleration, in steps.
    """

    def step(accel, t, q, v, h):
        at = sees or (lambda q, v: (q, v))
        if first == "position":
            dq = signs[0] * move(h) * v
            dv = signs[1] * kick(h) * accel(t + time * h, *at(q + dq if moves == "new" else q, v))
            return gives(q, v, dq, dv)
        dv = signs[1] * kick(h) * accel(t + time * h, *at(q, v))
        w = {"old": v, "new": v + dv, "mean": v + dv / 2, "change": dv, "both": 2 * v + dv}.get(moves, dv / h)
        return gives(q, v, signs[0] * move(h) * w, dv)

    return step


def _verlet(
    drift=lambda h: h,
    square=lambda h: h * h / 2,
    kick_old=lambda h: h / 2,
    kick_new=lambda h: h / 2,
    time=1.0,
    start=0.0,
    gives=lambda q, v, dq, dv: (q + dq, v + dv),
    sees="new",
    sign=1.0,
):
    """Kick, drift, kick as one formula: q + h v + h²/2 a_old and v + h/2 (a_old + a_new)."""

    def step(accel, t, q, v, h):
        a_old = sign * accel(t + start * h, q, v)
        dq = drift(h) * v + square(h) * a_old
        a_new = sign * accel(
            t + time * h, {"new": q + dq, "old": q, "drift": q + h * v, "change": dq}[sees], v
        )
        return gives(q, v, dq, kick_old(h) * a_old + kick_new(h) * a_new)

    return step


def _drift_kick_drift(
    before=lambda h: h / 2,
    kick=lambda h: h,
    after=lambda h: h / 2,
    time=0.5,
    late="new",
    gives=lambda q, v, dq, dv: (q + dq, v + dv),
    sign=1.0,
    sees=1.0,
):
    """``sees``: how much of the first half of the drift the kick gets."""

    def step(accel, t, q, v, h):
        dq = before(h) * v
        dv = sign * kick(h) * accel(t + time * h, q + sees * dq, v)
        return gives(q, v, dq + after(h) * {"new": v + dv, "old": v, "mean": v + dv / 2}[late], dv)

    return step


def _runge_kutta(
    weights=(1 / 6, 1 / 3, 1 / 3, 1 / 6),
    reach=(0, 0.5, 0.5, 1),
    times=(0, 0.5, 0.5, 1),
    source=(0, 0, 1, 2),
    source_v=None,
    reach_v=None,
    view=None,
    gives=lambda q, v, dq, dv: (q + dq, v + dv),
    sign=1.0,
    size=lambda h: h,
    weights_v=None,
):
    """The family around RK4: stage i is ``reach[i] * h`` along slope ``source[i]``, at ``times[i]``.

    ``reach_v`` and ``source_v``: of the velocity, where they are others than those of the position.
    ``view(q, v, q_i, v_i)`` is what accel and dq see of stage i: position, velocity, slope of q.
    """
    view = view or (lambda _q, _v, q_i, v_i: (q_i, v_i, v_i))

    def step(accel, t, q, v, h):
        slopes = [(np.zeros_like(q), np.zeros_like(v))]
        for i in range(4):
            dq = slopes[source[i] + 1 if i else 0][0]
            dv = slopes[(source_v or source)[i] + 1 if i else 0][1]
            q_i, v_i, slope = view(q, v, q + reach[i] * h * dq, v + (reach_v or reach)[i] * h * dv)
            slopes.append((slope, sign * accel(t + times[i] * h, q_i, v_i)))
        sums = [
            sum(w * k[part] for w, k in zip(ws, slopes[1:], strict=True))
            for part, ws in enumerate((weights, weights_v or weights))
        ]
        return gives(q, v, size(h) * sums[0], size(h) * sums[1])

    return step


#: Per task the right formulas.
RIGHT = {
    "explicit_euler_step": [_EULER],
    "semi_implicit_euler_step": [_KICK_DRIFT, _DRIFT_KICK],
    "velocity_verlet_step": [_KDK, _DKD],
    "rk4_step": [_RK4],
}


def each(code, *forms):
    """The same code for several forms of a term."""
    return tuple((code, form) for form in forms)


_GIVES = (
    ("RETURNS_SWAPPED", lambda q, v, dq, dv: (v + dv, q + dq)),
    ("RETURNS_INCREMENT", lambda q, v, dq, dv: (dq, dv)),
    ("STATE_NOT_ADVANCED", lambda q, v, dq, dv: (q, v)),
    ("POSITION_NOT_ADVANCED", lambda q, v, dq, dv: (q, v + dv)),
    ("VELOCITY_NOT_ADVANCED", lambda q, v, dq, dv: (q + dq, v)),
    *each("RETURNS_INCREMENT", lambda q, v, dq, dv: (dq, v + dv), lambda q, v, dq, dv: (q + dq, dv)),
    *each("WRONG_SIGN", lambda q, v, dq, dv: (q - dq, v - dv), lambda q, v, dq, dv: (q - dq, v + dv)),
    ("WRONG_SIGN", lambda q, v, dq, dv: (q + dq, v - dv)),
)


def _sizes(right):
    """Other factors in the place of one that is ``right`` times h."""
    forms = [
        ("STEP_SIZE_MISSING", lambda h: right),
        *each("POWER_OF_STEP_WRONG", lambda h: right * h * h, lambda h: right * h**0.5),
    ]
    forms += [("FACTOR_WRONG", lambda h, k=k: k * right * h) for k in (0.5, 2.0, 1 / 3, 1.5, 0.25, 4.0)]
    forms += [("WRONG_SIGN", lambda h: -right * h), ("TERM_MISSING", lambda h: 0.0)]
    return tuple(forms)


def _of_drift():
    """Other factors of half a drift."""
    missing = {"TERM_MISSING": "DRIFT_HALF_MISSING"}
    return tuple((missing.get(code, code), form) for code, form in _sizes(0.5))


_TIMES = (*each("STAGE_TIMES_AHEAD", 1.0, 0.5, 2.0), ("STAGE_TIMES_BEHIND", -1.0))
_SEES = (
    *each("ACCEL_ARGUMENTS_MIXED", lambda q, v: (v, q), lambda q, v: (q, q), lambda q, v: (v, v)),
    ("ACCEL_SEES_NO_VELOCITY", lambda q, v: (q, 0 * v)),
    ("ACCEL_SEES_NO_POSITION", lambda q, v: (0 * q, v)),
)
_EULER_TERMS = {
    "gives": _GIVES,
    "move": _sizes(1.0),
    "kick": _sizes(1.0),
    "time": _TIMES,
    "sees": _SEES,
}
_MOVES = (
    ("POSITION_MOVED_TWICE", "both"),
    ("MOVES_WITH_THE_CHANGE", "change"),
    ("MOVES_WITH_ACCELERATION", "acceleration"),
)
_SQUARE = (
    ("HALF_MISSING", lambda h: h * h),
    ("QUADRATIC_TERM_MISSING", lambda h: 0.0),
    *each("POSITION_TERM_SUBTRACTED", lambda h: -h * h / 2, lambda h: -h * h),
    *each("FACTOR_WRONG", lambda h: h * h / 4, lambda h: h * h / 3, lambda h: h * h / 6, lambda h: 2 * h * h),
    *each("POWER_OF_STEP_WRONG", lambda h: h / 2, lambda h: h, lambda h: h**3 / 2),
)
_KICKS = (
    ("KICKS_TOO_LARGE", lambda h: h),
    ("KICK_SUBTRACTED", lambda h: -h / 2),
    *each("FACTOR_WRONG", lambda h: h / 4, lambda h: h / 3),
    ("STEP_SIZE_MISSING", lambda h: 0.5),
    ("POWER_OF_STEP_WRONG", lambda h: h * h / 2),
)
_SIGN = (("WRONG_SIGN", -1.0),)
_LATER = (("STAGE_TIMES_FROZEN", 0.0), *each("STAGE_TIMES_WRONG", 0.5, 2.0))


def _weights(divisor, weights=(1, 2, 2, 1)):
    return tuple(w / divisor for w in weights)


def _sixths(code, *several):
    """The same code for several sets of weights, in sixths."""
    return each(code, *(_weights(6, weights) for weights in several))


_OF_ALL = {"FACTOR_WRONG": "WEIGHTS_DO_NOT_ADD_UP", "TERM_MISSING": "STATE_NOT_ADVANCED"}
_RK4_TERMS = {
    "gives": _GIVES,
    "weights": (
        ("EQUAL_WEIGHTS", (0.25,) * 4),
        ("WEIGHTS_MISPLACED", (1 / 3, 1 / 6, 1 / 6, 1 / 3)),
        *_sixths("WEIGHTS_MISPLACED", (2, 1, 1, 2), (1, 2, 1, 2), (2, 2, 1, 1), (1, 1, 2, 2), (2, 1, 2, 1)),
        *_sixths("WEIGHTS_MISPLACED", (1, 1, 1, 3), (1, 4, 0, 1), (1, 0, 4, 1)),
        *each("WEIGHTS_DO_NOT_ADD_UP", *map(_weights, (1, 2, 3, 4, 5, 8, 10, 12))),
        *each("WEIGHTS_DO_NOT_ADD_UP", *((w,) * 4 for w in (1 / 6, 1 / 3, 1 / 2, 1.0))),
        *_sixths("WEIGHTS_DO_NOT_ADD_UP", (1, 2, 2, 0), (0, 2, 2, 1), (1, 2, 1, 1), (1, 1, 2, 1)),
        *_sixths("WEIGHTS_DO_NOT_ADD_UP", (1, 3, 3, 1), (2, 2, 2, 1)),
        *_sixths("WEIGHT_SIGN_FLIPPED", (1, 2, 2, -1), (1, -2, 2, 1), (-1, 2, 2, 1)),
        ("RK4_IS_MIDPOINT", (0, 1, 0, 0)),
        ("MIDDLE_ONLY", (0, 0, 1, 0)),
        ("RK4_IS_EULER", (1, 0, 0, 0)),
        ("LAST_STAGE_ONLY", (0, 0, 0, 1)),
        ("ENDS_ONLY", (0.5, 0, 0, 0.5)),
        ("MIDDLE_ONLY", (0, 0.5, 0.5, 0)),
    ),
    "reach": (
        *each("HALF_STEP_MISSING", (0, 1, 1, 1), (0, 1, 0.5, 1), (0, 0.5, 1, 1)),
        ("LAST_STAGE_AT_HALF", (0, 0.5, 0.5, 0.5)),
        *each("STAGE_REACH_WRONG", (0, 0.25, 0.5, 1), (0, 0.5, 0.25, 1), (0, 0.5, 0.5, 2)),
        *each("STAGE_REACH_WRONG", (0, 1 / 3, 2 / 3, 1)),
        *each("STAGE_NOT_MOVED", (0, 0, 0.5, 1), (0, 0.5, 0, 1), (0, 0.5, 0.5, 0), (0, 0, 0, 0)),
        *each("WRONG_SIGN", (0, -0.5, 0.5, 1), (0, 0.5, -0.5, 1), (0, 0.5, 0.5, -1)),
    ),
    "times": (
        ("STAGE_TIMES_FROZEN", (0, 0, 0, 0)),
        *each("STAGE_TIMES_WRONG", (0, 1, 1, 1), (0, 0.5, 0.5, 0.5), (0, 0, 0, 1), (0, 0.5, 1, 1)),
        *each("STAGE_TIMES_WRONG", (0, 0.5, 0.5, 0), (0, 0, 0.5, 1), (0, 0.5, 0, 1), (1, 1, 1, 1)),
        *each("STAGE_TIMES_WRONG", (0, 0.25, 0.5, 1), (0, 0.25, 0.75, 1), (0, 1, 2, 3)),
    ),
    "source": each(
        "STAGES_NOT_CHAINED", (0, 0, 0, 0), (0, 0, 0, 2), (0, 0, 1, 1), (0, 0, 1, 0), (0, 0, 0, 1)
    ),
    "view": (
        ("STAGE_VELOCITY_IGNORED", lambda _q, v, q_i, v_i: (q_i, v, v_i)),
        ("STAGE_POSITION_IGNORED", lambda q, _v, _q_i, v_i: (q, v_i, v_i)),
        ("POSITION_SLOPES_FROZEN", lambda _q, v, q_i, v_i: (q_i, v_i, v)),
        ("STAGE_POSITION_IGNORED", lambda q, v, _q_i, v_i: (q, v, v_i)),
        ("POSITION_SLOPES_FROZEN", lambda _q, v, q_i, v_i: (q_i, v, v)),
    ),
    "weights_v": (
        *each("WEIGHTS_DIFFER", (0.25,) * 4, (1, 0, 0, 0), *map(_weights, (1, 3, 8))),
        *_sixths("WEIGHTS_DIFFER", (1, 2, 1, 1), (1, 1, 2, 1), (1, 1, 1, 1)),
    ),
    # A factor of both sums is one of all the weights.
    "size": tuple((_OF_ALL.get(code, code), form) for code, form in _sizes(1.0)),
    "sign": _SIGN,
}

_SECOND_NEW = (("EULER_IS_SEMI_IMPLICIT", lambda h: h),)

#: For each task its families: the family, what it takes for granted, and its terms.
TERMS = {
    "explicit_euler_step": [
        (
            _euler,
            {},
            _EULER_TERMS
            | {
                "moves": (("EULER_IS_SEMI_IMPLICIT", "new"), ("EULER_AVERAGES", "mean"), *_MOVES),
            },
        ),
        *(
            (_euler, {"first": "position", "moves": "new", "time": time}, {"kick": _SECOND_NEW})
            for time in (0.0, 1.0)
        ),
    ],
    "semi_implicit_euler_step": [
        (
            _euler,
            {"moves": "new"},
            _EULER_TERMS
            | {
                "moves": (("SEMI_IMPLICIT_IS_EULER", "old"), ("AVERAGED_VELOCITY", "mean"), *_MOVES),
            },
        ),
        (
            _euler,
            {"first": "position", "moves": "new", "time": 1.0},
            _EULER_TERMS
            | {
                "time": _LATER,
                "moves": (("END_TIME_OLD_POSITION", "old"),),
            },
        ),
    ],
    "velocity_verlet_step": [
        (
            _verlet,
            {},
            {
                "gives": _GIVES,
                "drift": _sizes(1.0),
                "square": _SQUARE,
                "kick_old": (*_KICKS, ("FIRST_KICK_MISSING", lambda h: 0.0)),
                "kick_new": (*_KICKS, ("SECOND_KICK_MISSING", lambda h: 0.0)),
                "time": _LATER,
                "start": _TIMES,
                "sees": (
                    ("END_SEEN_FROM_START", "old"),
                    ("END_WITHOUT_SQUARE", "drift"),
                    ("END_IS_THE_CHANGE", "change"),
                ),
                "sign": _SIGN,
            },
        ),
        (
            _drift_kick_drift,
            {},
            {
                "gives": _GIVES,
                "before": _of_drift(),
                "kick": _sizes(1.0),
                "after": _of_drift(),
                "time": (("STAGE_TIMES_FROZEN", 0.0), ("STAGE_TIMES_WRONG", 1.0)),
                "late": (("DRIFTS_WITH_OLD_VELOCITY", "old"), ("DRIFTS_WITH_MEAN_VELOCITY", "mean")),
                "sees": each("KICK_NOT_HALF_WAY", 2.0, 0.0),
                "sign": _SIGN,
            },
        ),
    ],
    "rk4_step": [(_runge_kutta, {}, _RK4_TERMS)],
}


def _one_component(step):
    """The same step, with one component of the acceleration for all directions."""

    def flat(accel, t, q, v, h):
        return step(lambda t, q, v: np.full(np.shape(q), np.ravel(accel(t, q, v))[0]), t, q, v, h)

    return flat


def _moves_twice(accel, t, q, v, h):
    """Drift, kick at the new place, and drift again."""
    q = q + h * v
    v = v + h * accel(t + h, q, v)
    return q + h * v, v


#: Wrong in another way than by one or two terms: per task, codes and formula.


def _new_on_both_sides(shift):
    """Semi-implicit Euler with the acceleration at the predicted place, and the old place then moved anew."""

    def step(accel, t, q, v, h):
        v_next = v + h * np.asarray(accel(t + shift * h, q + h * v, v))
        return q + h * v_next, v_next

    return step


def _square_on_top(accel, t, q, v, h):
    """Semi-implicit Euler with h²/2 a added to a position that the new velocity has moved already."""
    a = np.asarray(accel(t, q, v))
    return q + h * (v + h * a) + h * h / 2 * a, v + h * a


def _one_kick_half_way(accel, t, q, v, h):
    """Verlet's position, and one kick with the acceleration halfway to it."""
    q_next = q + h * v + h * h / 2 * np.asarray(accel(t, q, v))
    return q_next, v + h * np.asarray(accel(t + h / 2, (q + q_next) / 2, v))


def _moved_by_new_velocity(accel, t, q, v, h):
    """RK4's velocity, and the position moved with it alone."""
    v_next = _RK4(accel, t, q, v, h)[1]
    return q + h * v_next, v_next


def _kicked_again(shift, new):
    """Semi-implicit Euler whose velocity gets a kick at the new position, too, or that kick alone."""

    def step(accel, t, q, v, h):
        moved = v + h * np.asarray(accel(t, q, v))
        at = q + h * moved
        start, seen = (moved if part else v for part in new)
        return at, start + h * np.asarray(accel(t + shift * h, at, seen))

    return step


def _half_a_drift(accel, t, q, v, h):
    """Drift, kick, drift whose second half starts again from the old position."""
    v_next = v + h * np.asarray(accel(t + h / 2, q + h / 2 * v, v))
    return q + h / 2 * v_next, v_next


def _half_stages():
    """RK4 with a stage of which only the position, or only the velocity, is wrong."""
    kinds = (
        ("STAGES_NOT_CHAINED", "source", ((0, 0, 0, 2), (0, 0, 1, 1), (0, 0, 1, 0), (0, 0, 0, 0))),
        ("HALF_STEP_MISSING", "reach", ((0, 1, 0.5, 1), (0, 0.5, 1, 1), (0, 1, 1, 1))),
        ("LAST_STAGE_AT_HALF", "reach", ((0, 0.5, 0.5, 0.5),)),
        ("STAGE_NOT_MOVED", "reach", ((0, 0, 0.5, 1), (0, 0.5, 0, 1), (0, 0.5, 0.5, 0))),
    )
    right = {"source": (0, 0, 1, 2), "reach": (0, 0.5, 0.5, 1)}
    for code, term, forms in kinds:
        for form in forms:
            yield (code,), _runge_kutta(**{term: form, f"{term}_v": right[term]})
            yield (code,), _runge_kutta(**{f"{term}_v": form})


def drifts():
    """Kick, drift, kick with another factor in the drift, before the velocity at half a step."""
    for code, size in _sizes(1.0):
        if code != "TERM_MISSING":
            yield code, _verlet(drift=size, square=lambda h, size=size: size(h) * h / 2)


def _last_call_copied(accel, t, q, v, h):
    """RK4 whose last acceleration is taken half a step ahead, but its velocity a whole step."""
    slopes = [(v, accel(t, q, v))]
    for reach, seen in ((0.5, 0.5), (0.5, 0.5), (1.0, 0.5)):
        dq, dv = slopes[-1]
        slopes.append((v + reach * h * dv, accel(t + seen * h, q + seen * h * dq, v + seen * h * dv)))
    sums = (a + 2 * b + 2 * c + d for a, b, c, d in zip(*slopes, strict=True))
    q_next, v_next = (now + h / 6 * slope for now, slope in zip((q, v), sums, strict=True))
    return q_next, v_next


OTHERS = {
    "explicit_euler_step": [
        (("FIRST_COMPONENT_ONLY",), _one_component(_EULER)),
        (("EULER_IS_VERLET",), _KDK),
        (("EULER_IS_RK4",), _RK4),
        (("EULER_IS_MIDPOINT",), _runge_kutta(weights=(0, 1, 0, 0))),
        (("WRONG_SIGN",), lambda accel, t, q, v, h: _EULER(lambda *at: -accel(*at), t, q, v, h)),
    ],
    "semi_implicit_euler_step": [
        *each(("FIRST_COMPONENT_ONLY",), _one_component(_KICK_DRIFT), _one_component(_DRIFT_KICK)),
        (("POSITION_MOVED_TWICE",), _moves_twice),
        *((("NEW_ON_BOTH_SIDES",), _new_on_both_sides(shift)) for shift in (1, 0)),
        (("SQUARE_TERM_ON_TOP",), _square_on_top),
        *(
            (("KICKED_AGAIN",), _kicked_again(shift, new))
            for shift in (1, 0)
            for new in ((0, 0), (0, 1), (1, 0), (1, 1))
        ),
        (("SEMI_IMPLICIT_IS_EULER",), _EULER),
        *each(("SEMI_IMPLICIT_IS_VERLET",), _KDK, _DKD),
        (("SEMI_IMPLICIT_IS_RK4",), _RK4),
    ],
    "velocity_verlet_step": [
        *each(("FIRST_COMPONENT_ONLY",), _one_component(_KDK), _one_component(_DKD)),
        (("VERLET_IS_EULER",), _EULER),
        (("ONE_KICK_HALF_WAY",), _one_kick_half_way),
        (("DRIFT_HALF_MISSING",), _half_a_drift),
        *each(("VERLET_IS_SEMI_IMPLICIT",), _KICK_DRIFT, _DRIFT_KICK),
        (("VERLET_IS_RK4",), _RK4),
        (("VERLET_IS_MIDPOINT",), _runge_kutta(weights=(0, 1, 0, 0))),
        (("USES_OLD_ACCELERATION",), _verlet(kick_old=lambda h: h, kick_new=lambda h: 0.0)),
        (("USES_NEW_ACCELERATION",), _verlet(kick_old=lambda h: 0.0, kick_new=lambda h: h)),
        (("KICKS_TOO_LARGE",), _verlet(kick_old=lambda h: h, kick_new=lambda h: h)),
        (("KICKS_TOO_LARGE",), _verlet(square=lambda h: h * h, kick_old=lambda h: h, kick_new=lambda h: h)),
        (("KICK_SUBTRACTED",), _verlet(kick_old=lambda h: -h / 2, kick_new=lambda h: -h / 2)),
        (
            ("KICK_SUBTRACTED",),
            _verlet(square=lambda h: -h * h / 2, kick_old=lambda h: -h / 2, kick_new=lambda h: h / 2),
        ),
        *each(("STAGE_TIMES_FROZEN",), _at(_KDK, 0), _at(_DKD, 0)),
    ],
    "rk4_step": [
        (("POSITION_BY_NEW_VELOCITY",), _moved_by_new_velocity),
        (("FIRST_COMPONENT_ONLY",), _one_component(_RK4)),
        (("RK4_IS_EULER",), _EULER),
        (
            ("RK4_IS_HEUN",),
            _runge_kutta(
                weights=(0.5, 0, 0, 0.5), reach=(0, 0, 0, 1), times=(0, 0, 0, 1), source=(0, 0, 0, 0)
            ),
        ),
        *each(("RK4_IS_VERLET",), _KDK, _DKD),
        (("RK4_IS_SEMI_IMPLICIT",), _KICK_DRIFT),
        *(
            (("HALF_STEP_MISSING",), _runge_kutta(reach=reach, times=reach))
            for reach in ((0, 1, 1, 1), (0, 1, 0.5, 1), (0, 0.5, 1, 1))
        ),
        (("LAST_STAGE_AT_HALF",), _last_call_copied),
        (("LAST_STAGE_AT_HALF",), _runge_kutta(reach=(0, 0.5, 0.5, 0.5), times=(0, 0.5, 0.5, 0.5))),
        *_half_stages(),
    ],
}
