"""Finding out which mistake a failed check looks like, for the metrics of ``validation``.

A value is compared with what the usual wrong formulas give for the same arguments; the one that matches is
named. ``probes_runs.py`` does the same for the tasks that work on whole recordings.
"""

from __future__ import annotations

import numpy as np

from course.grading import kit

named = kit.companion("validation", "diagnosis").named

#: A wrong formula is recognised if it gives the value to this relative difference.
_SAME = 1e-6


def match(value, candidates, rel=_SAME):
    """The diagnosis of the first candidate (code, value) that equals ``value``, or None."""
    try:
        value = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):  # no number, or none that fits
        return None
    with np.errstate(all="ignore"):
        for code, wrong in candidates:
            if np.shape(wrong) == np.shape(value) and np.allclose(wrong, value, rtol=rel, atol=1e-12):
                return named(code)
    return None


def callback(signature, fn):
    """``fn`` as a counted callback that refuses any other number of arguments than ``signature`` has."""
    arity = signature.count(",") + 1

    def checked(*args, **kwargs):
        if kwargs or len(args) != arity:
            kit.fail(
                f"Your code calls {signature.partition('(')[0]} with other arguments than it takes.",
                help=f"Call it by position: {signature}.",
                diagnose="CALLED_WRONGLY",
                expected=signature,
                actual=[*args, *kwargs],
            )
        return fn(*args)

    return kit.counted(checked)


def of_rmse(value, e):
    """What a wrong rmse(e) is."""
    e = np.asarray(e, dtype=float)
    square = e @ e
    return match(
        value,
        [
            ("ROOT_MISSING", square / len(e)),
            ("MEAN_REMOVED", np.std(e)),
            ("MEAN_ABSOLUTE", np.mean(np.abs(e))),
            ("DDOF_ONE", np.sqrt(square / (len(e) - 1))),
            ("NOT_AVERAGED", np.sqrt(square)),
            ("BIAS_FOR_RMSE", np.mean(e)),
            ("BIAS_FOR_RMSE", abs(np.mean(e))),
            ("MEAN_REMOVED", np.std(e, ddof=1)),
        ],
    )


def of_bias(bias, variance, e):
    """What a wrong pair bias_variance(e) is: the first value's mistake before the second's."""
    e = np.asarray(e, dtype=float)
    mean, scatter = np.mean(e), np.var(e)
    if match((bias, variance), [("RETURNS_SWAPPED", (scatter, mean))]):
        return named("RETURNS_SWAPPED")
    if not np.isclose(bias, mean, rtol=_SAME):
        return match(
            bias,
            [
                ("UNSIGNED", abs(mean)),
                ("WRONG_SIGN", -mean),
                ("MEAN_ABSOLUTE", np.mean(np.abs(e))),
                ("MEDIAN_FOR_MEAN", np.median(e)),
            ],
        )
    return match(
        variance,
        [
            ("DDOF_ONE", np.var(e, ddof=1)),
            ("STD_FOR_VARIANCE", np.sqrt(scatter)),
            ("STD_FOR_VARIANCE", np.std(e, ddof=1)),
            ("VARIANCE_ABOUT_ZERO", np.mean(e * e)),
        ],
    )


def of_offset(submission, e, variance):
    """Why a variance is wrong where the mean is much larger than the scatter."""
    e = np.asarray(e, dtype=float)
    found = of_bias(np.mean(e), variance, e)
    if found:
        return found
    near = kit.as_tuple(submission.call("bias_variance", e - np.mean(e)), ("bias", "variance"))
    right = np.isclose(kit.as_number(near[1], "variance"), np.var(e), rtol=1e-6)
    return named("CANCELLATION") if right else None


def of_wrapped(values, angles):
    """What a wrong wrap_angle(angles) is."""
    e = np.asarray(angles, dtype=float)
    turn = 2 * np.pi
    once = np.where(e > np.pi, e - turn, np.where(e < -np.pi, e + turn, e))
    return match(
        values,
        [
            ("NOT_WRAPPED", e),
            ("WRAPPED_ONCE", once),
            ("ZERO_TO_TURN", e % turn),
            ("HALF_TURNS", (e + np.pi / 2) % np.pi - np.pi / 2),
            ("HALF_TURNS", e % np.pi),
            ("FOLDED", np.arcsin(np.sin(e))),
            ("FOLDED", np.arccos(np.cos(e))),
            ("CLIPPED", np.clip(e, -np.pi, np.pi)),
            ("IN_DEGREES", (e + 180) % 360 - 180),
            ("IN_DEGREES", np.degrees((e + np.pi) % turn - np.pi)),
            ("REMAINDER_SIGN", np.fmod(e + np.pi, turn) - np.pi),
            ("REMAINDER_SIGN", np.fmod(e, turn)),
        ],
    )


def of_normalised(value, err, covariance):
    """What a wrong nees(err, P) or nis(nu, S) is; ``value`` as it was returned."""
    d = err.shape[1]
    with np.errstate(all="ignore"):
        right = np.einsum("ni,nij,nj->n", err, np.linalg.inv(covariance), err)
        variances = np.einsum("nii->ni", covariance)
        candidates = [
            ("DIVIDED_BY_D", right / d),
            ("ROOT_TAKEN", np.sqrt(right)),
            ("DIAGONAL_ONLY", np.sum(err**2 / variances, axis=1)),
            ("NOT_INVERTED", np.einsum("ni,nij,nj->n", err, covariance, err)),
            ("INVERTED_BY_ELEMENT", np.einsum("ni,nij,nj->n", err, 1 / covariance, err)),
            ("UNWEIGHTED", np.sum(err**2, axis=1)),
            ("SUMMED", np.sum(right)),
            ("SUMMED", np.mean(right)),
        ]
    return match(value, candidates)


def of_band(lo, hi, dof, runs, alpha, quantile, normal):
    """What a wrong consistency_band is.

    quantile: of a chi-square distribution, (degrees of freedom, p) -> value
    normal: of the standard normal one, p -> value
    """
    n = dof * runs

    def band(degrees, low, by):
        return np.array([quantile(degrees, low), quantile(degrees, 1 - low)]) / by

    z = normal(1 - alpha / 2)
    half = z * np.sqrt(2 * dof / runs)
    right = band(n, alpha / 2, runs)
    candidates = [
        ("RETURNS_SWAPPED", right[::-1]),
        ("ONE_SIDED", band(n, alpha, runs)),
        ("LEVEL_FOR_ALPHA", band(n, (1 - alpha) / 2, runs)),
        ("NORMAL_BAND", np.array([dof - half, dof + half])),
    ]
    if runs > 1:  # for a single run these are the right band
        candidates += [
            ("NOT_DIVIDED_BY_RUNS", band(n, alpha / 2, 1)),
            ("RUNS_IGNORED", band(dof, alpha / 2, runs)),
        ]
    if dof > 1:
        candidates += [
            ("DIVIDED_BY_DOF", band(n, alpha / 2, n)),
            ("DIVIDED_BY_DOF", band(n, alpha / 2, dof)),
        ]
    found = match(np.array([lo, hi]), candidates, rel=0.01)
    if not found and runs > 1:
        # Approximations are poor at the lower end where there are few degrees of freedom: only hi counts.
        found = match(hi, [("RUNS_IGNORED", band(dof, alpha / 2, 1)[1])], rel=0.02)
    return found or match(np.array([lo, hi]), [("ROUGH_QUANTILES", right)], rel=0.2)


def of_coverage(value, y, lo, hi):
    """What a wrong coverage(y, lo, hi) is."""
    inside = (lo <= y) & (y <= hi)
    narrow = [np.mean((lo < y) & (y < hi)), np.mean((lo <= y) & (y < hi)), np.mean((lo < y) & (y <= hi))]
    return match(
        value,
        [
            *(("COVERAGE_OPEN_BOUNDS", share) for share in narrow),
            ("OUTSIDE_COUNTED", np.mean(~inside)),
            ("IN_PER_CENT", 100 * np.mean(inside)),
            ("COUNTED", float(np.sum(inside))),
            *(("IN_PER_CENT", 100 * share) for share in narrow),
            *(("COUNTED", len(y) * share) for share in narrow),
        ],
    )


def of_energies(values, energies):
    """What a wrong energy_error is, given the energies of the samples."""
    e = np.asarray(energies, dtype=float)
    change = e - e[0]
    steps = np.diff(e, prepend=e[0])
    previous = np.concatenate([e[:1], e[:-1]])
    return match(
        values,
        [
            ("NOT_ABSOLUTE", change / e[0]),
            ("TO_CURRENT", change / np.abs(e)),
            ("TO_CURRENT", change / e),
            ("TO_PREVIOUS", steps / np.abs(previous)),
            ("TO_PREVIOUS", steps / np.abs(e[0])),
            ("UNSIGNED", np.abs(change / e[0])),
            ("NOT_RELATIVE", change),
            ("WRONG_SIGN", -change / np.abs(e[0])),
            ("RATIO", e / np.abs(e[0])),
            ("RATIO", e / e[0]),
        ],
    )


def of_forces(key, value, f_sim, f_real):
    """What a wrong peak or impulse is."""
    of = np.max if key == "peak" else np.sum
    sim, real = of(f_sim), of(f_real)
    apart = f_sim - f_real
    if key == "peak":
        special = [
            ("PEAK_OF_ERROR", np.max(apart) / real),
            ("PEAK_OF_ERROR", np.max(np.abs(apart)) / real),
            ("PEAK_AT_SAME_TIME", (f_sim[np.argmax(f_real)] - real) / real),
        ]
        differences = [sim - real]
    else:
        special = [("IMPULSE_OF_ABSOLUTE", np.sum(np.abs(apart)) / real)]
        differences = []  # the step is not known here; it need not be
    common = [
        ("DIVIDED_BY_SIM", (sim - real) / sim),
        ("UNSIGNED", abs(sim - real) / real),
        ("WRONG_SIGN", (real - sim) / real),
        ("RATIO", sim / real),
        ("IN_PER_CENT", 100 * (sim - real) / real),
    ]
    # The impulse by another rule of integration differs a little.
    wrong = special + common + [("NOT_RELATIVE", d) for d in differences]
    return match(value, wrong, rel=1e-3)
