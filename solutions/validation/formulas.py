"""Metrics of ``validation``, right and wrong: the right one with a term in another form.

Each family makes a function with the signature of its task. ``TERMS`` lists for each task families, and for
each form of a term the code of the mistake; ``OTHERS`` has wrong ones of no family.
"""

from __future__ import annotations

import functools
import math
from statistics import NormalDist

import numpy as np

_TURN = 2 * math.pi


def _over_fewer(x):
    return np.sum(x) / (len(x) - 1)


def _same(x):
    return x


# -- sizes of errors ------------------------------------------------------------------------------------


def _rmse(of=_same, power=np.square, mean=np.mean, root=np.sqrt):
    return lambda e: float(root(mean(power(of(e)))))


_RMSE = {
    "of": (("MEAN_REMOVED", lambda e: e - np.mean(e)), ("MEAN_REMOVED", lambda e: e - np.median(e))),
    "power": (("NOT_SQUARED", np.abs),),
    "mean": (
        ("DDOF_ONE", _over_fewer),
        ("NOT_AVERAGED", np.sum),
        ("MEDIAN_FOR_MEAN", np.median),
        ("LARGEST_TAKEN", np.max),
        ("AVERAGED_TWICE", lambda x: np.sum(x) / len(x) ** 2),
    ),
    "root": (("ROOT_MISSING", _same),),
}


def _bias_variance(
    bias=np.mean, sign=_same, about=_same, power=np.square, mean=np.mean, root=_same, gives=lambda *pair: pair
):
    return lambda e: gives(float(sign(bias(e))), float(root(mean(power(e - about(np.mean(e)))))))


_BIAS = {
    "bias": (
        ("MEDIAN_FOR_MEAN", np.median),
        ("MEAN_ABSOLUTE", lambda e: np.mean(np.abs(e))),
        ("NOT_AVERAGED", np.sum),
    ),
    "sign": (("UNSIGNED", abs), ("WRONG_SIGN", lambda bias: -bias), ("BIAS_SQUARED", lambda bias: bias**2)),
    "about": (("VARIANCE_ABOUT_ZERO", lambda bias: 0.0),),
    "power": (("DEVIATION_ABSOLUTE", np.abs),),
    "mean": (("DDOF_ONE", _over_fewer), ("NOT_AVERAGED", np.sum), ("MEDIAN_FOR_MEAN", np.median)),
    "root": (("STD_FOR_VARIANCE", np.sqrt),),
    "gives": (("RETURNS_SWAPPED", lambda bias, variance: (variance, bias)),),
}


def _wrap_angle(turn=_TURN, shift=math.pi, back=math.pi, rest=np.mod, unit=_same, gives=_same):
    return lambda e: gives(rest(unit(e) + shift, turn) - back)


_WRAP = {
    "rest": (("REMAINDER_SIGN", np.fmod),),
    "shift": (("HALF_TURN_OFF", 0.0),),
    "back": (("HALF_TURN_OFF", 0.0),),
    "gives": (("WRONG_SIGN", np.negative), ("IN_DEGREES", np.degrees), ("IN_TURNS", lambda e: e / _TURN)),
    "unit": (("IN_DEGREES", np.radians), ("IN_DEGREES", np.degrees)),
}


_WRAP_OTHERS = (
    ("NOT_WRAPPED", _same),
    ("WRAPPED_ONCE", lambda e: np.where(e > math.pi, e - _TURN, np.where(e < -math.pi, e + _TURN, e))),
    ("WRAPPED_ONE_WAY", lambda e: np.where(e > 0, (e + math.pi) % _TURN - math.pi, e)),
    ("WRAPPED_ONE_WAY", lambda e: np.where(e > math.pi, e - _TURN, e)),
    ("WRAPPED_ONE_WAY", lambda e: np.where(e < -math.pi, e + _TURN, e)),
    ("ZERO_TO_TURN", lambda e: e % _TURN),
    ("HALF_TURNS", lambda e: (e + math.pi / 2) % math.pi - math.pi / 2),
    ("HALF_TURNS", lambda e: e % math.pi),
    ("HALF_TURNS", lambda e: (e + math.pi) % math.pi - math.pi),
    ("FOLDED", lambda e: np.arcsin(np.sin(e))),
    ("FOLDED", lambda e: np.arccos(np.cos(e))),
    ("HALF_TURNS", lambda e: np.arctan(np.tan(e))),
    ("ARGUMENTS_SWAPPED", lambda e: np.arctan2(np.cos(e), np.sin(e))),
    ("CLIPPED", lambda e: np.clip(e, -math.pi, math.pi)),
    ("IN_DEGREES", lambda e: (e + 180) % 360 - 180),
    ("REMAINDER_SIGN", lambda e: np.fmod(e, _TURN)),
    *(
        ("PI_ROUNDED", lambda e, pi=pi: (e + pi) % (2 * pi) - pi)
        for pi in (3.0, 3.1, 3.14, 3.141, 3.142, 3.1415, 3.1416, 3.14159, 22 / 7)
    ),
)

# -- consistency ----------------------------------------------------------------------------------------


def _scaled(factors):
    """Matrices that weigh each squared component; factors: (N, d)."""
    return factors[:, :, None] * np.eye(factors.shape[1])


def _variances(P):
    return np.einsum("nii->ni", P)


def _normalised(weights=np.linalg.inv, by=lambda P: 1, gives=lambda x, P: x):
    def normalised(err, P):
        return gives(np.einsum("ni,nij,nj->n", err, np.broadcast_to(weights(P), P.shape), err) / by(P), P)

    return normalised


def _flipped(P):
    """L^T L of Cholesky's P = L L^T: what the transposed factor belongs to."""
    L = np.linalg.cholesky(P)
    return L.transpose(0, 2, 1) @ L


def _sided(size):
    """One size for all components."""
    return lambda P: np.eye(P.shape[1]) / size(P)[:, None, None]


_NEES = {
    "weights": (
        ("NOT_INVERTED", _same),
        ("DIAGONAL_ONLY", lambda P: _scaled(1 / _variances(P))),
        ("INVERTED_BY_ELEMENT", lambda P: 1 / P),
        ("UNWEIGHTED", lambda P: _scaled(np.ones_like(_variances(P)))),
        ("ONE_COVARIANCE", lambda P: np.linalg.inv(P[0])),
        ("ONE_COVARIANCE", lambda P: np.linalg.inv(P[-1])),
        ("ONE_COVARIANCE", lambda P: np.linalg.inv(np.mean(P, axis=0))),
        ("INVERTED_TWICE", lambda P: np.linalg.inv(P @ P)),
        ("SQUARED_BY_ELEMENT", lambda P: np.linalg.inv(P * P)),
        ("CHOLESKY_TRANSPOSED", lambda P: np.linalg.inv(_flipped(P))),
        ("VARIANCE_MISREAD", lambda P: _scaled(1 / _variances(P) ** 2)),
        ("VARIANCE_MISREAD", lambda P: _scaled(1 / np.sqrt(_variances(P)))),
        ("VARIANCE_MISREAD", lambda P: _scaled(_variances(P))),
        ("SUMMED_THEN_SQUARED", lambda P: 1 / np.sqrt(_variances(P)[:, :, None] * _variances(P)[:, None])),
        ("ONE_SIZE_FOR_ALL", _sided(lambda P: np.trace(P, axis1=1, axis2=2))),
        ("ONE_SIZE_FOR_ALL", _sided(lambda P: np.trace(P, axis1=1, axis2=2) / P.shape[1])),
        ("ONE_SIZE_FOR_ALL", _sided(np.linalg.det)),
        ("DETERMINANT_MISSING", lambda P: np.linalg.inv(P) * np.linalg.det(P)[:, None, None]),
    ),
    "by": (("DIVIDED_BY_D", lambda P: P.shape[1]),),
    "gives": (
        ("ROOT_TAKEN", lambda x, P: np.sqrt(x)),
        ("HALVED", lambda x, P: x / 2),
        ("HALVED", lambda x, P: np.exp(-x / 2)),
        ("DETERMINANT_ADDED", lambda x, P: x + np.log(np.linalg.det(P))),
        ("SUMMED", lambda x, P: float(np.sum(x))),
        ("SUMMED", lambda x, P: float(np.mean(x))),
    ),
}


def _wilson_hilferty(n, alpha, root=math.sqrt, power=3, middle=lambda n: 1 - 2 / (9 * n)):
    z, width = NormalDist().inv_cdf(1 - alpha / 2), root(2 / (9 * n))
    return [n * (middle(n) + sign * z * width) ** power for sign in (-1, 1)]


def _below(a, x):
    """The regularised incomplete gamma function P(a, x), by its power series."""
    if x <= 0:
        return 0.0
    term = total = 1 / a
    n = 0
    while term > 1e-13 * total:
        n += 1
        term *= x / (a + n)
        total += term
    return total * math.exp(a * math.log(x) - x - math.lgamma(a))


@functools.cache
def _exact(n, alpha):
    """Both quantiles of the chi-square distribution with n degrees of freedom, by bisection."""

    def quantile(p):
        low, high = 0.0, 2 * n + 40
        while high - low > 1e-10 * high:
            middle = (low + high) / 2
            low, high = (middle, high) if _below(n / 2, middle) < p else (low, middle)
        return 2 * low

    return [quantile(alpha / 2), quantile(1 - alpha / 2)]


def _symmetric(n, alpha, variance=None):
    half = NormalDist().inv_cdf(1 - alpha / 2) * math.sqrt(2 * n if variance is None else variance)
    return [n - half, n + half]


def _fisher(n, alpha):
    z = NormalDist().inv_cdf(1 - alpha / 2)
    return [(sign * z + math.sqrt(2 * n - 1)) ** 2 / 2 for sign in (-1, 1)]


def _band(
    quantiles=_wilson_hilferty,
    degrees=lambda dof, runs: dof * runs,
    level=_same,
    by=lambda dof, runs: runs,
    gives=list,
):
    return lambda dof, runs, alpha: gives(
        [q / by(dof, runs) for q in quantiles(degrees(dof, runs), level(alpha))]
    )


_BAND = {
    "degrees": (
        ("RUNS_IGNORED", lambda dof, runs: dof),
        ("DOF_IGNORED", lambda dof, runs: runs),
        ("DEGREES_OFF", lambda dof, runs: dof * runs - 1),
        ("DEGREES_OFF", lambda dof, runs: dof * runs + 1),
        ("DEGREES_OFF", lambda dof, runs: dof + runs),
        ("DEGREES_OFF", lambda dof, runs: dof * max(runs - 1, 1)),
    ),
    "level": (("ONE_SIDED", lambda alpha: 2 * alpha), ("LEVEL_FOR_ALPHA", lambda alpha: 1 - alpha)),
    "by": (
        ("NOT_DIVIDED_BY_RUNS", lambda dof, runs: 1),
        ("DIVIDED_BY_DOF", lambda dof, runs: dof * runs),
        ("DIVIDED_BY_DOF", lambda dof, runs: dof),
        ("DIVIDED_BY_ROOT", lambda dof, runs: math.sqrt(runs)),
    ),
    "gives": (("RETURNS_SWAPPED", lambda ends: ends[::-1]),),
}
_BAND_OTHERS = (
    ("NORMAL_BAND", _symmetric),
    ("ROUGH_QUANTILES", _fisher),
    ("APPROXIMATION_SLIP", lambda n, alpha: _wilson_hilferty(n, alpha, root=_same)),
    ("APPROXIMATION_SLIP", lambda n, alpha: _wilson_hilferty(n, alpha, power=1)),
    ("APPROXIMATION_SLIP", lambda n, alpha: _wilson_hilferty(n, alpha, power=2)),
    ("APPROXIMATION_SLIP", lambda n, alpha: _wilson_hilferty(n, alpha, middle=lambda n: 1 + 2 / (9 * n))),
    ("APPROXIMATION_SLIP", lambda n, alpha: _wilson_hilferty(n, alpha, middle=lambda n: 1.0)),
    ("ALPHA_IGNORED", lambda n, alpha: _wilson_hilferty(n, 0.05)),
    ("NORMAL_BAND", lambda n, alpha: _symmetric(n, alpha, variance=n)),
)


def _coverage(inside=lambda y, lo, hi: (lo <= y) & (y <= hi), gives=np.mean):
    return lambda y, lo, hi: float(gives(inside(y, lo, hi)))


_COVERAGE = {
    "inside": (
        ("COVERAGE_OPEN_BOUNDS", lambda y, lo, hi: (lo < y) & (y < hi)),
        ("COVERAGE_OPEN_BOUNDS", lambda y, lo, hi: (lo <= y) & (y < hi)),
        ("COVERAGE_OPEN_BOUNDS", lambda y, lo, hi: (lo < y) & (y <= hi)),
        ("MIDDLE_AND_HALF", lambda y, lo, hi: np.abs(y - (lo + hi) / 2) <= (hi - lo) / 2),
        ("ONE_WIDTH_FOR_ALL", lambda y, lo, hi: np.abs(y - (lo + hi) / 2) <= np.mean(hi - lo) / 2),
        ("NEARLY_INSIDE", lambda y, lo, hi: (lo <= y) & (y <= hi) | np.isclose(y, lo) | np.isclose(y, hi)),
        ("EITHER_END", lambda y, lo, hi: (lo <= y) | (y <= hi)),
        ("ONE_END_ONLY", lambda y, lo, hi: lo <= y),
        ("ONE_END_ONLY", lambda y, lo, hi: y <= hi),
        ("ONE_INTERVAL_FOR_ALL", lambda y, lo, hi: (np.min(lo) <= y) & (y <= np.max(hi))),
        ("ONE_INTERVAL_FOR_ALL", lambda y, lo, hi: (np.max(lo) <= y) & (y <= np.min(hi))),
        ("ONE_INTERVAL_FOR_ALL", lambda y, lo, hi: (np.mean(lo) <= y) & (y <= np.mean(hi))),
        ("ONE_INTERVAL_FOR_ALL", lambda y, lo, hi: (lo[0] <= y) & (y <= hi[0])),
    ),
    "gives": (
        ("OUTSIDE_COUNTED", lambda inside: 1 - np.mean(inside)),
        ("IN_PER_CENT", lambda inside: 100 * np.mean(inside)),
        ("COUNTED", np.sum),
        ("DDOF_ONE", _over_fewer),
        ("ALL_OR_NONE", np.all),
        ("ALL_OR_NONE", np.any),
    ),
}

# -- energy and contact ---------------------------------------------------------------------------------


def _energy_error(change=lambda e: e - e[0], over=lambda e: abs(e[0]), gives=_same):
    def energy_error(q, v, energy):
        e = np.array([energy(q_i, v_i) for q_i, v_i in zip(q, v, strict=True)])
        return gives(change(e) / over(e))

    return energy_error


def _energy_of_swapped(q, v, energy):
    return _energy_error()(v, q, energy)


def _previous(e):
    return np.concatenate([e[:1], e[:-1]])


_ENERGY = {
    "change": (
        ("TO_PREVIOUS", lambda e: e - _previous(e)),
        ("TO_PREVIOUS", lambda e: np.append(np.diff(e), 0.0)),
        ("WRONG_SIGN", lambda e: e[0] - e),
        ("RATIO", _same),
        ("TO_ANOTHER", lambda e: e - np.mean(e)),
        ("TO_ANOTHER", lambda e: e - e[-1]),
        ("TO_ANOTHER", lambda e: e - np.min(e)),
    ),
    "over": (
        ("NOT_ABSOLUTE", lambda e: e[0]),
        ("TO_CURRENT", np.abs),
        ("TO_CURRENT", _same),
        ("NOT_RELATIVE", lambda e: 1.0),
        ("TO_ANOTHER", lambda e: np.max(np.abs(e))),
        ("TO_ANOTHER", lambda e: abs(np.mean(e))),
        ("TO_ANOTHER", lambda e: np.mean(np.abs(e))),
        ("TO_ANOTHER", np.mean),
        ("TO_ANOTHER", lambda e: abs(e[-1])),
        ("TO_ANOTHER", np.ptp),
    ),
    "gives": (
        ("UNSIGNED", np.abs),
        ("IN_PER_CENT", lambda x: 100 * x),
        ("SQUARED", np.square),
        ("SUMMED_UP", np.cumsum),
    ),
}


def _forces(
    peaks=lambda sim, real: (np.max(sim), np.max(real)),
    impulses=lambda sim, real, dt: (dt * np.sum(sim), dt * np.sum(real)),
    peak=lambda sim, real: (sim - real) / real,
    impulse=lambda sim, real: (sim - real) / real,
    gives=lambda peak, impulse: {"peak": peak, "impulse": impulse},
):
    def contact_force_error(f_sim, f_real, dt):
        return gives(float(peak(*peaks(f_sim, f_real))), float(impulse(*impulses(f_sim, f_real, dt))))

    return contact_force_error


def _forces_alike(relative=lambda sim, real: (sim - real) / real, **others):
    """Both numbers made by one rule."""
    return _forces(peak=relative, impulse=relative, **others)


def _until_peak(f, last):
    """last: the weight of the peak itself, which rules of integration differ in."""
    return np.sum(f[: np.argmax(f)]) + last * np.max(f)


_RELATIVE = (
    ("DIVIDED_BY_SIM", lambda sim, real: (sim - real) / sim),
    ("UNSIGNED", lambda sim, real: abs(sim - real) / real),
    ("WRONG_SIGN", lambda sim, real: (real - sim) / real),
    ("RATIO", lambda sim, real: sim / real),
    ("RATIO", lambda sim, real: real / sim),
    ("IN_PER_CENT", lambda sim, real: 100 * (sim - real) / real),
    ("NOT_RELATIVE", lambda sim, real: sim - real),
    ("DIVIDED_BY_BOTH", lambda sim, real: 2 * (sim - real) / (sim + real)),
    ("DIVIDED_BY_BOTH", lambda sim, real: (sim - real) / max(sim, real)),
)
_FORCES = {
    "peaks": (
        ("PEAK_AT_SAME_TIME", lambda sim, real: (sim[np.argmax(real)], np.max(real))),
        ("PEAK_AT_SAME_TIME", lambda sim, real: (np.max(sim), real[np.argmax(sim)])),
        ("PEAK_OF_ERROR", lambda sim, real: (np.max(sim - real) + np.max(real), np.max(real))),
        ("PEAK_OF_ERROR", lambda sim, real: (np.max(np.abs(sim - real)) + np.max(real), np.max(real))),
        ("MEAN_FORCE", lambda sim, real: (np.mean(sim), np.mean(real))),
    ),
    "impulses": (
        ("IMPULSE_OF_ABSOLUTE", lambda s, r, dt: (np.sum(np.abs(s - r)) + np.sum(r), np.sum(r))),
        ("MEAN_FORCE", lambda sim, real, dt: (np.mean(sim[sim > 0]), np.mean(real[real > 0]))),
        ("IMPULSE_OF_SQUARES", lambda sim, real, dt: (np.sum(sim**2), np.sum(real**2))),
        *(
            ("IMPULSE_UNTIL_PEAK", lambda s, r, dt, last=last: (_until_peak(s, last), _until_peak(r, last)))
            for last in (1.0, 0.5, 0.0)
        ),
        ("IMPULSE_OF_PEAK", lambda sim, real, dt: (np.max(sim) * dt, np.max(real) * dt)),
    ),
    "gives": (("RETURNS_SWAPPED", lambda peak, impulse: {"peak": impulse, "impulse": peak}),),
}


def _without_far_ones(e):
    e = np.asarray(e, dtype=float)
    return float(np.sqrt(np.mean(e[np.abs(e - e.mean()) <= 3 * e.std()] ** 2)))


def _times_dof(band):
    """The band of one component, times their number."""
    return lambda dof, runs, alpha: tuple(dof * end for end in band(1, runs, alpha))


def _unwrapped(e):
    smooth = np.unwrap(e)
    return smooth - _TURN * np.round(np.ravel(smooth)[0] / _TURN)


#: The band by quantiles that are no approximation.
exactly = functools.partial(_band, quantiles=_exact)
#: Task: (family, terms) of each family.
TERMS = {
    "rmse": [(_rmse, _RMSE)],
    "bias_variance": [(_bias_variance, _BIAS)],
    "wrap_angle": [(_wrap_angle, _WRAP)],
    **dict.fromkeys(("nees", "nis"), [(_normalised, _NEES)]),
    "consistency_band": [(_band, _BAND), (exactly, _BAND)],
    "coverage": [(_coverage, _COVERAGE)],
    "energy_error": [(_energy_error, _ENERGY)],
    "contact_force_error": [
        (_forces_alike, _FORCES | {"relative": _RELATIVE}),
        (_forces, _FORCES | {"peak": _RELATIVE, "impulse": _RELATIVE}),
    ],
}
#: Task: (code, function) of wrong ones that are no single term in another form.
OTHERS = {
    "rmse": [
        ("MEAN_ABSOLUTE", lambda e: float(np.mean(np.abs(e)))),
        ("BIAS_FOR_RMSE", lambda e: float(np.mean(e))),
        ("BIAS_FOR_RMSE", lambda e: float(abs(np.mean(e)))),
        ("LARGEST_TAKEN", lambda e: float(np.max(e))),
        ("MEAN_REMOVED", lambda e: float(np.std(e, ddof=1))),
        ("FROM_THE_FIRST", lambda e: float(np.sqrt(np.mean(np.square(np.subtract(e, e[0])))))),
        ("FAR_ONES_LEFT_OUT", _without_far_ones),
    ],
    "bias_variance": [
        ("MEDIAN_FOR_MEAN", lambda e: (float(np.median(e)), float(np.mean((e - np.median(e)) ** 2)))),
        ("VARIANCE_ABOUT_ZERO", lambda e: (float(np.mean(e)), float(_over_fewer(np.square(e))))),
        ("VARIANCE_OF_SIZES", lambda e: (float(np.mean(e)), float(np.var(np.abs(e))))),
        ("VARIANCE_OF_STEPS", lambda e: (float(np.mean(e)), float(np.mean(np.diff(e) ** 2) / 2))),
    ],
    "wrap_angle": [*_WRAP_OTHERS, ("UNWRAPPED", _unwrapped), ("UNWRAPPED", np.unwrap)],
    "consistency_band": [
        *((code, _band(quantiles=quantiles)) for code, quantiles in _BAND_OTHERS),
        ("RUNS_IGNORED", _band(degrees=lambda dof, runs: dof, by=lambda dof, runs: 1)),
        ("RUNS_IGNORED", exactly(degrees=lambda dof, runs: dof, by=lambda dof, runs: 1)),
        *(("BAND_OF_ONE_COMPONENT", _times_dof(band())) for band in (_band, exactly)),
    ],
    "coverage": [
        (
            "SIDES_MULTIPLIED",
            lambda y, lo, hi: float(np.mean(np.less_equal(lo, y)) * np.mean(np.less_equal(y, hi))),
        )
    ],
    "energy_error": [
        ("TO_PREVIOUS", _energy_error(lambda e: e - _previous(e), lambda e: np.abs(_previous(e)))),
        ("TO_ANOTHER", _energy_error(change=lambda e: e - np.mean(e), over=lambda e: abs(np.mean(e)))),
        ("ENERGY_ARGUMENTS_SWAPPED", _energy_of_swapped),
        ("LOGARITHM", _energy_error(change=lambda e: np.log(np.abs(e / e[0])), over=lambda e: 1.0)),
        ("LOGARITHM", _energy_error(change=lambda e: np.log(np.abs(e / e[0])), over=lambda e: np.sign(e[0]))),
        ("RATIO", _energy_error(change=_same, over=lambda e: e[0])),
    ],
}
