"""Comparisons of intervals by ``block_bootstrap_ci`` that the public and the hidden checks share."""

from __future__ import annotations

import numpy as np

from course.scoring import kit

probes = kit.companion("validation", "probes")
shared = kit.companion("validation", "expectations")


def expect_width(submission, rng, scale, offset):
    """Intervals for the mean of correlated errors are about as wide as they must be, and lie around it."""
    n, phi, block = 400, 0.9, 40
    series = offset + scale * shared.correlated(int(rng.integers(2**31)), 30, n, phi)
    calls = [(e, shared.MEAN, block, 70, 0.05, np.random.default_rng(rng.integers(2**31))) for e in series]
    ends = shared.interval_ends(submission.call_each("block_bootstrap_ci", calls))
    shown = {
        "series": "30, each sample keeps 0.9 of the one before",
        "N": n,
        "block": block,
        "n_boot": 70,
        "alpha": 0.05,
    }
    kit.expect_bounded(
        float(np.mean(ends[:, 1] - ends[:, 0])) / (2 * 1.96 * scale * shared.spread_of_mean(n, phi)),
        low=0.5,
        high=1.3,
        # Of any right interval, less than 0.5 has a chance below 3e-9; less than 0.55, one of 4e-5.
        source="blocks give 0.6 to 1.0, single samples 0.22",
        quantity="mean width over true width",
        input=shown,
        message="The intervals do not have the width that the scatter of the mean requires.",
        help="The ends are quantiles of the statistic over resamples that are made of blocks of neighbours.",
        diagnose=lambda: probes.of_interval(submission, 1),
    )
    expect_centred(submission, ends, np.mean(series, axis=1), shown)


def expect_resamples(submission, seed):
    """The resamples are n_boot, as long as the series, of blocks as asked for; the series stays as it was."""
    found = probes.resample(submission, seed)
    code = probes.of_resamples(found)
    if code is not None:
        kit.fail(
            "The statistic does not get the resamples that it should get.",
            help="Join blocks of neighbours, drawn with replacement, until there are as many as in e.",
            diagnose=probes.named(code),
            expected="24 resamples of 250 samples in blocks of 12",
            actual={
                "resamples": len(found.drawn),
                "lengths": sorted({len(samples) for samples in found.asked}),
                "they begin": [samples[:8] for samples in found.asked[:3]],
            },
        )
    short = probes.resample(submission, seed, 150, 2)
    left_out = [x for x in short.e[[0, -1]] if not any(x in samples for samples in short.drawn)]
    kit.expect_true(
        not left_out,
        "The statistic does not get the resamples that it should get.",
        diagnose=probes.named("AN_END_LEFT_OUT"),
        expected="1.0 and 24.0 in some of 150 resamples of 1.0, 2.0, ... 24.0 in blocks of 12",
        actual={"never drawn": left_out},
    )
    code = probes.of_ends(found)
    # Of few values, an interval by another rule may look like it: more of them must show it, too.
    mistake = code and probes.of_interval(submission, seed, found)
    if mistake is not None:
        kit.fail(
            "The ends of the interval are not the quantiles that they should be.",
            help="The alpha/2 and the 1 - alpha/2 quantile of the statistic over the resamples.",
            diagnose=lambda: mistake,
            expected="quantiles at 0.1 and 0.9 of what the statistic said",
            actual=found.inspected.value,
        )
    [ends] = shared.interval_ends([found.inspected.value])
    values = np.array(
        [value for x, value in zip(found.asked, found.answers, strict=True) if len(x) == len(found.e)]
    )
    kit.expect_bounded(
        float((ends[1] - ends[0]) / np.ptp(np.quantile(values, [0.1, 0.9]))),
        # 60,000 right intervals, each by quantiles of every kind and as a normal one, gave 0.43 to 2.4.
        low=0.2,
        high=5.0,
        source="right intervals of 24 values give 0.43 to 2.4",
        quantity="width over the distance of the 0.1 and 0.9 quantiles of the statistic",
        message="The interval does not come from what the statistic says of the resamples.",
        help="The ends are the alpha/2 and the 1 - alpha/2 quantile of the statistic over the resamples.",
    )
    shared.expect_left_alone(found.inspected, [found.e], ["e"])


def expect_whole(submission):
    """Of errors that are whole numbers the interval is the same as of these numbers as floats."""
    e = np.rint(20 * np.sin(np.arange(60) ** 1.3)).astype(int)
    asked = [(x, shared.MEAN, 5, 40, 0.2, np.random.default_rng(7)) for x in (e, e.astype(float))]
    ends = shared.interval_ends(submission.call_each("block_bootstrap_ci", asked))
    kit.expect_array(
        ends[0],
        ends[1],
        rel=1e-9,
        source="the same resamples, drawn by generators with the same seed",
        quantity="lo and hi",
        input={"e": e, "block": 5, "n_boot": 40, "alpha": 0.2},
        message="For errors that are whole numbers the interval is another than for the same ones as floats.",
        diagnose=probes.named("WHOLE_NUMBERS"),
    )


def expect_centred(submission, ends, statistics, shown):
    """Each interval has its statistic about in its middle, in the mean over all."""
    middle = np.mean(ends, axis=1)
    width = float(np.mean(ends[:, 1] - ends[:, 0]))
    kit.expect_true(
        bool(np.any(np.abs(ends[:, 1] - ends[:, 0]) > 1e-12 * np.max(np.abs(ends)))),
        "Both ends of the interval are the same number, or differ by rounding alone.",
        help="The ends are two quantiles of the statistic over the resamples. Draw each resample anew.",
        input=shown,
        actual=ends[0],
        diagnose=lambda: probes.of_interval(submission, 1),
    )
    kit.expect_bounded(
        float(np.mean(np.abs(middle - statistics)) / (width or 1e-12)),
        high=0.35,
        source="right intervals stay below 0.2",
        quantity="distance of the middle from the statistic, in widths",
        input=shown,
        message="The middle of the intervals is too far from the statistic of the series.",
        help="The ends are quantiles of the statistic over the resamples.",
        diagnose=lambda: probes.of_interval(submission, 1) or probes.named("NOT_CENTRED"),
    )


def expect_level(submission, rng, statistic):
    """From alpha 0.32 to 0.05 an interval grows as the quantiles do; chance comes from rng alone."""
    series = shared.correlated(int(rng.integers(2**31)), 8, 240, 0.6)
    seeds = [int(s) for s in rng.integers(2**31, size=len(series))]
    calls = [
        (e, statistic, 16, 120, alpha, np.random.default_rng(seed))
        for alpha in (0.05, 0.32)
        for e, seed in zip(series, seeds, strict=True)
    ]
    again = [(*calls[0][:-1], np.random.default_rng(seed)) for seed in (seeds[0], seeds[0] + 1)]
    # A short series, of which there are more resamples than it has samples.
    short = (series[0][:60], statistic, 8, 100, 0.32, np.random.default_rng(seeds[0]))
    ends = shared.interval_ends(submission.call_each("block_bootstrap_ci", [*calls, short, *again]))
    shown = {"N": 240, "block": 16, "n_boot": 120, "statistic": "mean of e**2, times a number"}
    _expect_chance(submission, ends[[0, -2, -1]], shown)
    wide, narrow = ends[:8], ends[8:16]
    values = np.array([statistic(e) for e in series])
    expect_centred(submission, wide, values, shown)
    ratio = float(np.mean(wide[:, 1] - wide[:, 0]) / np.mean(narrow[:, 1] - narrow[:, 0]))
    kit.expect_bounded(
        ratio,
        low=1.5,
        high=2.8,  # ends on the outer of two neighbouring values reach 2.5 with a chance of 9e-6
        source="a normal distribution gives 1.97",
        quantity="width at alpha 0.05 over width at alpha 0.32",
        input=shown,
        message="The width of the interval does not depend on alpha as it should.",
        help="alpha is the fraction outside, both sides together.",
        diagnose=lambda: (
            probes.of_interval(submission, 1, ends_first=True) or probes.named("ONE_STANDARD_ERROR")
        ),
    )


def _expect_chance(submission, ends, shown):
    first, same, other = ends
    kit.expect_true(
        bool(np.array_equal(first, same, equal_nan=True)),
        "Two calls with the same arguments, and generators in the same state, give different intervals.",
        help="Take every random number from rng.",
        input=shown,
        diagnose=probes.named("GLOBAL_RNG"),
    )
    kit.expect_true(
        not np.array_equal(first, other),
        "Two calls with different generators give the same interval.",
        help="Take every random number from rng.",
        input=shown,
        diagnose=lambda: probes.of_interval(submission, 1) or probes.of_chance(submission),
    )
