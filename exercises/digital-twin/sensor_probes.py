"""Finding out which mistake a sensor of ``digital-twin`` makes: small experiments with known outcomes."""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

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
    few = np.flatnonzero(counts != wanted)[:: max(1, np.count_nonzero(counts != wanted) // 8)]
    alone = [submission.call("encoder", theta[i : i + 1], per_turn) for i in few]
    if any(kit.as_vector(count, 1, "counts")[0] != counts[i] for count, i in zip(alone, few, strict=True)):
        return named("COUNTS_DEPEND_ON_OTHERS")
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
    steady = np.all(np.abs(ratios - middle) <= within) and middle > 0 and abs(middle - 1) > within
    return named("COUNTS_OFF_BY_FACTOR") if steady else None


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
    codes = (look() for look in looks[:: -1 if bias_first else 1])
    code = _of_parts(pairs) or next(filter(None, codes), None) or _of_both(pairs)
    return named(code) if code else of_randomness(submission)


_NAMES = ("measured", "bias")


def _of_parts(pairs):
    """Whether the two parts are what they are called: without a walk the bias is flat, the rate is not."""
    measured, bias = pairs[0]
    rough, flat = (float(np.std(np.diff(part))) for part in (bias, measured))
    if not rough > 0:
        return None
    if flat < 1e-12:
        return "RETURNS_SWAPPED"
    return "BIAS_HOLDS_WHITE_NOISE" if np.allclose(measured - bias, np.mean(measured - bias)) else None


def _of_white(pairs):
    """From two recordings without a walk."""
    noise = [measured - bias for measured, bias in pairs[:2]]
    if all(np.ptp(part) < 1e-12 < abs(part[0]) for part in noise):
        return "WHITE_NOISE_SHARED"
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
    if np.std(np.diff(biases[0])) == 0:
        return "BIAS_CONSTANT"
    later = biases[0][_N // 2 :]  # what it does at first may have to do with where it starts
    ten = np.var(later[10:] - later[:-10]) / np.var(np.diff(later))
    if ten < 8:  # of a walk 10, to some hundredths
        return "BIAS_NOT_RANDOM_WALK" if ten < 2 else "BIAS_PULLED_BACK"
    powers = {0.0: "BIAS_NOT_SCALED_BY_SQRT_DT", 1.0: "BIAS_TIMES_DT", -0.5: "BIAS_OVER_SQRT_DT"}
    code = _of_power([np.diff(bias) for bias in biases], 0.5, powers, "BIAS_CONSTANT", "BIAS_FACTOR")
    code = code or _of_drift(biases)
    if code:
        return code
    if any(abs(bias[0] - 0.3) > 1e-12 for bias in biases):
        return _of_first(biases)
    measured = pairs[2][0]
    looks = (("BIAS_NOT_ADDED", true), ("BIAS_SUBTRACTED", true - biases[0]))
    for name, values in looks:
        if np.allclose(measured, values, rtol=0, atol=1e-12):
            return name
    return None if np.allclose(measured, true + biases[0], rtol=0, atol=1e-9) else "BIAS_OUT_OF_STEP"


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
        ("BIAS_STARTS_LATE", starts(0.3, 0.3)),
        ("BIAS0_IGNORED", starts(0.0, 0.0)),
        ("BIAS_CARRIED_OVER", abs(biases[1][0] - biases[0][-1]) < max(steps)),
    )
    return next((code for code, seen in looks if seen), None)


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
    call = np.zeros(8), 0.1, 0.1, 0.1, 0.0
    runs = submission.call_each("imu", [(*call, np.random.default_rng(seed)) for seed in _SEEDS])
    pairs = [[kit.as_vector(part, 8, "measured") for part in kit.as_tuple(run, _NAMES)] for run in runs]
    if pairs[0][1][0] != pairs[1][1][0]:  # bias0 is the same
        return named("BIAS_CARRIED_OVER")
    return _of_draws([measured - bias for measured, bias in pairs]) or _of_draws([bias for _, bias in pairs])


#: Of three calls that differ in nothing else: the first two draws must be the same, the last another.
_SEEDS = (5, 5, 6)


def _of_draws(draws):
    first, again, other = draws
    if np.allclose(first, other, rtol=0.0, atol=1e-9):  # a difference of two numbers is rounded
        return named("GENERATOR_IGNORED")
    return None if np.array_equal(first, again) else named("GLOBAL_RANDOMNESS")


# -- fit_noise ------------------------------------------------------------------------------------------


@np.errstate(all="ignore")  # a submission may have returned anything
def of_density(found, cases):
    """The mistake behind noise densities found in recordings; found (n,), cases as of ``expect_fits``."""
    right = np.array([case[2] for case in cases])
    stills, dts = [case[0] for case in cases], np.array([case[1] for case in cases])
    std = np.array([np.std(still) for still in stills])
    root = np.sqrt(dts)
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
    walks = np.array([case[3] for case in cases if len(case) > 3])
    if len(walks) == len(found) and _all_near(found, walks, 0.6) and not _all_near(found, right, 0.3):
        return named("FIT_SWAPPED")
    if not (np.all(np.isfinite(found)) and np.all(found >= 0)):
        return None
    return named("DENSITY_TOO_LARGE" if np.median(found / right) > 1 else "DENSITY_TOO_SMALL")


def _all_near(found, values, rel):
    """Whether each number is the value of its recording, and nothing else would be: values that differ."""
    return bool(np.all(np.abs(found / values - 1) < rel))


def _off_by(ratios, factor, rel):
    """Whether ratios of found to right are this factor in the middle, and scatter about it."""
    return bool(abs(np.median(ratios) / factor - 1) < rel)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_walk(found, cases):
    """The mistake behind random walks found in recordings; as ``of_density``."""
    right = np.array([case[3] for case in cases])
    ratios = found / right
    steps = np.array([np.std(np.diff(still)) / math.sqrt(dt) for still, dt, *_ in cases])
    if any(_off_by(found / steps, factor, 0.1) for factor in (1.0, 1 / math.sqrt(2))):
        return named("NOISE_COUNTED_AS_DRIFT")
    if not (np.all(np.isfinite(ratios)) and np.all(found >= 0)):
        return None
    if _off_by(found / right**2, 1.0, 0.5) and not _off_by(ratios, 1.0, 0.8):
        return named("ROOT_FORGOTTEN")
    with np.errstate(all="ignore"):
        scatter = np.ptp(np.quantile(np.log(np.maximum(ratios, 1e-9)), (0.1, 0.9)))
    if scatter > 1.5:  # those of right programs scatter by 0.1 to 0.6
        return named("WALK_SCATTERS")
    # A median over eight recordings or more is known to some ten per cent.
    if _off_by(ratios, 1 / math.sqrt(3), 0.15):
        return named("WALK_WITHOUT_THREE")
    return named("WALK_TOO_LARGE" if np.median(ratios) > 1 else "WALK_TOO_SMALL")


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


# -- lidar ----------------------------------------------------------------------------------------------

_WALL = np.array([[[2.0, -1.0], [2.0, 1.0]]])
_ROW = np.array([[[2.0, -1.0], [2.0, 1.0]], [[1.0, -1.0], [1.0, 1.0]], [[3.5, -1.0], [3.5, 1.0]]])
_LONG = np.array([[[1.0, 0.5], [3.0, 0.5]]])  # parallel to a beam along x
_ORIGIN, _REACH = (0.0, 0.0, 0.0), 5.0

#: Four beams in a crooked room, and how far off its walls are along each.
_CORNERS = np.array([[-2.0, -1.5], [3.0, -1.0], [2.5, 2.0], [-1.5, 1.2]])
_ROOM = np.stack((_CORNERS, np.roll(_CORNERS, -1, axis=0)), axis=1)
_X, _Y, _HEADING = 0.4, 0.3, 0.7
_FAN = np.array([-2.9, -0.8, 0.5, 2.1])
_READS = (2.080981412770427, 2.4360363400828278, 1.4891209215957006, 2.0579057845480433)


def _at(beam, *distances):
    """What a beam reads of walls across the x axis."""
    return tuple(x / math.cos(beam) for x in distances)


#: code, position, walls, the one beam, the right reading, readings that only this mistake gives
_SCENES = (
    ("POSITION_IGNORED", (0.5, 0.1, 0.0), _WALL, 0.0, 1.5, (2.0,)),
    ("WALLS_BEHIND_SEEN", _ORIGIN, _WALL, 3.0, _REACH, (0.0, *_at(3.0, 2.0, -2.0))),
    ("WALLS_ENDLESS", _ORIGIN, _WALL, 1.0, _REACH, _at(1.0, 2.0)),
    ("WALLS_ENDLESS", _ORIGIN, _WALL, -1.0, _REACH, _at(1.0, 2.0)),
    ("NOT_THE_NEAREST", _ORIGIN, _ROW, 0.1, *_at(0.1, 1.0), _at(0.1, 2.0, 3.5)),
    ("BEYOND_RANGE", _ORIGIN, _WALL + np.array([4.0, 0.0]), 0.01, _REACH, _at(0.01, 6.0)),
)
#: position, walls, the one beam, the right reading: a wall ahead, one wall along the beam, none within reach
_PLAIN = (
    (_ORIGIN, _WALL, 0.3, *_at(0.3, 2.0)),
    (_ORIGIN, np.concatenate((_LONG, _WALL)), 0.0, 2.0),
    (_ORIGIN, _WALL + np.array([40.0, 0.0]), 2.0, _REACH),
)


#: One wall in three places; what a beam at it reads has to differ.
_SHIFTS = ((0.0, 0.0), (1.0, 0.0), (-0.7, 0.0))


@np.errstate(all="ignore")  # a submission may have returned anything
def of_lidar(submission):
    """The mistake that ``lidar`` makes, from a room and from scenes with one wall or two, without noise.

    A mistake is named where the readings are those that it gives, not only where they are wrong.
    """
    scenes = [scene[1:5] for scene in _SCENES] + list(_PLAIN)
    beams = ((_HEADING, _FAN), (0.0, _FAN), (0.0, _FAN - _HEADING), (0.0, _FAN + _HEADING))
    calls = [((_X, _Y, heading), _ROOM, fan) for heading, fan in beams]
    calls += [(pose, walls, np.array([beam])) for pose, walls, beam, _ in scenes]
    calls += [(_ORIGIN, _WALL + shift, np.array([0.05])) for shift in _SHIFTS]
    calls = [(*call, _REACH, 0.0, np.random.default_rng(1)) for call in calls]
    results = submission.call_each("lidar", calls)
    fans = [kit.as_vector(result, len(_FAN), "ranges") for result in results[: len(beams)]]
    readings = np.array([kit.as_vector(result, 1, "ranges")[0] for result in results[len(beams) : -3]])
    shifted = {float(kit.as_vector(result, 1, "ranges")[0]) for result in results[-3:]}
    if len(shifted) == 1 and shifted != {_REACH}:
        return named("WALLS_NOT_READ")
    right = np.abs(readings - [scene[-1] for scene in scenes]) < 1e-9
    if np.all(right) and np.allclose(fans[0], _READS, rtol=0, atol=1e-9):
        return of_lidar_noise(submission)
    return _of_scenes(readings, right, _turning(*fans))


def _turning(turned, ahead, less, more):
    """What turning the robot does to its beams, if not to turn them along; fans as they were asked for."""
    if np.ptp(ahead) < 0.1 or np.allclose(turned, more, rtol=0, atol=1e-9):
        return None
    if np.allclose(turned, ahead, rtol=0, atol=1e-9):
        return "HEADING_IGNORED"
    return "HEADING_SUBTRACTED" if np.allclose(turned, less, rtol=0, atol=1e-9) else None


def _of_scenes(readings, right, turning):
    """From what was read in the scenes, and what ``turning`` the robot does to the beams of the room."""
    plain, parallel, nothing = right[-3:]
    if not nothing:
        return named("NO_HIT_NOT_MAX")
    if not plain:
        return None  # beams go astray, and not in a way that is known: nothing else can be told from them
    if turning:
        return named(turning)
    if np.all(right[:-3]) and not parallel:
        return named("PARALLEL_WALLS")
    seen = zip(_SCENES, readings, strict=False)
    return next(
        (named(code) for (code, *_, slips), r in seen if np.min(np.abs(np.subtract(slips, r))) < 1e-9), None
    )


@np.errstate(all="ignore")  # a submission may have returned anything
def of_lidar_noise(submission):
    """The mistake in the noise of ``lidar``, from two fans of beams on one wall and one fan on none."""
    fan = np.linspace(-0.4, 0.4, 2000)
    near, none = (1.95, 0.0, 0.0), (-20.0, 0.0, 0.0)
    ahead = np.linspace(-0.01, 0.01, 2000)
    places = ((_ORIGIN, fan), (none, fan), (near, fan), ((-2.95, 0.0, 0.0), ahead))
    calls = [
        (pose, _WALL, beams, 5.0, 0.1, np.random.default_rng(seed))
        for seed, (pose, beams) in enumerate(places)
    ]
    scans = [kit.as_vector(r, 2000, "ranges") for r in submission.call_each("lidar", calls)]
    hits, misses, close, far = scans
    noise = hits - 2.0 / np.cos(fan)
    spread = float(np.std(noise))
    if not np.all(misses == 5.0):
        return named("LIDAR_NOISE_ON_MAX")
    if spread < 1e-9:
        return named("LIDAR_NOISE_SHARED" if abs(noise[0]) > 1e-9 else "LIDAR_NOISE_MISSING")
    if np.any(close < 0):
        return named("NEGATIVE_RANGE")
    if not 0.09 < spread < 0.11:
        return named("LIDAR_SIGMA_WRONG")
    if not np.any(far > 5.0):  # the wall is 4.95 m away
        return named("NOISE_CUT_AT_MAX")
    return of_scan_draws(submission)


@np.errstate(all="ignore")  # a submission may have returned anything
def of_scan_draws(submission):
    """Whether the noise of ``lidar`` comes from the generator that is passed in."""
    calls = [(_ORIGIN, _WALL, _AHEAD, 5.0, 0.1, np.random.default_rng(seed)) for seed in _SEEDS]
    return _of_draws([kit.as_vector(r, 8, "ranges") for r in submission.call_each("lidar", calls)])


_AHEAD = np.linspace(-0.4, 0.4, 8)
