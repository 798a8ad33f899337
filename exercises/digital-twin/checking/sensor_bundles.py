"""What public and hidden checks of the sensors of ``digital-twin`` have in common."""

from __future__ import annotations

import functools
import math

import numpy as np

from course.scoring import kit

bundles = kit.companion("digital-twin", "bundles")
scenes = kit.companion("digital-twin", "scenes")
scanners = kit.companion("digital-twin", "lidar_probes")
sensors = kit.companion("digital-twin", "sensor_probes")
expect_clean = bundles.expect_clean


def angles_between_counts(rng, n, most, per_turn):
    """Angles (n,), rad, of up to ``most`` counts either way, none where rounding decides about a count.

    Each lies 0.01 counts or more from every whole and every half count: multiplying before dividing, or
    after, is off by 1e-12 of a count.
    """
    counts = rng.integers(-most, most, n) + 0.5 * rng.integers(0, 2, n) + rng.uniform(0.01, 0.49, n)
    return counts * 2 * math.pi / per_turn


def angles_beside_counts(counts, per_turn):
    """Angles (4 N,), rad, 0.001 counts on either side of whole counts near these and of the next halves."""
    beside = np.add.outer(np.rint(counts), [-0.001, 0.001, 0.499, 0.501])
    return beside.ravel() * 2 * math.pi / per_turn


def expect_counts(submission, counts, theta, counts_per_rev):
    """Counts are whole numbers, and those of floor throughout or of round throughout."""
    given = {"theta": theta, "counts_per_rev": counts_per_rev}
    if isinstance(counts, list):
        whole = all(isinstance(count, int) and not isinstance(count, bool) for count in counts)
    else:
        whole = isinstance(counts, np.ndarray) and counts.dtype.kind == "i"
    values = kit.as_vector(counts, len(theta), "counts")
    exact = theta * counts_per_rev / (2 * math.pi)
    floor, nearest = np.floor(exact), np.rint(exact)
    wanted = floor if np.sum(values == floor) >= np.sum(values == nearest) else nearest
    kit.expect_array(
        values,
        wanted,
        abs=1e-9,
        source="counts are exact",
        quantity="counts",
        units="counts",
        input=given,
        message="The counts are neither the angles rounded down to whole counts nor rounded to nearest.",
        help="counts = theta * counts_per_rev / (2 pi), with math.pi, and then rounded: all down, or all "
        "to the nearest.",
        diagnose=lambda: sensors.of_encoder(submission, values, theta, counts_per_rev),
    )
    kit.expect_true(
        whole,
        "The counts have the wrong type.",
        input=given,
        diagnose=sensors.named("COUNTS_AS_FLOATS"),
    )


def std(values):
    """The std of what may hold anything; NaN where it has none."""
    with np.errstate(all="ignore"):
        return float(np.std(values))


#: Of noise and steps whose mean is 0, their mean as a share of their std: six times its scatter at the most.
MEAN_WITHIN = 0.15


def expect_no_mean(values, spread, quantity, diagnose, **finding):
    """Noise, or the steps of a walk, (n,), of this std go neither way on the whole."""
    with np.errstate(all="ignore"):
        mean = float(np.mean(values))
    kit.expect_close(
        mean,
        0.0,
        abs=MEAN_WITHIN * spread,
        source="the README's",
        quantity=f"mean of {quantity}",
        units="rad/s",
        message=f"The mean of {quantity} is not zero.",
        help="Noise and bias steps are standard normal numbers times a factor: they go either way alike.",
        diagnose=diagnose,
        **finding,
    )


def expect_std(values, expected, rel, source, message, diagnose, **finding):
    """The std of a sample is the expected one, and its mean is zero."""
    if not math.isfinite(std(values)):
        diagnose = None  # the comparison says what there is to say of a nan
    kit.expect_close(
        std(values),
        expected,
        rel=rel,
        source=source,
        units="rad/s",
        message=message,
        diagnose=diagnose,
        **finding,
    )
    shown = {key: finding[key] for key in ("input",) if key in finding}
    expect_no_mean(values, expected, finding["quantity"].removeprefix("std of "), diagnose, **shown)


def imu_pairs(submission, calls):
    """(measured, bias) of each call, as vectors as long as the true rate."""
    pairs = []
    for call, value in zip(calls, submission.call_each("imu", calls), strict=True):
        measured, bias = kit.as_tuple(value, ("measured", "bias"))
        n = len(call[0])
        pairs.append((kit.as_vector(measured, n, "measured"), kit.as_vector(bias, n, "bias")))
    return pairs


def of_quiet_imu(submission):
    """The mistake of ``imu`` in a check without white noise."""
    return bundles.unless(sensors.OF_THE_NOISE, lambda: sensors.of_imu(submission, bias_first=True))


def expect_white(submission, calls, rel, source):
    """Without a walk the bias stays, and measured minus it is as strong as the density says, at each rate."""
    for call, (measured, bias) in zip(calls, imu_pairs(submission, calls), strict=True):
        true, dt, density = call[:3]
        expect_std(
            measured - bias,
            density / math.sqrt(dt),
            rel,
            source,
            "Without a walk, the std of measured - bias is not noise_density / sqrt(dt).",
            lambda: bundles.unless(sensors.OF_THE_WALK, lambda: sensors.of_imu(submission)),
            quantity="std of measured - bias",
            help="A noise density is per square root of hertz: how many samples are there in a second?",
            input={"dt": dt, "noise_density": density, "bias_random_walk": 0.0, "samples": len(true)},
        )
        kit.expect_array(
            bias,
            np.full(len(true), bias[0]),
            abs=1e-9,
            source="rounding",
            quantity="bias",
            units="rad/s",
            input={"dt": dt, "noise_density": density, "bias_random_walk": 0.0, "bias0": call[4]},
            message="Without a walk, the bias does not stay what it is at first.",
            help="bias[k+1] = bias[k] + bias_random_walk sqrt(dt) n: without a walk it is bias[k].",
            diagnose=lambda bias=bias: sensors.of_still_bias(submission, bias),
        )


def expect_walk(submission, n, dt, walk, bias0, rng):
    """Over one sample and over ten, the bias wanders as the root of time."""
    ((_, bias),) = imu_pairs(submission, [(np.zeros(n), dt, 0.0, walk, bias0, rng)])
    for m in (1, 10):
        with np.errstate(all="ignore"):
            spread = std(bias[m:] - bias[:-m]) ** 2
        kit.expect_close(
            spread,
            walk**2 * m * dt,
            rel=0.15,
            source="the README's",
            quantity=f"variance of the bias over {m} samples",
            units="(rad/s)²",
            input={"dt": dt, "bias_random_walk": walk, "noise_density": 0.0, "samples": n},
            message="The bias does not wander as a random walk of this strength should.",
            help="Independent steps add up: the variance grows with the time between two samples.",
            diagnose=lambda: of_quiet_imu(submission),
        )
    ask = lambda: of_quiet_imu(submission)  # noqa: E731
    expect_no_mean(
        np.diff(bias), walk * math.sqrt(dt), "the bias steps", ask, input={"bias0": bias0, "dt": dt}
    )


def expect_rate_kept(submission, true, dt, bias0, rng):
    """The bias starts at bias0; without white noise, measured minus it is the true rate, which is kept."""
    call = (true, dt, 0.0, 0.02, bias0, rng)
    value = expect_clean(submission, "imu", call, ("true", *[None] * 5))
    measured, bias = kit.as_tuple(value, ("measured", "bias"))
    n = len(true)
    bias = kit.as_vector(bias, n, "bias")
    kit.expect_close(
        bias[0],
        bias0,
        abs=1e-9,
        source="exact",
        quantity="bias[0]",
        units="rad/s",
        message="The first bias is not bias0.",
        help="bias[0] = bias0; the first step leads to bias[1].",
        input={"bias0": bias0, "dt": dt},
        diagnose=lambda: of_quiet_imu(submission),
    )
    kit.expect_array(
        kit.as_vector(measured, n, "measured") - bias,
        true,
        abs=1e-9,
        source="rounding",
        quantity="measured - bias",
        units="rad/s",
        message="Without white noise, measured minus bias is not the true rate.",
        help="measured[k] = true[k] + bias[k] + white noise.",
        input={"true": true, "dt": dt},
        diagnose=lambda: of_quiet_imu(submission),
    )


def expect_no_copy(submission, task, *args):
    """The function draws from the generator that it is given after these arguments, so that this moves on."""
    kit.expect_true(
        not sensors.copies_generator(submission, task, *args),
        "The call makes a deep copy of its generator `rng`.",
        help="Draw from rng itself: it moves on with each number. A copy gives the same numbers again.",
        diagnose=sensors.named("GENERATOR_COPIED"),
    )


def _most_alike(a, b):
    """The largest correlation of one with the other any number of samples later; with itself, after 0."""
    itself = a is b
    a, b = ((each - np.mean(each)) / np.std(each) / math.sqrt(len(each)) for each in (a, b))
    size = len(a) + len(b)  # no sample meets one from the other end
    shifted = np.fft.irfft(np.fft.rfft(a, size).conj() * np.fft.rfft(b, size), size)
    return float(np.max(np.abs(shifted[1 : size // 2] if itself else shifted)))


def expect_gyroscope_draws(submission, seed, dt):
    """Noise and bias of ``imu`` are independent, and the generator that is passed in decides about each."""
    n = 4000
    calls = [(np.zeros(n), dt, 0.01, 0.01, 0.0, np.random.default_rng(s)) for s in (seed, seed, seed + 1)]
    pairs = imu_pairs(submission, calls)
    first, again, other = ((measured - bias, np.diff(bias)) for measured, bias in pairs)
    # The noise and the walk, each by itself: told apart by subtraction, which rounds.
    kit.expect_true(
        all(np.array_equal(a, b, equal_nan=True) for a, b in zip(first, again, strict=True)),
        "With two generators in the same state, the noise (measured - bias) or the bias steps differ.",
        help="Draw both from rng itself and from nothing else, and keep nothing between two calls.",
        diagnose=lambda: sensors.of_randomness(submission),
    )
    for a, c, name in zip(
        first, other, ("samples of the noise (measured - bias)", "of the bias steps"), strict=True
    ):
        kit.expect_true(
            not bool(np.mean(np.abs(a - c) < 1e-9) > 0.01),  # of right ones, one in a million at most
            f"With two generators in different states, some {name} are the same.",
            help="Draw a standard normal number of its own from rng for each sample and for each step.",
            diagnose=lambda: sensors.of_randomness(submission) or sensors.of_imu(submission, bias_first=True),
        )
    expect_no_copy(submission, "imu", np.zeros(8), dt, 0.01, 0.01, 0.0)
    white, steps = first
    sizes = ((white, 0.01 / math.sqrt(dt), "measured - bias"), (steps, 0.01 * math.sqrt(dt), "the steps"))
    for values, expected, name in sizes:
        kit.expect_close(
            std(values),
            expected,
            rel=0.06,
            source="the README's",
            quantity=f"std of {name}",
            units="rad/s",
            input={"dt": dt, "noise_density": 0.01, "bias_random_walk": 0.01, "samples": n},
            message=f"With white noise and a walk together, the std of {name} is wrong.",
            diagnose=lambda: sensors.of_imu(submission),
        )
    with np.errstate(all="ignore"):
        alike = [_most_alike(*pair) for pair in ((white, steps), (white, white), (steps, steps))]
    kit.expect_bounded(
        max(alike) if np.all(np.isfinite(alike)) else math.nan,
        high=0.12,
        source="the README's 0.1, and what chance adds",
        quantity="largest correlation",
        input={"dt": dt, "noise_density": 0.01, "bias_random_walk": 0.01, "samples": n},
        message="The white noise and the bias steps are correlated: with each other, or with what they were "
        "some samples before.",
        help="Draw two arrays of standard normal numbers, use each number once, and sum up only one array.",
        diagnose=lambda: sensors.of_imu(submission),
    )
    parts = ((white, "samples of the noise (measured - bias)"), (steps, "bias steps"))
    for values, name in parts:
        kit.expect_true(
            not bool(abs(np.mean(values)) < 1e-9 * std(values)),
            f"The {name} add up to zero, which independent ones never do.",
            help="Use the random numbers as they are drawn: do not take their mean away.",
            input={"dt": dt, "noise_density": 0.01, "bias_random_walk": 0.01, "samples": n},
            diagnose=sensors.named("NOISE_CENTRED"),
        )
    # Of 4000 normal numbers 50 are beyond 2.5 stds: of right ones, never in a lifetime none.
    for values, name in parts:
        kit.expect_true(
            bool(np.any(np.abs(values) > sensors.FAR * std(values))),
            f"Of thousands of {name}, none is as far from zero as one standard normal number in a hundred.",
            help="Draw standard normal numbers: rng.standard_normal(...).",
            input={"dt": dt, "noise_density": 0.01, "bias_random_walk": 0.01, "samples": n},
            diagnose=lambda: sensors.of_imu(submission),
        )


def recordings(rng, count, make):
    """``count`` recordings at rest as cases of ``expect_fits``, two in three of them with a negative bias.

    make: gives (dt, noise_density, bias_random_walk, size of bias0) for each.
    """
    cases = []
    for i in range(count):
        dt, density, walk, size = make()
        numbers = density, walk, float(size) * (1.0 if i % 3 == 0 else -1.0)
        still = scenes.recording(rng, int(rng.integers(11500, 12501)), dt, *numbers)
        cases.append((still, dt, *numbers))
    return cases


#: What the README allows of the median errors of N and K (logarithms of ratios) and of bias0 (in sqrt(N K)).
#: Over 200 seeds good fits used at most 0.029, 0.25 and 1.7. A coarse one was off by 0.37 once.
FITS_WITHIN = (0.05, 0.35, 2.1)


def expect_fits(submission, cases):
    """fit_noise recovers what recordings were made with.

    cases: (still, dt, noise_density, bias_random_walk, bias0) each

    Medians over the cases count, of |log(N ratio)|, |log(K ratio)| and |bias0 error| / sqrt(N K): who looks
    at few blocks is far off on a rare recording, and right about the method.
    """
    found = _found(submission, cases)
    off = _off(found, cases)
    units = ("log of a ratio", "log of a ratio", "sqrt(N K)")
    for column, key in enumerate(_KEYS):
        i = int(np.argmax(np.abs(off[:, column])))
        median = float(np.median(np.abs(off[:, column])))
        if not math.isfinite(median) and np.all(np.isfinite(found[:, column])):  # no logarithm, but a number
            kit.fail(
                f"From at least half of the recordings, fit_noise finds a `{key}` that is not positive.",
                help="Noise density and random walk are square roots of variances: positive numbers.",
                diagnose=lambda column=column: _of_fit(submission, column, found, cases),
                expected={key: [case[2 + column] for case in cases]},
                actual={key: found[:, column]},
            )
        kit.expect_close(
            median,
            0.0,
            abs=FITS_WITHIN[column],
            source="the README's",
            quantity=f"median error of {key}",
            units=units[column],
            input={
                "dt": cases[i][1],
                "worst recording made with": dict(zip(_KEYS, cases[i][2:], strict=True)),
                "found": list(found[i]),
            },
            message=f"From recordings at rest, fit_noise does not find `{key}`.",
            help="bias0 is the mean of the first sqrt(3) N/K seconds or so."
            if key == "bias0"
            else "Half the mean square of the differences of neighbouring block means is N²/T + K² T/3. "
            "Compare both sides, for a short T and for a long one.",
            diagnose=lambda column=column: _of_fit(submission, column, found, cases),
        )


_KEYS = ("noise_density", "bias_random_walk", "bias0")


def _found(submission, cases):
    """What fit_noise finds in recordings, (n, 3)."""
    values = submission.call_each("fit_noise", [(still, dt) for still, dt, *_ in cases])
    return np.array(
        [[kit.as_number(kit.as_record(value, _KEYS)[key], key) for key in _KEYS] for value in values]
    )


@np.errstate(all="ignore")  # a submission may have returned anything
def _off(found, cases):
    """How far each of these is from what the recording was made with, (n, 3): as in ``FITS_WITHIN``."""
    right = np.array([case[2:] for case in cases])
    off = np.log(found / right)
    off[:, 2] = (found[:, 2] - right[:, 2]) / np.sqrt(right[:, 0] * right[:, 1])
    off[~np.isfinite(off)] = np.inf
    return off


def unknown_gyroscope(rng):
    """dt, noise density, random walk and size of bias0 of a gyroscope of any kind, for ``recordings``."""
    # N/K is far from one second either way: at a second, its inverse is as good.
    density, dt = 10 ** rng.uniform(-3.5, -2.0), float(rng.choice([0.001, 0.1]) * rng.uniform(0.7, 1.4))
    # The walk takes over after some 60 to 120 samples: both are to be seen in one recording.
    return dt, density, density / (dt * rng.uniform(60, 120)), density * rng.uniform(10, 60)


@functools.cache
def _telling():
    """Recordings that tell the mistakes apart, the same ones at home and in every run.

    Where walk and density happen to be alike in what a run draws, one looks like the other.
    """
    rng = np.random.default_rng(12)
    return tuple(recordings(rng, 8, lambda: unknown_gyroscope(rng)))


def _of_fit(submission, column, found, cases):
    """The mistake behind one of the three numbers; what is wrong with the check's own recordings, if none."""

    def look(found, cases):
        if column == 0:
            return sensors.of_density(found[:, 0], cases, found[:, 1] if len(cases[0]) > 3 else None)
        if column == 1:
            return sensors.of_walk(found[:, 1], cases, submission)
        return sensors.of_bias0(found[:, 2], cases)

    def is_cause(said):
        return said is not None and sensors.named.kind(said.code) == "cause"

    own, here = kit.attempt(lambda: _found(submission, _telling())), look(found, cases)
    if own is None or np.median(np.abs(_off(own, _telling())[:, column])) <= FITS_WITHIN[column]:
        return here
    said = look(own, _telling())
    if is_cause(said):
        return said
    return None if is_cause(here) else here


def expect_density_of_short(submission, still, dt, density):
    """From a short recording, which is left alone, the noise density is found."""
    value = expect_clean(submission, "fit_noise", (still, dt), ("still", None))
    found = kit.as_record(value, _KEYS)
    kit.expect_close(
        found["noise_density"],
        density,
        rel=0.2,
        source="the README's",
        quantity="noise_density",
        units="rad/s/sqrt(Hz)",
        message="From a short recording, the noise density is wrong.",
        diagnose=lambda: _of_fit(submission, 0, np.array([[found["noise_density"]]]), [(still, dt, density)]),
    )


#: A long wall across the x axis, 3 m ahead: a beam at angle a reads 3/cos(a).
_WALL = np.array([[[3.0, -30.0], [3.0, 30.0]]])
#: In std, how far the mean of 4000 readings may be off: six times its scatter. The smaller of two readings
#: half a std apart is off by 0.35 on the mean.
_MEAN_OF_HITS_WITHIN = 0.1


def expect_scan_noise(submission, r_max, sigma, rng):
    """Hits have noise of std sigma, each its own, from zero to beyond r_max; other readings have none.

    r_max: 6 m or more, so that half of a wide fan hits
    """
    n, fan, ahead = 4000, np.linspace(-2.0, 2.0, 4000), np.linspace(-0.01, 0.01, 4000)
    places = ((0.0, fan), (3.0 - 0.5 * sigma, ahead), (3.0 - r_max + 0.5 * sigma, ahead))
    calls = [(np.array([x, 0.0, 0.0]), _WALL, beams, r_max, sigma, rng) for x, beams in places]
    behind = np.concatenate((_WALL + np.array([0.5 * sigma, 0.0]), _WALL))
    calls.append((np.zeros(3), behind, ahead, r_max, sigma, rng))
    wide, near, far, two = (kit.as_vector(v, n, "ranges") for v in submission.call_each("lidar", calls))
    with np.errstate(divide="ignore"):
        exact = np.where(np.cos(fan) > 0, 3.0 / np.cos(fan), np.inf)
    hits, clear = exact <= r_max, exact > r_max + 6 * sigma
    given = {"r_max": r_max, "sigma": sigma, "beams": n}
    ask = lambda: scanners.of_straight_lidar(submission)  # noqa: E731

    def expect_reach(beams):
        kit.expect_true(
            bool(np.all(wide[beams] == r_max)),
            "A beam without a hit within r_max does not read r_max exactly.",
            help="Without a hit the reading is r_max itself: noise belongs to hits only.",
            input=given,
            diagnose=ask,
        )

    expect_reach(clear)
    off = (wide - exact)[hits]
    with np.errstate(all="ignore"):
        missed = float(np.mean(wide[hits & (exact < r_max - 6 * sigma)] == r_max))
        middle = float(np.median(off))
    kit.expect_true(
        missed == 0.0 and abs(middle) < 0.5 * sigma,
        "Of one long wall, the readings do not scatter about its distances.",
        help="Is this wall read as it is with sigma = 0? If so, look at the noise, which goes either way "
        "alike; if not, look at the distances.",
        input=given,
        diagnose=ask,
    )
    expect_reach(~hits)  # of a wall read at another distance nothing is said of noise
    kit.expect_close(
        std(off),
        sigma,
        rel=0.1,
        source="the README's",
        quantity="std of the noise",
        units="m",
        input=given,
        message="The readings of hits do not scatter about the distances with the std sigma.",
        help="Add sigma times a standard normal number of its own to each hit.",
        diagnose=ask,
    )
    # Half a std from zero or from r_max, three in ten readings go beyond: 0.2 is sixteen stds away.
    negative = bool(np.any(near < 0.0))
    kit.expect_true(
        not negative and bool(np.mean(near == 0.0) > 0.2),
        "Very close to a wall, some readings are negative."
        if negative
        else "Very close to a wall, too few readings are 0.",
        help="A distance cannot be negative: apply np.maximum(..., 0.0) after the noise."
        if negative
        else "What the noise makes negative reads 0: draw no number again, and leave none out. If this wall "
        "is not seen with sigma = 0 either, let it count however near it is.",
        input=given,
        diagnose=ask,
    )
    kit.expect_true(
        bool(np.mean(far > r_max) > 0.2),
        "Close to the maximum range, too few readings of hits lie beyond r_max.",
        help="Whether a beam hits is decided without noise; what the noise makes of the reading stays.",
        input=given,
        diagnose=ask,
    )
    with np.errstate(all="ignore"):
        mean = float(np.mean(two - 3.0 / np.cos(ahead)))
    kit.expect_close(
        mean,
        0.0,
        abs=_MEAN_OF_HITS_WITHIN * sigma,
        source="the README's",
        quantity="mean of the readings minus the distance of the nearer wall",
        units="m",
        input={**given, "distances of two walls": [3.0, 3.0 + 0.5 * sigma]},
        message="Of two walls, one just behind the other, the mean reading is not that of the nearer one.",
        help="Is the mean off with one wall as well? If so, look at the noise. If not, find the nearest wall "
        "without noise first, and then add noise to its distance.",
        diagnose=ask,
    )


def expect_scan_draws(submission, seed):
    """The generator that is passed in decides about the noise of a scan."""
    beams = np.linspace(-0.5, 0.5, 20)
    seeds = (seed, seed, seed + 1, seed + 2, seed + 3)  # rounded readings may be equal once by chance
    calls = [(np.zeros(3), _WALL, beams, 9.0, 0.05, np.random.default_rng(s)) for s in seeds]
    first, again, *others = (kit.as_vector(v, 20, "ranges") for v in submission.call_each("lidar", calls))
    kit.expect_true(
        np.array_equal(first, again, equal_nan=True),
        "With two generators in the same state, the readings differ.",
        help="Draw from rng itself and from nothing else.",
        diagnose=lambda: scanners.of_scan_draws(submission),
    )
    expect_no_copy(submission, "lidar", np.zeros(3), _WALL, beams, 9.0, 0.05)
    kit.expect_true(
        not np.any(np.all(first == others, axis=0)),
        "With four generators in different states, at least one reading of a hit is the same.",
        help="Draw a standard normal number of its own from rng for each hit, and round no reading.",
        diagnose=lambda: scanners.of_scan_draws(submission),
    )
