"""Calls that tell wrong programs of ``validation`` apart; a task with a failed check is asked them besides.

The same at home and in a grading run. What they should give is not here. A bootstrap's resamples are looked
at instead (``probes.py``): its chance may be drawn in many ways.
"""

from __future__ import annotations

import numpy as np

from course.scoring import kit

shared = kit.companion("validation", "expectations")

_I = np.arange(60)
#: Errors without a pattern, of any size, number and sign.
_ERRORS = [
    *(
        (np.round(size * np.sin(1.7 * _I[:n] ** 1.3) + mean, 3),)
        for n, size, mean in ((7, 2.0, 0.4), (12, 0.6, -1.3), (5, 30.0, 4.0), (20, 1.0, 0.0))
    ),
    (np.append(np.round(np.sin(_I[:19]), 3), 25.0),),  # one far from all others
]
_ANGLES = np.concatenate(
    [np.linspace(-347.3, 551.9, 37), np.linspace(-3.1, 3.1, 12), np.linspace(3.3, 9.1, 7)]
)


def _estimates():
    """Errors and their covariances: one, two and three components that go together, of different size."""
    for d, rows in ((1, 4), (2, 5), (3, 4), (4, 4)):
        sizes = np.array([0.4, 2.5, 1.1, 0.7])[:d]
        waves = np.sin(1 + np.arange(rows * d * d) ** 1.2).reshape(rows, d, d)
        factors = (waves + 1.5 * np.eye(d)) * sizes[:, None]
        err = sizes * np.cos(1.4 * np.arange(rows * d) ** 1.1).reshape(rows, d)
        yield err, factors @ factors.transpose(0, 2, 1)


def _bands(answer, names):
    """Both ends of bands of few runs and of many; approximations differ by almost a per cent."""
    # No quantile of a single degree of freedom, with dof or runs left out: own integrals fail at it.
    settings = [(2, 20, 0.05), (10, 2, 0.1), (2, 13, 0.13), (4, 30, 0.02), (3, 200, 0.2), (7, 6, 0.05)]
    return {"consistency_band": [end for said in answer(settings) for end in _ends(said)]}


def _ends(said):
    if isinstance(said, np.ndarray):
        said = said.tolist()
    if not isinstance(said, list | tuple) or len(said) != 2:
        return -1.0, -1.0
    return [float(x) if isinstance(x, int | float) and abs(x) < 1e300 else -2.0 for x in said]


def _intervals():
    """Values in the middle, on either end and outside of intervals, some of which are points."""
    y = np.array([0.5, 1.0, 2.0, -3.0, 4.0, 5.25, -6.0, 7.0, 0.0, 1.5, 3.5, 2.25, -1.0])
    below = np.array([0.5, 0.0, 1.0, 2.0, -1.0, 0.25, 0.0, 0.5, 0.0, 3.0, -0.5, 0.0, 0.75])
    above = np.array([0.25, 1.0, 0.0, 0.5, 2.0, -0.5, 0.5, 0.0, 0.0, 0.25, 1.5, 0.5, -0.25])
    yield y, y - below, y + np.maximum(above, -below)
    low = np.round(3 * np.sin(np.arange(60) ** 1.3), 2)
    yield low + np.abs(low) / 3, low, low + np.abs(low) / 3  # on the upper end, by numbers that are rounded
    yield y + 1e-9, y - np.maximum(below, 0.1), y  # hardly outside
    yield np.array([1.0, 1.2, 5.0]), np.zeros(3), np.full(3, 2.0)
    yield np.array([9.0, 1.2, 0.5, 1.0, 1.5]), np.zeros(5), np.full(5, 2.0)
    yield np.array([0.0, 1.0, 9.0]), np.array([5.0, 6.0, 7.0]), np.array([6.0, 7.0, 8.0])


def _energy(q, v):
    """Of either sign; whatever it is handed, it gives a number."""
    try:
        return float(np.sum(np.square(v)) / 2 + 3.0 * np.sum(q))
    except (TypeError, ValueError):
        return 0.0


def _paths():
    for n, d, height in ((6, 1, -2.0), (8, 2, 1.5), (5, 3, -0.7)):
        waves = np.sin(1 + np.arange(n * d) ** 1.3).reshape(n, d)
        yield 0.3 * waves + height, waves[::-1] + 0.4, _energy


def _blow(start, length, peak, rise):
    """A force that begins and ends so smoothly, in so many samples, that all rules of integration agree."""
    return shared.pulse(np.arange(401), start, length, peak, rise)


# Rise and fall have whole samples, an even number of them: else the rules differ by 1e-7.
_BLOWS = [
    (_blow(150, 160, 88.0, 0.6), _blow(90, 200, 80.0, 0.4), 0.0013),
    (_blow(60, 200, 130.0, 0.5), _blow(80, 160, 180.0, 0.7), 0.0007),
    (_blow(100, 240, 3.3, 0.4), _blow(110, 160, 3.1, 0.55), 0.002),
]

# -- cross-validation: y = gain * u, whose gain is fitted ---------------------------------------------------


def _fit(runs):
    try:
        u, y = (np.concatenate([run[key] for run in runs]) for key in ("u", "y"))
        return float(u @ y / (u @ u))
    except (IndexError, KeyError, TypeError, ValueError):
        return 0.0


def _predict(model, run):
    try:
        return float(model) * np.asarray(run["u"], dtype=float)
    except (IndexError, KeyError, TypeError, ValueError):
        return np.zeros(1)


def _pushed(lengths):
    """Runs of different length and gain."""
    runs = []
    for i, n in enumerate(lengths):
        u = np.sin((2 + i) * np.arange(1, n + 1) ** 1.2)
        runs.append({"id": f"r{i}", "u": u, "y": (1 + 0.3 * i) * u + 0.1 * np.cos(7 * u + i) - 0.05})
    return runs


# -- the verdict ----------------------------------------------------------------------------------------

#: id: (samples, dt, what it swings about, how far, how late, too high by, sigma)
_DRIVEN = {
    "b": (150, 0.02, 2.0, 1.0, -0.07, -0.5, 0.42),
    "a": (90, 0.01, -1.0, 1.4, -0.03, -0.2, 0.3),
    "d": (150, 0.02, 0.5, 0.8, 0.04, 2.0, 0.1),  # it was calibrated on: quite wrong
    "c": (90, 0.02, 0.4, 1.2, -0.05, -0.35, 0.5),
}


def _driven(names, sign=1):
    """A simulation of these runs, and them measured in another order, each side with a run of its own."""
    sim, real = [], []
    for i, (name, (n, dt, middle, size, late, offset, sigma)) in enumerate(_DRIVEN.items()):
        t = dt * np.arange(n)
        speed = lambda t, m=middle, s=size, i=i: m + s * np.sin(2 * np.pi * (0.9 + 0.1 * i) * t + i)  # noqa: E731
        y = speed(t - sign * late) + sign * offset + 0.3 * np.sin(17 * t + i)
        own = name if name in names else f"sim {name}"
        sim.append({"id": own, "t": t, "y": y, "sigma": sigma * (1 + 0.5 * np.sin(5 * t))})
        real.append({"id": name if name in names else f"real {name}", "t": t.copy(), "y": speed(t)})
    return sim, [real[i] for i in (2, 3, 0, 1)]  # of the same lengths, place by place


_LENIENT = {"rmse_max": 99.0, "bias_max": 99.0, "lag_max_s": 9.0, "coverage_min": -9.0, "coverage_max": 9.0}
#: Limits that leave out a whole interval, or one end of it and not the number; of a lag's no end is exact.
_LIMITS = [{}, {"bias_max": 0.05}, {"lag_max_s": 0.01}, {"rmse_max": 0.3}, {"rmse_max": 0.65}]
_LIMITS += [{"bias_max": 0.5}, {"coverage_min": 0.87}, {"coverage_min": 1.05}]
_LIMITS += [{"coverage_max": 0.97}, {"coverage_max": 0.7}]


def _verdicts():
    for names, sign, count in (("abcd", 1, len(_LIMITS)), ("acd", -1, 3), ("bd", 1, 1), ("d", 1, 1)):
        sim, real = _driven(names, sign)
        for limit in _LIMITS[:count]:
            yield {"calibrated_on": ["d"], "runs": sim}, {"runs": real}, _LENIENT | limit


def _report(report):
    """All but the lag, which a search finds to a share of a sample."""
    keys = ("rmse", "bias", "coverage")
    ends = report["intervals"] and [report["intervals"][key] for key in keys]
    told = [report[key] for key in keys]
    return told, ends, report["reasons"], report["accepted"], sorted(report["runs_used"])


QUESTIONS = {
    "rmse": _ERRORS,
    "bias_variance": _ERRORS,
    "wrap_angle": [(_ANGLES,)],
    "nees": list(_estimates()),
    "nis": list(_estimates()),
    "coverage": list(_intervals()),
    "block_bootstrap_ci": [],
    "energy_error": list(_paths()),
    "contact_force_error": _BLOWS,
    "cross_validate": [(_fit, _predict, _pushed((8, 20, 13, 30, 17, 9)), k) for k in (3, 6)],
    "validate": list(_verdicts()),
}
ASK = {"consistency_band": _bands}
READ = {"validate": _report}
#: Approximations of the chi-square distribution differ by up to 0.7 % from it.
WITHIN = {"consistency_band": 0.012}
