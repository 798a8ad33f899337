"""Mistakes in `integrators`: words beside the programs that they are true of."""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.authoring.mistakes import Mistakes
from course.scoring import kit

mistakes = Mistakes()

mistakes(
    "EULER_IS_SEMI_IMPLICIT",
    "One of position and velocity is already new when the other is computed, as in semi-implicit Euler.",
    "Explicit Euler uses old values only. Compute a = accel(t, q, v) first, then q + h*v with the old v, and v + h*a.",
).body("explicit_euler_step", "return semi_implicit_euler_step(accel, t, q, v, h)")
mistakes(
    "MUTATES_INPUT",
    "A step must leave its caller's arrays as they were.",
    "Write q = q + ..., which makes a new array. q += ... and q[:] = ... change the caller's array.",
    kind="fact",
).body(
    "explicit_euler_step",
    """
        a = accel(t, q, v)
        q += h * v
        v += h * a
        return q, v
    """,
).body(
    "semi_implicit_euler_step",
    """
        v += h * accel(t, q, v)
        q += h * v
        return q.copy(), v.copy()
    """,
).around(
    "rk4_step",
    """
        q_next, v_next = _right(accel, t, q, v, h)
        q += q_next - q
        v += v_next - v
        return q_next, v_next
    """,
).around(
    "integrate",
    """
        t, q, v = _right(step, accel, q0, v0, t_end, h)
        np.asarray(q0, dtype=float)[:], np.asarray(v0, dtype=float)[:] = q[-1], v[-1]
        return t, q, v
    """,
)
mistakes(
    "INTEGER_STATE",
    "An array made of whole numbers has no room for fractions: they are lost, or the code fails.",
    "Start from np.array(q, dtype=float), and write a = a * h and not a *= h. Make float arrays before you store values in them: np.zeros(...) makes floats, but np.zeros_like(q0) takes the type of q0.",
).around(
    "explicit_euler_step",
    """
        q_next, v_next = _right(accel, t, q, v, h)
        return q_next.astype(q.dtype), v_next.astype(v.dtype)
    """,
).edit(
    "integrate",
    {
        "q = np.empty((n + 1, len(q0)))": "q = np.array([q0] * (n + 1))",
        "v = np.empty((n + 1, len(v0)))": "v = np.array([v0] * (n + 1))",
    },
)
mistakes(
    "SEMI_IMPLICIT_IS_EULER",
    "Position and velocity both move with old values. That is explicit Euler.",
    "Update the velocity first, then move the position with the new velocity: q + h*v_next, not q + h*v.",
).body("semi_implicit_euler_step", "return q + h * v, v + h * accel(t, q, v)")
mistakes(
    "AVERAGED_VELOCITY",
    "The position moves with the mean of the old and the new velocity. Adding h**2/2 times the acceleration does the same.",
    "Move the position with the new velocity alone. The mean looks more accurate, but the step is then no longer symplectic, and a spring gains energy.",
).edit("semi_implicit_euler_step", {"h * v_next, v_next": "h * (v + v_next) / 2, v_next"})
mistakes(
    "STAGE_TIMES_FROZEN",
    "accel gets the time at the start of the step where a later one belongs. Only a force that depends on time shows this: if a check with another force fails, too, there is a second mistake.",
    "Give accel the time of its position: t + h/2 for a state half a step on, t + h for one a whole step on.",
).edit(
    "semi_implicit_euler_step",
    {
        "v_next = v + h * accel(t, q, v)": "q_next = q + h * v",
        "q + h * v_next, v_next": "q_next, v + h * accel(t, q_next, v)",
    },
).edit("velocity_verlet_step", {"accel(t + h, q_next": "accel(t, q_next"}).around(
    "rk4_step", "return _right(lambda _t, q, v: accel(t, q, v), t, q, v, h)"
)
mistakes(
    "RETURNS_SWAPPED",
    "Your code returns its two values in the wrong order.",
    "Return (q_next, v_next): the position first.",
).edit("semi_implicit_euler_step", {"q + h * v_next,": "v_next, q + h *"})
mistakes(
    "USES_OLD_ACCELERATION",
    "After one step the position is right, but the velocity takes the old acceleration for the whole step.",
    "Evaluate accel again at (t + h, q_next), and give the velocity half a kick with each: v + h/2*(a_old + a_new).",
).body(
    "velocity_verlet_step",
    """
        a = accel(t, q, v)
        return q + h * v + h**2 / 2 * a, v + h * a
    """,
)
mistakes(
    "HALF_MISSING",
    "The position is moved by h*v + h**2*a: the term with h squared lacks its factor one half.",
    "A constant acceleration moves a body by h*v + h**2/2*a. Put the 1/2 in, or drift with the velocity after the first half kick, v + h/2*a.",
).edit(
    "velocity_verlet_step",
    {
        "v_half = v + h / 2 *": "a =",
        "* v_half": "* v + h**2 * a",
        "v_half + h / 2 * accel(t + h, q_next, v_half": "v + h / 2 * (a + accel(t + h, q_next, v)",
    },
)
mistakes(
    "STALE_CACHE",
    "The same call gives another result after a call in between, as if your code remembered something that is no longer valid.",
    "The result may depend on the arguments alone. Evaluate accel again where accel, t, q or v differ.",
).program(
    "velocity_verlet_step",
    """
        _kept = []


        def velocity_verlet_step(accel, t, q, v, h):
            if not _kept or _kept[0].shape != q.shape:
                _kept[:] = [accel(t, q, v)]
            v_half = v + h / 2 * _kept[0]
            q_next = q + h * v_half
            _kept[0] = accel(t + h, q_next, v_half)
            return q_next, v_half + h / 2 * _kept[0]
    """,
).program(
    "velocity_verlet_step",
    """
        _last = {}


        def velocity_verlet_step(accel, t, q, v, h):
            known = _last and abs(_last["t"] - t) < 1e-9 and np.shape(_last["a"]) == np.shape(q)
            w = v + h / 2 * (_last["a"] if known else np.asarray(accel(t, q, v), dtype=float))
            q_next = q + h * w
            a_next = np.asarray(accel(t + h, q_next, w), dtype=float)
            _last.update(t=t + h, a=a_next)
            return q_next, w + h / 2 * a_next
    """,
).program(
    "velocity_verlet_step",
    """
        _last = {}


        def velocity_verlet_step(accel, t, q, v, h):
            a = _last["a"] if _last and np.array_equal(_last["q"], q) else accel(t, q, v)
            w = v + h / 2 * a
            q_next = q + h * w
            a_next = accel(t + h, q_next, w)
            _last.update(q=q_next.copy(), a=a_next)
            return q_next, w + h / 2 * a_next
    """,
)
mistakes(
    "VERLET_OF_POSITIONS",
    "The position moves by h*v + h**2*a and the velocity by h/2*a, as if q - h*v were the position a step before.",
    "Verlet's formula of positions needs the true one. With a velocity, move by h*v + h**2/2*a, and add h/2 times the sum of the old and the new acceleration to the velocity.",
).body(
    "velocity_verlet_step",
    """
        before = q - h * v
        q_next = 2 * q - before + h**2 * accel(t, q, v)
        return q_next, (q_next - before) / (2 * h)
    """,
)
mistakes(
    "EQUAL_WEIGHTS",
    "The four slopes are averaged with equal weights.",
    "The two middle slopes count double: (k1 + 2*k2 + 2*k3 + k4)/6.",
).edit(
    "rk4_step",
    {
        "h / 6 * (dq1 + 2 * dq2 + 2 * dq3 + dq4)": "h / 4 * (dq1 + dq2 + dq3 + dq4)",
        "h / 6 * (dv1 + 2 * dv2 + 2 * dv3 + dv4)": "h / 4 * (dv1 + dv2 + dv3 + dv4)",
    },
)
mistakes(
    "HALF_STEP_MISSING",
    "A middle slope is taken a whole step ahead instead of half a step, at least in position or in velocity.",
    "The second and the third slope belong to t + h/2, and each is reached with h/2 times the slope before it.",
).edit(
    "rk4_step",
    {
        "q + h / 2 * dq1, v + h / 2 * dv1": "q + h * dq1, v + h * dv1",
        "q + h / 2 * dq2, v + h / 2 * dv2": "q + h * dq2, v + h * dv2",
    },
)
mistakes(
    "SECOND_STAGE_ELSEWHERE",
    "The first call of accel is right, but the second gets another time, position or velocity than in the classical method.",
    "In the classical method the second slope belongs to t + h/2, and is reached with the first: with a1 = accel(t, q, v), call accel(t + h/2, q + h/2*v, v + h/2*a1). Another method, such as the 3/8 rule, has calls of its own: compare with its table.",
    kind="consequence",
).edit("rk4_step", {"q + h / 2 * dq1, v + h / 2 * dv1": "q + h / 3 * dq1, v + h / 3 * dv1"})
mistakes(
    "THIRD_STAGE_ELSEWHERE",
    "The first two calls of accel are right, but the third gets another time, position or velocity than in the classical method.",
    "In the classical method the third slope belongs to t + h/2, and is reached with the second. With v2 and a2, the velocity and the acceleration of the second call, call accel(t + h/2, q + h/2*v2, v + h/2*a2). Another method, such as the 3/8 rule, has calls of its own: compare with its table.",
    kind="consequence",
).edit("rk4_step", {"v + h / 2 * dv2": "v + h / 2 * dv1 + h / 2 * dv2"})
mistakes(
    "FOURTH_STAGE_ELSEWHERE",
    "The first three calls of accel are right, but the fourth gets another time, position or velocity than in the classical method.",
    "In the classical method the fourth slope belongs to t + h, and is reached with the third. With v3 and a3, the velocity and the acceleration of the third call, call accel(t + h, q + h*v3, v + h*a3). Another method, such as the 3/8 rule, has calls of its own: compare with its table.",
    kind="consequence",
).edit("rk4_step", {"v + h * dv3": "v + h / 2 * dv2 + h / 2 * dv3"})
mistakes(
    "STAGES_PUT_TOGETHER_WRONG",
    "All four calls of accel get what they should, but their slopes are not put together as in the classical method, in position or in velocity.",
    "With v1 to v4, the velocities that accel was called with, and a1 to a4, what it returned: q + h/6*(v1 + 2*v2 + 2*v3 + v4) and v + h/6*(a1 + 2*a2 + 2*a3 + a4).",
    kind="consequence",
).edit("rk4_step", {"dv1 + 2 * dv2 + 2 * dv3 + dv4": "2 * dv1 + dv2 + dv3 + 2 * dv4"})
mistakes(
    "STAGES_WEIGHED_WRONG",
    "Your four calls of accel are those of a method of order four, but their slopes are not put together with its weights.",
    "Compare the last line of your step with the last line of the method's table: each weight stands below its own stage.",
    kind="consequence",
).body(
    "rk4_step",
    """
        root = math.sqrt(2.0)

        def slope(time, y):
            return np.array([y[1], accel(time, y[0], y[1])])

        y = np.array([q, v], dtype=float)
        k1 = slope(t, y)
        k2 = slope(t + h / 2, y + h / 2 * k1)
        k3 = slope(t + h / 2, y + h * ((root - 1) / 2 * k1 + (2 - root) / 2 * k2))
        k4 = slope(t + h, y + h * (-root / 2 * k2 + (2 + root) / 2 * k3))
        return tuple(y + h / 6 * (k1 + (2 + root) * k2 + (2 - root) * k3 + k4))
    """,
)
mistakes(
    "STAGE_VELOCITY_IGNORED",
    "accel gets the velocity from the start of the step each time. Only a force that depends on velocity, such as damping, shows this: if a check with another force fails, too, there is a second mistake.",
    "Give accel the velocity of the stage as well: each stage has its own position and its own velocity.",
).around("rk4_step", "return _right(lambda t, q, _v: accel(t, q, v), t, q, v, h)")
mistakes(
    "EXTRA_EVALUATIONS",
    "accel is called more often than this method needs.",
    "The Euler methods call accel once a step, Verlet once or twice, RK4 four times. If you need the same acceleration twice, keep it in a variable; if you call accel to guess a velocity for another call, give that call the old one. If you iterate, or divide the step into shorter ones, it is another method.",
    kind="fact",
).around(
    "rk4_step",
    """
        def twice(t, q, v):
            accel(t, q, v)
            return accel(t, q, v)

        return _right(twice, t, q, v, h)
    """,
).body(
    "velocity_verlet_step",
    """
        q_next = q + h * v + h**2 / 2 * accel(t, q, v)
        return q_next, v + h / 2 * (accel(t, q, v) + accel(t + h, q_next, v))
    """,
)
mistakes(
    "TRUNCATED_STEP_COUNT",
    "The number of steps is cut off instead of rounded: t_end/h may come out just below a whole number.",
    "Use round(t_end / h), not int(...) and not //.",
).edit("integrate", {"t = h *": "n = int(t_end / h)\n    t = h *"})
mistakes(
    "OFF_BY_ONE_SAMPLE",
    "There is one sample too many or one too few: n steps connect n + 1 states.",
    "Take n = round(t_end / h) steps, not one more and not one less. Record the initial state before the loop and one state after each step.",
).edit("integrate", {"return t, q, v": "return t[1:], q[1:], v[1:]"})
mistakes(
    "TIME_ACCUMULATES",
    "The steps are counted by a running sum of h, or by np.arange up to an end. Rounding errors, or <= in the place of <, then add a step or lose one.",
    "Fix the number of steps first, n = round(t_end / h), loop over range(n), and compute the time as i*h.",
).body(
    "integrate",
    """
        if abs(t_end / h - round(t_end / h)) > 1e-6:
            raise ValueError
        t, q, v = [0.0], [np.array(q0, float)], [np.array(v0, float)]
        while t[-1] < t_end:
            q_next, v_next = step(accel, t[-1], q[-1], v[-1], h)
            t.append(t[-1] + h)
            q.append(q_next)
            v.append(v_next)
        return np.array(t), np.array(q), np.array(v)
    """,
)
mistakes(
    "TIME_NOT_PASSED",
    "All steps get the same starting time. Only a force that depends on time shows this.",
    "Call step(accel, i * h, q, v, h) with the time at which this particular step starts.",
).around(
    "integrate",
    "return _right(lambda accel, _t, q, v, h: step(accel, 0.0, q, v, h), accel, q0, v0, t_end, h)",
)
mistakes(
    "DURATION_NOT_CHECKED",
    "For a duration that is not a whole number of steps your code raises no ValueError.",
    "With N = round(t_end / h), raise ValueError if abs(t_end / h - N) > 1e-6. A difference in seconds is another limit, and so is np.isclose, whose limit grows with N.",
    kind="fact",
).around("integrate", "return _right(step, accel, q0, v0, round(t_end / h) * h, h)")
mistakes(
    "DURATION_LIMIT_TOO_WIDE",
    "Durations far from a whole number of steps are refused, and this one is not.",
    "With N = round(t_end / h), raise ValueError if abs(t_end / h - N) > 1e-6. A difference in seconds is another limit, and so is np.isclose, whose limit grows with N.",
    kind="fact",
).edit("integrate", {"- n) > 1e-6": "- n) > 9e-6"}).edit("integrate", {"> 1e-6": "> 1e-6 * n"})
mistakes(
    "DURATION_CHECKED_ON_ONE_SIDE",
    "Durations are refused on one side of a whole number of steps only: a little too long, or a little too short.",
    "Take the difference without its sign: raise ValueError if abs(t_end / h - N) > 1e-6.",
    kind="fact",
).edit("integrate", {"abs(t_end / h - n)": "t_end / h - n"})
mistakes(
    "REFUSES_DIVISIBLE",
    "t_end / h may come out just below a whole number, as 28.999999999999996 for 0.29 s at 0.01 s. Then int() and // give 28, and t_end % h is almost h. np.arange in steps of h may have one entry too many.",
    "Take N = round(t_end / h) for the steps and np.arange(N + 1) * h for the times, and raise ValueError only if abs(t_end / h - N) > 1e-6.",
    kind="fact",
).around(
    "integrate",
    """
        if t_end % h != 0:
            raise ValueError("t_end must be a multiple of h")
        return _right(step, accel, q0, v0, t_end, h)
    """,
)
mistakes(
    "STATE_NOT_CARRIED",
    "Every row after the first is what one step makes of the initial state: no step starts from the result of the step before.",
    "Start each step from the state that the step before it returned: row i goes in, row i + 1 comes out.",
).edit("integrate", {"q[i], v[i], h)": "q[0], v[0], h)"})
mistakes(
    "ORDER_SLOPE_INVERTED",
    "The result is the slope of log h over log error, or one over the right slope: as if the two axes were swapped.",
    "The order is d log(error) / d log(h): h belongs on the horizontal axis (the first argument of np.polyfit), the error on the vertical one.",
).body("observed_order", "return np.polyfit(np.log(errors), np.log(hs), 1)[0]")
mistakes(
    "ORDER_OF_THE_OTHER_AXIS",
    "The line is fitted to log h over log error, and its slope is turned over. Where points scatter, that is another line.",
    "Fit log error over log h: divide the sum of dx*dy by that of dx**2, with dx of log h and dy of log error.",
).body(
    "observed_order",
    """
        x, y = np.log(hs), np.log(errors)
        return float(1 / np.polyfit(y, x, 1)[0])
    """,
)
mistakes(
    "LOGARITHM_MISSING",
    "The result is the slope without the logarithm on at least one axis.",
    "error = C * h**p is a straight line only with logarithms on both axes, so take np.log of hs and of errors.",
).body("observed_order", "return np.polyfit(hs, errors, 1)[0]")
mistakes(
    "ORDER_FROM_ENDS",
    "The result is the slope between two of the points, without the others.",
    "Fit a line to all points by least squares: np.polyfit with degree 1, or a sum over centred logarithms.",
).body("observed_order", "return math.log(errors[0] / errors[-1]) / math.log(hs[0] / hs[-1])")
mistakes(
    "ORDER_MEAN_OF_PAIRS",
    "The result comes from slopes between two points each, not from one line through all points.",
    "Fit one line through all points by least squares.",
).body(
    "observed_order",
    """
        x, y = np.log(hs), np.log(errors)
        return float(np.mean(np.diff(y) / np.diff(x)))
    """,
)
mistakes(
    "RETURNS_Z",
    "For more than one map, the result is the product h * omega at the limit, not the step itself.",
    "Divide by omega: the answer is a time in seconds. If you do, look at the acceleration: it has to be -omega**2 * q.",
).around("max_stable_step", "return _right(step, omega) * omega")
mistakes(
    "STABILITY_BY_NORM",
    "The limits are those of a norm of the matrix. One step can stretch a state, and the motion still stays bounded.",
    "Look whether you use the eigenvalues, max(abs(np.linalg.eigvals(M))). If you do, compare the two unit states from which M is made: (1, 0) and (0, omega), with velocities divided by omega afterwards.",
).edit("max_stable_step", {"max(abs(np.linalg.eigvals(matrix)))": "np.linalg.norm(matrix, 2)"})
mistakes(
    "ASSUMES_ITS_LIMIT",
    "h * omega comes out the same for three methods with different limits.",
    "What in your result depends on the given step? Its calls on (1, 0) and (0, omega) give a matrix at each h, and the eigenvalues of that matrix have to decide where the search goes.",
).body("max_stable_step", "return 2.0 / omega")
mistakes(
    "EIGENVALUES_WITHOUT_MODULUS",
    "The limits are those of the real parts or the signed values of the eigenvalues: -1.1 and 0.8 + 0.8i are unstable too.",
    "Take the modulus of each eigenvalue before the maximum: max(abs(np.linalg.eigvals(M))).",
).edit("max_stable_step", {"max(abs(np.linalg.eigvals(matrix)))": "max(np.linalg.eigvals(matrix).real)"})
mistakes(
    "LARGEST_STABLE_STEP",
    "The method becomes unstable and then stable again, and the result may lie beyond the unstable steps.",
    "Walk up from 0.05/omega in increments of less than 0.25/omega, stop at the first unstable step, and bisect only within that last increment.",
).body(
    "max_stable_step",
    """
        def radius(z):
            columns = [
                step(lambda t, q, v: -(omega**2) * q, 0.0, np.array([a]), np.array([b * omega]), z / omega)
                for a, b in ((1.0, 0.0), (0.0, 1.0))
            ]
            return max(abs(np.linalg.eigvals([[c[0][0] for c in columns], [c[1][0] / omega for c in columns]])))

        z = 10.0
        if radius(z) <= 1 + 1e-8:
            return math.inf
        while z > 0.05 and radius(z) > 1 + 1e-8:
            z *= 0.996
        return z / omega if z > 0.05 else 0.0
    """,
)
mistakes(
    "NO_INFINITY",
    "The result is not math.inf for a method that is stable at every step up to 10/omega.",
    "Return math.inf when no step up to 10/omega is unstable, whatever comes beyond.",
    kind="consequence",
).around("max_stable_step", "return min(_right(step, omega), 10 / omega)").edit(
    "max_stable_step",
    {
        "np.linspace(0.05, 10.0, 51)": "np.arange(0.05, 13.0, 0.1)",
        "for _ in range(20)": "while high - low > 1e-6",
    },
)
mistakes(
    "STEP_SIZE_MISSING",
    "A change is added without its factor h, as if a step lasted one second.",
    "Multiply every slope by h (or by its fraction of h) before you add it.",
).edit("explicit_euler_step", {"h * v, v + h *": "v, v +"})
mistakes(
    "ACCEL_ARGUMENTS_MIXED",
    "accel gets its arguments in another order, or something else in the place of one.",
    "Call accel(t, q, v): the time, the position, the velocity. The position of a later stage is q plus a fraction of h times a slope, not the slope itself.",
).edit("explicit_euler_step", {"(t, q, v)": "(q, v, t)"})
mistakes(
    "USES_NEW_ACCELERATION",
    "After one step the position is right, but the velocity takes the new acceleration for the whole step.",
    "Use the acceleration from the start of the step as well: v + h/2*(a_old + a_new).",
).body(
    "velocity_verlet_step",
    """
        q_next = q + h * v + h**2 / 2 * accel(t, q, v)
        return q_next, v + h * accel(t + h, q_next, v)
    """,
)
mistakes(
    "POSITION_TERM_SUBTRACTED",
    "In the position, the term with the acceleration is subtracted.",
    "A constant acceleration moves a body by h*v + h**2/2*a. accel already has the right sign, so the term is added.",
).edit(
    "velocity_verlet_step",
    {
        "v_half = v + h / 2 *": "a =",
        "* v_half": "* v - 0.5 * h * h * a",
        "v_half + h / 2 * accel(t + h, q_next, v_half": "v + h / 2 * (a + accel(t + h, q_next, v)",
    },
)
mistakes(
    "KICK_SUBTRACTED",
    "In the velocity, an acceleration is subtracted.",
    "accel already has the right sign, so both half kicks are added: v + h/2*(a_old + a_new).",
).edit("velocity_verlet_step", {"v_half + h": "v_half - h"})
mistakes(
    "HISTORIES_SWAPPED",
    "The positions and the velocities that integrate returns have changed places.",
    "Return (t, q, v): the positions before the velocities, each in its own array.",
    true_too=("INITIAL_STATE_WRONG",),
).edit("integrate", {"return t, q, v": "return t, v, q"})
mistakes(
    "HISTORIES_IDENTICAL",
    "The positions and the velocities that integrate returns are the same numbers.",
    "Make an array for each: v = q only gives the same array a second name. Fill each with its half of the state, and return both.",
).edit("integrate", {"v = np.empty((n + 1, len(v0)))": "v = q"})
mistakes(
    "TRUNCATED_AND_SHORT",
    "The number of steps is truncated instead of rounded, and for that many steps there is one sample too few.",
    "Use n = round(t_end / h), not int(...) and not //; then record the initial state before the loop and one state after each of the n steps.",
    true_too=("OFF_BY_ONE_SAMPLE",),
).edit(
    "integrate",
    {"t = h *": "n = int(t_end / h)\n    t = h *", "return t, q, v": "return t[:-1], q[1:], v[1:]"},
)
mistakes(
    "INITIAL_STATE_MISSING",
    "The first sample is not the initial state.",
    "Row 0 is q0 and v0, at time 0. Store them before the first step, and let step number i write row i + 1.",
).edit("integrate", {"return t, q, v": "q[0], v[0] = 0.0, 0.0\n    return t, q, v"})
mistakes(
    "INITIAL_STATE_WRONG",
    "The first row is not the initial state.",
    "Row 0 of the positions is q0 and row 0 of the velocities is v0, as they were before any step. The first step starts from them.",
    true_too=("INITIAL_STATE_MISSING",),
).around("integrate", "return _right(step, accel, np.ones(len(q0)), np.asarray(v0), t_end, h)")
mistakes(
    "TIMES_START_LATE",
    "The times begin one step late.",
    "Row i belongs to time i*h, so the initial state is at time 0.",
).edit("integrate", {"return t, q, v": "return t + h, q, v"})
mistakes(
    "ENERGY_FADES",
    "Your code leaves less energy in the spring than this method does.",
    "Compute one step of a spring by hand, from a large q and a large v, and compare both results: sign, factor, and whether old or new values are used.",
    kind="consequence",
).body(
    "explicit_euler_step",
    """
        q_next, v_next = q, v
        for _ in range(20):
            q_next, v_next = q + h * v_next, v + h * accel(t + h, q_next, v_next)
        return q_next, v_next
    """,
)
mistakes(
    "ENERGY_GROWS_TOO_LITTLE",
    "Your code adds less energy to the spring than this method does.",
    "Compute one step of a spring by hand, from a large q and a large v, and compare both results: sign, factor, and whether old or new values are used.",
    kind="consequence",
).edit("explicit_euler_step", {"accel(t, q, v": "accel(t + h / 2, q + h / 2 * v, v"})
mistakes(
    "ENERGY_GROWS",
    "Your code leaves more energy in the spring than this method does.",
    "Compute one step of a spring by hand, from a large q and a large v, and compare both results: sign, factor, and whether old or new values are used.",
    kind="consequence",
).edit("explicit_euler_step", {"accel(t, q, v": "accel(t - h / 2, q - h / 2 * v, v"})
mistakes(
    "SEMI_IMPLICIT_IS_VERLET",
    "The steps are those of velocity Verlet.",
    "Semi-implicit Euler takes whole steps: v_next = v + h*accel(t, q, v), then q + h*v_next.",
).body("semi_implicit_euler_step", "return velocity_verlet_step(accel, t, q, v, h)")
mistakes(
    "ENERGY_SWINGS_TOO_FAR",
    "The energy of the spring strays further from its initial value than with this method.",
    "Compute one step of a spring by hand, from a large q and a large v, and compare both results: each term once, with its factor, and with the old or new value that belongs there.",
    kind="consequence",
).edit("semi_implicit_euler_step", {"h * v_next, v_next": "h * (1.25 * v_next - 0.25 * v), v_next"})
mistakes(
    "ENERGY_FADES_TOO_LITTLE",
    "Your code takes less energy out of the spring than this method does.",
    "Compute one step of a spring by hand, from a large q and a large v, and compare both results: sign, factor, and whether old or new values are used.",
    kind="consequence",
).around("rk4_step", "return _right(accel, t + h / 2, *_right(accel, t, q, v, h / 2), h / 2)")
mistakes(
    "ACCEL_BY_KEYWORD",
    "That works only where its arguments have these very names.",
    "Call it by position: accel(t, q, v).",
    kind="fact",
).edit("explicit_euler_step", {"accel(t, q, v)": "accel(t=t, q=q, v=v)"})
mistakes(
    "PAIRS_BROKEN",
    "The steps are sorted without their errors, so that an error meets the step of another.",
    "A slope needs no sorted points. If you sort, sort the pairs: order = np.argsort(hs), then hs[order] and errors[order].",
).edit("observed_order", {"np.log(hs), np.log(errors)": "np.log(np.sort(hs)), np.log(np.sort(errors))"})
mistakes(
    "REFUSES_NO_DURATION",
    "t_end = 0 raises an exception, and another duration does not.",
    "No steps are a whole number of steps: return the initial state as the only row.",
    kind="fact",
).edit("integrate", {"if abs(": "if t_end <= 0 or abs("})
mistakes(
    "POSITION_WRAPPED",
    "Far from zero the position is brought back to a range, as an angle might be, or is stopped at a limit.",
    "q may be any number of metres or of turns. Return the sum as it is, and give it to accel as it is.",
).around(
    "explicit_euler_step",
    """
        q_next, v_next = _right(accel, t, q, v, h)
        return (q_next + np.pi) % (2 * np.pi) - np.pi, v_next
    """,
).around(
    "velocity_verlet_step",
    "return _right(lambda t, q, v: accel(t, (np.asarray(q) + np.pi) % (2 * np.pi) - np.pi, v), t, q, v, h)",
)
mistakes("RESULT_OVERWRITTEN").program(
    "explicit_euler_step",
    """
        _right, _buffers = explicit_euler_step, {}


        def explicit_euler_step(accel, t, q, v, h):
            result = _right(accel, t, q, v, h)
            kept = _buffers.setdefault(len(q), (np.zeros(len(q)), np.zeros(len(q))))
            kept[0][:], kept[1][:] = result
            return kept
    """,
).program(
    "explicit_euler_step",
    """
        _BUFFERS = {}


        def explicit_euler_step(accel, t, q, v, h):
            q, v = np.asarray(q, dtype=float), np.asarray(v, dtype=float)
            pair = _BUFFERS.setdefault(q.shape, [np.empty((2, *q.shape)), np.empty((2, *q.shape))])
            pair.reverse()
            pair[0][0], pair[0][1] = q + h * v, v + h * np.asarray(accel(t, q, v))
            return pair[0][0], pair[0][1]
    """,
)
mistakes(
    "SEARCH_TOO_COARSE",
    "The result is off by less than 0.25/omega, but by more than 1 %.",
    "A step is stable up to a spectral radius of 1 + 1e-8. If something else decides in your code, mend that first. Then bisect between two neighbouring steps: the lower stays stable and the upper unstable, until they are less than 1 % apart, a share of the step and not a number of seconds. If your code does that, compare its matrix column by column: from (1, 0) and from (0, omega) at the same h, with both resulting velocities divided by omega.",
    kind="consequence",
).edit(
    "max_stable_step",
    {
        "np.linspace(0.05, 10.0, 51)": "np.arange(0.05, 10.0, 0.1)",
        "for _ in range(20)": "while (high - low) / omega > 1e-3",
    },
)
mistakes(
    "LIMIT_NEVER_SEEN",
    "Infinity is returned for a method that is unstable at some step before 10/omega.",
    "Check every h from 0.05/omega to 10/omega, in increments of less than 0.25/omega, by the largest modulus of the eigenvalues. Infinity is right only where none of them exceeds 1 + 1e-8. If your code does that, compare its matrix column by column: from (1, 0) and from (0, omega) at the same h, with both resulting velocities divided by omega.",
    kind="nan",
).edit(
    "max_stable_step",
    {
        "np.linspace(0.05, 10.0, 51)": "np.geomspace(0.05, 10.0, 92)",
        "for _ in range(20)": "while high - low > 1e-6",
    },
)
mistakes(
    "EQUAL_ERRORS_LOST",
    "The result is the slope with only the later one of two points of the same error.",
    "All points count: use lists or arrays, hs[i] with errors[i]. A dictionary, for example, would keep one entry for each error.",
).around(
    "observed_order",
    """
        points = {float(error): float(h) for h, error in zip(hs, errors)}
        return _right(list(points.values()), list(points))
    """,
)
mistakes(
    "STEP_GIVEN_WRONG",
    "Your code calls step with a step size other than h.",
    "Call it as step(accel, i * h, q, v, h).",
).edit("integrate", {"t[i], q[i], v[i], h": "h, q[i], v[i], t[i]"})
mistakes(
    "OTHER_STEP_TAKEN",
    "The rows are those of another step than the one that is given.",
    "Call what you are given: step(accel, i * h, q, v, h), whatever it is.",
).around("integrate", "return _right(rk4_step, accel, q0, v0, t_end, h)")
mistakes(
    "LOOP_ENDS_AT_REST",
    "The loop takes no more steps once one of them changes nothing, or hardly anything.",
    "Take all N steps: a force that depends on time may move the body later.",
    kind="consequence",
).edit(
    "integrate",
    {
        "v[i], h)": (
            "v[i], h)\n"
            "        if np.allclose(q[i + 1], q[i]) and np.allclose(v[i + 1], v[i]):\n"
            "            q[i + 1 :], v[i + 1 :] = q[i], v[i]\n"
            "            break"
        )
    },
)
mistakes(
    "STEPS_THROWN_AWAY",
    "The step is called more often than N times.",
    "Call it once for each of the N steps, and use what it returns.",
    kind="fact",
).around(
    "integrate",
    """
        result = _right(step, accel, q0, v0, t_end, h)
        step(accel, t_end, result[1][-1], result[2][-1], h)
        return result
    """,
)
mistakes(
    "STEPS_LEFT_OUT",
    "The step is called less often than N times.",
    "Call it once for each of the N steps.",
    kind="fact",
)
mistakes(
    "REFUSES_NEARLY_WHOLE",
    "Half a millionth of a step off a whole number is refused already.",
    "With N = round(t_end / h), raise ValueError only if abs(t_end / h - N) > 1e-6.",
    kind="fact",
).edit("integrate", {"> 1e-6": "> 1e-9"})
mistakes(
    "PATH_STANDS_STILL",
    "All rows hold the initial state.",
    "What step returns must get into the next row: q[i + 1], v[i + 1] = step(accel, i * h, q[i], v[i], h).",
).edit("integrate", {"q[i + 1], v[i + 1] = step": "q[i + 1], v[i + 1] = q[i], v[i]\n        step"})
mistakes(
    "POWER_OF_STEP_WRONG",
    "A term has the wrong power of h.",
    "Check the units: a velocity times h is a distance; an acceleration times h is a velocity, and times h squared a distance.",
).edit("rk4_step", {"return v, accel(t, q, v)": "return h * v, h * accel(t, q, v)"})
mistakes(
    "RETURNS_THE_INTERCEPT",
    "The result is where the line meets the axis, or the factor C of the error C * h**p, instead of the slope.",
    "np.polyfit(x, y, 1) returns the slope first. np.polynomial.polynomial.polyfit returns it last.",
).body("observed_order", "return float(np.polyfit(np.log10(hs), np.log10(errors), 1)[1])")
mistakes(
    "RETURNS_ARGUMENT",
    "The result is an array that your code was given: if the caller changes one later, the other changes too.",
    "Return new arrays: q + ... makes one. Where nothing is added, use q.copy().",
    kind="fact",
).body(
    "explicit_euler_step",
    """
        a = accel(t, q, v)
        return (q + h * v if np.any(v) else q), v + h * a
    """,
)
mistakes("STATE_KEPT").program(
    "integrate",
    """
        _right = integrate
        _TIMES = {}


        def integrate(step, accel, q0, v0, t_end, h):
            t, q, v = _right(step, accel, q0, v0, t_end, h)
            return _TIMES.setdefault(len(t), t).copy(), q, v
    """,
)
mistakes(
    "LIMIT_TOO_EARLY",
    "Steps beyond the result are still stable, without a break.",
    "Is 0.05/omega the first step that you look at, and is a step stable up to a spectral radius of 1 + 1e-8? If so, compare the matrix column by column: from (1, 0) and from (0, omega) at the same h, with both resulting velocities divided by omega.",
    kind="consequence",
).edit(
    "max_stable_step",
    {
        "np.linspace(0.05, 10.0, 51)": "np.cumsum([0.1] + [0.05] * 199)",
        "for _ in range(20)": "while high - low > 1e-6",
    },
)
mistakes(
    "ZERO_IS_SPECIAL",
    "A step from rest, or from the origin, follows another formula than one from other states.",
    "Use the same formulas for every state: a body at rest, or at the origin, is accelerated like any other.",
).edit(
    "velocity_verlet_step",
    {"v_half = v + h / 2 * accel(t, q, v)": "v_half = v + h / 2 * accel(t, q, v) if np.any(v) else v"},
).edit(
    "velocity_verlet_step",
    {
        "v_half = v + h / 2 * accel(t, q, v)": (
            "a = accel(t, q, v)\n"
            "    if not np.any(a):\n"
            "        return q + h * v, v + h * a\n"
            "    v_half = v + h / 2 * a"
        )
    },
)
mistakes(
    "END_TIME_OLD_POSITION",
    "accel gets the time t + h with the old position.",
    "Give accel the position that belongs to t + h: v + h*accel(t + h, q_next, v).",
)
mistakes(
    "VERLET_IS_EULER",
    "The steps are those of explicit Euler.",
    "Verlet takes half a kick, then a whole drift with the velocity after that half kick, then another half kick with the acceleration at the new position and time.",
)
mistakes(
    "VERLET_IS_SEMI_IMPLICIT",
    "The steps are those of semi-implicit Euler: the whole kick is on one side of the drift.",
    "Split the kick: half of it before the drift with the old acceleration, and half after it with the new one.",
)
mistakes(
    "RK4_IS_EULER",
    "The steps are those of explicit Euler: only the first slope is used.",
    "Evaluate four slopes, the first at the start, the second and third at the middle and the fourth at the end of the step. Combine them with weights one sixth, one third, one third, one sixth.",
)
mistakes(
    "RK4_IS_MIDPOINT",
    "The steps are those of the midpoint method: only the second slope is used.",
    "The third and the fourth slope count too: the third at the middle, reached with the second, and the fourth at the end, reached with the third. Add k1 + 2*k2 + 2*k3 + k4, over 6.",
)
mistakes(
    "RK4_IS_HEUN",
    "The steps are those of Heun's method, the average of the slopes at the two ends.",
    "Two slopes give order two at most. Add two at the middle of the step, reach the end with the second of these, and take (k1 + 2*k2 + 2*k3 + k4)/6.",
)
mistakes(
    "RK4_IS_VERLET",
    "The steps are those of velocity Verlet.",
    "Runge-Kutta needs four slopes of the whole state (dq = v and dv = accel), each computed from the one before.",
)
for code, method in (
    ("EULER_IS_VERLET", "velocity Verlet"),
    ("EULER_IS_RK4", "RK4"),
    ("EULER_IS_MIDPOINT", "the midpoint method"),
):
    mistakes(
        code,
        f"The steps are those of {method}.",
        "Explicit Euler uses one slope, the one at the start: q + h*v and v + h*accel(t, q, v).",
    )
mistakes(
    "SEMI_IMPLICIT_IS_RK4",
    "The steps are those of RK4.",
    "Semi-implicit Euler takes whole steps: v_next = v + h*accel(t, q, v), then q + h*v_next.",
)
for code, method in (
    ("VERLET_IS_RK4", "RK4"),
    ("VERLET_IS_MIDPOINT", "the midpoint method"),
):
    mistakes(
        code,
        f"The steps are those of {method}.",
        "Kick, drift, kick: v_half = v + h/2*a, q_next = q + h*v_half, v_next = v_half + h/2*accel(t + h, q_next, v_half).",
    )
mistakes(
    "RK4_IS_SEMI_IMPLICIT",
    "The steps are those of semi-implicit Euler.",
    "Compute four slopes, each from the one before, then take (k1 + 2*k2 + 2*k3 + k4)/6.",
)
mistakes(
    "RETURNS_INCREMENT",
    "Your code returns the change of q or of v, or of both, instead of the new values.",
    "Add the changes to the old state.",
)
mistakes(
    "STATE_NOT_ADVANCED",
    "Your code returns the state it was given.",
    "Does the return statement name the values that you computed? Is a factor zero, as 1 // 6 is?",
)
mistakes(
    "WRONG_SIGN",
    "Something is subtracted that should be added: a change of the position, a change of the velocity, or an acceleration.",
    "A velocity or an acceleration already has the right sign: add its terms, whatever the force is.",
)
mistakes(
    "STAGE_TIMES_AHEAD",
    "accel gets the old position with a later time.",
    "Give accel the time of its position: t for q, t + h for q_next.",
)
mistakes(
    "EULER_AVERAGES",
    "The position moves with the mean of the old and the new velocity. Adding h**2/2 times the acceleration does the same.",
    "Explicit Euler moves the position with the old velocity alone: q + h*v. The term with h squared belongs to other methods.",
)
mistakes(
    "QUADRATIC_TERM_MISSING",
    "The position is moved with the old velocity alone.",
    "Drift with the velocity after the first half kick: q + h*(v + h/2*a).",
)
mistakes(
    "KICKS_TOO_LARGE",
    "The kicks are too large: one of them, or both, covers the whole step.",
    "There are two kicks in a step, and each covers h/2.",
)
mistakes(
    "SECOND_KICK_MISSING",
    "The velocity gets the first half kick but not the second.",
    "After the drift, evaluate accel at (t + h, q_next) and add the other half kick.",
)
mistakes(
    "WEIGHTS_MISPLACED",
    "The weights of the four slopes add up to one, but some slopes have the weight of another.",
    "The two middle slopes count double: (k1 + 2*k2 + 2*k3 + k4)/6.",
)
mistakes(
    "WEIGHTS_DO_NOT_ADD_UP",
    "With a constant slope, the step is too long or too short by the same factor for every h, as if the weights of the four slopes did not add up to one.",
    "The weights 1, 2, 2 and 1 add up to 6: divide the sum by 6, once. Every slope is in the sum, and is multiplied once, by the whole h.",
)
mistakes(
    "LAST_STAGE_AT_HALF",
    "The fourth slope is taken half a step ahead, at least in position or in velocity.",
    "The fourth slope belongs to the end of the step: t + h, reached with h times the third slope.",
)
mistakes(
    "STAGES_NOT_CHAINED",
    "A later stage starts from another slope than the one just before it, at least in position or in velocity.",
    "Each stage uses the slope before it, for q and for v: the second uses k1, the third k2, the fourth k3.",
)
mistakes(
    "STAGE_POSITION_IGNORED",
    "accel always gets the position from the start of the step.",
    "Give accel the position of the stage: each stage has its own position and its own velocity.",
)
mistakes(
    "POSITION_SLOPES_FROZEN",
    "Every stage moves the position with the velocity from the start of the step.",
    "Update position and velocity together: in each stage, the slope of q is that stage's velocity, not v.",
)
mistakes(
    "DOES_NOT_CONVERGE",
    "With smaller steps the error hardly falls, or not at all.",
    "Compare q and v of one step with the formula, term by term: sign, factor, power of h, rounding, and what accel is given.",
    kind="consequence",
)
mistakes(
    "ORDER_TOO_LOW",
    "The error falls with the step, but too slowly for this method.",
    "Compare one step with the formula, term by term: sign, factor and power of h, then the time, the position and the velocity that accel is given.",
    kind="consequence",
)
mistakes(
    "ENERGY_SWINGS_TOO_LITTLE",
    "The energy of the spring stays closer to its initial value than with this method.",
    "Compute one step of a spring by hand, from a large q and a large v, and compare both results: each term once, with its factor, and with the old or new value that belongs there.",
    kind="consequence",
)
mistakes(
    "MISSING_EVALUATIONS",
    "accel is called less often than this method needs.",
    "Call accel once for each stage, with that stage's own time, position and velocity: RK4 has four, Verlet one or two, an Euler method one. Keep no value of another stage or of an earlier step.",
    kind="fact",
)
mistakes(
    "TIME_OUTSIDE_STEP",
    "Every time that accel gets lies outside the step, as 0 and h do once t is larger.",
    "The step starts at t, the argument of your function, and ends at t + h: accel gets one of these, or a time in between.",
)
mistakes(
    "FIRST_COMPONENT_ONLY",
    "One component of the acceleration is used for all directions. In one dimension the result is the same.",
    "accel returns an array like q. Add the whole array, h * np.asarray(accel(t, q, v)); do not convert it with float(), and do not take one entry of it.",
)
mistakes(
    "POSITION_NOT_ADVANCED",
    "Your code returns the old position.",
    "Return q_next: the position changes by h times a velocity.",
)
mistakes(
    "VELOCITY_NOT_ADVANCED",
    "Your code returns the old velocity.",
    "Return v_next: the velocity changes by h times an acceleration.",
)
mistakes(
    "NEW_ON_BOTH_SIDES",
    "The acceleration is taken at the new position, and the new velocity then moves the old position again.",
    "One of the two goes first and stays. Position first: q_next = q + h*v, then v + h*accel(t + h, q_next, v). Velocity first: v_next = v + h*accel(t, q, v), then q + h*v_next.",
)
mistakes(
    "SQUARE_TERM_ON_TOP",
    "The position gets a term with h squared besides the new velocity, which contains it already.",
    "Move the position with the new velocity alone: q + h*v_next.",
)
mistakes(
    "ONE_KICK_HALF_WAY",
    "The velocity gets one kick, with the acceleration halfway between q and q_next. That is of second order too, but in general neither symplectic nor reversible.",
    "Take half a kick at each end: v + h/2*(a_old + a_new), with a_new at (t + h, q_next).",
)
mistakes(
    "POSITION_BY_NEW_VELOCITY",
    "The four slopes are averaged for the velocity only; the position moves with the new velocity.",
    "The position has four slopes of its own, the velocities of the stages: average them with the same weights.",
)
mistakes(
    "FACTOR_WRONG",
    "One term has the wrong number in front of it.",
    "Compare each term with the README's formula: which number is in front of it, and is it halved where, and only where, it should be?",
)
mistakes(
    "FEW_DIGITS",
    "A step is right to six digits or more, but not to all of them, as in single precision or after rounding.",
    "Compute in Python's own floats (float64): no np.float32, and no round(). A constant that is typed with few digits does the same: write 1/6, not 0.166667.",
)
mistakes(
    "WEIGHTS_ROUNDED",
    "The four accelerations are weighted by rounded numbers, such as 0.1667 for 1/6.",
    "Write 1/6 and 1/3, or h/6*(...): the error of a rounded weight does not shrink with the step.",
).edit(
    "rk4_step",
    {
        "h / 6 * (dv1 + 2 * dv2 + 2 * dv3 + dv4)": "h * (0.1667 * dv1 + 0.3333 * dv2 + 0.3333 * dv3 + 0.1667 * dv4)"
    },
)
mistakes(
    "KICKS_UNEQUAL",
    "In the new velocity, the two accelerations do not count half each.",
    "It is v + h/2*(a + a'), with a from before the position changes and a' from after.",
).edit(
    "velocity_verlet_step",
    {"h / 2 * accel(t + h, q_next, v_half)": "h / 4 * (accel(t + h, q_next, v_half) + (v_half - v) * 2 / h)"},
)
mistakes(
    "VELOCITY_ALONE_WRONG",
    "After one step the position is right, and the velocity is not.",
    "Compare the line of the velocity with the formula: the old velocity, the factor of h, the time, position and velocity that accel is given, and nothing besides.",
    kind="consequence",
)
mistakes(
    "POSITION_ALONE_WRONG",
    "After one step the velocity is right, and the position is not.",
    "Compare the line of the position with the formula: the old place, the velocity, the factor of h, and nothing besides.",
    kind="consequence",
)
mistakes(
    "TERM_MISSING",
    "One term is missing, so position or velocity is updated without it.",
    "Compare each term with the README's formula: the position, the velocity, and which acceleration is used.",
)
mistakes(
    "STAGE_TIMES_BEHIND",
    "The acceleration is evaluated at a time before the step starts.",
    "A step starts at t and ends at t + h, so no evaluation belongs before t.",
    true_too=("TIME_OUTSIDE_STEP",),
)
mistakes(
    "STAGE_TIMES_WRONG",
    "The acceleration is evaluated at a wrong time of the step, or outside it.",
    "The time of each evaluation belongs to its state: t with the old state, t + h/2 with the state half a step on, t + h with the state at the end.",
)
mistakes(
    "ACCEL_SEES_NO_VELOCITY",
    "accel gets zero instead of the velocity.",
    "Pass a velocity as its third argument. Friction depends on it.",
)
mistakes(
    "ACCEL_SEES_NO_POSITION",
    "accel gets zero instead of the position.",
    "Pass a position as its second argument.",
)
mistakes(
    "MOVES_WITH_THE_CHANGE",
    "The position is moved with the change of the velocity only, not with the velocity.",
    "Move the position with the velocity itself: the old one in explicit Euler, v_next = v + h*a in semi-implicit Euler.",
)
mistakes(
    "MOVES_WITH_ACCELERATION",
    "The position is moved by h times the acceleration, where h times a velocity belongs.",
    "The position changes by h times a velocity, and the velocity by h times an acceleration.",
)
mistakes(
    "KICKED_AGAIN",
    "The velocity that moves the position is not the one that is returned: that one gets the acceleration at the new position.",
    "One call of accel is enough. Velocity first: v_next = v + h*accel(t, q, v), then q + h*v_next, and v_next stays.",
)
mistakes(
    "KICK_NOT_HALF_WAY",
    "The acceleration between the two halves of the drift is not taken at the position half way.",
    "Drift first, m = q + h/2*v, then give accel that position: v + h*accel(t + h/2, m, v).",
)
mistakes(
    "POSITION_MOVED_TWICE",
    "The position is moved twice in one step: once with the old velocity and once with the new one.",
    "Move it once. Explicit Euler: by h*v. Semi-implicit Euler: by h*v_next after a kick at the old position, or by h*v before a kick at the new one.",
)
mistakes(
    "FIRST_KICK_MISSING",
    "The half kick with the acceleration at the start is missing from the velocity.",
    "There is half a kick at each end: v + h/2*(a_old + a_new).",
)
mistakes(
    "END_SEEN_FROM_START",
    "The second acceleration is evaluated at the old position.",
    "The second acceleration belongs to the end of the step: accel(t + h, q_next, ...).",
)
mistakes(
    "END_WITHOUT_SQUARE",
    "The second acceleration is evaluated at q + h*v, which is not where the step ends.",
    "Evaluate it at q_next, which includes the term with h squared.",
)
mistakes(
    "END_IS_THE_CHANGE",
    "The second acceleration is evaluated at the change of the position, not at the new position.",
    "Evaluate it at q_next, which is q plus the change.",
)
mistakes(
    "DRIFTS_WITH_OLD_VELOCITY",
    "The second half of the drift uses the old velocity.",
    "After the kick, drift with the new velocity: q_half + h/2*v_next.",
)
mistakes(
    "DRIFT_HALF_MISSING",
    "Half of the drift is missing: the position moves by one of its two halves only.",
    "Drift twice: m = q + h/2*v before the kick, then q_next = m + h/2*v_next after it.",
)
mistakes(
    "DRIFTS_WITH_MEAN_VELOCITY",
    "The second half of the drift uses the mean of the old and the new velocity.",
    "After the kick, drift with the new velocity: q_half + h/2*v_next.",
)
mistakes(
    "WEIGHT_SIGN_FLIPPED",
    "One of the four slopes is subtracted.",
    "Add all four: k1 + 2 k2 + 2 k3 + k4, over 6.",
    true_too=("WEIGHTS_DO_NOT_ADD_UP",),
)
mistakes(
    "WEIGHTS_DIFFER",
    "The position and the velocity use different weights.",
    "Both use the same weighted mean of their four slopes: 1, 2, 2, 1 over 6.",
)
mistakes(
    "LAST_STAGE_ONLY",
    "Only the last of the four slopes is used.",
    "Take (k1 + 2*k2 + 2*k3 + k4)/6. If you do: is k1 still the first slope by then? One array that every stage fills anew holds only the last.",
)
mistakes(
    "ENDS_ONLY",
    "Only the first and the last slope are used.",
    "The two middle slopes count double: k1 + 2 k2 + 2 k3 + k4, over 6.",
)
mistakes(
    "MIDDLE_ONLY",
    "Only the slopes in the middle of the step are used.",
    "The slopes at the two ends count too: k1 + 2 k2 + 2 k3 + k4, over 6.",
)
mistakes(
    "STAGE_REACH_WRONG",
    "A stage is taken too far along the slope before it, or not far enough.",
    "The second, third and fourth stage are h/2, h/2 and h after the start.",
)
mistakes(
    "STAGE_NOT_MOVED",
    "A stage evaluates the slope with the state at the start of the step instead of one further along, at least in position or in velocity.",
    "The second, third and fourth stage are h/2, h/2 and h after the start, each reached along the slope before it.",
)
mistakes(
    "STEP_COUNT_ROUNDED_UP",
    "The number of steps is rounded up: t_end/h may come out just above a whole number.",
    "Use round(t_end / h), not math.ceil(...). np.arange(0, t_end, h) rounds up, too.",
)
mistakes(
    "TIMES_NOT_AS_ROWS",
    "q has N + 1 rows, and t has another number of entries.",
    "t[i] is i * h for i from 0 to N: np.arange(N + 1) * h. np.arange in steps of h, up to an end, may have one entry too many.",
    kind="fact",
).edit("integrate", {"h * np.arange(n + 1)": "np.arange(0, t_end + h, h)"})
mistakes(
    "COUNT_NOT_ROUNDED",
    "The number of samples is right where h is exact in floating point, as for 1 s in steps of 0.25 s, and can be wrong where h is rounded.",
    "n = round(t_end / h), and n + 1 samples of each: not int(...), // or math.ceil(...), no running sum of h, and no np.arange with a step of h.",
)
mistakes(
    "STEP_RESULT_SWAPPED",
    "In the second row the position is what step returns as the velocity, and the velocity what it returns as the position.",
    "A step returns (q_next, v_next): unpack and store it in this order.",
)
mistakes(
    "ROW_OF_Q_WRONG",
    "After the first step the velocity is right and the position is not.",
    "One call of step gives both: q and v of row i go in, q and v of row i + 1 come out.",
)
mistakes(
    "ROW_OF_V_WRONG",
    "After the first step the position is right and the velocity is not.",
    "One call of step gives both: q and v of row i go in, q and v of row i + 1 come out.",
)
mistakes(
    "TIMES_ROUNDED",
    "The steps get times that are rounded to a few decimals.",
    "Pass i * h as it is: no round().",
).edit("integrate", {"t = h * np.arange(n + 1)": "t = np.round(h * np.arange(n + 1), 3)"})
mistakes(
    "TIMES_NOT_FIRST",
    "The times are not the first of them.",
    "Return (t, q, v): the times first, then the positions, then the velocities.",
    kind="fact",
)
mistakes(
    "LAST_STEP_MISSING",
    "The last row holds nothing but zeros.",
    "n steps fill rows 1 to n: loop over range(n) and write row i + 1.",
)
mistakes(
    "FIRST_STEP_MISSING",
    "Row 1, which is what the first step makes of the initial state, holds nothing but zeros.",
    "Loop over range(n), which begins with 0. Row i + 1 is what step(accel, i * h, q[i], v[i], h) returns.",
).body(
    "integrate",
    """
        n = round(t_end / h)
        if abs(t_end / h - n) > 1e-6:
            raise ValueError
        t, q, v = h * np.arange(n + 1), np.zeros((n + 1, len(q0))), np.zeros((n + 1, len(v0)))
        q[0], v[0] = q0, v0
        q_now, v_now = np.array(q0, float), np.array(v0, float)
        for i in range(1, n):
            q_now, v_now = step(accel, t[i], q_now, v_now, h)
            q[i + 1], v[i + 1] = q_now, v_now
        return t, q, v
    """,
)
mistakes(
    "ROWS_HAVE_FEW_DIGITS",
    "The rows are right to a millionth of the largest number in them, but not to all digits, as in single precision or after rounding.",
    "Keep the states in Python's own floats: np.zeros((N + 1, d)) without np.float32, and no rounding.",
).edit("integrate", {"q = np.empty((n + 1, len(q0)))": "q = np.empty((n + 1, len(q0)), dtype=np.float32)"})
mistakes(
    "SLOPE_WEIGHTED",
    "The result is a slope by least squares in which some points count more than others.",
    "All points count alike: np.polyfit(np.log(hs), np.log(errors), 1), without weights w.",
).body("observed_order", "return float(np.polyfit(np.log(hs), np.log(errors), 1, w=np.asarray(errors))[0])")
mistakes(
    "VELOCITY_NOT_CARRIED",
    "The position is passed on from step to step, but the velocity is not.",
    "Pass on both halves of the state that the step before returned.",
)
mistakes(
    "TIME_AHEAD",
    "The steps get a later time than the one at which they start.",
    "Call step(accel, i * h, q, v, h) with the time at which this particular step starts.",
)
mistakes(
    "OTHER_EXCEPTION",
    "A caller who catches ValueError does not catch that.",
    "Write raise ValueError(...) where your code refuses the duration.",
    kind="fact",
)
mistakes(
    "ROWS_ALL_THE_SAME",
    "All rows hold the same state, and it is not the initial one.",
    "Write into row i alone, or append a copy. q[:] = ... fills every row, and an array that is appended again and again and changed in between ends up in all rows.",
    true_too=("INITIAL_STATE_WRONG",),
)
mistakes(
    "TIMES_ARE_INDICES",
    "The times are the indices of the samples, or all the same number, instead of seconds.",
    "The time of sample i is i * h.",
)
mistakes(
    "TIME_IS_THE_INDEX",
    "The steps get their index, or h each time, instead of the time in seconds.",
    "Step number i starts at i * h.",
)
mistakes(
    "POSITION_NOT_CARRIED",
    "Each step starts from the initial position.",
    "Pass on both halves of the state that the step before returned.",
)
mistakes(
    "HISTORIES_TRANSPOSED",
    "q and v have one column for each sample instead of one row.",
    "Their shape is (N+1, d): row i is the state at time i * h.",
)
mistakes(
    "ORDER_SIGN_FLIPPED",
    "The slope has the other sign, or belongs to other pairs of h and error.",
    "Use log h, not log(1/h), subtract in the same order on both axes, and pair each h with its own error.",
)
mistakes(
    "ORDER_NEGATIVE",
    "The result is negative, although the errors shrink with the steps.",
    "The order is the slope of the straight line through the points (log h, log error). Which number of a fit do you return, and is anything subtracted from it? np.polyfit with degree 1 gives the slope first.",
    kind="consequence",
)
mistakes(
    "LOGARITHMS_MIXED",
    "The result is the slope with logarithms of different bases on the two axes.",
    "Use the same logarithm for both. Its base does not matter, because it cancels.",
)
mistakes(
    "ORDER_THROUGH_ORIGIN",
    "The result is the slope of a line through the origin.",
    "error = C * h**p has an intercept, log C: subtract the mean of each axis first, or fit two coefficients.",
)
mistakes(
    "ORDER_ROUNDED",
    "The slope is rounded.",
    "Return the slope itself as a float, with all its digits.",
)
mistakes(
    "HALVING_ASSUMED",
    "The result is a ratio of errors as a logarithm to base 2, as if each step were half of the one before.",
    "Use the steps as they are: take the slope of log error over log h, through all points.",
)
mistakes(
    "POINTS_LEFT_OUT",
    "The points with small errors are left out.",
    "All points count. Whether some are mere rounding is for the caller to decide.",
)
mistakes(
    "ORDER_OFF_BY_ONE",
    "The order comes out one too large or one too small.",
    "The slope itself is the order: add nothing and subtract nothing.",
)
mistakes(
    "SLOPE_NOT_CENTRED",
    "Of the two sums in the slope, one is taken about the mean and the other is not.",
    "Least squares gives sum (x - mean x)(y - mean y) over sum (x - mean x)**2.",
)
mistakes(
    "SLOPE_BY_SPREADS",
    "The result is a spread, a covariance or a correlation, or a ratio of these, and not the slope.",
    "Least squares gives sum (x - mean x)(y - mean y) over sum (x - mean x)**2. By default np.cov divides by n - 1, and np.var by n.",
)
mistakes(
    "SLOPE_WITHOUT_SIGN",
    "The result is positive, although the slope through these points is negative.",
    "Return the slope with its sign, without abs().",
    kind="consequence",
)
mistakes(
    "SLOPE_CUT_AT_ZERO",
    "The result is 0, although the slope through these points is negative.",
    "Return the slope as it is: errors may grow as h shrinks.",
    kind="consequence",
).around("observed_order", "return max(0.0, _right(hs, errors))")
mistakes(
    "EQUAL_STEPS_LOST",
    "The result is the slope with only the later one of two points of the same step.",
    "All points count: use lists or arrays, hs[i] with errors[i]. A dictionary, for example, would keep one entry for each step.",
).around(
    "observed_order",
    """
        points = {float(h): float(error) for h, error in zip(hs, errors)}
        return _right(list(points), list(points.values()))
    """,
)
mistakes(
    "SLOPE_NEARLY_RIGHT",
    "The slope is near the right one, but not equal to it to nine digits.",
    "Round nothing, keep no number in float32, and add nothing to the errors before the logarithm.",
    kind="consequence",
)
mistakes(
    "STABILITY_BY_DETERMINANT",
    "The limits are those of the determinant, the product of the eigenvalues: one can be large while the other is small.",
    "Look at the largest modulus alone: max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "STABILITY_BY_TRACE",
    "The limits are those of the trace, the sum of the eigenvalues: a complex pair can grow while its sum is small.",
    "Look at the largest modulus: max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "TOLERANCE_TOO_TIGHT",
    "A step counts as unstable although its spectral radius is at most 1 + 1e-8.",
    "Compare max(abs(np.linalg.eigvals(M))) with 1 + 1e-8. A norm of M, or of a power of M, may be larger, and rounding takes the modulus a little above one.",
)
mistakes(
    "NO_ZERO",
    "A step that is not zero is returned for a method that is unstable at 0.05/omega already.",
    "Test h = 0.05/omega first, and return 0.0 if the largest modulus of its eigenvalues exceeds 1 + 1e-8. If your code does that, compare its matrix column by column: from (1, 0) and from (0, omega) at the same h, with both resulting velocities divided by omega.",
    kind="consequence",
)
mistakes(
    "NONE_FOR_ZERO",
    "The result is None for a method that is unstable at 0.05/omega already.",
    "Return 0.0 there.",
    kind="fact",
)
mistakes(
    "NONE_FOR_INFINITY",
    "The result is None for a method that is stable at every step below 10/omega.",
    "Return math.inf there.",
    kind="fact",
)
mistakes(
    "NONE_FOR_LIMIT",
    "The result is None for a method that becomes unstable before 10/omega.",
    "Return the largest stable step. If your None stands for 'never unstable', look at the largest modulus of the eigenvalues, and return math.inf there.",
    kind="fact",
)
mistakes(
    "LIMIT_TOO_LATE",
    "The result lies beyond steps at which the method is unstable.",
    "Look at every step from 0.05/omega on, in increments of less than 0.25/omega. The first whose spectral radius exceeds 1 + 1e-8 is unstable. If your code does that, compare its matrix column by column: from (1, 0) and from (0, omega) at the same h, with both resulting velocities divided by omega.",
    kind="consequence",
)
mistakes(
    "EIGENVALUES_OF_SYMMETRIC",
    "The limits are those of a symmetric matrix, which np.linalg.eigvalsh and np.linalg.eigh take for granted.",
    "The matrix of a step is not symmetric. Use max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "SMALLEST_EIGENVALUE",
    "The limits are those of the smaller eigenvalue.",
    "The largest modulus decides, because that part of the motion prevails after many steps.",
)
mistakes(
    "FIRST_EIGENVALUE",
    "The limits are those of the first of the two eigenvalues, and the second may be larger.",
    "np.linalg.eigvals gives them in no special order: take the largest modulus, max(abs(np.linalg.eigvals(M))).",
).edit("max_stable_step", {"max(abs(np.linalg.eigvals(matrix)))": "abs(np.linalg.eigvals(matrix)[0])"})
mistakes(
    "MODULUS_BY_SUM",
    "The limits are those of |Re| + |Im| of the eigenvalues, which is more than the modulus.",
    "The modulus of a + b i is sqrt(a**2 + b**2): abs() of a complex number, or math.hypot(a, b).",
).edit(
    "max_stable_step",
    {
        "max(abs(np.linalg.eigvals(matrix)))": "max(abs(one.real) + abs(one.imag) for one in np.linalg.eigvals(matrix))"
    },
)
mistakes(
    "ONE_START_DECIDES",
    "The limits are those of one column of the matrix: how far one step takes a single start.",
    "Make the whole matrix, from (1, 0) and from (0, omega). The largest modulus of its eigenvalues says what many steps do.",
).edit("max_stable_step", {"max(abs(np.linalg.eigvals(matrix)))": "np.linalg.norm(np.array(matrix)[:, 0])"})
mistakes(
    "STABILITY_BY_ENTRY",
    "The limits are those of entries of the matrix, not of its eigenvalues.",
    "A step is stable if the largest modulus of the eigenvalues is at most 1 + 1e-8: max(abs(np.linalg.eigvals(M))).",
)
mistakes(
    "TOLERANCE_TOO_LOOSE",
    "Unstable steps count as stable, as with a limit on the spectral radius that is too loose.",
    "Stable means that the spectral radius of one step is at most 1 + 1e-8. A run of many steps does not show growth that slow.",
)
mistakes(
    "SEARCH_IN_SECONDS",
    "The search starts or ends at a fixed h in seconds, such as 0.05 s or 10 s, whatever omega is.",
    "Start at h = 0.05/omega, and end at 10/omega.",
)
mistakes(
    "OMEGA_SQUARED_IN_STEP",
    "h and h*omega are mixed up somewhere: the results have the wrong power of omega.",
    "Search in z = h*omega from 0.05 to 10, call the step with h = z/omega, and return z/omega.",
)
mistakes(
    "START_NOT_SCALED",
    "Velocities are not counted in units of omega both before and after the step, so the matrix is not that of (q, v/omega).",
    "Start from (1, 0) and (0, omega), and divide the resulting velocities by omega.",
)
mistakes(
    "ACCELERATION_WRONG",
    "The limits are those of another spring than a = -omega**2 q.",
    "Call the step with accel = -omega**2 * q.",
)
mistakes(
    "SEARCH_ENDS_EARLY",
    "Some limits are missed that lie far from 0.05/omega, but before 10/omega.",
    "Check every h from 0.05/omega up to 10/omega.",
)


formulas = kit.sibling(__file__, "formulas")
model = kit.sibling(__file__, "integrators")


@mistakes.more
def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    families = formulas.TERMS | {
        "integrate": [(_loop, {}, _LOOP)],
        "observed_order": [],
        "max_stable_step": [(_search, {}, _SEARCH)],
    }
    for task, several in families.items():
        for codes, function in formulas.OTHERS.get(task, ()):
            yield task, codes, function
        for family, base, terms in several:
            for term, forms in terms.items():
                for code, form in forms:
                    yield task, (code,), family(**base | {term: form})
        for family, base, terms in several:
            yield from _pairs(task, family, base, terms)
    for name in ("explicit_euler_step", "semi_implicit_euler_step", "velocity_verlet_step", "rk4_step"):
        own = getattr(model, name)
        yield (
            "integrate",
            ("OTHER_STEP_TAKEN",),
            lambda step, *rest, own=own: model.integrate(own, *rest),
        )
    yield from (("observed_order", (code,), slope) for code, slope in _slopes())
    # After the pairs: two wrong terms of the same formula would give some of these, too.
    yield from (("velocity_verlet_step", (code,), step) for code, step in formulas.drifts())
    yield "max_stable_step", ("LIMIT_NEVER_SEEN",), lambda step, omega: math.inf
    in_seconds = {"probe": lambda z, omega: z, "unit": lambda z, omega: z}
    for way in (in_seconds, {"start": lambda omega: omega}, {"end": lambda omega: omega}):
        yield "max_stable_step", ("SEARCH_IN_SECONDS",), _search(**way)


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    firsts = {term: dict(reversed(forms)).items() for term, forms in terms.items()}
    for one, other in itertools.combinations(terms, 2):
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other]):
            if code != second:
                yield task, (code, second), family(**base | {one: form, other: another})


def _running(t_end, h, overshoot=False):
    t, n = 0.0, 0
    while (t < t_end or (overshoot and t <= t_end)) and n < 1000:
        t, n = t + h, n + 1
    return n


def _running_short(t_end, h):
    """Steps that end at t_end or before it, by a running sum."""
    t, n = 0.0, 0
    while t + h <= t_end:
        t, n = t + h, n + 1
    return n


def _loop(
    count=lambda t_end, h: round(t_end / h),
    refuses=lambda x: abs(x - round(x)) > 1e-6,
    rows="all",
    time=lambda i, h: i * h,
    told=lambda i, h: i * h,
    carries=("q", "v"),
    gives=lambda t, q, v: (t, q, v),
    store=lambda a: np.array(a, dtype=float),
    start=lambda q, v: (q, v),
    size=lambda h: h,
):
    """``told``: the time that a step is given; ``carries``: what is handed on; ``store``: how rows are."""

    def integrate(step, accel, q0, v0, t_end, h):
        if refuses(t_end / h):
            raise ValueError
        q, v = start(np.asarray(q0), np.asarray(v0))
        states = [(q, v)]
        for i in range(count(t_end, h)):
            q_next, v_next = step(accel, told(i, h), q, v, size(h))
            states.append((q_next, v_next))
            q, v = q_next if "q" in carries else q, v_next if "v" in carries else v
        if rows == "later":
            states = states[1:]
        elif rows == "but the last":
            states = states[:-1]
        t = np.array([time(i, h) for i in range(len(states))])
        if rows == "zero first" and states:
            states[0] = tuple(0 * np.asarray(part) for part in states[0])
        if rows == "last empty" and len(states) > 1:
            states[-1] = tuple(0 * np.asarray(part) for part in states[-1])
        if rows == "same" and states:
            states = [states[-1]] * len(states)
        q, v = (store([state[part] for state in states]).reshape(len(states), -1) for part in (0, 1))
        return gives(t, q, v)

    return integrate


_LOOP = {
    "count": (
        ("TRUNCATED_STEP_COUNT", lambda t_end, h: int(t_end / h)),
        ("TRUNCATED_STEP_COUNT", lambda t_end, h: int(t_end // h)),
        ("STEP_COUNT_ROUNDED_UP", lambda t_end, h: math.ceil(t_end / h)),
        ("OFF_BY_ONE_SAMPLE", lambda t_end, h: round(t_end / h) - 1),
        ("OFF_BY_ONE_SAMPLE", lambda t_end, h: round(t_end / h) + 1),
        ("OFF_BY_ONE_SAMPLE", lambda t_end, h: int(t_end / h) + 1),
        ("TRUNCATED_AND_SHORT", lambda t_end, h: int(t_end / h) - 1),
        ("TRUNCATED_AND_SHORT", lambda t_end, h: int(t_end // h) - 1),
        *formulas.each("TIME_ACCUMULATES", _running, _running_short),
        ("TIME_ACCUMULATES", lambda t_end, h: _running(t_end, h, overshoot=True)),
        ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end + h, h)) - 1),
        ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end, h)) - 1),
        ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end, h))),
    ),
    "refuses": (
        ("REFUSES_NO_DURATION", lambda x: x <= 0),
        ("DURATION_NOT_CHECKED", lambda x: False),
        ("DURATION_LIMIT_TOO_WIDE", lambda x: abs(x - round(x)) > 0.01),
        ("DURATION_CHECKED_ON_ONE_SIDE", lambda x: x - round(x) > 1e-6),
        *formulas.each("REFUSES_DIVISIBLE", lambda x: x != round(x), lambda x: x % 1 > 1e-6),
        ("REFUSES_DIVISIBLE", lambda x: int(x) != x),
    ),
    "rows": (
        ("INITIAL_STATE_MISSING", "zero first"),
        *formulas.each("OFF_BY_ONE_SAMPLE", "later", "but the last"),
        ("LAST_STEP_MISSING", "last empty"),
        ("ROWS_ALL_THE_SAME", "same"),
    ),
    "time": (
        ("TIMES_START_LATE", lambda i, h: (i + 1) * h),
        *formulas.each("TIMES_ARE_INDICES", lambda i, h: float(i), lambda i, h: h),
    ),
    "told": (
        ("TIME_NOT_PASSED", lambda i, h: 0.0),
        *formulas.each("TIME_AHEAD", lambda i, h: (i + 1) * h, lambda i, h: (i + 0.5) * h),
        *formulas.each("TIME_IS_THE_INDEX", lambda i, h: float(i), lambda i, h: h),
    ),
    "carries": (
        ("STATE_NOT_CARRIED", ()),
        ("VELOCITY_NOT_CARRIED", ("q",)),
        ("POSITION_NOT_CARRIED", ("v",)),
    ),
    "gives": (
        ("HISTORIES_SWAPPED", lambda t, q, v: (t, v, q)),
        *formulas.each("HISTORIES_IDENTICAL", lambda t, q, v: (t, v, v), lambda t, q, v: (t, q, q)),
        ("HISTORIES_TRANSPOSED", lambda t, q, v: (t, q.T, v.T)),
    ),
    "store": (("INTEGER_STATE", lambda a: np.array(a).astype(int).astype(float)),),
    "start": (
        *formulas.each("INITIAL_STATE_WRONG", lambda q, v: (0.0 * q, 0.0 * v), lambda q, v: (q, 0.0 * v)),
        *formulas.each("INITIAL_STATE_WRONG", lambda q, v: (v, q), lambda q, v: (0.0 * q + 1, 0.0 * v)),
    ),
    "size": (("STEP_GIVEN_WRONG", lambda h: 1.0), ("STEP_GIVEN_WRONG", lambda h: h / 2)),
}


def _slope(x, y):
    x = x - np.mean(x)
    return float(x @ y / (x @ x))


def _origin(x, y):
    return float(x @ y / (x @ x))


def _slopes():
    """Codes and wrong slopes through (hs, errors)."""

    def on(kind, by=_slope, first=np.log, second=np.log):
        return kind, lambda hs, errors: by(first(np.asarray(hs)), second(np.asarray(errors)))

    def same(x):
        return np.asarray(x, dtype=float)

    def apart(mean):
        return lambda x, y: float(mean(np.diff(y) / np.diff(x)))

    def every_pair(mean):
        def of(x, y):
            i, j = np.triu_indices(len(x), 1)
            return float(mean((y[j] - y[i]) / (x[j] - x[i])))

        return of

    def by_size(mean):
        return lambda x, y: apart(mean)(x[np.argsort(x)], y[np.argsort(x)])

    yield on("ORDER_ROUNDED", lambda x, y: float(round(_slope(x, y))))
    yield on("ORDER_ROUNDED", lambda x, y: float(int(_slope(x, y))))
    yield on("ORDER_SLOPE_INVERTED", lambda x, y: _slope(y, x))
    yield on("ORDER_SLOPE_INVERTED", lambda x, y: 1 / _slope(x, y))
    yield on("ORDER_SIGN_FLIPPED", lambda x, y: -_slope(x, y))
    yield on("ORDER_SIGN_FLIPPED", lambda x, y: _slope(x[::-1], y))
    yield on("LOGARITHM_MISSING", first=same, second=same)
    yield on("LOGARITHM_MISSING", first=same)
    yield on("LOGARITHM_MISSING", second=same)
    for first, second in itertools.permutations((np.log, np.log10, np.log2), 2):
        yield on("LOGARITHMS_MIXED", first=first, second=second)
    for i, j in itertools.combinations(range(5), 2):
        ends = lambda x, y, i=i, j=j: float((y[j] - y[i]) / (x[j] - x[i])) if len(x) > j else _slope(x, y)  # noqa: E731
        yield on("ORDER_FROM_ENDS", ends)
    yield on("ORDER_FROM_ENDS", lambda x, y: float((y[-1] - y[0]) / (x[-1] - x[0])))
    yield on("ORDER_FROM_ENDS", lambda x, y: float((y[1] - y[0]) / (x[1] - x[0])))
    yield on("ORDER_FROM_ENDS", lambda x, y: float((y[-1] - y[-2]) / (x[-1] - x[-2])))
    yield on("ORDER_FROM_ENDS", lambda x, y: float((y[x.argmax()] - y[x.argmin()]) / (x.max() - x.min())))
    for i in (0, -1):  # the two smallest steps, the two largest
        yield on("ORDER_FROM_ENDS", by_size(lambda slopes, i=i: slopes[i]))
    yield on("ORDER_THROUGH_ORIGIN", _origin)
    yield on("ORDER_THROUGH_ORIGIN", lambda x, y: float(np.mean(y / x)))
    for mean in (np.mean, np.median, np.max, np.min):
        yield on("ORDER_MEAN_OF_PAIRS", apart(mean))
        yield on("ORDER_MEAN_OF_PAIRS", by_size(mean))
    yield on("ORDER_MEAN_OF_PAIRS", lambda x, y: float(np.mean(np.diff(y)) / np.mean(np.diff(x))))
    yield on("ORDER_MEAN_OF_PAIRS", lambda x, y: float(np.mean(np.gradient(y, x))))
    for mean in (np.mean, np.median):
        yield on("ORDER_MEAN_OF_PAIRS", every_pair(mean))
    yield on("ORDER_OF_THE_OTHER_AXIS", lambda x, y: 1 / _slope(y, x))
    for power in (-1, -0.5, 0.5, 1):  # of the errors, of the steps
        yield on("SLOPE_WEIGHTED", lambda x, y, p=power: float(np.polyfit(x, y, 1, w=np.exp(p * y))[0]))
        yield on("SLOPE_WEIGHTED", lambda x, y, p=power: float(np.polyfit(x, y, 1, w=np.exp(p * x))[0]))
    yield on("HALVING_ASSUMED", lambda x, y: float(np.mean(-np.diff(y)) / np.log(2)))
    yield on("HALVING_ASSUMED", lambda x, y: float(np.mean(np.diff(y[np.argsort(x)])) / np.log(2)))
    yield on("HALVING_ASSUMED", lambda x, y: float((y[0] - y[-1]) / np.log(2)))
    yield on("HALVING_ASSUMED", lambda x, y: float((y[0] - y[1]) / np.log(2)))
    yield on("PAIRS_BROKEN", lambda x, y: _slope(np.sort(x), np.sort(y)))
    yield on("PAIRS_BROKEN", lambda x, y: _slope(np.sort(x), y))
    for least in (1e-6, 1e-8, 1e-10, 1e-12, 1e-14):
        yield on("POINTS_LEFT_OUT", lambda x, y, low=math.log(least): _slope(x[y > low], y[y > low]))
    yield on("ORDER_OFF_BY_ONE", lambda x, y: _slope(x, y) - 1)
    yield on("ORDER_OFF_BY_ONE", lambda x, y: _slope(x, y) + 1)
    yield on("SLOPE_NOT_CENTRED", lambda x, y: float((x - x.mean()) @ y / (x @ x)))
    yield on("SLOPE_NOT_CENTRED", lambda x, y: float(x @ (y - y.mean()) / (x @ x)))
    yield on("SLOPE_BY_SPREADS", lambda x, y: float(np.std(y) / np.std(x)))
    yield on("SLOPE_BY_SPREADS", lambda x, y: float(np.corrcoef(x, y)[0, 1]))
    yield on("SLOPE_BY_SPREADS", lambda x, y: float(np.cov(x, y)[0, 1] / np.var(x)))
    yield on("SLOPE_BY_SPREADS", lambda x, y: float(np.mean((x - x.mean()) * y)))
    yield on("RETURNS_THE_INTERCEPT", lambda x, y: float(np.mean(y) - _slope(x, y) * np.mean(x)))
    yield on("RETURNS_THE_INTERCEPT", lambda x, y: float(np.exp(np.mean(y) - _slope(x, y) * np.mean(x))))


def _radius(m):
    return max(abs(np.linalg.eigvals(m)))


def _search(
    size=_radius,
    limit=1 + 1e-8,
    unit=lambda z, omega: z / omega,
    first=0.05,
    last=10.0,
    zero=0.0,
    none=math.inf,
    above=False,
    dz=0.05,
    scales=(1, 1, 1),
    start=lambda omega: 1.0,
    end=lambda omega: 1.0,
    force=lambda omega: omega**2,
    probe=lambda z, omega: z / omega,
):
    """``size`` of the map must not exceed ``limit``.

    ``scales``: powers of omega in the unit of the second start's velocity, and of the two that come out.
    """

    def largest(step, omega):
        def accel(t, q, v):
            return -force(omega) * q

        def stable(z):
            h = probe(z, omega)
            given, *rates = (omega**power for power in scales)
            zero_, one = np.zeros(1), np.ones(1)
            columns = [step(accel, 0.0, one, zero_, h), step(accel, 0.0, zero_, given * one, h)]
            rows = zip(columns, rates, strict=True)
            m = np.array([[float(c[0][0]), float(c[1][0]) / rate] for c, rate in rows]).T
            return size(m) <= limit

        begin = first * start(omega)
        if above:
            z = last
            while z > first and not stable(z):
                z -= dz
            return (none if z == last else unit(z, omega)) if z > first else zero
        if not stable(begin):
            return zero if zero is not None else unit(begin, omega)
        low = begin
        while stable(low + dz):
            low += dz
            if low >= last * end(omega):
                return none if none is not None else unit(low, omega)
        high = low + dz
        for _ in range(20):
            middle = (low + high) / 2
            low, high = (middle, high) if stable(middle) else (low, middle)
        return unit(low, omega)

    return largest


def _norm(order):
    return lambda m: np.linalg.norm(m, order)


_SEARCH = {
    "size": (
        *(("STABILITY_BY_NORM", _norm(order)) for order in (2, np.inf, 1, "fro")),
        ("STABILITY_BY_NORM", lambda m: np.linalg.norm(m, axis=0).max()),
        ("STABILITY_BY_DETERMINANT", lambda m: abs(np.linalg.det(m))),
        ("STABILITY_BY_DETERMINANT", lambda m: math.sqrt(abs(np.linalg.det(m)))),
        *formulas.each("STABILITY_BY_TRACE", lambda m: abs(np.trace(m)) / 2, lambda m: np.trace(m) / 2),
        ("EIGENVALUES_WITHOUT_MODULUS", lambda m: np.linalg.eigvals(m).real.max()),
        ("EIGENVALUES_WITHOUT_MODULUS", lambda m: abs(np.linalg.eigvals(m).real).max()),
        ("EIGENVALUES_WITHOUT_MODULUS", lambda m: abs(np.linalg.eigvals(m).max())),
        ("EIGENVALUES_OF_SYMMETRIC", lambda m: max(abs(np.linalg.eigvalsh(m)))),
        ("SMALLEST_EIGENVALUE", lambda m: min(abs(np.linalg.eigvals(m)))),
        ("FIRST_EIGENVALUE", lambda m: abs(np.linalg.eigvals(m)[0])),
        ("MODULUS_BY_SUM", lambda m: max(abs(e.real) + abs(e.imag) for e in np.linalg.eigvals(m))),
        ("ONE_START_DECIDES", lambda m: np.linalg.norm(m[:, 0])),
        ("ONE_START_DECIDES", lambda m: np.linalg.norm(m[:, 1])),
        *formulas.each("STABILITY_BY_ENTRY", lambda m: abs(m[0, 0]), lambda m: np.abs(m).max()),
    ),
    "limit": (
        ("TOLERANCE_TOO_TIGHT", 1.0 - 1e-12),
        *formulas.each("TOLERANCE_TOO_LOOSE", 1.001, 1.05, 1.01, 1.1, 2.0),
        *(("TOLERANCE_TOO_LOOSE", 1 + more) for more in (1e-4, 1e-5, 1e-6)),
    ),
    "unit": (
        ("RETURNS_Z", lambda z, omega: z),
        *formulas.each("OMEGA_SQUARED_IN_STEP", lambda z, omega: z / omega**2, lambda z, omega: z * omega),
    ),
    "zero": (("NO_ZERO", None),),
    "none": (("NO_INFINITY", None), ("NO_INFINITY", 0.0)),
    "above": (("LARGEST_STABLE_STEP", True),),
    "scales": formulas.each(
        "START_NOT_SCALED", (0, 1, 1), (1, 0, 0), (1, -1, -1), (0, 0, 1), (0, 1, 0), (1, 1, 0), (1, 0, 1)
    ),
    "force": (*formulas.each("ACCELERATION_WRONG", lambda omega: omega, lambda omega: 1.0),),
    "probe": (("OMEGA_SQUARED_IN_STEP", lambda z, omega: z),),
    "dz": tuple(("LARGEST_STABLE_STEP", dz) for dz in (1.0, 2.5, 4.975, 9.95)),
    "last": (("SEARCH_ENDS_EARLY", 1.7), ("SEARCH_ENDS_EARLY", 2.5)),
}
