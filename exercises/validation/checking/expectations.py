"""Comparisons that the public and the hidden checks of ``validation`` share.

Each calls one function of the submission on the data it is given and compares the answer with the
definition. ``expect_report`` for the verdict is in ``probes_runs.py``.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.physics import systems
from course.scoring import kit

probes = kit.companion("validation", "probes")

EXACT = "a closed formula: only rounding is allowed"
MEAN = systems.AveragePolynomial([0.0, 1.0])


def _near(values, right):
    """Whether numbers are these but for rounding."""
    return bool(np.allclose(kit.as_array(values, np.shape(right), "the result"), right, rtol=1e-8, atol=1e-9))


def expect_rmse(submission, e):
    """rmse agrees with the definition on these errors, and leaves them alone."""
    e = np.asarray(e)
    right = math.sqrt(np.mean(np.square(e, dtype=float)))
    inspected = submission.call_inspect("rmse", e)
    kit.expect_close(
        inspected.value,
        right,
        rel=1e-9,
        abs=1e-12,
        source=EXACT,
        quantity="rmse",
        units="m",
        input={"e": e},
        message="The root mean square error is wrong.",
        help="Square all the errors, average the squares, then take the root.",
        diagnose=lambda: (
            probes.of_whole(submission, "rmse", [e], lambda x: _near(x, right))
            or probes.of_digits(inspected.value, right)
        ),
    )
    expect_left_alone(inspected, [e], ["e"])


def expect_bias_variance(submission, e):
    """bias_variance agrees with the definition on these errors, and leaves them alone."""
    names = ("bias", "variance")
    e = np.asarray(e)
    inspected = submission.call_inspect("bias_variance", e)
    values = zip(kit.as_tuple(inspected.value, names), names, strict=True)
    bias, variance = (kit.as_number(x, name) for x, name in values)
    for actual, expected, name in ((bias, np.mean(e), "bias"), (variance, np.var(e), "variance")):
        kit.expect_close(
            actual,
            float(expected),
            rel=1e-9,
            abs=1e-12,
            source=EXACT,
            quantity=name,
            units="m" if name == "bias" else "m²",
            input={"e": e},
            message=f"The {name} is wrong.",
            help="The bias is the mean; the variance is the mean square of what is left after subtracting "
            "it.",
            diagnose=lambda actual=actual, expected=expected: (
                probes.of_whole(
                    submission, "bias_variance", [e], lambda pair: _near(pair, (np.mean(e), np.var(e)))
                )
                or probes.of_digits(actual, expected)
            ),
        )
    expect_left_alone(inspected, [e], ["e"])


def expect_large_mean(submission, e):
    """The variance keeps its digits where the mean is ten million times the scatter."""
    value = submission.call("bias_variance", e)
    _, variance = kit.as_tuple(value, ("bias", "variance"))
    variance = kit.as_number(variance, "variance")
    kit.expect_close(
        variance,
        float(np.var(e)),
        rel=1e-6,
        source="rounding, if the mean is subtracted first",
        quantity="variance",
        units="m²",
        input={"e": e},
        message="Where the errors are large but scatter little, the variance is wrong.",
        help="The variance is the mean square of what is left after subtracting the mean.",
        diagnose=lambda: probes.of_offset(submission, e),
    )


def expect_left_alone(inspected, given, names):
    """The arguments that have a name are as they were. To hand back the very array that came is allowed."""
    for name, before, after in zip(names, given, inspected.args_after, strict=False):
        if name is None:  # a function: it is nothing that could be changed
            continue
        kit.expect_true(
            same(before, after),
            f"The call changed its argument `{name}` in place.",
            help="Make a new array.",
            diagnose=probes.named("MUTATES_INPUT"),
            expected={name: before},
            actual={name: after},
        )


def same(before, after):
    """Whether two nests of dicts, lists and arrays are equal; ``after`` may be anything."""
    if isinstance(before, dict):
        return (
            isinstance(after, dict)
            and before.keys() == after.keys()
            and all(same(before[key], after[key]) for key in before)
        )
    if isinstance(before, np.ndarray):
        return isinstance(after, np.ndarray) and np.array_equal(before, after)
    if isinstance(before, list):
        return isinstance(after, list) and len(before) == len(after) and all(map(same, before, after))
    return type(before) is type(after) and before == after


def expect_band(submission, setting, value, right, *, source, help):
    """Both ends of a band are right to 1 %; setting: (dof, runs, alpha)."""
    names = ("lo", "hi")
    ends = [kit.as_number(x, name) for x, name in zip(kit.as_tuple(value, names), names, strict=True)]
    for actual, wanted, name in zip(ends, right, names, strict=True):
        kit.expect_close(
            actual,
            wanted,
            rel=0.01,
            source=source,
            quantity=name,
            input=dict(zip(("dof", "runs", "alpha"), setting, strict=True)),
            message=f"`{name}` of the band is off by more than 1 %.",
            help=help,
            diagnose=lambda: (
                probes.of_random_band(submission, setting) or probes.of_band(submission, setting, ends, right)
            ),
        )


def expect_coverage(submission, y, lo, hi):
    """coverage agrees with the definition, and leaves values and intervals alone."""
    inspected = submission.call_inspect("coverage", y, lo, hi)
    value = kit.as_number(inspected.value)
    kit.expect_close(
        value,
        float(np.mean((lo <= y) & (y <= hi))),
        abs=1e-12,
        source=EXACT,
        quantity="coverage",
        input={"y": y, "lo": lo, "hi": hi},
        message="The fraction of covered values is wrong.",
        help="Look at each value, the first and the last too. Count those with lo <= y <= hi, ends included, "
        "and divide by the number of values.",
        diagnose=lambda: probes.of_whole(
            submission, "coverage", [y, lo, hi], lambda x: _near(x, np.mean((lo <= y) & (y <= hi)))
        ),
    )
    expect_left_alone(inspected, [y, lo, hi], ["y", "lo", "hi"])


def expect_normalised(submission, task, err, covariance, names):
    """Each normalised squared error is as expected, and errors and covariances are left alone."""
    inspected = submission.call_inspect(task, err, covariance)
    value = inspected.value
    expected = np.einsum("ni,nij,nj->n", err, np.linalg.inv(covariance), err)
    if isinstance(value, int | float | np.number) or (isinstance(value, np.ndarray) and value.ndim == 0):
        kit.fail(
            "The result does not have one row per error.",
            help="Return one value per row.",
            diagnose=probes.named("SUMMED" if len(err) > 1 else "SINGLE_ROW_SQUEEZED"),
            expected=f"shape ({len(err)},)",
            actual=value,
        )
    rows = kit.as_vector(value, len(err), "the result")
    kit.expect_array(
        rows,
        expected,
        rel=1e-8,
        source="rounding",
        quantity=task,
        input={names[0]: err, names[1]: covariance},
        message="The normalised squared errors are wrong.",
        help=f"For each row: solve {names[1]} w = {names[0]} for w, then sum {names[0]} * w."
        + (" np.squeeze would remove the axis of a single component, too." if err.shape[1] == 1 else ""),
        diagnose=lambda: (
            probes.of_rows(rows, expected)
            or probes.of_whole(submission, task, [err, covariance], lambda rows: _near(rows, expected))
            or probes.of_digits(rows, expected)
        ),
    )
    expect_left_alone(inspected, [err, covariance], names)


@functools.cache
def correlated(seed, count, n, phi):
    """``count`` series of errors that each keep ``phi`` of the one before; variance 1, mean 0."""
    rng = np.random.default_rng(seed)
    e = np.empty((count, n))
    e[:, 0] = rng.standard_normal(count)
    kicks = math.sqrt(1 - phi**2) * rng.standard_normal((count, n))
    for i in range(1, n):
        e[:, i] = phi * e[:, i - 1] + kicks[:, i]
    return e


def interval_ends(values):
    """What block_bootstrap_ci returned, called several times: shape (n, 2)."""
    ends = [kit.as_vector(kit.as_tuple(value, ("lo", "hi")), 2, "(lo, hi)") for value in values]
    return np.array(ends)


def spread_of_mean(n, phi):
    """Standard deviation of the mean of such a series: exact."""
    lags = np.arange(1, n)
    return math.sqrt((1 + 2 * np.sum((1 - lags / n) * phi**lags)) / n)


def expect_energies(submission, q, v, energy):
    """energy_error agrees with the definition on the energies of these samples."""
    d = q.shape[1]

    def checked(q, v):
        if np.shape(q) != (d,) or np.shape(v) != (d,):
            kit.fail(
                "Your code calls energy with arguments of another shape than one position and one velocity.",
                help=f"Call energy(q[i], v[i]): two arrays of shape ({d},) here.",
                diagnose=probes.named(
                    "WHOLE_ARRAYS" if max(np.size(q), np.size(v)) > d else "ENERGY_OF_ONE_SHAPE"
                ),
                expected=f"energy(q_i, v_i), both of shape ({d},)",
                actual=[f"shape {np.shape(a)}" for a in (q, v)],
            )
        return energy(kit.as_vector(q, d, "q"), kit.as_vector(v, d, "v"))

    probe = probes.callback("energy(q_i, v_i)", checked)
    inspected = probe.during(lambda: submission.call_inspect("energy_error", q, v, probe))
    values = kit.as_vector(inspected.value, len(q), "the result")
    energies = np.array([energy(a, b) for a, b in zip(q, v, strict=True)])
    right = (energies - energies[0]) / abs(energies[0])
    kit.expect_array(
        values,
        right,
        abs=1e-9,
        source=EXACT,
        quantity="energy error",
        input={"energies": energies},
        message="The relative error of the energy is wrong.",
        help="Compare every sample with the first, and divide by the absolute value of the first.",
        diagnose=lambda: probes.of_whole(
            submission, "energy_error", [q, v, energy], lambda errors: _near(errors, right)
        ),
    )
    expect_left_alone(inspected, [q, v], ["q", "v"])


def pulse(t, start, length, peak, rise=0.5):
    """A force that begins and ends smoothly; rise: the share of its length before the peak."""
    x = np.clip((t - start) / length, 0, 1)
    phase = np.where(x < rise, x / rise, 1 + (x - rise) / (1 - rise)) / 2
    return peak * np.where(x < 1, np.sin(np.pi * phase) ** 2, 0.0)


#: How each force becomes one number.
_REDUCED = {
    "peak": "The peak of a force is its largest sample, not a point of a curve through it nor a percentile.",
    "impulse": "Integrate each force by itself, from the first sample of the recording to the last.",
}


def expect_forces(submission, pairs):
    """contact_force_error agrees with the definition on these pulses, (f_sim, f_real, dt) each."""
    for f_sim, f_real, dt in pairs:
        inspected = submission.call_inspect("contact_force_error", f_sim, f_real, dt)
        record = kit.as_record(inspected.value, ("peak", "impulse"))
        for key, of in (("peak", np.max), ("impulse", np.sum)):
            number = kit.as_number(record[key], key)
            kit.expect_close(
                number,
                (of(f_sim) - of(f_real)) / of(f_real),
                abs=2e-3,
                source="rules of integration differ by less than 0.0005 on these pulses",
                quantity=key,
                input={"peaks": [np.max(f_sim), np.max(f_real)], "dt": dt, "samples": len(f_sim)},
                message=f"The relative error of the {key} is wrong.",
                help=f"{_REDUCED[key]} Then divide the difference of the two numbers by the real one.",
                diagnose=functools.partial(probes.of_force, key, number, f_sim, f_real, dt),
            )
        expect_left_alone(inspected, [f_sim, f_real], ["f_sim", "f_real"])


def expect_folds(submission, data, k):
    """cross_validate holds out k contiguous folds and scores them as the README says."""
    folds = probes.Folds(data)
    given = [dict(run) for run in data]
    inspected = folds.cross_validate(submission, k)
    scores = kit.as_vector(inspected.value, k, "the result")
    shown = {"runs": len(data), "k": k, "samples": [len(run["y"]) for run in data]}
    code = folds.fault(k)
    if code is not None:
        kit.fail(
            "Runs are not held out as they should be.",
            help="Each run is predicted once, by a model fitted to all runs outside its fold.",
            diagnose=probes.named(code),
            input=shown,
            expected=f"{k} contiguous folds, each predicted by a model fitted to the rest",
            actual=[
                {"fitted to": fit, "asked about": asked}
                for fit, asked in zip(folds.fitted, folds.asked, strict=True)
            ],
        )
    residuals = folds.residuals()
    kit.expect_array(
        scores,
        [math.sqrt(np.mean(np.concatenate(fold) ** 2)) for fold in residuals],
        abs=1e-9,
        source=EXACT,
        quantity="RMSE of the folds",
        input=shown,
        message="The scores are not those of the folds, in the order of the list.",
        help="Pool the errors of all runs of a fold, then take one RMSE; fold by fold, in order.",
        diagnose=lambda: folds.of_order(scores),
    )
    expect_left_alone(inspected, [None, None, given], [None, None, "runs"])
