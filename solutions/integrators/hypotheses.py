"""Wrong programs for the tasks of ``integrators``, as functions: what a diagnosis is compared with.

Steps are made from the terms in ``formulas.py``; the loop and the two instruments from those below.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.scoring import kit

formulas = kit.sibling(__file__, "formulas")

#: What else is true of a program with a mistake, by its code.
ALSO = {
    "INITIAL_STATE_WRONG": ("INITIAL_STATE_MISSING",),
    "ROWS_ALL_THE_SAME": ("INITIAL_STATE_WRONG",),
    "TRUNCATED_AND_SHORT": ("OFF_BY_ONE_SAMPLE",),
    "WEIGHT_SIGN_FLIPPED": ("WEIGHTS_DO_NOT_ADD_UP",),
    "STAGE_TIMES_BEHIND": ("TIME_OUTSIDE_STEP",),
}


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
    yield from (("observed_order", (code,), slope) for code, slope in _slopes())
    yield "max_stable_step", ("LIMIT_NEVER_SEEN",), lambda step, omega: math.inf


def _pairs(task, family, base, terms):
    """Two terms wrong at once, each in the first form of its code."""
    firsts = {term: dict(reversed(forms)).items() for term, forms in terms.items()}
    for one, other in itertools.combinations(terms, 2):
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other]):
            if code != second:
                yield task, (code, second), family(**base | {one: form, other: another})


# -- the loop -----------------------------------------------------------------------------------------


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
        ("TIME_ACCUMULATES", _running),
        ("TIME_ACCUMULATES", _running_short),
        ("TIME_ACCUMULATES", lambda t_end, h: _running(t_end, h, overshoot=True)),
        ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end + h, h)) - 1),
        ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end, h)) - 1),
        ("TIME_ACCUMULATES", lambda t_end, h: len(np.arange(0, t_end, h))),
    ),
    "refuses": (
        ("REFUSES_NO_DURATION", lambda x: x <= 0),
        ("DURATION_NOT_CHECKED", lambda x: False),
        ("DURATION_NOT_CHECKED", lambda x: abs(x - round(x)) > 0.01),
        ("DURATION_NOT_CHECKED", lambda x: abs(x - round(x)) > 0.1),
        ("REFUSES_DIVISIBLE", lambda x: x != round(x)),
        ("REFUSES_DIVISIBLE", lambda x: x % 1 > 1e-6),
        ("REFUSES_DIVISIBLE", lambda x: int(x) != x),
    ),
    "rows": (
        ("INITIAL_STATE_MISSING", "zero first"),
        ("OFF_BY_ONE_SAMPLE", "later"),
        ("OFF_BY_ONE_SAMPLE", "but the last"),
        ("LAST_STEP_MISSING", "last empty"),
        ("ROWS_ALL_THE_SAME", "same"),
    ),
    "time": (
        ("TIMES_START_LATE", lambda i, h: (i + 1) * h),
        ("TIMES_ARE_INDICES", lambda i, h: float(i)),
        ("TIMES_ARE_INDICES", lambda i, h: h),
    ),
    "told": (
        ("TIME_NOT_PASSED", lambda i, h: 0.0),
        ("TIME_AHEAD", lambda i, h: (i + 1) * h),
        ("TIME_AHEAD", lambda i, h: (i + 0.5) * h),
        ("TIME_IS_THE_INDEX", lambda i, h: float(i)),
        ("TIME_IS_THE_INDEX", lambda i, h: h),
    ),
    "carries": (
        ("STATE_NOT_CARRIED", ()),
        ("VELOCITY_NOT_CARRIED", ("q",)),
        ("POSITION_NOT_CARRIED", ("v",)),
    ),
    "gives": (
        ("HISTORIES_SWAPPED", lambda t, q, v: (t, v, q)),
        ("HISTORIES_IDENTICAL", lambda t, q, v: (t, v, v)),
        ("HISTORIES_IDENTICAL", lambda t, q, v: (t, q, q)),
        ("HISTORIES_TRANSPOSED", lambda t, q, v: (t, q.T, v.T)),
    ),
    "store": (("INTEGER_STATE", lambda a: np.array(a).astype(int).astype(float)),),
    "start": (
        ("INITIAL_STATE_WRONG", lambda q, v: (0.0 * q, 0.0 * v)),
        ("INITIAL_STATE_WRONG", lambda q, v: (q, 0.0 * v)),
        ("INITIAL_STATE_WRONG", lambda q, v: (v, q)),
        ("INITIAL_STATE_WRONG", lambda q, v: (0.0 * q + 1, 0.0 * v)),
    ),
    "size": (("STEP_GIVEN_WRONG", lambda h: 1.0), ("STEP_GIVEN_WRONG", lambda h: h / 2)),
}

# -- the slope ----------------------------------------------------------------------------------------


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


# -- the largest stable step --------------------------------------------------------------------------


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
    scales="both",
    start=1.0,
    force=lambda omega: omega**2,
    probe=lambda z, omega: z / omega,
):
    """``size`` of the map must not exceed ``limit``.

    ``scales``: where velocities are counted in units of omega, going "in", coming "out", or "both".
    """

    def largest(step, omega):
        def accel(t, q, v):
            return -force(omega) * q

        def stable(z):
            h = probe(z, omega)
            given, rate = (1.0 if scales == side else omega for side in ("out", "in"))
            zero_, one = np.zeros(1), np.ones(1)
            columns = [step(accel, 0.0, one, zero_, h), step(accel, 0.0, zero_, given * one, h)]
            m = np.array([[float(c[0][0]) for c in columns], [float(c[1][0]) / rate for c in columns]])
            return size(m) <= limit

        if above:
            z = last
            while z > first and not stable(z):
                z -= dz
            return (none if z == last else unit(z, omega)) if z > first else zero
        if not stable(first):
            return zero if zero is not None else unit(first, omega)
        low = first
        while stable(low + dz):
            low += dz
            if low >= last:
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
        ("STABILITY_BY_DETERMINANT", lambda m: abs(np.linalg.det(m))),
        ("STABILITY_BY_TRACE", lambda m: abs(np.trace(m)) / 2),
        ("STABILITY_BY_TRACE", lambda m: np.trace(m) / 2),
        ("EIGENVALUES_WITHOUT_MODULUS", lambda m: np.linalg.eigvals(m).real.max()),
        ("EIGENVALUES_WITHOUT_MODULUS", lambda m: abs(np.linalg.eigvals(m).real).max()),
        ("SMALLEST_EIGENVALUE", lambda m: min(abs(np.linalg.eigvals(m)))),
        ("STABILITY_BY_ENTRY", lambda m: abs(m[0, 0])),
        ("STABILITY_BY_ENTRY", lambda m: np.abs(m).max()),
    ),
    "limit": (
        ("TOLERANCE_TOO_TIGHT", 1.0 - 1e-12),
        ("TOLERANCE_TOO_LOOSE", 1.001),
        ("TOLERANCE_TOO_LOOSE", 1.05),
        ("TOLERANCE_TOO_LOOSE", 1.01),
        ("TOLERANCE_TOO_LOOSE", 1.1),
        ("TOLERANCE_TOO_LOOSE", 2.0),
    ),
    "unit": (
        ("RETURNS_Z", lambda z, omega: z),
        ("OMEGA_SQUARED_IN_STEP", lambda z, omega: z / omega**2),
        ("OMEGA_SQUARED_IN_STEP", lambda z, omega: z * omega),
    ),
    "zero": (("NO_ZERO", None),),
    "none": (("NO_INFINITY", None), ("NO_INFINITY", 0.0)),
    "above": (("LARGEST_STABLE_STEP", True),),
    "scales": (("START_NOT_SCALED", "out"), ("START_NOT_SCALED", "in")),
    "force": (
        ("ACCELERATION_WRONG", lambda omega: omega),
        ("ACCELERATION_WRONG", lambda omega: 1.0),
    ),
    "probe": (("OMEGA_SQUARED_IN_STEP", lambda z, omega: z),),
    "dz": tuple(("LARGEST_STABLE_STEP", dz) for dz in (1.0, 2.5, 4.975, 9.95)),
    "last": (("SEARCH_ENDS_EARLY", 1.7), ("SEARCH_ENDS_EARLY", 2.5)),
}
