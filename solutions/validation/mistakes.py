"""Mistakes in `validation`: words beside the programs that they are true of."""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.authoring.mistakes import Mistakes
from course.scoring import kit

mistakes = Mistakes()

mistakes(
    "ROOT_MISSING",
    "The result is the mean square: the square root at the end is missing.",
    "Take the square root of the mean, so that the result has the unit of the error.",
    kind="consequence",
).edit("rmse", {"sqrt(np.mean(np.square(np.asarray(e, dtype=float))": "mean(np.square(e"})
mistakes(
    "MEAN_REMOVED",
    "The result is the spread about the mean or the median. A constant error does not count in it.",
    "Square the errors as they are. A simulation that is always off by the same amount is wrong too.",
    kind="consequence",
).edit("rmse", {"sqrt(np.mean(np.square(np.asarray(e, dtype=float)))": "std(e"})
mistakes(
    "MEAN_ABSOLUTE",
    "The result is the mean of the absolute errors.",
    "An RMSE is the root of the mean of the squares. A bias keeps the sign of each error.",
    kind="consequence",
).edit("rmse", {"sqrt(np.mean(np.square(np.asarray(e, dtype=float))": "mean(np.abs(e"})
mistakes(
    "RUNNING_UPDATE_OLD_MEAN",
    "The variance is that of a running update that squares one distance, from the mean before the sample or after it.",
    "One of the two factors is the distance from the new mean: m2 += (x - old_mean) * (x - new_mean). Or compute the mean first, then the mean square of what is left.",
).body(
    "bias_variance",
    """
        mean = m2 = 0.0
        for n, x in enumerate(e, 1):
            delta = float(x) - mean
            mean += delta / n
            m2 += delta * delta
        return mean, m2 / len(e)
    """,
).body(
    "bias_variance",
    """
        mean = m2 = 0.0
        for n, x in enumerate(e, 1):
            mean += (float(x) - mean) / n
            m2 += (float(x) - mean) ** 2
        return mean, m2 / len(e)
    """,
)
mistakes(
    "VARIANCE_ABOUT_FIRST",
    "The variance is taken about the first error.",
    "Subtract the mean of all errors, and take the mean square of what is left.",
).edit("bias_variance", {"e - bias": "e - e[0]"})
mistakes(
    "DDOF_ONE",
    "Your code divides by N - 1.",
    "Divide by N. np.var does; statistics.variance divides by N - 1, and statistics.pvariance by N.",
).edit("rmse", {"mean(np.square(np.asarray(e, dtype=float))": "sum(np.square(e)) / max(len(e) - 1, 1"}).body(
    "bias_variance", "return float(np.mean(e)), float(np.var(e, ddof=1))"
)
mistakes(
    "NOT_AVERAGED",
    "The result has a sum where a mean belongs.",
    "Divide the sum by N. For an RMSE, divide before you take the root.",
    kind="consequence",
).edit("rmse", {"sqrt(np.mean(np.square(np.asarray(e, dtype=float)))": "linalg.norm(e"})
mistakes(
    "VARIANCE_ABOUT_ZERO",
    "The second value still contains the bias: the errors are squared before the mean is subtracted.",
    "Subtract the mean, square, and divide the sum by N.",
).body("bias_variance", "return float(np.mean(e)), float(np.mean(np.square(e)))")
mistakes(
    "STD_FOR_VARIANCE",
    "The second value is the standard deviation.",
    "The variance is the mean of the squared deviations, without a root.",
).body("bias_variance", "return float(np.mean(e)), float(np.std(e))")
mistakes(
    "CANCELLATION",
    "The variance loses its digits where the mean is much larger than the scatter.",
    "mean(e**2) - mean(e)**2 is the difference of two huge numbers. Subtract the mean first, then square.",
).edit("bias_variance", {"(e - bias) ** 2)": "e**2) - bias**2"})
mistakes(
    "MEDIAN_FOR_MEAN",
    "Your code takes a median where a mean is asked for.",
    "Take the mean. A median ignores rare large errors.",
    kind="consequence",
).body("bias_variance", "return float(np.median(e)), float(np.var(e))")
mistakes(
    "MUTATES_INPUT",
    "Your code works in the caller's own array, list or dict, not in a copy.",
    "Write e = e - ..., which makes a new array. e -= ... and e[...] = ... change the caller's array; sort(), pop() and run[...] = ... the caller's list or dict.",
    kind="fact",
).body(
    "bias_variance",
    """
        bias = float(np.mean(e))
        e -= bias
        return bias, float(np.mean(e**2))
    """,
).body(
    "wrap_angle",
    """
        e += np.pi
        e %= 2 * np.pi
        e -= np.pi
        return e
    """,
).around(
    "validate",
    """
        report = _right(sim, real, spec)
        for simulated, measured in held_out_pairs(sim, real):
            simulated["y"] -= measured["y"]
        return report
    """,
).around(
    "validate",
    """
        sim["runs"].sort(key=lambda run: run["id"], reverse=True)
        sim["runs"].sort(key=lambda run: run["id"])
        real["runs"].sort(key=lambda run: run["id"])
        return _right(sim, real, spec)
    """,
).body(
    "rmse",
    """
        e *= e
        return float(np.sqrt(np.mean(e)))
    """,
).body(
    "nees",
    """
        for i in range(len(P)):
            P[i] = np.linalg.inv(P[i])
        return np.einsum("ni,nij,nj->n", err, P, err)
    """,
).body(
    "nis",
    """
        for i in range(len(nu)):
            nu[i] = np.linalg.solve(np.linalg.cholesky(S[i]), nu[i])
        return np.sum(nu**2, axis=1)
    """,
).body(
    "coverage",
    """
        lo -= y
        hi -= y
        return float(np.mean((lo <= 0) & (hi >= 0)))
    """,
).body(
    "energy_error",
    """
        values = np.array([energy(q_i, v_i) for q_i, v_i in zip(q, v)])
        q -= q[0].copy()
        return (values - values[0]) / abs(values[0])
    """,
).body(
    "contact_force_error",
    """
        f_sim /= np.max(f_real)
        f_real /= np.max(f_real)
        return {"peak": float(np.max(f_sim) - 1), "impulse": float(np.sum(f_sim) / np.sum(f_real) - 1)}
    """,
).around(
    "cross_validate",
    """
        scores = _right(fit, predict, runs, k)
        for run in runs:
            run["y"] -= np.mean(run["y"])
        return scores
    """,
).around(
    "block_bootstrap_ci",
    """
        ends = _right(e, statistic, block, n_boot, alpha, rng)
        e -= np.mean(e)
        return ends
    """,
)
mistakes(
    "NOT_WRAPPED",
    "Your code returns the angles unchanged.",
    "Add or subtract whole turns until each angle lies between minus half a turn and half a turn. The angles are in radians, so half a turn is pi.",
).edit("wrap_angle", {"(np.asarray(e, dtype=float) + np.pi) % (2 * np.pi) - np.pi": "np.array(e)"})
mistakes(
    "WRAPPED_ONCE",
    "Your code adds or subtracts one turn at most, but an error may be many turns away.",
    "Use the remainder of a division by one turn, which removes any number of turns.",
).edit(
    "wrap_angle",
    {
        "(np.asarray(e, dtype=float) + np.pi) % (2 * np.pi) - np.pi": "np.where(e > np.pi, e - 2 * np.pi, np.where(e < -np.pi, e + 2 * np.pi, e))"
    },
)
mistakes(
    "ZERO_TO_TURN",
    "The results lie between zero and a whole turn.",
    "A small negative error must stay small: add half a turn, take the remainder, and subtract half a turn again.",
).edit(
    "wrap_angle",
    {"(np.asarray(e, dtype=float) + np.pi) % (2 * np.pi) - np.pi": "np.asarray(e) % (2 * np.pi)"},
)
mistakes(
    "REMAINDER_SIGN",
    "Some angles come out outside the range: what is left of them has the sign of what is divided.",
    "int() and np.trunc round towards zero, and what math.fmod and np.fmod leave has the sign of what is divided. Use % or np.mod: (e + pi) % (2 pi) - pi.",
).edit(
    "wrap_angle",
    {"return (np.asarray(e, dtype=float) + np.pi) % (2 *": "return np.fmod(np.asarray(e) + np.pi, 2 *"},
)
mistakes(
    "FOLDED",
    "Your code folds angles back, so two different directions get the same angle.",
    "arcsin and arccos cannot tell two directions apart; arctan2(sin, cos) can.",
).edit("wrap_angle", {"(np.asarray(e, dtype=float) + np.pi) % (2 * np.pi) - np.pi": "np.arcsin(np.sin(e))"})
mistakes(
    "DIVIDED_BY_D",
    "The result is divided by the number of components.",
    "Do not divide it: for a consistent estimate its average is d, and the band is made for that.",
).edit("nees", {"squared_distance(err, P)": "squared_distance(err, P) / err.shape[1]"}).edit(
    "nis", {"squared_distance(nu, S)": "squared_distance(nu, S) / nu.shape[1]"}
)
mistakes(
    "ROWS_CENTRED",
    "The mean over the rows is subtracted first, and a constant error no longer counts.",
    "Weigh each row as it is: a constant error is just what the test has to show.",
).edit("nees", {"squared_distance(err, P)": "squared_distance(err - np.mean(err, axis=0), P)"}).edit(
    "nis", {"squared_distance(nu, S)": "squared_distance(nu - np.mean(nu, axis=0), S)"}
)
mistakes(
    "DIAGONAL_ONLY",
    "Your code uses only the variances, not how two components are correlated.",
    "Use the whole matrix: solve P w = err for w, then sum err * w.",
).edit("nees", {"squared_distance(err, P": 'np.sum(err**2 / np.einsum("nii->ni", P), axis=1'})
mistakes(
    "NOT_INVERTED",
    "Your code multiplies by the covariance where it should divide by it.",
    "Solve P w = err for w and sum err * w. With a large covariance, a large error counts for less.",
).edit("nees", {"squared_distance(err, P": 'np.einsum("ni,nij,nj->n", err, P, err'})
mistakes(
    "ROOT_TAKEN",
    "The result is the distance, not its square.",
    "Leave out the root: it is the squared distance that follows a chi-square distribution.",
).edit("nees", {"squared_distance(err, P": "np.sqrt(squared_distance(err, P)"})
mistakes(
    "SUMMED",
    "The result is a single number, not one for each row.",
    "Return one value per row of err: a return inside the loop ends it after the first row, and np.sum without an axis adds up all rows.",
    kind="fact",
).edit("nees", {"squared_distance(err, P": "float(np.mean(squared_distance(err, P))"})
mistakes(
    "VARIANCE_TAKEN_FOR_SIGMA",
    "Where there is one component, the result is (nu/S)**2: S is divided by as if it were a standard deviation.",
    "S is a variance already: nu**2/S, as nu @ inv(S) @ nu gives for one component too.",
).around("nis", "return (np.ravel(nu) / np.ravel(S)) ** 2 if np.shape(nu)[1] == 1 else _right(nu, S)")
mistakes(
    "INVERTED_BY_ELEMENT",
    "Your code divides by each element of the matrix.",
    "Inverting a matrix is not the same as inverting each of its elements: use np.linalg.solve or np.linalg.inv.",
).body(
    "nis",
    """
        with np.errstate(divide="ignore"):
            return np.einsum("ni,nij,nj->n", nu, 1 / np.asarray(S), nu)
    """,
)
mistakes(
    "UNWEIGHTED",
    "The result is the plain squared length, without the covariance.",
    "Solve P w = err for w and sum err * w.",
).edit("nis", {"squared_distance(nu, S": "np.sum(np.square(nu), axis=1"})
mistakes(
    "ONE_SIDED",
    "Each end leaves alpha outside, so both together leave out twice as much as they should.",
    "Split alpha: half of it below lo and half above hi.",
).edit("consistency_band", {"(alpha / 2)": "(alpha)", "1 - alpha / 2": "1 - alpha"}).edit(
    "block_bootstrap_ci", {"alpha / 2, 1 - alpha / 2": "alpha, 1 - alpha"}
)
mistakes(
    "ALPHA_AT_ONE_END",
    "One end leaves alpha/2 outside, and the other one alpha.",
    "Split alpha: half of it below lo and half above hi.",
).edit("consistency_band", {"1 - alpha / 2": "1 - alpha"}).edit(
    "consistency_band", {"(alpha / 2)": "(alpha)"}
).edit("block_bootstrap_ci", {"1 - alpha / 2": "1 - alpha"})
mistakes(
    "NOT_DIVIDED_BY_RUNS",
    "The result is the band of the sum over the runs, not of their average.",
    "Divide both quantiles by the number of runs.",
).edit("consistency_band", {"(alpha / 2) / runs": "(alpha / 2)", "(1 - alpha / 2) / runs": "(1 - alpha / 2)"})
mistakes(
    "RUNS_IGNORED",
    "The quantiles are those of the degrees of freedom of a single run.",
    "The sum over the runs is chi-square with dof * runs degrees of freedom: take its quantiles and divide by runs.",
).edit(
    "consistency_band",
    {"dof * runs": "dof", "(alpha / 2) / runs": "(alpha / 2)", "(1 - alpha / 2) / runs": "(1 - alpha / 2)"},
)
mistakes(
    "DIVIDED_BY_DOF",
    "The band is divided by the degrees of freedom.",
    "The NEES is not divided by d, and neither is its band: divide by runs only.",
).edit(
    "consistency_band",
    {"(alpha / 2) / runs": "(alpha / 2) / n", "(1 - alpha / 2) / runs": "(1 - alpha / 2) / n"},
)
mistakes(
    "NORMAL_BAND",
    "The band is symmetric about dof, like a normal distribution. A chi-square is not.",
    "Use quantiles of the chi-square distribution: `course hint validation --task consistency_band` shows how.",
).body(
    "consistency_band",
    """
        half = NormalDist().inv_cdf(1 - alpha / 2) * math.sqrt(2 * dof / runs)
        return dof - half, dof + half
    """,
)
mistakes(
    "COVERAGE_OPEN_BOUNDS",
    "A value exactly on an end is not counted.",
    "Ends are included: use <= on both sides.",
).body("coverage", "return float(np.mean((lo < y) & (y < hi)))").body(
    "coverage", "return float(np.mean((lo <= y) & (y < hi)))"
)
mistakes(
    "COUNTED",
    "The result is the number of values inside, not their fraction.",
    "Divide by the number of values.",
).body("coverage", "return int(np.sum((lo <= y) & (y <= hi)))")
mistakes(
    "OUTSIDE_COUNTED",
    "The result is the fraction that lies outside.",
    "Count where lo <= y <= hi.",
    kind="consequence",
).body("coverage", "return float(np.mean((y < lo) | (hi < y)))")
mistakes(
    "IN_PER_CENT",
    "The result is a hundred times too large.",
    "Return a fraction, not a percentage.",
    kind="consequence",
).body("coverage", "return 100 * float(np.mean((lo <= y) & (y <= hi)))")
mistakes(
    "IID_BOOTSTRAP",
    "In the resamples, most errors are not followed by the next one of the series. Are single errors drawn, or blocks taken apart?",
    "Choose random starts, take block consecutive samples from each, and keep their order.",
).around("block_bootstrap_ci", "return _right(e, statistic, 1, n_boot, alpha, rng)")
mistakes(
    "RESAMPLE_SIZE",
    "In a short trial, not every resample has as many errors as the series.",
    "Join blocks until there are at least N samples, and cut off the rest; N need not be a multiple of block.",
    kind="fact",
).edit("block_bootstrap_ci", {"[:, :n]": ""}).edit(
    "block_bootstrap_ci", {"math.ceil(n / block)": "n // block"}
)
mistakes(
    "BLOCK_IGNORED",
    "The blocks in the resamples are much shorter or longer than `block`.",
    "Each block has a random start of its own, and then block consecutive samples.",
).around("block_bootstrap_ci", "return _right(e, statistic, round(len(e) ** (1 / 3)), n_boot, alpha, rng)")
mistakes(
    "ONE_STANDARD_ERROR",
    "Which part of your code uses alpha, and is half of it left out on either side?",
    "Take the quantiles of the resampled values at alpha/2 and 1 - alpha/2, or z standard deviations either way, with z the normal quantile at 1 - alpha/2. A fixed level or factor is right for one alpha only.",
    kind="consequence",
).edit(
    "block_bootstrap_ci",
    {
        "np.quantile(values, ": "np.mean(values) + np.std(values) * np.array(",
        "[alpha / 2, 1 - alpha / 2]": "[-2, 2]",
    },
    also=("WIDTH_SCALED", "FIXED_LEVELS"),
)
mistakes(
    "STATISTIC_IGNORED",
    "The interval is not made of what the statistic returns for the resamples.",
    "Keep what statistic(samples) returns for each resample; it need not be the mean.",
).edit("block_bootstrap_ci", {"statistic(e[row])": "np.mean(e[row])"}).edit(
    "block_bootstrap_ci", {"statistic(e[row])": "(statistic(e[row]), np.mean(e[row]))[1]"}
)
mistakes(
    "GLOBAL_RNG",
    "The same generator in the same state gives a different interval.",
    "Take every random number from rng, and keep nothing from one call to the next.",
    kind="fact",
).edit("block_bootstrap_ci", {"rng.integers": "np.random.default_rng().integers"})
mistakes(
    "FIXED_SEED",
    "Another generator gives exactly the same interval.",
    "Take every random number from rng, anew in each call.",
    kind="fact",
).edit("block_bootstrap_ci", {"rng.integers": "np.random.default_rng(0).integers"})
mistakes(
    "NOT_ABSOLUTE",
    "Your code divides by the first energy with its sign. Where energies are negative, a gain looks like a loss.",
    "Divide by abs(E[0]).",
).edit("energy_error", {"abs(values[0])": "values[0]"})
mistakes(
    "TO_CURRENT", "Your code divides by the energy at each moment.", "Divide by abs(E[0]), always."
).edit("energy_error", {"abs(values[0])": "np.abs(values)"})
mistakes(
    "WHOLE_NUMBERS",
    "The result is right for floats, and wrong for the same numbers in an array of whole numbers.",
    "Start from floats: np.asarray(x, dtype=float) of each array that comes in. np.empty_like(x) and np.zeros_like(x) make an array of whole numbers where x is one, and cut off every fraction.",
    kind="fact",
).edit("energy_error", {"zip(q, v)]": "zip(q, v)], dtype=np.asarray(q).dtype"}).edit(
    "coverage", {"(lo <= y) & (y <= hi)": "(np.array(lo, y.dtype) <= y) & (y <= np.array(hi, y.dtype))"}
).around("wrap_angle", "return _right(e).astype(np.asarray(e).dtype)").edit(
    "block_bootstrap_ci", {"(e, dtype=float)": "(e)", "(values": "(np.array(values, dtype=e.dtype)"}
)
mistakes(
    "UNSIGNED",
    "The result has lost its sign.",
    "Take no absolute value of the error: its sign says whether it is too large or too small. Only energy_error has bars, and there they belong to E[0] alone.",
).edit("energy_error", {"(values - values[0])": "np.abs(values - values[0])"}).edit(
    "contact_force_error", {"float(": "abs("}
).edit("bias_variance", {"float(bias)": "abs(float(bias))"})
mistakes(
    "TO_PREVIOUS",
    "Your code compares each sample with the one before it.",
    "Subtract E[0] from each sample and divide by abs(E[0]): a slow drift cannot be seen from step to step.",
).edit("energy_error", {"(values - values[0])": "np.diff(values, prepend=values[0])"})
mistakes(
    "WHOLE_ARRAYS",
    "More than one of each is passed at once.",
    "Loop over the samples: energy(q[i], v[i]) returns one number.",
    kind="fact",
).edit("energy_error", {"[energy(q_i, v_i) for q_i, v_i in zip(q, v)]": "energy(q, v)"})
mistakes(
    "PEAK_OF_ERROR",
    "The peak is that of the difference. So a late impact looks like one of the wrong strength.",
    "Take the peak of each force separately, then compare the two numbers.",
    kind="consequence",
).edit(
    "contact_force_error", {"relative(np.max)": "float(np.max(np.subtract(f_sim, f_real)) / np.max(f_real))"}
)
mistakes(
    "PEAK_AT_SAME_TIME",
    "Your code compares the two forces at the moment at which one of them has its peak.",
    "Take the peak of each force separately, wherever it is.",
    kind="consequence",
).edit("contact_force_error", {"np.max": "lambda f: f[np.argmax(f_real)]"})
mistakes(
    "IMPULSE_OF_ABSOLUTE",
    "The impulse is the integral of the absolute difference. So a late impact looks like one of the wrong strength.",
    "Integrate each force separately, then compare the two numbers.",
    kind="consequence",
).edit(
    "contact_force_error",
    {"relative(lambda f: np.sum(f) * dt)": "float(np.sum(np.abs(f_sim - f_real)) / np.sum(f_real))"},
)
mistakes(
    "IMPULSE_WHILE_BOTH",
    "Your code integrates only over the samples at which both forces are above zero.",
    "Integrate each force over its whole recording: the two impacts need not be at the same time.",
    kind="consequence",
).edit("contact_force_error", {"np.sum(f)": "np.sum(f[(f_sim > 0) & (f_real > 0)])"})
mistakes(
    "DIVIDED_BY_SIM",
    "The difference is divided by the simulated value.",
    "Divide by the real value: it is the reference.",
    kind="consequence",
).edit("contact_force_error", {") / of(f_real)": ") / of(f_sim)"})
mistakes(
    "FITS_ONCE",
    "All predictions come from a single model, which was fitted to all runs, so no run is held out.",
    "Fit a new model for each fold, without the runs of that fold.",
    kind="fact",
).edit(
    "cross_validate",
    {
        "fit([run for i, run in enumerate(runs) if i not in held_out])": "model if scores else fit(runs)",
        "np.array(scores)": "scores",
    },
)
mistakes(
    "LEAKS_HELD_OUT",
    "A model predicts runs that it was fitted to.",
    "For each fold, fit to all the runs outside it and predict those inside it.",
    kind="fact",
).edit("cross_validate", {"i not in held_out": "i != held_out[0]", "np.array(scores)": "scores"}).edit(
    "cross_validate",
    {"[run for i, run in enumerate(runs) if i not in held_out]": "runs", "np.array(scores)": "scores"},
)
mistakes(
    "SCORES_TRAINING",
    "Each model predicts the very runs that it was fitted to.",
    "Fit to all the runs outside the fold, and predict the runs of the fold.",
    kind="fact",
).edit(
    "cross_validate",
    {"for i in held_out]": "for i in range(len(runs)) if i not in held_out]", "np.array(scores)": "scores"},
)
mistakes(
    "NOT_CONTIGUOUS",
    "The runs of a fold are not neighbours in the list.",
    "The first fold is the first runs of the list, and so on: do not shuffle or alternate.",
    kind="fact",
).edit(
    "cross_validate",
    {
        "np.array_split(np.arange(len(runs)), k)": "[range(j, len(runs), k) for j in range(k)]",
        "np.array(scores)": "scores",
    },
)
mistakes(
    "FOLDS_UNEVEN",
    "The folds that hold a run are not k, or a run is in none of them, or in several.",
    "np.array_split(range(len(runs)), k) gives k parts whose lengths differ by at most one.",
    kind="fact",
).edit(
    "cross_validate",
    {
        "np.array_split(np.arange(len(runs)), k)": "np.arange(len(runs) // k * k).reshape(k, -1)",
        "np.array(scores)": "scores",
    },
)
mistakes(
    "FOLD_SIZES",
    "There are k folds and each run is in one of them, but one fold has at least two runs more than another.",
    "Give the runs that are left over to different folds, one each: seven runs in three folds are 3, 2 and 2. np.array_split(range(len(runs)), k) does so.",
    kind="fact",
).edit("cross_validate", {")), k)": ")), np.arange(1, k) * (len(runs) // k))"}).edit(
    "cross_validate", {")), k)": ")), np.arange(1, k) * math.ceil(len(runs) / k))"}, also=("", "RAISED")
)
mistakes(
    "ONE_RUN_LEFT_OUT",
    "Each model leaves out a single run, not a whole fold.",
    "For each fold, fit one model to all the runs outside it, and predict every run of the fold with that.",
    kind="fact",
).edit(
    "cross_validate",
    {
        "        model = fit([run for i, run in enumerate(runs) if i not in held_out])\n": "",
        "predict(model, runs[i])": "predict(fit(runs[:i] + runs[i + 1 :]), runs[i])",
    },
)
mistakes(
    "ROOTS_WEIGHTED",
    "Each score is the mean of the RMSEs of its runs, each as often as the run has samples.",
    "Square the errors of all samples of the fold, average them, and take the root once, at the end.",
)
mistakes(
    "MEAN_OF_RUNS",
    "Your code averages results of single runs. So a short run counts as much as a long one.",
    "Pool all samples first, then compute the number once.",
    kind="consequence",
).edit(
    "cross_validate",
    {
        "np.sqrt(np.mean(np.concatenate(e) ** 2))": "np.mean([np.sqrt(np.mean(x**2)) for x in e])",
        "np.array(scores)": "scores",
    },
).around(
    "validate",
    """
        report = _right(sim, real, spec)
        if report["runs_used"]:
            e = [columns(pair) for pair in held_out_pairs(sim, real)]
            report["rmse"] = float(np.mean([np.sqrt(np.mean((y - r) ** 2)) for y, _, r in e]))
        return report
    """,
)
mistakes(
    "TRAINS_ON_TOO_LITTLE",
    "A model is not fitted to all the runs outside its fold.",
    "Pass every run outside the fold to fit, also those that come later in the list. If you tell runs apart by a key or by their length, use their place in the list instead.",
    kind="fact",
).edit(
    "cross_validate",
    {
        "[run for i, run in enumerate(runs) if i not in held_out]": "[runs[held_out[0] - 1]]",
        "np.array(scores)": "scores",
    },
).body(
    "cross_validate",
    """
        scores = []
        for fold in np.array_split(np.arange(len(runs)), k):
            lengths = {len(runs[i]["y"]) for i in fold}
            alike = len({len(run["y"]) for run in runs}) == 1
            outside = [
                run for i, run in enumerate(runs) if i not in fold and (alike or len(run["y"]) not in lengths)
            ]
            model = fit(outside)
            errors = [predict(model, runs[i]) - runs[i]["y"] for i in fold]
            scores.append(math.sqrt(np.mean(np.concatenate(errors) ** 2)))
        return np.array(scores)
    """,
)
mistakes(
    "CALIBRATION_RUNS_SCORED",
    "Your code scores runs on which the simulation was calibrated.",
    "Leave out every run whose id is in calibrated_on before you compute anything.",
    kind="fact",
).edit("validate", {' if run["id"] not in sim["calibrated_on"]': ""}, of="held_out_pairs")
mistakes(
    "PART_OF_AN_ID",
    "A run is left out whose id is only a part of one in calibrated_on.",
    "Compare whole ids. `in` looks for whole ones in a list or a set, and for a part of a text in a text.",
    kind="fact",
).edit("validate", {'not in sim["calibrated_on"]': 'not in str(sim["calibrated_on"])'}, of="held_out_pairs")
mistakes(
    "NOTHING_LEFT",
    "With one run left, or none, your code does not answer as the README says.",
    "With none: reason calibration_data, four numbers and intervals None, runs_used empty. With one: the four numbers, intervals None, reason single_run.",
    kind="fact",
).edit("validate", {'False, "reasons": [why]': 'not pairs, "reasons": [why] if pairs else []'}).around(
    "validate",
    """
        report = _right(sim, real, spec)
        if len(report["runs_used"]) == 1:
            ends = {key: (report[key], report[key]) for key in ("rmse", "bias", "lag_s", "coverage")}
            report |= {"accepted": True, "reasons": [], "intervals": ends}
        return report
    """,
).edit("validate", {"measures(pairs) if pairs else dict": "dict"})
mistakes(
    "MATCHED_BY_POSITION",
    "Your code pairs runs by their position in the list.",
    "Pair them by id: the two lists may have different orders and different runs.",
    kind="fact",
).body(
    "validate",
    """
        pairs = zip(sim["runs"], real["runs"])
        return [(s, r) for s, r in pairs if s["id"] not in sim["calibrated_on"]]
    """,
    of="held_out_pairs",
)
mistakes(
    "LAG_SIGN",
    "The lag has the wrong sign, or has lost its sign.",
    "The lag is positive where the simulation is late: where sim(t + lag) looks like real(t).",
    kind="fact",
).around("validate", "return -_right(pairs)", of="best_shift")
mistakes(
    "LAG_WHOLE_SAMPLES",
    "Here the lag is a whole number of samples.",
    "The best shift may lie between two samples. Fit a parabola to the mean square at the best shift and its two neighbours.",
    kind="fact",
).edit(
    "validate",
    {"shifts[i] + (0.5 * dt * (a - c) / bend if bend > 0 else 0.0)": "shifts[np.argmin(cost)]"},
    of="best_shift",
)
mistakes(
    "LAG_NOT_BEST",
    "Another shift fits the samples of all runs better.",
    "For each shift s, from -0.19 to 0.19 s, add up the squares of sim(t + s) - real(t) over all runs, each with its own time step and sim interpolated linearly, and divide by the number of samples. Leave out a sample where t + s lies outside of sim's recording, or take sim's last value there. The best shift has the smallest mean square; the parabola goes through it and its two neighbours.",
    kind="fact",
).body(
    "validate",
    """
        dt = min(r["t"][1] - r["t"][0] for _, r in pairs)
        shifts = np.arange(-round(MAX_LAG / dt), round(MAX_LAG / dt) + 1) * dt
        off = np.zeros(len(shifts))
        for simulated, r in pairs:
            t = np.asarray(r["t"])
            for i, s in enumerate(shifts):
                inside = (t + s >= t[0] - 1e-9) & (t + s <= t[-1] + 1e-9)
                off[i] += np.sum(np.interp(t[inside] + s, t, simulated["y"]) - np.asarray(r["y"])[inside])
        i = int(np.clip(np.argmin(np.abs(off)), 1, len(shifts) - 2))
        a, b, c = np.abs(off[i - 1 : i + 2])
        return float(shifts[i] + 0.5 * dt * (a - c) / (a - 2 * b + c))
    """,
    of="best_shift",
    also=("LAG_AT_THE_END", "LAG_SIGN", "LAG_NOT_NEGATIVE", "LAG_MEAN_OF_RUNS", "LAG_OF_ONE_RUN", ""),
)
mistakes(
    "LAG_OF_PRODUCTS",
    "The lag is about the shift with the largest sum of products, sim times real: that of a correlation.",
    "Take the shift with the smallest mean square of sim(t + s) - real(t). A sum of products is large where many samples overlap, or large ones.",
    kind="fact",
).edit(
    "validate",
    {') - r["y"]': ') * r["y"]', "e**2": "-e", "squares / counts": "squares"},
    of="misfit",
    also=("LAG_PAST_THE_END", "LAG_NOT_BEST", ""),
).edit(
    "validate",
    {
        'simulated["y"]) - r["y"]': 'simulated["y"] - np.mean(simulated["y"])) * (r["y"] - np.mean(r["y"]))',
        "e**2": "-e",
        "squares / counts": "squares",
    },
    of="misfit",
    also=("LAG_PAST_THE_END", "LAG_OF_PARTS", "LAG_NOT_BEST", ""),
)
mistakes(
    "LAG_SEARCH_SHORT",
    "Asked about single runs, your code finds a lag of 0.05 s, but none of 0.17 s.",
    "Try all shifts from -0.19 to 0.19 s.",
    kind="fact",
).program("validate", "MAX_LAG = 0.1  # s", also=("LAG_AT_THE_END",))
mistakes(
    "LAG_EARLY_MISSED",
    "Asked about single runs, your code finds how late a simulation is, but not how early.",
    "Try negative shifts, too: from -0.19 to 0.19 s. The lag of an early simulation is negative.",
    kind="fact",
).edit(
    "validate",
    {"np.arange(-round(MAX_LAG / dt),": "np.arange(0,", " if bend > 0 else 0.0": ""},
    of="best_shift",
    also=("LAG_NOT_NEGATIVE", "LAG_OF_PARTS", ""),
)
mistakes(
    "LAG_OF_SUMS",
    "The lag is about the shift with the smallest sum of squares over the samples that overlap.",
    "Divide the sum at each shift by the number of samples in it. Fewer samples have a smaller sum, but no better fit.",
    kind="fact",
).edit("validate", {"squares / counts": "squares"}, of="misfit", also=("LAG_NOT_BEST",))
mistakes(
    "LAG_PAST_THE_END",
    "The lag is about the best shift of a simulation that is zero, or begins again, outside of its recording.",
    "Where t + s lies outside of sim's recording, leave the sample out, or take sim's last value. np.roll brings back the other end; left=0 and right=0 in np.interp give zeros.",
    kind="fact",
).edit(
    "validate",
    {
        'simulated["y"])': 'simulated["y"], left=0.0, right=0.0)',
        "(later >= t[0] - 1e-9) & (later <= t[-1] + 1e-9)": "np.full(later.shape, True)",
    },
    of="misfit",
    also=("LAG_NOT_BEST",),
)
mistakes(
    "LAG_OF_ONE_STEP",
    "The lag is about the best shift if all runs are moved by the same number of samples.",
    "A shift is a time, and the runs have different time steps: compare np.interp(t + s, t, y_sim) with y_real, run by run.",
    kind="fact",
).body(
    "validate",
    """
        dt = pairs[0][1]["t"][1] - pairs[0][1]["t"][0]
        most = round(MAX_LAG / dt)
        cost = np.array([
            np.mean(np.concatenate([
                (np.roll(np.asarray(s["y"]), -k) - np.asarray(r["y"]))[max(0, -k) : len(r["y"]) - max(0, k)]
                for s, r in pairs
            ]) ** 2)
            for k in range(-most, most + 1)
        ])  # fmt: skip
        i = int(np.clip(np.argmin(cost), 1, len(cost) - 2))
        a, b, c = cost[i - 1 : i + 2]
        return float(dt * (i - most + 0.5 * (a - c) / (a - 2 * b + c)))
    """,
    of="best_shift",
    also=("LAGS_OF_SINGLE_RUNS", "LAG_OF_PARTS", "LAG_OF_EVEN_RUNS", "LAG_NOT_BEST", ""),
)
mistakes(
    "LAG_PARABOLA_BACKWARDS",
    "Your code finds the best sample, but moves the lag from there to the wrong side.",
    "With costs a, b, c at the best shift and its two neighbours, add step * (a - c) / (2 * (a - 2 * b + c)) to the best shift.",
    kind="fact",
).edit(
    "validate", {"shifts[i] + ": "shifts[i] - "}, of="best_shift", also=("LAG_NOT_BEST", "LAG_OF_PARTS", "")
)
mistakes(
    "LAG_OF_EVEN_RUNS",
    "The lag is about the shift with the smallest mean of the runs' own mean squares.",
    "Add up the squares of all runs, then divide by the number of all their samples that overlap. A mean of mean squares counts a short run as much as a long one.",
    kind="fact",
).around(
    "validate",
    "return np.mean([_right([pair], shifts) for pair in pairs], axis=0)",
    of="misfit",
    also=("LAG_MEAN_OF_RUNS", "LAG_OF_PARTS", "LAG_NOT_BEST"),
)
mistakes(
    "LAG_OF_ONE_RUN",
    "The lag is about that of one of the runs by itself.",
    "At each shift, add up the squares of all runs. If a loop over the runs sets the sum to zero each time, only the last run is left: set it to zero before the loop.",
    kind="fact",
).around(
    "validate",
    "return _right(pairs[-1:], shifts)",
    of="misfit",
    also=("LAG_MEAN_OF_RUNS", "LAG_OF_PARTS", "LAG_NOT_BEST"),
).around(
    "validate",
    'return _right(sorted(pairs, key=lambda pair: pair[0]["id"])[:1])',
    of="best_shift",
    also=("LAG_MEAN_OF_RUNS", ""),
)
mistakes(
    "LAG_NOT_NEGATIVE",
    "Here the simulation is early, but the lag is not negative.",
    "If your shifts begin at zero, let them begin at -0.19 s. A negative lag is that of a simulation that is early.",
    kind="fact",
)
mistakes(
    "ABOUT_THE_NUMBER",
    "The interval is as wide as with the squares of x_i minus the number, not minus the mean of the x_i.",
    "Subtract the mean of the numbers with one run left out: error = sqrt((n - 1)/n * sum((x_i - mean(x_i))**2)). If you do, see that each x_i leaves out one run and no more.",
    kind="consequence",
).edit("validate", {"values - np.mean(values)": "values - value"}, of="interval_of_each")
mistakes(
    "FEW_DIGITS",
    "Here the first digits are right, and the later ones are not.",
    "Use float64, numpy's default. Do not round, and add no small number.",
    kind="consequence",
)
mistakes(
    "PEAK_NOT_LARGEST",
    "The peak is that of a curve through the samples, an average of some, or a percentile.",
    "A peak is the largest sample, as it was recorded.",
    kind="consequence",
).edit("contact_force_error", {"np.max": "lambda f: np.percentile(f, 99)"})
mistakes(
    "BEGINNING_REPEATED",
    "After its whole blocks, every resample of a short trial repeats its own beginning.",
    "If N is no multiple of block, draw one more block, and cut the resample off at N samples. np.resize repeats the beginning.",
    kind="fact",
).edit("block_bootstrap_ci", {"math.ceil(n / block)": "max(1, n // block)", "e[row]": "np.resize(e[row], n)"})
mistakes(
    "LAG_IN_SAMPLES",
    "The lag is as large as a number of samples, or of milliseconds.",
    "lag_s is in seconds: multiply a number of samples by the time between them, or divide milliseconds by 1000.",
    kind="fact",
).around("validate", 'return _right(pairs) / min(r["t"][1] - r["t"][0] for _, r in pairs)', of="best_shift")
mistakes(
    "SIGN_OF_LIMIT_IGNORED",
    "A negative bias or lag is accepted, although its interval reaches beyond the margin.",
    "Margins of bias and lag extend to both sides of zero. Refuse where lo < -limit or hi > limit.",
).edit("validate", {"if not least": 'if (key != "lag_s" or numbers[key] >= 0) and not least'}).edit(
    "validate", {"if not least": 'if (key != "bias" or numbers[key] >= 0) and not least'}
)
mistakes(
    "SIGMA_NOT_SCALED",
    "The coverage is as large as with one sigma to each side.",
    "The interval is y plus and minus 1.96 sigma, which should cover 95 % of the values.",
    kind="consequence",
).edit("validate", {"1.96 * sigma": "sigma"}, of="measures")
mistakes(
    "WRONG_SIGN",
    "The result has the wrong sign.",
    "An error is simulated minus real. A change is the present value minus the first. A wrapped angle keeps its direction.",
    kind="consequence",
).around(
    "validate",
    """
        report = _right(sim, real, spec)
        return {**report, "bias": -report["bias"]} if report["runs_used"] else report
    """,
)
mistakes(
    "NOT_SORTED", "The reasons are right but not in order.", "Sort them alphabetically.", kind="fact"
).edit("validate", {'"reasons": reasons': '"reasons": reasons[::-1]'})
mistakes(
    "RMSE_ALONE_JUDGED",
    "Only the rmse leads to a reason. Bias, coverage and lag pass with their intervals outside their margins.",
    "bias, coverage, lag and rmse each have their own margin and reason. Refuse where lo < least or hi > most.",
).edit("validate", {"margins.items()": "list(margins.items())[:1]"})
mistakes(
    "POINT_ESTIMATE_JUDGED",
    "Your code judges by the number alone. With other runs that number may be different.",
    "Compare the whole interval with the margin.",
).edit(
    "validate", {"least <= intervals[key][0] <= intervals[key][1] <= most": "least <= numbers[key] <= most"}
)
mistakes(
    "BURDEN_REVERSED",
    "Your code refuses only what is certainly too bad. So an interval that is too wide to decide passes.",
    "Accept only if both ends of the interval lie inside the margin.",
).edit(
    "validate",
    {
        "not least <= intervals[key][0]": "intervals[key][0] > most",
        "<= intervals[key][1] <= most": "or intervals[key][1] < least",
    },
)
mistakes(
    "OVER_COVERAGE_ACCEPTED",
    "The coverage has no upper limit in your code. So a sigma of 1 km passes.",
    "Refuse a coverage whose interval reaches below coverage_min or above coverage_max.",
).around("validate", 'return _right(sim, real, {**spec, "coverage_max": math.inf})')
mistakes(
    "JACKKNIFE_FACTOR",
    "The interval is as wide as with another factor than (n - 1)/n.",
    "The standard error is sqrt((n - 1)/n * sum), and the interval reaches t of them to either side. The values with one run left out differ little from each other, so their squares are not divided by n or n - 1 again.",
    kind="consequence",
).edit("validate", {"(n - 1) / n *": "1 / n *"}, of="interval_of_each")
mistakes(
    "NOT_STUDENTS_T",
    "The interval is as wide as with another number of standard errors than T95[n - 2].",
    "With n runs, multiply by T95[n - 2]: the fewer runs, the wider the interval.",
    kind="consequence",
).edit("validate", {"T95[n - 2]": "1.96"}, of="interval_of_each")
mistakes(
    "SPREAD_OF_RUNS",
    "The interval is made from the values of single runs.",
    "Leave out one run at a time, and pool the samples of all the others.",
).edit(
    "validate",
    {"pairs[:i] + pairs[i + 1 :]": "[pairs[i]]", "(n - 1) / n": "1 / (n - 1) / n"},
    of="interval_of_each",
)
mistakes(
    "SAMPLES_COUNTED",
    "The interval is as wide as if all samples were independent. Neighbours resemble each other.",
    "Count runs, not samples: leave out one run at a time.",
).around(
    "validate",
    """
        y, sigma, measured = (np.concatenate(column) for column in zip(*map(columns, pairs)))
        e = y - measured
        intervals, bias = _right(pairs), float(np.mean(e))
        half = 1.96 * float(np.std(e)) / math.sqrt(len(e))
        return intervals | {"bias": (bias - half, bias + half)}
    """,
    of="interval_of_each",
)
mistakes(
    "LAG_MEAN_OF_RUNS",
    "The lag is about the mean of one lag for each run.",
    "Look for one shift for all runs: the one with the smallest mean square of all their samples.",
    kind="fact",
).around(
    "validate",
    """
        counts = [len(r["t"]) for _, r in pairs]
        return float(np.average([_right([pair]) for pair in pairs], weights=counts))
    """,
    of="best_shift",
    also=("",),
)
mistakes(
    "FITS_THE_FOLD",
    "Each model is fitted to its fold, not to the runs outside it.",
    "Fit to all the runs outside the fold, and predict those of the fold.",
    kind="fact",
).edit(
    "cross_validate",
    {
        " held_out ": " fold ",
        "run for i, run in enumerate(runs) if i not in held_out": "runs[i] for i in fold",
        "i in held_out]": "i in range(len(runs)) if i not in fold]",
    },
)
mistakes(
    "RETURNS_SWAPPED",
    "Two results are in the wrong order.",
    "Return (bias, variance), (lo, hi), or peak and impulse under their names.",
).edit("block_bootstrap_ci", {"float(lo), float(hi)": "float(hi), float(lo)"})
mistakes(
    "DRAWN_ONCE",
    "All resamples are the same.",
    "Draw new starting points from rng for each resample, inside the loop.",
    kind="fact",
).edit(
    "block_bootstrap_ci",
    {"size=(n_boot": "size=(1", "reshape(n_boot": "reshape(1", "in rows": "in list(rows) * n_boot"},
)
mistakes(
    "OTHER_NUMBER_OF_RESAMPLES",
    "Your code calls the statistic more often, or less often, than once for each of n_boot resamples.",
    "Draw n_boot resamples and call statistic once for each; besides, at most twice for the series itself.",
    kind="fact",
).around("block_bootstrap_ci", "return _right(e, statistic, block, 1000, alpha, rng)").edit(
    "block_bootstrap_ci",
    {"statistic(e[row])": "statistic(e[row]) - statistic(e)", "np.quantile": "statistic(e) + np.quantile"},
)
mistakes(
    "ENDS_ON_ONE_SIDE",
    "Both ends are made from the smallest of the resampled values.",
    "np.quantile counts from 0 to 1, np.percentile from 0 to 100, and an index of the sorted values from 0 to n_boot - 1.",
).edit("block_bootstrap_ci", {"np.quantile": "np.percentile"})
mistakes(
    "FIXED_LEVELS",
    "The ends are about the quantiles at 0.025 and 0.975, although alpha is not 0.05.",
    "Take the quantiles at alpha/2 and 1 - alpha/2, for the alpha that is passed in.",
).edit("block_bootstrap_ci", {"alpha / 2, 1 - alpha / 2": "0.025, 0.975"})
mistakes(
    "ENDS_UNSORTED",
    "The ends are resampled values at the right places of the list, but the list is not sorted.",
    "Sort the values before you pick two of them, or take np.quantile.",
).edit(
    "block_bootstrap_ci",
    {"np.quantile(values, [": "(values[int(p * n_boot)] for p in (", "1 - alpha / 2])": "1 - alpha / 2))"},
)
mistakes(
    "NOT_CENTRED",
    "The statistic of the series is not near the middle of the interval.",
    "Take the quantiles of the resampled values at alpha/2 and 1 - alpha/2, as they are. A basic interval mirrors them: 2 * statistic(e) minus each end, in reverse order.",
    kind="consequence",
).around(
    "block_bootstrap_ci",
    """
        whole = statistic(e)
        return _right(e, lambda sample: statistic(sample) - whole, block, n_boot, alpha, rng)
    """,
)
mistakes(
    "LEVEL_FOR_ALPHA",
    "alpha is taken as the share inside.",
    "alpha is the share outside: the ends are the quantiles at alpha/2 and 1 - alpha/2.",
).edit("block_bootstrap_ci", {"alpha / 2, 1 - alpha / 2": "(1 - alpha) / 2, (1 + alpha) / 2"})
mistakes(
    "BAND_BY_CHANCE",
    "Two calls with the same arguments give different bands.",
    "If you draw random numbers, compute the quantiles instead: `course hint validation --task consistency_band` shows ways.",
    kind="fact",
).body(
    "consistency_band",
    """
        sums = np.random.default_rng().chisquare(dof * runs, 2000)
        return tuple(np.quantile(sums, [alpha / 2, 1 - alpha / 2]) / runs)
    """,
)
mistakes(
    "ROUGH_QUANTILES",
    "The band is roughly right.",
    "Check the levels, alpha/2 and 1 - alpha/2, and the degrees of freedom, dof * runs. If they are right, find the quantiles more exactly, of random draws by taking a million: `course hint validation --task consistency_band` shows ways.",
    kind="consequence",
).body(
    "consistency_band",
    """
        n, z = dof * runs, NormalDist().inv_cdf(1 - alpha / 2)
        root = math.sqrt(2 * n - 1)
        return (root - z) ** 2 / 2 / runs, (root + z) ** 2 / 2 / runs
    """,
)
mistakes(
    "OTHER_RUNS_LISTED",
    "The numbers are those of the right runs, but runs_used does not list the ids of these.",
    "List the ids of the runs that you pooled.",
    kind="fact",
).around(
    "validate",
    """
        both = {run["id"] for run in real["runs"]}
        return _right(sim, real, spec) | {"runs_used": [run["id"] for run in sim["runs"] if run["id"] in both]}
    """,
)
mistakes(
    "STATISTIC_OF_BLOCKS",
    "In a short trial, your code asks the statistic about single blocks, not about whole resamples.",
    "Join the blocks of a resample until there are at least N samples, and cut off the rest. Then call statistic once, on all N.",
    kind="fact",
).edit(
    "block_bootstrap_ci",
    {"statistic(e[row])": "np.mean([statistic(e[s : s + block]) for s in row])", "in rows": "in starts"},
).edit("block_bootstrap_ci", {"math.ceil(n / block)": "1"})
mistakes(
    "ONE_BLOCK_REPEATED",
    "In a short trial, each resample is one block, again and again.",
    "Draw a new start for every block of a resample.",
    kind="fact",
).edit("block_bootstrap_ci", {"math.ceil(n / block)": "1", "e[row]": "np.resize(e[row], n)"})
mistakes(
    "STARTS_AMONG_FIRST",
    "In a short trial, every block begins among the first N/block samples of the series.",
    "Draw starts from 0 to N - block, both included. The number of a block is not its start: block 3 begins at 3 * block.",
    kind="fact",
).edit("block_bootstrap_ci", {"n - block + 1": "n // block"})
mistakes(
    "AN_END_LEFT_OUT",
    "Of a short series, the first or the last sample occurs in none of many resamples.",
    "Draw each start from 0 to N - block, both included: rng.integers(0, N - block + 1) leaves out its upper end. Blocks that go on at the start take their indices modulo N.",
    kind="fact",
).edit("block_bootstrap_ci", {"n - block + 1": "n - block"})
mistakes(
    "PART_OF_SERIES",
    "In a short trial, more than a fifth of the series occurs in none of the resamples.",
    "Draw a new start for every block of every resample, from 0 to N - block, both included, and take every block from `e` as it was given.",
    kind="fact",
).edit("block_bootstrap_ci", {"n - block + 1": "n // 2"})
mistakes(
    "DRAWN_WITHOUT_REPLACEMENT",
    "Every resample contains more than nine tenths of the errors of the series.",
    "Draw each start by itself, with replacement, so that some parts occur twice and others not at all.",
    kind="fact",
).edit(
    "block_bootstrap_ci",
    {
        "rng.integers(0, n - block + 1, size=(n_boot, ": "block * np.array([rng.permutation(",
        "math.ceil(n / block)))": "math.ceil(n / block)) for _ in range(n_boot)])",
        "[:, :n]": "[:, :n] % n",
    },
)
mistakes(
    "SINGLE_ROW_SQUEEZED",
    "For a single error your code returns a bare number.",
    "Return an array of shape (1,) there. np.squeeze removes every axis of length 1; name the axis that must go.",
    kind="fact",
).around("nis", "return np.squeeze(_right(nu, S))")
mistakes(
    "IMPULSE_UNTIL_PEAK",
    "The impulse is integrated only up to the peak.",
    "Integrate over the whole recording: the force that remains after the peak is part of the impulse.",
).edit("contact_force_error", {"np.sum(f)": "np.sum(f[: np.argmax(f) + 1])"})
mistakes(
    "REPEATS_AN_END",
    "The first or the last error is repeated where a block should go on.",
    "Let a block start at N - block at most, or go on at the start of the series. Do not cut indices off at N - 1.",
    kind="fact",
).edit("block_bootstrap_ci", {"n - block + 1": "n", "e[row]": "e[np.minimum(row, n - 1)]"})
mistakes(
    "BLOCKS_OF_OTHER_LENGTH",
    "In a short trial nearly all blocks have the same length, and it is not `block`.",
    "Take `block` samples from each start: e[s : s + block] ends before s + block, and np.arange(block) has `block` numbers.",
    kind="fact",
).edit(
    "block_bootstrap_ci",
    {"n / block": "n / max(block - 1, 1)", "np.arange(block)": "np.arange(max(block - 1, 1))"},
)
mistakes(
    "BLOCKS_CUT_SHORT",
    "In a short trial, many blocks end at the last error of the series before they have `block` errors.",
    "Let a block start at N - block at most, or go on at the start of the series. A slice that reaches beyond the end of `e` is shorter, without a word.",
    kind="fact",
).body(
    "block_bootstrap_ci",
    """
        e = np.asarray(e, dtype=float)
        values = []
        for _ in range(n_boot):
            parts = []
            while sum(map(len, parts)) < len(e):
                start = rng.integers(len(e))
                parts.append(e[start : start + block])
            values.append(statistic(np.concatenate(parts)[: len(e)]))
        return tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))
    """,
)
mistakes(
    "BLOCKS_DRAWN_ONCE",
    "In a short trial, no block is drawn twice for the same resample, though chance would.",
    "Draw the starting points with replacement, as rng.integers does. rng.choice needs replace=True, its default.",
    kind="fact",
).edit(
    "block_bootstrap_ci",
    {
        "rng.integers(0, n - block + 1, size=(n_boot, math.ceil(n / block)))": "np.array([rng.choice(n - block + 1, math.ceil(n / block), replace=False) for _ in range(n_boot)])"
    },
)
mistakes(
    "LAST_VALUE_LEFT_OUT",
    "The last value is never counted as inside its interval.",
    "Look at all values: range(len(y)) reaches the last one, range(len(y) - 1) does not.",
).edit("coverage", {"np.mean((lo <= y) & (y <= hi))": "np.sum(((lo <= y) & (y <= hi))[:-1]) / len(y)"})
mistakes(
    "MIDDLE_AND_HALF",
    "Values on an end are lost by rounding. That happens where the distance to the middle is compared with half the width.",
    "Compare with the ends themselves: (lo <= y) & (y <= hi).",
).edit("coverage", {"(lo <= y) & (y <= hi)": "np.abs(y - (lo + hi) / 2) <= (hi - lo) / 2"})
mistakes(
    "ONE_WIDTH_FOR_ALL",
    "All intervals get the same width.",
    "Each interval has its own ends: (lo <= y) & (y <= hi), one by one.",
).edit("coverage", {"(lo <= y) & (y <= hi)": "np.abs(y - (lo + hi) / 2) <= np.mean(hi - lo) / 2"})
mistakes(
    "ENERGY_OF_ONE_SHAPE",
    "Your code does not pass energy a position and a velocity of shape (d,).",
    "Pass q[i] and v[i] as they are.",
    kind="fact",
).edit("energy_error", {"energy(q_i, v_i)": "energy(np.atleast_2d(q_i), np.atleast_2d(v_i))"})
mistakes(
    "MARGIN_EXCLUDED",
    "An end that lies exactly on its margin counts as outside.",
    "Refuse where lo < least or hi > most, with < and >, not <= and >=.",
    kind="fact",
).edit(
    "validate",
    {
        "least <= intervals[key][0] <= intervals[key][1] <= most": "least < intervals[key][0] <= intervals[key][1] < most"
    },
)
mistakes("RAISED").edit(
    "block_bootstrap_ci",
    {
        " block ": " n_boot ",
        "(starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]": "np.minimum((starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n], n - 1)",
    },
)
mistakes(
    "FEW_DEGREES_ONLY",
    "The band is right for dof * runs = 40, and wrong here, where it is more.",
    "A search must reach far enough, a table must be long enough, random draws must be many, and a gamma function of a large argument overflows.",
).around("consistency_band", "return tuple(min(end, 1000.0 / runs) for end in _right(dof, runs, alpha))")
mistakes(
    "NOT_SQUARED",
    "The result is made of absolute errors where squares belong.",
    "Square each error, average the squares, then take the root.",
)
mistakes(
    "LARGEST_TAKEN",
    "The result is the largest error.",
    "Average the squares of all errors and take the root; the largest is only one of them.",
)
mistakes(
    "AVERAGED_TWICE",
    "Your code divides by N outside the root, or twice. So more samples of the same errors give a smaller result.",
    "Divide the sum of squares by N once, before taking the root.",
)
mistakes(
    "BIAS_FOR_RMSE",
    "The result is the mean, in which positive and negative errors cancel.",
    "Square each error before you average, and take the root of the mean.",
    kind="consequence",
)
mistakes(
    "DEVIATION_ABSOLUTE",
    "The second value is the mean absolute deviation.",
    "Square the deviations from the mean, then average.",
)
mistakes(
    "BIAS_SQUARED",
    "The first value is the square of the bias.",
    "Return the mean itself, with its sign and in the unit of the error.",
)
mistakes(
    "SINGLE_PRECISION",
    "Digits are lost, as in single precision or by rounding: where large numbers nearly cancel, all of them may be.",
    "Use float64, numpy's default, and do not round.",
)
mistakes(
    "WRAPPED_ONE_WAY",
    "Your code removes turns in one direction only.",
    "Angles of both signs occur. (e + pi) % (2 pi) - pi handles both.",
)
mistakes(
    "HALF_TURNS",
    "Your code removes half turns, so forwards and backwards become the same direction.",
    "The period of a direction is 2 pi; that of the tangent is only pi.",
)
mistakes(
    "HALF_TURN_OFF",
    "The results are off by half a turn.",
    "Add half a turn before you take the remainder of a turn, and subtract it again afterwards.",
)
mistakes(
    "IN_TURNS",
    "The result is a number of turns.",
    "The result must be in radians, as the argument is: a turn is 2 pi.",
)
mistakes(
    "PI_ROUNDED",
    "The error grows with every turn that is removed, as if a turn were not exactly 2 pi.",
    "Use math.pi or np.pi, which are exact to sixteen digits.",
)
mistakes(
    "ARGUMENTS_SWAPPED",
    "The arguments of arctan2 are in the wrong order, so the angle is measured from the wrong axis.",
    "np.arctan2 takes the sine first: arctan2(sin(e), cos(e)).",
)
mistakes(
    "CLIPPED",
    "Your code limits large angles to half a turn.",
    "Add or subtract whole turns until each angle lies between minus half a turn and half a turn. A limit gives another direction.",
)
mistakes(
    "IN_DEGREES",
    "Degrees and radians are mixed up.",
    "All angles are in radians, the arguments and the results: a turn is 2 pi.",
)
mistakes(
    "ONE_COVARIANCE",
    "Your code uses one covariance for all rows.",
    "Each row has its own covariance: P[i] belongs to err[i], or S[i] to nu[i]. np.linalg.solve and np.linalg.inv accept the whole stack.",
)
mistakes(
    "ONE_SIZE_FOR_ALL",
    "Your code divides the squared length by one number, such as the trace or the determinant of the matrix.",
    "Each component has its own uncertainty: solve P w = err for w, then sum err * w.",
)
mistakes(
    "VARIANCE_MISREAD",
    "Your code uses only the diagonal, and does not divide by it as it stands.",
    "The diagonal has variances, which are squares already. Use the whole matrix: solve P w = err for w, then sum err * w.",
)
mistakes(
    "SUMMED_THEN_SQUARED",
    "The components are added up, each over its standard deviation, and their sum is squared.",
    "Use the whole matrix: solve P w = err for w, then sum err * w.",
)
mistakes(
    "INVERTED_TWICE",
    "The covariance counts twice: its inverse is applied twice, or its square is inverted.",
    "Solve P w = err once, then sum err * w.",
)
mistakes(
    "SQUARED_BY_ELEMENT",
    "Your code squares each element of the matrix before it inverts it.",
    "The matrix contains variances and covariances, which are in squared units already: invert it as it is.",
)
mistakes(
    "CHOLESKY_TRANSPOSED",
    "Your code uses the transpose of the Cholesky factor.",
    "np.linalg.cholesky(P) returns the lower triangle L with L L^T = P: solve L w = err for w, then sum w * w. For nis, read S and nu.",
)
mistakes(
    "DETERMINANT_MISSING",
    "The result is the right one times the determinant.",
    "The inverse is the adjugate divided by the determinant; np.linalg.inv returns the inverse.",
)
mistakes(
    "DETERMINANT_ADDED",
    "The logarithm of the determinant is added, as in a likelihood.",
    "Leave it out: the task asks only for the squared distance.",
)
mistakes(
    "HALVED",
    "The result is half of the squared distance, or exp of it, as in a likelihood.",
    "Return the squared distance itself.",
)
mistakes(
    "FIRST_ROW_ALONE",
    "Only the first row is computed; the rest of the result is as your code made it.",
    "Compute every row. A return or a break inside the loop ends it after the first one.",
    kind="fact",
)
mistakes(
    "DOF_IGNORED",
    "The band is that of as many degrees of freedom as there are runs: dof is left out.",
    "The sum over the runs has dof * runs degrees of freedom.",
)
mistakes(
    "DEGREES_OFF",
    "The band is that of another number of degrees of freedom.",
    "The sum over the runs has exactly dof * runs degrees of freedom. Subtract none, and add none.",
)
mistakes(
    "DIVIDED_BY_ROOT",
    "The band is divided by the square root of the number of runs.",
    "Divide both quantiles of the sum by runs. What comes out has the smaller scatter of an average.",
)
mistakes(
    "APPROXIMATION_SLIP",
    "The Wilson-Hilferty formula has a slip: in the root, in the cube, or in 1 - 2/(9n).",
    "n * (1 - 2/(9n) + z * sqrt(2/(9n)))**3, with n = dof * runs and z the normal quantile.",
)
mistakes(
    "ALPHA_IGNORED",
    "The band is the same for alpha = 0.01, 0.08 and 0.2.",
    "Take the quantiles at alpha/2 and 1 - alpha/2 for the alpha that is passed in: 1.96 belongs to 0.05 alone.",
)
mistakes(
    "SUM_OF_RUNS",
    "The result is the sum of one RMSE for each run of the fold.",
    "Pool the errors of all runs of the fold, and compute one RMSE from all of them.",
)
mistakes(
    "NEARLY_INSIDE",
    "Values just outside of their intervals are counted.",
    "Compare without a tolerance, and do not round before: (lo <= y) & (y <= hi).",
)
mistakes(
    "EITHER_END",
    "Your code counts a value that keeps within only one of the two ends.",
    "Both must hold: (lo <= y) & (y <= hi).",
)
mistakes(
    "ONE_END_ONLY",
    "Your code checks only one end of the intervals.",
    "Both must hold: (lo <= y) & (y <= hi).",
)
mistakes(
    "ONE_INTERVAL_FOR_ALL",
    "Your code compares all values with one interval.",
    "Each value has its own interval: compare y[i] with lo[i] and hi[i], or the arrays as they are.",
)
mistakes(
    "ALL_OR_NONE",
    "The result is 0 or 1: whether all values lie inside, or whether any does.",
    "Take the mean of the True and False values.",
)
mistakes(
    "NOT_RESAMPLED",
    "Each time that your code calls the statistic, it passes the series itself.",
    "Draw new random starting points for the blocks of each resample, with replacement, and pass the resample to statistic.",
    kind="fact",
)
mistakes(
    "NOT_OF_THE_SERIES",
    "The resamples contain values that are not in the series.",
    "Use the errors as they are: add nothing, subtract nothing, and fill each resample to its end.",
    kind="fact",
)
mistakes(
    "WIDTH_SCALED",
    "Both ends are much nearer to the middle, or much farther from it, than the right quantiles.",
    "Take the quantiles at alpha/2 and 1 - alpha/2 as they are, without any factor.",
)
mistakes(
    "SHRINKS_WITH_RESAMPLES",
    "More resamples make the interval narrower. Is something divided by n_boot, or by its root?",
    "The spread of the resampled values already is that of the statistic: take their quantiles, and do not divide.",
)
mistakes(
    "ENERGY_ARGUMENTS_SWAPPED",
    "Your code passes the velocity to energy first, and then the position.",
    "Call energy(q[i], v[i]): position first.",
)
mistakes(
    "TO_ANOTHER",
    "Your code subtracts, or divides by, something other than the first energy.",
    "Subtract E[0] and divide by abs(E[0]).",
)
mistakes(
    "AFTER_THE_SHIFT",
    "rmse, bias and coverage are computed after the simulation was moved by its lag.",
    "Compare the samples at the same times, as they are: a lag is an error like any other.",
).around(
    "validate",
    """
        lag = best_shift(pairs)
        moved = [({**s, "y": np.interp(np.asarray(s["t"]) + lag, s["t"], s["y"])}, r) for s, r in pairs]
        return {**_right(moved), "lag_s": lag}
    """,
    of="measures",
)
mistakes(
    "FROM_THE_FIRST",
    "The first error is subtracted from all of them.",
    "Square the errors as they are: one that is the same throughout counts too.",
)
mistakes(
    "FAR_ONES_LEFT_OUT",
    "Errors far from the others are left out.",
    "Square all of them: a rare, large error is what the rmse is meant to show.",
)
mistakes(
    "VARIANCE_OF_SIZES",
    "The second value is the variance of the sizes: the signs of the errors are lost.",
    "Subtract the bias from each error as it is, and take the mean square.",
)
mistakes(
    "VARIANCE_OF_STEPS",
    "The second value comes from the differences of neighbours.",
    "Subtract the bias from each error, and take the mean square: the order of the errors does not matter.",
)
mistakes(
    "UNWRAPPED",
    "Each angle is joined to the one before it, as np.unwrap does, and leaves the range.",
    "Wrapping is the opposite: bring each angle by itself between -pi and pi.",
)
mistakes(
    "BAND_OF_ONE_COMPONENT",
    "The band is that of a single component, times dof.",
    "The sum over all components and runs has dof * runs degrees of freedom. Take its quantiles, and divide them by runs.",
)
mistakes(
    "SIDES_MULTIPLIED",
    "You multiply the share of values above lo by the share below hi.",
    "A value counts if it is within both ends: combine the comparisons before you take the mean.",
)
mistakes(
    "LAG_OF_SHAPES",
    "The lag is about the shift at which the shapes fit best, with the mean difference of each run taken off.",
    "Leave the differences as they are: sim(t + s) - real(t), squared.",
    kind="fact",
).around(
    "validate",
    """
        level = [np.mean(np.subtract(s["y"], r["y"])) for s, r in pairs]
        return _right([({**s, "y": np.asarray(s["y"]) - off}, r) for off, (s, r) in zip(level, pairs)])
    """,
    of="best_shift",
    also=("LAG_NOT_BEST", ""),
)
mistakes(
    "LOGARITHM",
    "The result is the logarithm of the ratio.",
    "Return (E - E[0]) / abs(E[0]): a difference, which also works for negative energies.",
)
mistakes("SQUARED", "The result is squared.", "Return the relative difference itself, with its sign.")
mistakes(
    "SUMMED_UP",
    "The result is the running sum of the errors.",
    "Each sample has its own error, so do not add them up.",
)
mistakes(
    "NOT_RELATIVE",
    "The result is a difference that is not divided by anything.",
    "Divide by what the README says, so that the result has no unit.",
    kind="consequence",
)
mistakes(
    "RATIO",
    "The result is a quotient: without an error it is 1 or -1, not 0.",
    "Take the difference first, then divide: (E - E[0]) / abs(E[0]), or (sim - real) / real.",
    kind="consequence",
)
mistakes(
    "IMPULSE_AT_SAME_TIME",
    "The impulse of one force is taken only where the other one acts.",
    "Integrate each force over the whole recording, wherever the other one begins and ends.",
    kind="consequence",
).edit("contact_force_error", {"np.sum(f)": "np.sum(f[f_real > 0])"})
mistakes(
    "IMPULSE_OF_SQUARES",
    "The impulse is the integral of the squared force.",
    "Integrate the force itself over time.",
    kind="consequence",
)
mistakes(
    "IMPULSE_OF_PEAK",
    "The error of the impulse is that of the peak.",
    "Integrate: sum all samples of the force and multiply by dt.",
    kind="consequence",
)
mistakes(
    "MEAN_FORCE",
    "A mean force stands for the peak or for the impulse.",
    "The peak is the largest sample. The impulse is the sum of all samples times dt.",
    kind="consequence",
)
mistakes(
    "DIVIDED_BY_BOTH",
    "The difference is divided by the mean of both values, or by the larger one.",
    "Divide by the real value: it is the reference.",
    kind="consequence",
)
mistakes(
    "NEVER_PREDICTS",
    "predict is never called.",
    "For each fold, call predict(model, run) for each of its runs, with the model that was fitted to the others.",
    kind="fact",
)
mistakes(
    "LAST_RUN_ALONE",
    "The score of a fold uses only its last run.",
    "Collect the errors of all runs of the fold, and compute one RMSE from all of them.",
)
mistakes(
    "FOLDS_IN_OTHER_ORDER",
    "The scores are right, but in another order than the folds.",
    "Do not shuffle or sort the runs: the first score belongs to the first runs of the list.",
)
mistakes(
    "FOLDS_REVERSED",
    "The scores are in reverse order.",
    "The first score belongs to the first fold, which is the first runs of the list.",
)
mistakes(
    "LAG_AT_THE_END",
    "The lag is larger than any lag here can be.",
    "Return seconds, not an index. Search up to 0.2 s either way, with each run's own time step. Compare mean squares, not sums: fewer samples overlap at a larger shift.",
    kind="fact",
)
mistakes(
    "LAGS_OF_SINGLE_RUNS",
    "The interval of the lag is as wide as the lags of single runs make it.",
    "Leave out one run at a time, and search for the best shift of all the others together.",
    kind="fact",
)
mistakes(
    "LAG_OF_PARTS",
    "The lag is close enough, but its interval is not.",
    "Leave out one run at a time, and search for the best shift of all the others together, early or late. It has the smallest mean square of the samples that overlap, not the smallest sum, with sim interpolated linearly. Then fit the parabola.",
    kind="fact",
)
mistakes(
    "INTERVALS_SCALED",
    "Several intervals are too wide, or too narrow, by the same factor.",
    "Look at what they share: the factor in sqrt((n - 1)/n * sum), and T95[n - 2].",
    kind="consequence",
)
mistakes(
    "ZERO_WIDTH",
    "The interval is a single point.",
    "The interval reaches from the number minus t standard errors to the number plus t standard errors. Where that is so, see that the number is computed anew, the lag too, for each set with one run left out, and to a fraction of a sample.",
    kind="consequence",
)
mistakes(
    "CENTRED_ON_THE_REST",
    "The middle of the interval is the mean of the values with one run left out.",
    "Centre it on the number from all runs: from number - t * error to number + t * error.",
)
mistakes(
    "MEASURE_NOT_JUDGED",
    "One of the four measures passes, even with its whole interval outside its margin.",
    "bias, coverage, lag and rmse each have their own margin and reason. Refuse where lo < least or hi > most.",
)
mistakes(
    "SIGMA_MULTIPLE",
    "The coverage is as large as with another multiple of sigma than 1.96.",
    "Use 1.96 sigma to each side: that is 95 %.",
    kind="consequence",
)
mistakes(
    "SIGMA_MISREAD",
    "The coverage is as large as with the root, the square or the mean of sigma.",
    "sigma is the standard deviation of each sample: use 1.96 * sigma, sample by sample.",
    kind="consequence",
)
mistakes(
    "OWN_SPREAD_FOR_SIGMA",
    "The coverage is as large as with the spread of the errors in the place of sigma.",
    'The simulation claims a sigma of its own: use run["sigma"].',
    kind="consequence",
)
mistakes(
    "SIGMA_ONE_SIDED",
    "Only one side of the interval is checked.",
    "A value may be too high or too low: abs(y_sim - y_real) <= 1.96 sigma.",
)
mistakes(
    "REASON_MISSING",
    "A reason is missing: the right interval reaches beyond its margin.",
    "Refuse where lo < least or hi > most, with the ends of the interval and not the number itself, for each of the four. Collect every reason that applies.",
    kind="consequence",
)
mistakes(
    "REASON_TOO_MANY",
    "A reason does not apply: the right interval lies inside its margin.",
    "Compare each interval with its own margin: of the rmse the upper end, of the others both.",
    kind="consequence",
)
mistakes(
    "REASON_TWICE",
    "A reason is listed more than once.",
    "List each reason once, also where an interval reaches beyond its margin on both sides.",
    kind="fact",
)
mistakes(
    "REASON_UNKNOWN",
    "A reason is none of bias, coverage, lag and rmse.",
    'With two runs or more, the reasons are "bias", "coverage", "lag" and "rmse", spelled exactly like this.',
    kind="fact",
)
mistakes(
    "VERDICT_AGAINST_REASONS",
    "`accepted` contradicts the reasons.",
    "accepted is True exactly where there is no reason.",
    kind="fact",
)


model, formulas, facts = (kit.sibling(__file__, name) for name in ("validation", "formulas", "facts"))


MEASURES = facts.MEASURES


_EXACT = ("rmse", "bias", "coverage")
_SOME = (MEASURES, *((key,) for key in _EXACT))


@mistakes.more
def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for task, families in TERMS.items():
        for code, function in formulas.OTHERS.get(task, ()):
            yield task, (code,), function
        for family, terms in families:
            for term, (code, form) in ((term, entry) for term in terms for entry in terms[term]):
                yield task, (code,), family(**{term: form})
    yield from (("validate", codes, function) for codes, function in _widths())
    for task, families in TERMS.items():
        for family, terms in families:
            # Two terms wrong at once; of many, each in the first form of its code.
            pairs = _pairs(terms)
            if len(pairs) > _FEW:
                pairs = _pairs({term: tuple(dict(reversed(forms)).items()) for term, forms in terms.items()})
            for codes, wrong in pairs[:: max(1, math.ceil(len(pairs) / _MOST))]:
                yield task, codes, family(**wrong)


def _pairs(terms):
    return [
        ((code, second), {one: form, other: another})
        for one, other in itertools.combinations(terms, 2)
        for (code, form), (second, another) in itertools.product(terms[one], terms[other])
        if code != second
    ]


#: Programs with two mistakes that are made of a family, spread evenly over what there is.
_FEW, _MOST = 140, 190


def _cross_validate(
    cut=lambda n, k: np.array_split(np.arange(n), k),
    seen=lambda fold, n, first: [i for i in range(n) if i not in fold],
    score=lambda e: np.sqrt(np.mean(np.concatenate(e) ** 2)),
    gives=list,
):
    """``seen``: which runs a model is fitted to; ``score``: of the errors of each run of a fold."""

    def cross_validate(fit, predict, runs, k):
        folds, scores = cut(len(runs), k), []
        for fold in folds:
            model = fit([runs[i] for i in seen(fold, len(runs), folds[0])])
            scores.append(score([predict(model, runs[i]) - runs[i]["y"] for i in fold]))
        return np.array(gives(scores))

    return cross_validate


_FOLDS = {
    "score": (
        ("MEAN_OF_RUNS", lambda e: np.mean([np.sqrt(np.mean(run**2)) for run in e])),
        ("MEAN_OF_RUNS", lambda e: np.sqrt(np.mean([np.mean(run**2) for run in e]))),
        (
            "ROOTS_WEIGHTED",
            lambda e: np.average([np.sqrt(np.mean(run**2)) for run in e], weights=[len(run) for run in e]),
        ),
        ("ROOT_MISSING", lambda e: np.mean(np.concatenate(e) ** 2)),
        ("NOT_AVERAGED", lambda e: np.sqrt(np.sum(np.concatenate(e) ** 2))),
        ("SUM_OF_RUNS", lambda e: np.sum([np.sqrt(np.mean(run**2)) for run in e])),
        ("MEAN_REMOVED", lambda e: np.std(np.concatenate(e))),
        ("MEAN_ABSOLUTE", lambda e: np.mean(np.abs(np.concatenate(e)))),
        ("BIAS_FOR_RMSE", lambda e: np.mean(np.concatenate(e))),
        ("MEDIAN_FOR_MEAN", lambda e: np.sqrt(np.median(np.concatenate(e) ** 2))),
        ("LAST_RUN_ALONE", lambda e: np.sqrt(np.mean(e[-1] ** 2))),
    ),
    "cut": (
        ("NOT_CONTIGUOUS", lambda n, k: [np.arange(i, n, k) for i in range(k)]),
        ("FOLDS_UNEVEN", lambda n, k: [np.arange(i * (n // k), (i + 1) * (n // k)) for i in range(k)]),
    ),
    "seen": (
        ("LEAKS_HELD_OUT", lambda fold, n, first: range(n)),
        ("FITS_THE_FOLD", lambda fold, n, first: fold),
        ("LEAKS_HELD_OUT", lambda fold, n, first: [i for i in range(n) if i not in first]),
    ),
    "gives": (("FOLDS_REVERSED", lambda scores: scores[::-1]),),
}


def _together(pairs, key, of):
    return of(key, *facts.together(pairs))


def _only(key, other):
    """One number by another rule: a function of the errors and sigmas."""
    return lambda asked, e, sigma: other(e, sigma) if asked == key else facts.number(asked, e, sigma)


def _t(n):
    return model.T95[n - 2]


def _spread(rest):
    return facts.error(rest) * math.sqrt(len(rest) / (len(rest) - 1))


def _sampled(key, pairs):
    """The standard error that a number would have, were all samples independent."""
    e, sigma = facts.together(pairs)
    share, root = facts.number("coverage", e, sigma), math.sqrt(len(e))
    if key == "coverage":
        return math.sqrt(share * (1 - share)) / root
    return np.std(e**2) / (2 * np.sqrt(np.mean(e**2))) / root if key == "rmse" else np.std(e) / root


def _outside(value, ends, margin):
    return not (margin[0] <= ends[0] and ends[1] <= margin[1])


_LAGS = {}


def _lag(pairs):
    """The lag of these runs, searched for once."""
    key = tuple((s["id"], np.asarray(s["y"]).tobytes()) for s, _ in pairs)
    if key not in _LAGS:
        _LAGS[key] = model.best_shift(pairs)
    return _LAGS[key]


def _step(pairs):
    """The smallest step of the runs, s."""
    return min(float(s["t"][1] - s["t"][0]) for s, _ in pairs)


def _validate(
    pairs=model.held_out_pairs,
    number=facts.number,
    pool=_together,
    lag=_lag,
    t=lambda key, n: _t(n),
    error=lambda key, n, rest, *_: facts.error(rest),
    middle=lambda value, without: value,
    wrong=lambda key, *known: _outside(*known),
    order=sorted,
    few=lambda report: report,
):
    """``t``, ``error``: of an interval; ``wrong``: whether it speaks against; ``few``: no interval."""

    def validate(sim, real, spec):
        some = pairs(sim, real)
        measure = lambda key, some: float(lag(some) if key == "lag_s" else pool(some, key, number))  # noqa: E731
        numbers = {key: measure(key, some) if some else None for key in MEASURES}
        report = {"accepted": False, **numbers, "intervals": None, "runs_used": [s["id"] for s, _ in some]}
        n = len(some)
        if n < 2:
            return few({**report, "reasons": ["single_run" if some else "calibration_data"]})
        margins = {
            "rmse": (-math.inf, spec["rmse_max"]),
            "bias": (-spec["bias_max"], spec["bias_max"]),
            "lag_s": (-spec["lag_max_s"], spec["lag_max_s"]),
            "coverage": (spec["coverage_min"], spec["coverage_max"]),
        }
        intervals, reasons = {}, []
        for key, value in numbers.items():
            without = np.array([measure(key, some[:i] + some[i + 1 :]) for i in range(n)])
            alone = np.array([measure(key, [pair]) for pair in some])
            sampled = _sampled(key, some) if key != "lag_s" else 0.0
            width = t(key, n) * error(key, n, without, alone, sampled, value)
            centre = middle(value, without)
            intervals[key] = (centre - width, centre + width)
            if wrong(key, value, intervals[key], margins[key]):
                reasons.append(key.removesuffix("_s"))
        return {**report, "accepted": not reasons, "reasons": order(reasons), "intervals": intervals}

    return validate


def _all_pairs(sim, real, ids=None):
    known = {run["id"]: run for run in real["runs"] if ids is None or run["id"] in ids}
    return [(run, known[run["id"]]) for run in sim["runs"] if run["id"] in known]


def _by_place(sim, real):
    pairs = zip(sim["runs"], real["runs"], strict=False)
    return [(s, r) for s, r in pairs if s["id"] not in sim["calibrated_on"]]


def _by_place_if_known(sim, real):
    known = {run["id"] for run in real["runs"]}
    return [(s, r) for s, r in _by_place(sim, real) if s["id"] in known]


def _mean_of_runs(keys):
    def pool(pairs, key, of):
        alone = [_together([pair], key, of) for pair in pairs]
        return np.mean(alone) if key in keys else _together(pairs, key, of)

    return pool


def _covered(within):
    """A coverage by another rule; ``within``: of the errors and sigmas."""
    return _only("coverage", lambda e, sigma: np.mean(within(e, sigma)))


#: (code, what stands for T95[n - 2]): of n runs.
_FACTORS = [
    *(("NOT_STUDENTS_T", lambda n, z=z: z) for z in (1.0, 1.645, 1.96, 2.0, 3.0)),
    *(
        ("NOT_STUDENTS_T", lambda n, table=table: table[n - 2])
        for table in (model.T95[1:], (0.0, *model.T95), (12.706, 4.303, 3.182, 2.776, 2.571))
    ),
]
#: (code, error): of n runs, of values without each, of each alone, the error if samples counted, the number.
_ERRORS = [
    *(("JACKKNIFE_FACTOR", lambda n, rest, *_, p=p: _spread(rest) / n**p) for p in (0, 0.5, 1)),
    *(
        ("JACKKNIFE_FACTOR", lambda n, rest, *_, by=by: _spread(rest) / math.sqrt((n - 1) * n**by))
        for by in (0, 1)
    ),
    ("ABOUT_THE_NUMBER", lambda n, rest, _, own, x: math.sqrt((n - 1) / n * np.sum((rest - x) ** 2))),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, *_: np.std(alone, ddof=1) / math.sqrt(n)),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, *_: np.std(alone, ddof=1)),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, *_: np.std(alone)),
    ("SPREAD_OF_RUNS", lambda n, rest, alone, *_: facts.error(alone)),
    ("ZERO_WIDTH", lambda *_: 0.0),
    ("SAMPLES_COUNTED", lambda n, rest, alone, own, _: own),
]


def _in_some(rules, usual):
    """Each rule for the width of all intervals, and of each of three alone; of samples there is no lag."""
    for code, rule in rules:
        for keys in (MEASURES if code != "SAMPLES_COUNTED" else _EXACT, *_SOME[1:]):
            yield (
                code,
                lambda key, n, *known, keys=keys, rule=rule: (rule if key in keys else usual)(n, *known),
            )


_WIDTHS = {
    "t": tuple(_in_some(_FACTORS, _t)),
    "error": tuple(_in_some(_ERRORS, lambda n, rest, *_: facts.error(rest))),
}


def _widths():
    """Codes and function: both wrong in the same intervals; where samples count, the factor is that of many."""
    for some in range(len(_SOME)):
        for (_, t), (code, error) in itertools.product(
            *(forms[some :: len(_SOME)] for forms in _WIDTHS.values())
        ):
            if code == "SAMPLES_COUNTED" or not some:
                codes = (code,) if code == "SAMPLES_COUNTED" else (code, "NOT_STUDENTS_T")
                yield codes, _validate(t=t, error=error)


def _judging():
    """(code, ``wrong``): for some of the measures a rule, or for numbers in place of intervals."""
    signed, each = (("bias",), ("lag_s",), ("bias", "lag_s")), [(key,) for key in MEASURES]
    slips = [
        *(
            ("SIGN_OF_LIMIT_IGNORED", keys, lambda value, ends, margin: ends[1] > margin[1])
            for keys in signed
        ),
        *(
            ("SIGN_OF_LIMIT_IGNORED", keys, lambda value, *known: value >= 0 and _outside(value, *known))
            for keys in signed
        ),
        ("OVER_COVERAGE_ACCEPTED", ("coverage",), lambda value, ends, margin: ends[0] < margin[0]),
        ("RMSE_ALONE_JUDGED", MEASURES[1:], lambda *known: False),
        *(("MEASURE_NOT_JUDGED", keys, lambda *known: False) for keys in each),
        *(
            ("BURDEN_REVERSED", keys, lambda value, ends, margin: ends[1] < margin[0] or ends[0] > margin[1])
            for keys in (MEASURES, *each)
        ),
        ("POINT_ESTIMATE_JUDGED", (), None),
    ]
    for code, keys, rule in slips:
        if code != "POINT_ESTIMATE_JUDGED":
            yield code, _by_rule(keys, rule)
        # Of a number there is no more to say, and a measure that is not judged has none.
        if code not in {"BURDEN_REVERSED", "MEASURE_NOT_JUDGED"}:
            yield code, _by_rule(keys, rule, points=True)


def _by_rule(keys, rule, points=False):
    def wrong(key, value, ends, margin):
        ends = (value, value) if points else ends
        return (rule if key in keys else _outside)(value, ends, margin)

    return wrong


_VERDICT = {
    "pairs": (
        ("CALIBRATION_RUNS_SCORED", _all_pairs),
        ("CALIBRATION_RUNS_SCORED", lambda sim, real: _all_pairs(sim, real, sim["calibrated_on"])),
        ("MATCHED_BY_POSITION", _by_place),
        ("MATCHED_BY_POSITION", _by_place_if_known),
    ),
    "number": (
        ("WRONG_SIGN", lambda key, e, sigma: facts.number(key, -e, sigma)),
        ("ROOT_MISSING", _only("rmse", lambda e, sigma: np.mean(e**2))),
        ("MEAN_REMOVED", _only("rmse", lambda e, sigma: np.std(e))),
        ("BIAS_FOR_RMSE", _only("rmse", lambda e, sigma: np.mean(e))),
        ("MEAN_ABSOLUTE", _only("rmse", lambda e, sigma: np.mean(np.abs(e)))),
        ("MEAN_ABSOLUTE", _only("bias", lambda e, sigma: np.mean(np.abs(e)))),
        ("UNSIGNED", _only("bias", lambda e, sigma: abs(np.mean(e)))),
        ("MEDIAN_FOR_MEAN", _only("bias", lambda e, sigma: np.median(e))),
        ("IN_PER_CENT", _covered(lambda e, sigma: 100.0 * (np.abs(e) <= 1.96 * sigma))),
        ("OUTSIDE_COUNTED", _covered(lambda e, sigma: np.abs(e) > 1.96 * sigma)),
        ("SIGMA_NOT_SCALED", _covered(lambda e, sigma: np.abs(e) <= sigma)),
        ("SIGMA_MULTIPLE", _covered(lambda e, sigma: np.abs(e) <= 2.0 * sigma)),
        ("SIGMA_MULTIPLE", _covered(lambda e, sigma: np.abs(e) <= 1.645 * sigma)),
        ("SIGMA_MULTIPLE", _covered(lambda e, sigma: np.abs(e) <= 3.0 * sigma)),
        ("SIGMA_MISREAD", _covered(lambda e, sigma: np.abs(e) <= 1.96 * np.sqrt(sigma))),
        ("SIGMA_MISREAD", _covered(lambda e, sigma: np.abs(e) <= 1.96 * sigma**2)),
        ("SIGMA_MISREAD", _covered(lambda e, sigma: np.abs(e) <= 1.96 * np.mean(sigma))),
        ("OWN_SPREAD_FOR_SIGMA", _covered(lambda e, sigma: np.abs(e) <= 1.96 * np.std(e))),
        ("SIGMA_ONE_SIDED", _covered(lambda e, sigma: e <= 1.96 * sigma)),
    ),
    "pool": tuple(("MEAN_OF_RUNS", _mean_of_runs(keys)) for keys in _SOME),
    "lag": (
        ("LAG_SIGN", lambda pairs: -_lag(pairs)),
        ("LAG_SIGN", lambda pairs: abs(_lag(pairs))),
        ("LAG_IN_SAMPLES", lambda pairs: _lag(pairs) / (pairs[0][1]["t"][1] - pairs[0][1]["t"][0])),
        ("LAG_WHOLE_SAMPLES", lambda pairs: round(_lag(pairs) / _step(pairs)) * _step(pairs)),
        ("LAG_MEAN_OF_RUNS", lambda pairs: np.mean([_lag([pair]) for pair in pairs])),
        ("LAG_NOT_BEST", lambda pairs: _lag(pairs[:1])),
    ),
    **_WIDTHS,
    "middle": (("CENTRED_ON_THE_REST", lambda value, without: np.mean(without)),),
    "wrong": tuple(_judging()),
    "few": (
        ("NOTHING_LEFT", lambda report: {**report, "accepted": True, "reasons": []}),
        ("NOTHING_LEFT", lambda report: {**report, "reasons": []}),
    ),
}


TERMS = formulas.TERMS | {"cross_validate": [(_cross_validate, _FOLDS)], "validate": [(_validate, _VERDICT)]}
