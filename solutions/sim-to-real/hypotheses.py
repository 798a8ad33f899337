"""Wrong programs for the tasks of ``sim-to-real``, as functions: on them it is tried what mistakes are told.

Each is the model solution's way with one thing, or two, in another form.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.scoring import kit

model = kit.sibling(__file__, "sim_to_real")
NAMES = model.NAMES


def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for task, family, terms in (
        ("plan", _plan, _PLAN),
        ("design_excitation", _excitation, _EXCITATION),
        ("identify", _identify, _IDENTIFY),
        ("tune", _tune, _TUNE),
    ):
        for term, forms in terms.items():
            for code, form in forms:
                yield task, (code,), family(**{term: form})
    firsts = {term: dict(reversed(forms)).items() for term, forms in _PLAN.items()}
    for one, other in itertools.combinations(_PLAN, 2):
        for (code, form), (second, another) in itertools.product(firsts[one], firsts[other]):
            if code != second:
                yield "plan", (code, second), _plan(**{one: form, other: another})


# -- plan -----------------------------------------------------------------------------------------------


def _plan(
    box=lambda w: [math.exp(-w), math.exp(w)],
    left_out=(),
    seconds=20.0,
    promise=0.94,
    metric="success",
    **gap,
):
    """``gap``: what is changed of the plan's second gap; ``gaps``: which of them are kept."""
    kept = gap.pop("gaps", slice(None))
    changed = gap.pop("gap", {})

    def plan():
        found = model.plan()
        found["gaps"][1].update(changed)
        return {
            **found,
            "gaps": found["gaps"][kept],
            "excitation_budget_s": seconds,
            "randomization": {k: box(w) for k, w in model.LOG_WIDTH.items() if k not in left_out},
            "metric": metric,
            "threshold": promise,
        }

    return plan


def _gap(parameter, source, estimator, excitation="prbs", **rest):
    return {
        "parameter": parameter,
        "source": source,
        "estimator": estimator,
        "excitation": excitation,
        **rest,
    }


_LEAST = "integral_least_squares"
_PLAN = {
    "box": (
        ("BOX_TOO_WIDE", lambda w: [math.exp(-2 * w), math.exp(2 * w)]),
        ("BOX_TOO_WIDE", lambda w: [0.2, 5.0]),
        ("BOX_TOO_NARROW", lambda w: [1.0, 1.0]),
        ("BOX_TOO_NARROW", lambda w: [math.exp(-w / 2), math.exp(w / 2)]),
        ("BOX_TOO_NARROW", lambda w: [1.0, math.exp(w)]),
        ("BOX_TOO_NARROW", lambda w: [0.9, 1.1]),
        ("BOX_IS_LINEAR", lambda w: [1 - w, 1 + w]),
        ("BOX_IN_LOGARITHMS", lambda w: [-w, w]),
        ("BOX_REVERSED", lambda w: [math.exp(w), math.exp(-w)]),
        ("BOX_REVERSED", lambda w: [0.0, math.exp(w)]),
    ),
    "left_out": (("BOX_LACKS", ("latency",)), ("BOX_LACKS", ("tau", "latency"))),
    "seconds": (
        ("BUDGET_EXCEEDED", 60.0),
        ("BUDGET_EXCEEDED", 0.0),
        ("BUDGET_TOO_SHORT", 0.5),
    ),
    "promise": (
        ("PROMISE_TOO_SMALL", 0.5),
        ("PROMISE_NOT_A_SHARE", 94.0),
        ("PROMISE_OF_PERFECTION", 1.0),
    ),
    "metric": (("METRIC_DOES_NOT_JUDGE", "relative_error"), ("METRIC_DOES_NOT_JUDGE", "settling time")),
    "gaps": (("TOO_FEW_GAPS", slice(2)), ("TOO_FEW_GAPS", slice(0))),
    "gap": (
        ("UNKNOWN_WORD", {"excitation": "white noise"}),
        ("UNKNOWN_WORD", {"unit": "percent"}),
        ("UNKNOWN_WORD", {"parameter": "viscous friction"}),
        ("SOURCE_NOT_HERE", _gap("play", "gear_backlash", "standard_deviation")),
        ("PARAMETER_OF_ANOTHER_SOURCE", _gap("m", "friction", _LEAST, threshold=3.0)),
        ("PARAMETER_OF_ANOTHER_SOURCE", _gap("tau", "delay", "delay_grid")),
        ("ESTIMATOR_CANNOT", _gap("b", "friction", "delay_grid")),
        ("ESTIMATOR_CANNOT", _gap("lag", "delay", _LEAST)),
        ("EXCITATION_CANNOT_SHOW", _gap("Fc", "friction", _LEAST, "rest")),
        ("EXCITATION_CANNOT_SHOW", _gap("lag", "delay", "delay_grid", "constant")),
        ("EXCITATION_CANNOT_SHOW", _gap("noise", "sensor_noise", "standard_deviation", "prbs")),
        ("PROMISES_TOO_MUCH", _gap("b", "friction", _LEAST, threshold=0.1, unit="%")),
        ("PROMISES_TOO_MUCH", _gap("b", "friction", _LEAST, threshold=0.05, unit="%")),
        ("PROMISES_TOO_LITTLE", _gap("b", "friction", _LEAST, threshold=50.0, unit="%")),
        ("PROMISES_TOO_LITTLE", _gap("b", "friction", _LEAST, threshold=5.0, unit="1")),
    ),
}

# -- design_excitation ----------------------------------------------------------------------------------


def _excitation(count=lambda s: round(100 * s), force=lambda u_max: u_max, wave=None, active=lambda u: u):
    def design_excitation(budget_s, u_max, rng):
        n = count(budget_s)
        t = 0.01 * np.arange(n)
        signs = np.repeat(rng.choice([-1.0, 1.0], n), rng.integers(10, 60, n))[:n]
        return active(force(u_max) * (signs if wave is None else wave(t, rng)))

    return design_excitation


def _first(seconds):
    def active(u):
        return np.where(np.arange(len(u)) < 100 * seconds, u, 0.0)

    return active


_EXCITATION = {
    "count": (
        ("WRONG_LENGTH", lambda s: int(100 * s)),
        ("WRONG_LENGTH", lambda s: 2000),
        ("WRONG_LENGTH", lambda s: round(1000 * s)),
        ("WRONG_LENGTH", lambda s: round(100 * s) + 1),
    ),
    "force": (
        ("EXCITATION_SATURATES", lambda u_max: 3.0),
        ("EXCITATION_SATURATES", lambda u_max: 2 * u_max),
        ("EXCITATION_TOO_WEAK", lambda u_max: 0.1 * u_max),
        ("EXCITATION_TOO_WEAK", lambda u_max: 0.25 * u_max),
    ),
    "wave": (
        ("EXCITATION_TOO_SLOW", lambda t, rng: np.sin(2 * np.pi * 0.05 * t)),
        ("EXCITATION_TOO_FAST", lambda t, rng: np.sin(2 * np.pi * 8 * t)),
        ("EXCITATION_TOO_FAST", lambda t, rng: rng.uniform(-1, 1, len(t))),
        ("EXCITATION_TOO_FAST", lambda t, rng: rng.choice([-1.0, 1.0], len(t))),
        ("EXCITATION_CONSTANT", lambda t, rng: np.ones(len(t))),
        ("EXCITATION_RESTS", lambda t, rng: np.where(t < 2.0, 1.0, 0.0)),
        ("EXCITATION_ZERO", lambda t, rng: np.zeros(len(t))),
    ),
    "active": (("EXCITATION_RESTS", _first(2.0)),),
}

# -- identify -------------------------------------------------------------------------------------------


def _identify(read=lambda t, u, y: (t, u, y), told=lambda found: found):
    """``read``: what the fit is given; ``told``: what is made of its six entries [value, low, high]."""

    def identify(t, u, y):
        return told(model.identify(*read(t, u, y)))

    return identify


def _values(change):
    """Entries with other values, each as wide as before."""

    def told(found):
        values = change({k: entry[0] for k, entry in found.items()})
        return {k: [values[k] + x - found[k][0] for x in found[k]] for k in found}

    return told


def _widths(change):
    def told(found):
        return {k: [v, v - change(k, v, h - v), v + change(k, v, h - v)] for k, (v, _, h) in found.items()}

    return told


_FIXED = {"m": 0.029, "b": 0.19, "Fc": 0.19, "tau": 0.19, "latency": 0.19, "lag": 0.19}
_SHEET = {"m": 1.5, "b": 0.6, "Fc": 0.4, "tau": 0.06, "latency": 0.08, "lag": 0.14}
_IDENTIFY = {
    "read": (
        ("FORCE_SCALED", lambda t, u, y: (t, u / 3.0, y)),
        ("FORCE_SCALED", lambda t, u, y: (t, 2.0 * u, y)),
    ),
    "told": (
        ("MASS_INVERTED", _values(lambda v: {**v, "m": 1 / v["m"]})),
        (
            "COEFFICIENTS_NOT_PARAMETERS",
            _values(lambda v: {**v, "b": v["b"] / v["m"], "Fc": v["Fc"] / v["m"]}),
        ),
        ("FRICTION_SIGN", _values(lambda v: {**v, "b": -v["b"], "Fc": -v["Fc"]})),
        ("FRICTIONS_SWAPPED", _values(lambda v: {**v, "b": v["Fc"], "Fc": v["b"]})),
        ("VISCOUS_MISSING", _values(lambda v: {**v, "b": 1e-3})),
        ("COULOMB_MISSING", _values(lambda v: {**v, "Fc": 1e-3 * v["m"]})),
        (
            "UNITS_NOT_SECONDS",
            _values(lambda v: {**v, **{k: 1000 * v[k] for k in ("tau", "latency", "lag")}}),
        ),
        ("UNITS_NOT_SECONDS", _values(lambda v: {**v, **{k: 100 * v[k] for k in ("tau", "latency", "lag")}})),
        ("LAG_NOT_SUM", _values(lambda v: {**v, "lag": v["tau"]})),
        ("LAG_NOT_SUM", _values(lambda v: {**v, "lag": v["latency"]})),
        ("LAG_NOT_SUM", _values(lambda v: {**v, "lag": v["latency"] - v["tau"]})),
        ("ESTIMATE_HARD_CODED", _values(lambda v: _SHEET)),
        ("TIME_FROM_SHEET", _values(lambda v: {**v, "tau": 0.06, "lag": 0.06 + v["latency"]})),
        ("PARAMETER_FIXED", _values(lambda v: {**v, "latency": 0.1, "lag": v["tau"] + 0.1})),
        ("PARAMETER_FIXED", _values(lambda v: {**v, "Fc": 0.3})),
        ("INTERVAL_REVERSED", lambda found: {k: [v, h, low] for k, (v, low, h) in found.items()}),
        ("INTERVAL_REVERSED", lambda found: {k: [v, low - v, h - v] for k, (v, low, h) in found.items()}),
        ("INTERVAL_WITHOUT_WIDTH", _widths(lambda k, v, w: 0.0)),
        ("INTERVAL_OVERCONFIDENT", _widths(lambda k, v, w: w / 20)),
        ("INTERVAL_WITHOUT_RECORDING", _widths(lambda k, v, w: _FIXED[k] * v)),
        ("INTERVAL_USELESS", _widths(lambda k, v, w: 20 * w)),
    ),
}

# -- tune -----------------------------------------------------------------------------------------------


def _tune(read=lambda estimate, box: (estimate, box), told=lambda gains, estimate: gains):
    """``read``: what the search is asked about; ``told``: what is made of its gains."""

    def tune(estimate, randomization):
        return told(model.tune(*read(estimate, randomization)), estimate)

    return tune


def _without(name):
    return lambda estimate, box: ({**estimate, name: [0.001] * 3}, box)


def _one(box):
    return {k: [1.0, 1.0] for k in box}


_TUNE = {
    "read": (
        ("RANDOMIZATION_IGNORED", lambda estimate, box: (estimate, _one(box))),
        ("RANDOMIZATION_IGNORED", lambda estimate, box: (estimate, {k: [0.7, 1.4] for k in box})),
        ("ESTIMATE_IGNORED", lambda estimate, box: ({k: [v] * 3 for k, v in _SHEET.items()}, box)),
        ("ESTIMATE_IGNORED", lambda estimate, box: (dict.fromkeys(estimate, [1.0] * 3), box)),
        ("DELAY_IGNORED", _without("latency")),
    ),
    "told": (
        ("GAINS_SWAPPED", lambda gains, estimate: {"kp": gains["kd"], "kd": gains["kp"]}),
        ("NO_DAMPING", lambda gains, estimate: {**gains, "kd": 0.0}),
        ("GAINS_NEGATIVE", lambda gains, estimate: {k: -v for k, v in gains.items()}),
        ("GAINS_HARD_CODED", lambda gains, estimate: {"kp": 10.0, "kd": 7.0}),
        (
            "GAINS_BY_FORMULA",
            lambda gains, estimate: {"kp": 9.3 * estimate["m"][0], "kd": 4.5 * estimate["m"][0]},
        ),
        ("SEARCH_ENDED_EARLY", lambda gains, estimate: {k: 0.6 * v for k, v in gains.items()}),
        (
            "SEARCH_ENDED_EARLY",
            lambda gains, estimate: {"kp": min(gains["kp"], 3.0), "kd": min(gains["kd"], 2.0)},
        ),
    ),
}
