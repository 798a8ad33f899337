"""Finding out which mistake a sensor of ``digital-twin`` makes: small experiments with known outcomes."""

from __future__ import annotations

import math

import numpy as np

from course.scoring import kit

named = kit.words("digital-twin")


#: Counts that sixteen bits tell apart: what does not fit into them is off by a multiple of it.
_OVERFLOW = 2**16


@np.errstate(all="ignore")  # a submission may have returned anything
def of_encoder(submission, counts, theta, per_turn):
    """The mistake behind counts (N,) of angles theta: in all of them, or in what some do to others."""
    exact = theta * per_turn / (2 * math.pi)
    floor, nearest = np.floor(exact), np.rint(exact)
    wanted = floor if np.sum(counts == floor) >= np.sum(counts == nearest) else nearest
    if found := of_counts(counts, wanted):
        return found
    single = theta.astype(np.float32)
    for angles in (single, single.astype(float)):
        turned = angles * per_turn / (2 * math.pi)
        if any(np.array_equal(counts, rounded(turned)) for rounded in (np.floor, np.rint)):
            return named("COUNTS_SINGLE_PRECISION")
    few = np.flatnonzero(counts != wanted)[:: max(1, np.count_nonzero(counts != wanted) // 8)]
    alone = [submission.call("encoder", theta[i : i + 1], per_turn) for i in few]
    if any(kit.as_vector(count, 1, "counts")[0] != counts[i] for count, i in zip(alone, few, strict=True)):
        again = kit.as_vector(submission.call("encoder", theta, per_turn), len(theta), "counts")
        return named("COUNTS_DEPEND_ON_OTHERS") if np.array_equal(again, counts) else None
    if np.all((counts == floor) | (counts == nearest)):
        return named("ROUNDED_TWO_WAYS")
    return named("WHOLE_TURNS_ONLY") if np.all(counts % per_turn == 0) and np.any(counts) else None


@np.errstate(all="ignore")  # a submission may have returned anything
def of_counts(counts, wanted):
    """What counts (N,) have in common with the wanted ones: a factor, if each is off by the same."""
    if not np.all(np.isfinite(counts)):
        return None
    if np.any(counts != np.rint(counts)):
        return named("NOT_QUANTISED") if np.max(np.abs(counts - wanted)) <= 1.0 else None
    far = np.abs(wanted) > 0.5 * np.max(np.abs(wanted))
    ratios = counts[far] / wanted[far]
    # Rounded to whole counts, a constant ratio scatters by a count in the far ones.
    within = 2.0 / np.min(np.abs(wanted[far])) * max(1.0, abs(float(np.median(ratios))))
    off = np.abs(counts - wanted)
    if np.all(off % _OVERFLOW == 0) and np.any(off):
        return named("COUNTS_OVERFLOW")
    middle = float(np.median(ratios))
    # Counts of nearly zero have no factor: any would fit.
    steady = np.all(np.abs(ratios - middle) <= within) and middle > 2 * within and abs(middle - 1) > within
    return named("COUNTS_OFF_BY_FACTOR") if steady else None


# -- gyroscope ------------------------------------------------------------------------------------------

_N, _K = 20000, 0.02
_FAST, _SLOW = 0.0025, 0.16  # s; eight times apart in the root


#: Mistakes that make no difference where there is no walk, and those that make none without white noise.
OF_THE_WALK = {
    "BIAS_CONSTANT",
    "BIAS_HELD",
    "BIAS_NOT_RANDOM_WALK",
    "BIAS_PULLED_BACK",
    "BIAS_STEPS_RELATED",
    "BIAS_NOT_SCALED_BY_SQRT_DT",
    "BIAS_TIMES_DT",
    "BIAS_OVER_SQRT_DT",
    "BIAS_FACTOR",
    "BIAS_STARTS_LATE",
    "LAST_BIAS_LEFT_OUT",
    "BIAS_STEPS_NOT_NORMAL",
}
OF_THE_NOISE = {
    "WHITE_NOISE_MISSING",
    "WHITE_NOISE_NOT_SCALED_BY_SQRT_DT",
    "WHITE_NOISE_TIMES_SQRT_DT",
    "WHITE_NOISE_TIMES_DT",
    "WHITE_NOISE_OVER_DT",
    "WHITE_NOISE_FACTOR",
    "WHITE_NOISE_ACCUMULATES",
    "WHITE_NOISE_RELATED",
    "WHITE_NOISE_SHARED",
    "WHITE_NOISE_NOT_NORMAL",
}


@np.errstate(all="ignore")  # a submission may have returned anything
def of_imu(submission, bias_first=False):
    """The mistake that ``imu`` makes, found on long recordings with one kind of noise at a time.

    bias_first: look at the bias before the white noise, for a check of the bias
    """
    zeros, ones = np.zeros(_N), np.linspace(1.0, 2.0, _N)
    seeds = iter(range(100, 200))
    setups = (
        (zeros, _FAST, _K, 0.0, 0.3),
        (zeros, _SLOW, _K, 0.0, 0.3),
        (ones, _FAST, 0.0, _K, 0.3),
        (ones, _SLOW, 0.0, _K, 0.3),
        (zeros, _FAST, _K, _K, 0.0),
        (zeros, _FAST, _K, 0.0, 0.3),
        (zeros, _FAST, 0.0, _K, 0.3),
    )
    runs = submission.call_each("imu", [(*setup, np.random.default_rng(next(seeds))) for setup in setups])
    pairs = [
        [kit.as_vector(part, _N, name) for part, name in zip(kit.as_tuple(run, _NAMES), _NAMES, strict=True)]
        for run in runs
    ]
    looks = [lambda: _of_white(pairs), lambda: _of_bias(pairs, ones)]
    codes = (look() for look in looks[:: -1 if bias_first else 1])
    code = _of_parts(pairs, ones) or next(filter(None, codes), None)
    if code in {None, "WHITE_NOISE_FACTOR", "BIAS_FACTOR"}:
        code = _of_shape(pairs, code, bias_first) or code
    code = code or (_CARRIED if _carries_over(submission) else None) or _of_both(pairs)
    return named(code) if code else of_randomness(submission)


_NAMES = ("measured", "bias")


def of_still_bias(submission, bias):
    """The mistake behind a bias (n,) that moves although its walk has no strength."""
    if np.all(np.diff(np.abs(bias)) < 0) and bias[0] * bias[-1] > 0:
        return named("BIAS_FADES")
    return of_imu(submission, bias_first=True)


def _of_parts(pairs, true):
    """Whether the two parts are what they are called, and each is as strong as its own number says."""
    measured, bias = pairs[0]  # without a walk the bias is flat, and the rate is not
    rough, flat = (float(np.std(np.diff(part))) for part in (bias, measured))
    rate, walked = pairs[2]  # and without white noise the rate is the true one plus a walk
    still, wandered = pairs[6]  # noise that the true rate makes is none of the walk's
    if (
        np.ptp(measured - bias) < 1e-12
        and np.ptp(still - wandered) > 1e-9
        and _is_white(rate - walked - true, np.diff(walked))
    ) or (rough > 0 and _wanders(bias) > 8 and np.ptp(walked) == 0):
        return "STRENGTHS_MIXED"
    if not rough > 0:
        return None
    if flat < 1e-12 and np.allclose(walked - rate, true, rtol=0, atol=1e-9):
        return "RETURNS_SWAPPED"
    holds = _wanders(bias) < 2 and np.allclose(measured - bias, np.mean(measured - bias))
    return "BIAS_HOLDS_WHITE_NOISE" if holds else None


#: Std; one standard normal number in eighty is further from zero, and no uniform one.
FAR = 2.5


def _of_shape(pairs, code, bias_first):
    """Whether white noise or steps, each alone, stay within limits; of that whose size is wrong, if any."""
    looks = [
        ("WHITE_NOISE_FACTOR", "WHITE_NOISE_NOT_NORMAL", np.subtract(*pairs[5])),
        ("BIAS_FACTOR", "BIAS_STEPS_NOT_NORMAL", np.diff(pairs[6][1])),
    ]
    for wrong, bounded, values in looks[:: -1 if bias_first else 1]:
        size = float(np.std(values))
        if code in (None, wrong) and size > 1e-9 and np.all(np.abs(values) < FAR * size):
            return bounded
    return None


def _is_white(noise, steps):
    """Whether noise (n,) has nothing to do with itself a sample before, nor with the steps (n - 1,)."""
    pairs = ((noise[1:], noise[:-1]), (noise[1:], steps), (noise[:-1], steps))
    return np.std(noise) > 1e-9 and all(not abs(np.corrcoef(*pair)[0, 1]) > 0.1 for pair in pairs)


def _wanders(values):
    """The variance over ten samples by that over one: of a walk 10, of white noise 1, to some hundredths."""
    return float(np.var(values[10:] - values[:-10]) / np.var(np.diff(values)))


def _of_white(pairs):
    """From two recordings without a walk, if there is no noise without a density."""
    noise = [measured - bias for measured, bias in pairs[:2]]
    if np.ptp(np.subtract(*pairs[6])) > 1e-9:
        return None
    if all(np.ptp(part) < 1e-12 < abs(part[0]) for part in noise):
        other = np.subtract(*pairs[5])  # with other random numbers
        return "WHITE_NOISE_MISSING" if abs(other[0] - noise[0][0]) < 1e-12 else "WHITE_NOISE_SHARED"
    if np.std(noise[0]) > 0 and abs(np.corrcoef(noise[0][1:], noise[0][:-1])[0, 1]) > 0.1:
        # A running sum goes ten times as far in a hundred steps as in one, a mean of neighbours does not.
        far = np.std(noise[0][100:] - noise[0][:-100]) / np.std(np.diff(noise[0]))
        return "WHITE_NOISE_ACCUMULATES" if 6.0 < far < 16.0 else "WHITE_NOISE_RELATED"
    powers = {
        0.0: "WHITE_NOISE_NOT_SCALED_BY_SQRT_DT",
        0.5: "WHITE_NOISE_TIMES_SQRT_DT",
        1.0: "WHITE_NOISE_TIMES_DT",
        -1.0: "WHITE_NOISE_OVER_DT",
    }
    return _of_power(noise, -0.5, powers, "WHITE_NOISE_MISSING", "WHITE_NOISE_FACTOR")


def _of_bias(pairs, true):
    """From two recordings without white noise."""
    biases = [bias for _, bias in pairs[2:4]]
    steps, measured = np.diff(biases[0]), pairs[2][0]
    if np.std(steps) == 0:
        return "BIAS_OUT_OF_STEP" if _wanders(measured - true) > 8 else "BIAS_CONSTANT"
    last = abs(steps[-1]) > 20 * np.median(np.abs(steps)) > 0  # of right ones, hardly any is beyond 6
    held = np.mean(steps == 0) > 0.01
    if last or held or np.ptp(steps) < 1e-6 * abs(np.mean(steps)):
        return "LAST_BIAS_LEFT_OUT" if last else "BIAS_HELD" if held else "BIAS_DRIFTS"
    ten = _wanders(biases[0][_N // 2 :])  # what it does at first may have to do with where it starts
    if ten < 8:
        return "BIAS_NOT_RANDOM_WALK" if ten < 2 else "BIAS_PULLED_BACK"
    powers = {0.0: "BIAS_NOT_SCALED_BY_SQRT_DT", 1.0: "BIAS_TIMES_DT", -0.5: "BIAS_OVER_SQRT_DT"}
    code = "BIAS_STEPS_RELATED" if ten > 12 else _of_drift(biases)
    code = code or _of_power([np.diff(bias) for bias in biases], 0.5, powers, "BIAS_CONSTANT", "BIAS_FACTOR")
    if code:
        return code
    if any(abs(bias[0] - 0.3) > 1e-12 for bias in biases):
        return _of_first(biases)
    return _of_sum(measured, true, biases[0])


def _of_sum(measured, true, bias):
    """Why a rate without white noise is not the true one plus the bias; no more than is seen."""
    for code, values in (
        ("BIAS_NOT_ADDED", true),
        ("BIAS_SUBTRACTED", true - bias),
        ("TRUE_RATE_MISSING", bias),
    ):
        if np.allclose(measured, values, rtol=0, atol=1e-9):
            return code
    off, steps = measured - true - bias, np.diff(bias)
    if np.max(np.abs(off)) < 1e-6 or _is_white(off, steps):  # rounded, or noise that should not be there
        return None
    same = np.ptp(off) < 1e-9
    return "BIAS_OUT_OF_STEP" if same or np.std(np.diff(off)) > 0.1 * np.std(steps) else None


def _of_drift(biases):
    """Whether two walks from bias0 = 0.3 rad/s run off to one side, and by how much in each step."""
    steps = [np.diff(bias) for bias in biases]
    if not all(abs(np.mean(each)) > 0.15 * np.std(each) for each in steps):
        return None
    return (
        "BIAS0_ADDED_EACH_STEP" if all(abs(np.mean(each) - 0.3) < 0.05 for each in steps) else "BIAS_DRIFTS"
    )


def _of_first(biases):
    """Why two walks do not start at their bias0, 0.3 rad/s."""
    steps = [5 * float(np.std(np.diff(bias))) for bias in biases]  # a first step is hardly ever larger

    def starts(*places):
        return all(
            abs(bias[0] - place) < step for bias, step, place in zip(biases, steps, places, strict=True)
        )

    looks = (
        ("BIAS_WALKS_TO_BIAS0", all(abs(bias[-1] - 0.3) < 1e-12 for bias in biases)),
        ("BIAS_STARTS_LATE", starts(0.3, 0.3) and abs(biases[0][0] - 0.3) > 1e-3 * steps[0]),  # not rounded
        ("BIAS0_IGNORED", starts(0.0, 0.0)),
    )
    return next((code for code, seen in looks if seen), None)


def _of_power(noise, right, powers, missing, factor):
    """How the std depends on dt, from one recording at each of two sampling rates."""
    fast, slow = (float(np.std(part)) for part in noise)
    if not math.isfinite(fast * slow):
        return None
    if not (fast > 0 and slow > 0):
        return missing
    power = math.log(slow / fast) / math.log(_SLOW / _FAST)
    # A single jump, or tails that a few draws decide, is not how all of them depend on dt.
    middle_fast, middle_slow = (float(np.median(np.abs(part - np.median(part)))) for part in noise)
    if middle_fast > 0 and abs(math.log(middle_slow / middle_fast) / math.log(_SLOW / _FAST) - power) > 0.1:
        return None
    for value, code in powers.items():
        if abs(power - value) < 0.1:
            return code
    wrong = abs(fast / (_K * _FAST**right) - 1) > 0.05
    return factor if abs(power - right) < 0.1 and wrong else None


def _of_both(pairs):
    (noise, held), (_, walk) = pairs[0], pairs[6]
    alone = np.std(np.diff(walk)), np.std(noise - held)
    measured, bias = pairs[4]
    white, steps = (measured - bias), np.diff(bias)
    rights = _K * math.sqrt(_FAST), _K / math.sqrt(_FAST)
    if any(abs(size / right - 1) > 0.05 for size, right in zip(alone, rights, strict=True)):
        return None
    if any(abs(np.std(x) / right - 1) > 0.05 for x, right in zip((steps, white), rights, strict=True)):
        return "STRENGTHS_MIXED"  # each is right where the other is not asked for
    alike = max(abs(np.corrcoef(white[shift : len(steps) + shift], steps)[0, 1]) for shift in (0, 1))
    return "SAME_DRAW_TWICE" if alike > 0.5 else None


def of_randomness(submission):
    """Whether the randomness comes from the generator that is passed in."""
    call = np.zeros(8), 0.1, 0.1, 0.1, 0.0
    runs = submission.call_each("imu", [(*call, np.random.default_rng(seed)) for seed in SEEDS])
    pairs = [[kit.as_vector(part, 8, "measured") for part in kit.as_tuple(run, _NAMES)] for run in runs]
    if _carries_over(submission):
        return named(_CARRIED)
    return of_draws([measured - bias for measured, bias in pairs]) or of_draws([bias for _, bias in pairs])


_CARRIED = "BIAS_CARRIED_OVER"


def _carries_over(submission):
    """Whether a bias that does not walk starts where that of the call before ended, and not at bias0."""
    calls = [
        (np.zeros(8), 0.1, 0.0, walk, first, np.random.default_rng(seed))
        for seed, (walk, first) in enumerate(((0.1, 7.0), (0.0, -1.0)) * 2)
    ]
    pairs = [kit.as_tuple(value, _NAMES) for value in submission.call_each("imu", calls)]
    before, after, later, last = (kit.as_vector(bias, 8, "bias") for _, bias in pairs)
    kept = abs(after[0] - before[-1]) < 1e-9 and abs(last[0] - later[-1]) < 1e-9
    return bool(kept and abs(before[-1] - later[-1]) > 1e-6)


#: Of three calls that differ in nothing else: the first two draws must be the same, the last another.
SEEDS = (5, 5, 6)


def copies_generator(submission, task, *args):
    """Whether a function makes a deep copy of the generator, its last argument: of one that would notice."""
    rng, copies = np.random.default_rng(SEEDS[0]), []
    drawn = {
        name: getattr(rng, name) for name in ("normal", "standard_normal", "random", "uniform", "integers")
    }
    # What comes of the call is no matter: a program may ask for more than this generator can do.
    noticing = kit.black_box(**drawn, __deepcopy__=lambda *_: copies.append(task))
    kit.attempt(lambda: submission.call(task, *args, noticing))
    return bool(copies)


def of_draws(draws):
    first, again, other = draws
    if max(np.ptp(first), np.ptp(other)) < 1e-9:
        return None  # nothing random in it
    if np.allclose(first, other, rtol=0.0, atol=1e-9):  # a difference of two numbers is rounded
        return named("GENERATOR_IGNORED")
    return None if np.array_equal(first, again, equal_nan=True) else named("GLOBAL_RANDOMNESS")


# -- fit_noise ------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a submission may have returned anything
def of_density(found, cases, walk=None):
    """The mistake behind noise densities found in recordings; found (n,), cases as of ``expect_fits``.

    walk: the random walks that were found beside them, (n,)
    """
    right = np.array([case[2] for case in cases])
    stills, dts = [case[0] for case in cases], np.array([case[1] for case in cases])
    std = np.array([np.std(still) for still in stills])
    root = np.sqrt(dts)
    walks = np.array([case[3] for case in cases if len(case) > 3])
    if walk is not None and _all_near(found, walks, 0.6) and _off_by(walk / right, 1.0, 0.1):
        return named("FIT_SWAPPED")
    # Each in proportion to the recordings' own numbers, which differ by more than the scatter allowed here.
    looks = (
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", right / root),
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", math.sqrt(2) * right / root),
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", std),
        ("DRIFT_COUNTED_AS_NOISE", std * root),
        ("DENSITY_FROM_DIFFERENCES", math.sqrt(2) * right),
        ("ROOT_FORGOTTEN", right**2),
    )
    for code, values in looks:
        if _all_near(found, values, 0.08 if values is not std else 0.01):
            return named(code)
    if not (np.all(np.isfinite(found)) and np.all(found >= 0)):
        return None
    larger, smaller = np.mean(found > 1.03 * right), np.mean(found < right / 1.03)
    if min(larger, smaller) > 0.2:
        return named("DENSITY_SCATTERS")
    if max(larger, smaller) > 0.5:
        none = walk is not None and np.mean((found < right / 3) & (walk > 5 * walks)) > 0.5
        small = "FIT_WITHOUT_NOISE" if none else "DENSITY_TOO_SMALL"
        return named("DENSITY_TOO_LARGE" if larger > smaller else small)
    return None


def _all_near(found, values, rel):
    """Whether each number is the value of its recording, and nothing else would be: values that differ."""
    return bool(np.all(np.abs(found / values - 1) < rel))


#: Std of the logarithms of ratios: right fits of the walk reach 0.22 in 100 sets of eight recordings, and
#: walks from one random number each have 0.46 or more.
_STEADY = 0.3


def _off_by(ratios, factor, rel, scatter=_STEADY):
    """Whether ratios of found to right are this factor in the middle, and hardly scatter about it."""
    return bool(abs(np.median(ratios) / factor - 1) < rel and np.std(np.log(ratios)) < scatter)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_walk(found, cases, submission):
    """The mistake behind random walks found in recordings; as ``of_density``."""
    right = np.array([case[3] for case in cases])
    ratios = found / right
    steps = np.array([np.std(np.diff(still)) / math.sqrt(dt) for still, dt, *_ in cases])
    if any(_off_by(found / steps, factor, 0.1) for factor in (1.0, 1 / math.sqrt(2))):
        return named("NOISE_COUNTED_AS_DRIFT")
    if not (np.all(np.isfinite(ratios)) and np.all(found >= 0)):
        return None
    if _off_by(found / right**2, 1.0, 0.5, 2 * _STEADY) and _is_square(submission, cases[0], found[0]):
        return named("ROOT_FORGOTTEN")
    both = min(np.mean(ratios > 1.2), np.mean(ratios < 1 / 1.2))
    if both > 0.2 or (both > 0 and np.std(np.log(ratios)) > 0.4):
        return named("WALK_SCATTERS")
    # A median over eight recordings or more is known to some ten per cent.
    if _off_by(ratios, 1 / math.sqrt(3), 0.15):
        return named("WALK_WITHOUT_THREE")
    return named("WALK_TOO_LARGE" if np.median(ratios) > 1 else "WALK_TOO_SMALL")


def _is_square(submission, case, found):
    """Whether ten times the recording has a walk a hundred times as large: numbers may be near by chance."""
    still, dt, *_ = case
    keys = ("noise_density", "bias_random_walk", "bias0")
    larger = kit.as_record(submission.call("fit_noise", 10 * still, dt), keys)
    walk = kit.as_number(larger["bias_random_walk"], "bias_random_walk")
    return math.isclose(walk, 100 * found, rel_tol=0.2)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_bias0(found, cases):
    """The mistake behind first biases found in recordings; as ``of_density``."""
    right = np.array([case[4] for case in cases])
    if np.all(np.abs(found - [case[0][0] for case in cases]) < 1e-9):
        return named("FIRST_SAMPLE_AS_BIAS")
    if np.all(np.abs(found - [np.mean(case[0]) for case in cases]) < 1e-9):
        return named("WHOLE_MEAN_AS_BIAS")
    lengths = [_samples_averaged(mean, case) for mean, case in zip(found, cases, strict=True)]
    if all(lengths):
        best = [math.sqrt(3) * case[2] / case[3] / case[1] for case in cases]  # samples
        inverse = [min(3 / case[1] ** 2 / n, len(case[0])) for n, case in zip(best, cases, strict=True)]
        off, tells = np.log(np.divide(lengths, inverse)), np.log(np.divide(best, inverse))
        if max(abs(off)) < 0.5 < np.median(abs(tells)):
            return named("BIAS0_TIME_INVERTED")
        ratio = np.median(np.array(lengths) / best)
        if not 1 / 3 < ratio < 3:  # within it a mean is hardly worse than the best one
            return named("BIAS0_TIME_TOO_SHORT" if ratio < 1 else "BIAS0_TIME_TOO_LONG")
    less = [(case[0] - np.mean(case[0]), *case[1:]) for case in cases]
    ends = [(case[0][::-1], *case[1:]) for case in cases]
    for code, others in (("BIAS0_FROM_THE_MEAN", less), ("BIAS0_OF_THE_END", ends)):
        lengths = [_samples_averaged(mean, case) for mean, case in zip(found, others, strict=True)]
        if all(n and n < len(case[0]) / 2 for n, case in zip(lengths, others, strict=True)):
            return named(code)
    signless = np.all(found >= 0) and np.median(np.abs(found / np.abs(right) - 1)) < 0.2
    return named("BIAS0_WITHOUT_SIGN") if signless else None


def _samples_averaged(mean, case):
    """Of how many samples from the start a number is the mean; None if it is none."""
    still = case[0]
    means = np.cumsum(still) / np.arange(1, len(still) + 1)
    near = np.flatnonzero(np.abs(means - mean) < 1e-12 * np.max(np.abs(still)))
    return int(near[0]) + 1 if len(near) else None
