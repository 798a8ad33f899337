"""Finding out which mistake a sensor of ``digital-twin`` makes: small experiments with known outcomes."""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

named = kit.companion("digital-twin", "diagnosis").named

_TURN = 2 * math.pi


@np.errstate(all="ignore")  # a submission may have returned anything
def of_encoder(counts, theta, counts_per_rev):
    """The mistake behind these counts of these angles."""
    exact = theta * counts_per_rev / _TURN
    looks = (
        ("TRUNCATES_TOWARD_ZERO", np.trunc(exact)),
        ("ROUNDS_UP", np.ceil(exact)),
        ("NOT_QUANTISED", exact),
        ("TURNS_FORGOTTEN", np.floor(exact) % counts_per_rev),
        ("TURNS_FORGOTTEN", np.rint(exact) % counts_per_rev),
        ("TURNS_FORGOTTEN", np.fmod(np.floor(exact), counts_per_rev)),
        ("RADIANS_AS_TURNS", np.floor(theta * counts_per_rev)),
        ("RADIANS_AS_TURNS", np.rint(theta * counts_per_rev)),
        ("DEGREES_FOR_RADIANS", np.floor(theta * counts_per_rev / 360)),
        ("DEGREES_FOR_RADIANS", np.rint(theta * counts_per_rev / 360)),
        ("RETURNS_ANGLE", np.floor(exact) * _TURN / counts_per_rev),
        ("RETURNS_ANGLE", np.rint(exact) * _TURN / counts_per_rev),
    )
    for code, values in looks:
        if np.allclose(counts, values, rtol=1e-9, atol=1e-9):
            return named(code)
    return None


# -- gyroscope ------------------------------------------------------------------------------------------

_N, _K = 20000, 0.02
_FAST, _SLOW = 0.0025, 0.16  # s; eight times apart in the root


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
    )
    runs = submission.call_each("imu", [(*setup, np.random.default_rng(next(seeds))) for setup in setups])
    pairs = [
        [kit.as_vector(part, _N, name) for part, name in zip(kit.as_tuple(run, _NAMES), _NAMES, strict=True)]
        for run in runs
    ]
    looks = [lambda: _of_white(pairs), lambda: _of_bias(pairs, ones)]
    codes = (look() for look in (lambda: _swapped(pairs), *looks[:: -1 if bias_first else 1]))
    code = next(filter(None, codes), None) or _of_both(pairs)
    return named(code) if code else of_randomness(submission)


_NAMES = ("measured", "bias")


def _swapped(pairs):
    rough = [float(np.std(np.diff(part))) for part in pairs[0]]
    return "RETURNS_SWAPPED" if rough[1] > 0 and rough[0] < 1e-12 else None


def _of_white(pairs):
    """From two recordings without a walk."""
    noise = [measured - bias for measured, bias in pairs[:2]]
    if np.corrcoef(noise[0][1:], noise[0][:-1])[0, 1] > 0.5 if np.std(noise[0]) > 0 else False:
        return "WHITE_NOISE_ACCUMULATES"
    powers = {
        0.0: "WHITE_NOISE_NOT_SCALED_BY_SQRT_DT",
        0.5: "WHITE_NOISE_TIMES_SQRT_DT",
        -1.0: "WHITE_NOISE_OVER_DT",
    }
    return _of_power(noise, -0.5, powers, "WHITE_NOISE_MISSING", "WHITE_NOISE_FACTOR")


def _of_bias(pairs, true):
    """From two recordings without white noise."""
    biases = [bias for _, bias in pairs[2:4]]
    if np.std(np.diff(biases[0])) == 0:
        return "BIAS_CONSTANT"
    ten = np.var(biases[0][10:] - biases[0][:-10]) / np.var(np.diff(biases[0]))
    if ten < 2:
        return "BIAS_NOT_RANDOM_WALK"
    powers = {0.0: "BIAS_NOT_SCALED_BY_SQRT_DT", 1.0: "BIAS_TIMES_DT", -0.5: "BIAS_OVER_SQRT_DT"}
    code = _of_power([np.diff(bias) for bias in biases], 0.5, powers, "BIAS_CONSTANT", "BIAS_FACTOR")
    if code:
        return code
    if abs(biases[0][0] - 0.3) > 1e-12:
        return "BIAS_STARTS_LATE"
    measured = pairs[2][0]
    looks = (("BIAS_NOT_ADDED", true), ("BIAS_SUBTRACTED", true - biases[0]))
    for name, values in looks:
        if np.allclose(measured, values, rtol=0, atol=1e-12):
            return name
    return None if np.allclose(measured, true + biases[0], rtol=0, atol=1e-9) else "BIAS_OUT_OF_STEP"


def _of_power(noise, right, powers, missing, factor):
    """How the std depends on dt, from one recording at each of two sampling rates."""
    fast, slow = (float(np.std(part)) for part in noise)
    if not (fast > 0 and slow > 0 and math.isfinite(fast * slow)):
        return missing
    power = math.log(slow / fast) / math.log(_SLOW / _FAST)
    for value, code in powers.items():
        if abs(power - value) < 0.1:
            return code
    wrong = abs(fast / (_K * _FAST**right) - 1) > 0.05
    return factor if abs(power - right) < 0.1 and wrong else None


def _of_both(pairs):
    measured, bias = pairs[4]
    white, steps = (measured - bias), np.diff(bias)
    alike = max(abs(np.corrcoef(white[shift : len(steps) + shift], steps)[0, 1]) for shift in (0, 1))
    return "SAME_DRAW_TWICE" if alike > 0.5 else None


def of_randomness(submission):
    """Whether the randomness comes from the generator that is passed in."""
    seeds = (5, 5, 6)
    call = np.zeros(8), 0.1, 0.1, 0.1, 0.0
    runs = submission.call_each("imu", [(*call, np.random.default_rng(seed)) for seed in seeds])
    first, again, other = (kit.as_vector(kit.as_tuple(run, _NAMES)[0], 8, "measured") for run in runs)
    if np.array_equal(first, other):
        return named("GENERATOR_IGNORED")
    return None if np.array_equal(first, again) else named("GLOBAL_RANDOMNESS")


# -- fit_noise ------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a submission may have returned anything
def of_density(found, still, dt, right):
    """The mistake behind a noise density, from one recording."""
    std, step = float(np.std(still)), float(np.std(np.diff(still)))
    root = math.sqrt(dt)
    looks = (
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", step / math.sqrt(2)),
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", std),
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", step),
        ("DENSITY_NOT_SCALED_BY_SQRT_DT", right / root),
        ("DRIFT_COUNTED_AS_NOISE", std * root),
        ("DENSITY_FROM_DIFFERENCES", step * root),
    )
    for code, value in looks:
        if abs(found - value) < 0.01 * value:
            return named(code)
    return None


def of_walk(found, right):
    """The mistake behind a random walk."""
    return named("NOISE_COUNTED_AS_DRIFT" if found > 2 * right else "WALK_TOO_SMALL")


def of_bias0(found, still):
    """The mistake behind the first bias."""
    if abs(found - still[0]) < 1e-9:
        return named("FIRST_SAMPLE_AS_BIAS")
    return named("WHOLE_MEAN_AS_BIAS") if abs(found - np.mean(still)) < 1e-9 else None


# -- lidar ----------------------------------------------------------------------------------------------

_WALL = np.array([[[2.0, -1.0], [2.0, 1.0]]])
_TWO = np.array([[[2.0, -1.0], [2.0, 1.0]], [[1.0, -1.0], [1.0, 1.0]], [[3.0, -1.0], [3.0, 1.0]]])
_LONG = np.array([[[1.0, 0.5], [3.0, 0.5]]])  # parallel to a beam along x
_AHEAD, _LEFT = (0.0, 0.0, 0.0), (0.0, 0.0, math.pi / 2)

#: code, pose, walls, the one beam, the right reading with a reach of 5 m
_SCENES = (
    ("HEADING_IGNORED", _LEFT, _WALL, -math.pi / 2, 2.0),
    ("POSITION_IGNORED", (0.5, 0.1, 0.0), _WALL, 0.0, 1.5),
    ("WALLS_BEHIND_SEEN", _AHEAD, _WALL, 3.0, 5.0),
    ("WALLS_ENDLESS", _AHEAD, _WALL, 1.0, 5.0),
    ("WALLS_ENDLESS", _AHEAD, _WALL, -1.0, 5.0),
    ("NOT_THE_NEAREST", _AHEAD, _TWO, 0.1, 1.0 / math.cos(0.1)),
    ("BEYOND_RANGE", _AHEAD, _WALL + np.array([4.0, 0.0]), 0.01, 5.0),
    ("PARALLEL_WALLS", _AHEAD, np.concatenate((_LONG, _WALL)), 0.0, 2.0),
    ("NO_HIT_NOT_MAX", _AHEAD, _WALL, 2.0, 5.0),
)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_lidar(submission):
    """The mistake that ``lidar`` makes, from scenes with one wall or two, without noise."""
    plain = np.random.default_rng(1)
    calls = [(pose, walls, np.array([beam]), 5.0, 0.0, plain) for _, pose, walls, beam, _ in _SCENES]
    readings = [kit.as_vector(r, 1, "ranges")[0] for r in submission.call_each("lidar", calls)]
    nothing = readings[-1]  # what the last scene reads, where no wall is near the beam
    for (code, *_, right), reading in zip(_SCENES, readings, strict=True):
        if not abs(reading - right) < 1e-9:
            blank = right == 5.0 and nothing != 5.0 and (reading == nothing or not np.isfinite(reading))
            return named("NO_HIT_NOT_MAX" if blank else code)
    return of_lidar_noise(submission)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_lidar_noise(submission):
    """The mistake in the noise of ``lidar``, from two fans of beams on one wall and one fan on none."""
    fan = np.linspace(-0.4, 0.4, 2000)
    near, none = (1.95, 0.0, 0.0), (-20.0, 0.0, 0.0)
    calls = [
        (pose, _WALL, fan, 5.0, 0.1, np.random.default_rng(seed))
        for seed, pose in enumerate((_AHEAD, none, near))
    ]
    hits, misses, close = (kit.as_vector(r, 2000, "ranges") for r in submission.call_each("lidar", calls))
    noise = hits - 2.0 / np.cos(fan)
    spread = float(np.std(noise))
    if not np.all(misses == 5.0):
        return named("LIDAR_NOISE_ON_MAX")
    if spread < 1e-9:
        return named("LIDAR_NOISE_SHARED" if abs(noise[0]) > 1e-9 else "LIDAR_NOISE_MISSING")
    if np.any(close < 0):
        return named("NEGATIVE_RANGE")
    return named("LIDAR_SIGMA_WRONG") if not 0.09 < spread < 0.11 else None
