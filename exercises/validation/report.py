"""What ``course report validation`` shows: the student's own instruments on public data."""

from __future__ import annotations

import numpy as np

from course.physics.systems import AveragePolynomial
from course.scoring import kit

dataset = kit.companion("validation", "dataset")
twins = kit.companion("validation", "twins")

SPEC = {"rmse_max": 0.06, "bias_max": 0.03, "lag_max_s": 0.012, "coverage_min": 0.85, "coverage_max": 0.99}


def report(submission):
    """Error with its band, NEES with its band, intervals by block length, and five verdicts."""
    sections = (
        ("How large is the error, and is it admitted?", _errors),
        ("Does the filter know how wrong it is?", _consistency),
        ("How sure is the bias?", _intervals),
        ("Which twin may stand in for the cart?", _verdicts),
    )
    return kit.Report(
        title="Your instruments at work",
        sections=tuple(
            kit.guarded_section(title, lambda title=title, make=make: make(submission, title))
            for title, make in sections
        ),
    )


def _recordings():
    rng = np.random.default_rng(2024)
    return [twins.record(rng, name, 9.0, 0.01, 0.03) for name in ("a", "b", "c", "d")]


def _errors(submission, title):
    recorded = _recordings()[:1]
    real = recorded[0].y
    rows, panels, seen = [], [], []
    for name, mass in (("good twin", twins.MASS), ("a fifth too heavy", 1.2 * twins.MASS)):
        run = twins.simulated(recorded, mass=mass)["runs"][0]
        t, y, half = run["t"], run["y"], 1.96 * run["sigma"]
        e = y - real
        size = kit.as_number(submission.call("rmse", e), "rmse")
        bias, variance = kit.as_vector(submission.call("bias_variance", e), 2, "(bias, variance)")
        inside = kit.as_number(submission.call("coverage", real, y - half, y + half), "coverage")
        rows.append((name, f"{size:.3f} m/s", f"{bias:+.4f} m/s", f"{variance:.5f} m²/s²", f"{inside:.1%}"))
        series = (
            kit.Series("error" if panels else "", t, e),
            kit.Series("claimed: 1.96 sigma" if panels else "", t, -half, kind="band", high=half),
        )
        panels.append(kit.Panel("time / s", "speed error / (m/s)", series, title=name))
        seen.append(
            f"{name}: errors up to {np.max(np.abs(e)):.2f} m/s, a band of up to {np.max(half):.2f} m/s to "
            f"either side; your rmse is {size:.3f} m/s, and your coverage finds {inside:.1%} inside."
        )
    return kit.Section(
        title,
        text="A cart was driven for 9 s and its speed recorded. Two twins simulate the same drive, and both "
        "claim the same sigma. An honest band holds about 95 % of the errors.",
        columns=("twin", "rmse", "bias", "variance", "coverage"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="Simulated minus real speed, and what the twin claims",
            panels=tuple(panels),
            description=f"Error over time about zero, and the band. Above, {seen[0]} Below, {seen[1]}",
        ),
    )


def _consistency(submission, title):
    runs = 25
    lo, hi = kit.as_vector(submission.call("consistency_band", 2, runs, 0.05), 2, "(lo, hi)")
    rows, series, seen = [], [], []
    for name, factor in (("right", 1.0), ("half", 0.5), ("twice", 2.0)):
        track = dataset.track(factor * dataset.NOISE, runs)
        n = len(track.t)
        covariance = np.tile(track.P, (runs, 1, 1))
        values = submission.call("nees", track.err.reshape(runs * n, 2), covariance)
        mean = kit.as_vector(values, runs * n, "nees").reshape(runs, n).mean(axis=0)
        innovations = submission.call("nis", track.nu.reshape(runs * n, 1), np.tile(track.S, (runs, 1, 1)))
        nis = float(np.mean(kit.as_vector(innovations, runs * n, "nis")))
        within = float(np.mean((lo <= mean) & (mean <= hi)))
        rows.append((name, f"{mean.mean():.2f}", f"{within:.0%}", f"{nis:.2f}"))
        series.append(kit.Series(f"noise believed: {name}", track.t, mean))
        above, below = float(np.mean(mean > hi)), float(np.mean(mean < lo))
        seen.append(
            f"With the noise believed to be {name}, your NEES is {mean.mean():.2f} on average, from "
            f"{mean.min():.2f} to {mean.max():.2f}; at {within:.0%} of the moments it is in the band, at "
            f"{above:.0%} above and at {below:.0%} below."
        )
    series += [
        kit.Series("95 % band", [], lo, kind="level", quiet=True),
        kit.Series("", [], hi, kind="level", quiet=True),
    ]
    return kit.Section(
        title,
        text=f"Three filters track the same {runs} runs of a cart; they assume different noise in "
        "the sensor. With the right noise the average NEES is 2, inside the right band at 95 % of the "
        f"moments, and the average NIS is 1. Your values are below, and your band is {lo:.2f} to {hi:.2f}. A "
        "filter that trusts its sensor too much should lie far above the band.",
        columns=("noise believed", "mean NEES", "moments in the band", "mean NIS"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="NEES over time, averaged over 25 runs",
            panels=(kit.Panel("time / s", "NEES", tuple(series)),),
            description=f"Three curves and your band from {lo:.2f} to {hi:.2f}. {' '.join(seen)}",
        ),
    )


def _intervals(submission, title):
    e = dataset.slow_errors()
    mean = AveragePolynomial([0.0, 1.0])
    blocks = (1, 2, 5, 10, 20, 40, 80)
    calls = [(e, mean, block, 300, 0.05, np.random.default_rng(8)) for block in blocks]
    ends = np.array(
        [kit.as_vector(v, 2, "(lo, hi)") for v in submission.call_each("block_bootstrap_ci", calls)]
    )
    held = _held(submission, mean)
    words = [str(block) for block in blocks]
    widths = 1000 * (ends[:, 1] - ends[:, 0])
    holding = int(np.sum((ends[:, 0] <= dataset.BIAS) & (ends[:, 1] >= dataset.BIAS)))
    return kit.Section(
        title,
        text=f"400 errors with a bias of {dataset.BIAS} m, each of which keeps 0.9 of the one before. With "
        "blocks of one sample an interval assumes that all 400 are independent. It must be too narrow, "
        "and it must grow with the block until the blocks are longer than the correlation of the errors. "
        "With very long blocks there are too few to draw from. Nominally these are 95 % intervals. Of "
        f"{_SERIES} such series, with blocks of 40, {held:.0%} of your intervals contain the true bias: the "
        "ten blocks of a series are too few to know their spread well, and cutting loses some of it.",
        columns=("block", "from", "to", "width"),
        rows=tuple(
            (word, f"{1000 * lo:+.1f} mm", f"{1000 * hi:+.1f} mm", f"{1000 * (hi - lo):.1f} mm")
            for word, (lo, hi) in zip(words, ends, strict=True)
        ),
        plot=kit.Plot(
            title="The 95 % interval for the bias, by length of block",
            panels=(
                kit.Panel(
                    "block / samples",
                    "bias / m",
                    (
                        kit.Series(
                            "interval", words, np.full(7, e.mean()), "interval", ends[:, 0], ends[:, 1]
                        ),
                        kit.Series("true bias", [], dataset.BIAS, kind="level", quiet=True),
                    ),
                ),
            ),
            description=f"Seven intervals of yours, and the true bias of {1000 * dataset.BIAS:.0f} mm, which "
            f"{holding} of them hold. {_compared(widths, words)}",
        ),
    )


#: Series whose intervals are counted; a share of 81 % is known to 4 % by so many.
_SERIES = 100


def _held(submission, statistic):
    """The share of intervals for series of their own that hold the true bias."""
    series = [dataset.slow_errors(seed=1000 + i) for i in range(_SERIES)]
    calls = [(e, statistic, 40, 200, 0.05, np.random.default_rng(i)) for i, e in enumerate(series)]
    values = submission.call_each("block_bootstrap_ci", calls)
    ends = np.array([kit.as_vector(kit.as_tuple(v, ("lo", "hi")), 2, "(lo, hi)") for v in values])
    return float(np.mean((ends[:, 0] <= dataset.BIAS) & (ends[:, 1] >= dataset.BIAS)))


def _compared(widths, blocks):
    """Which interval is how wide, in words."""
    short, long = int(np.argmin(widths)), int(np.argmax(widths))
    if widths[long] - widths[short] < 0.05:  # mm; less is not shown
        return f"All are {widths[0]:.1f} mm wide."
    return (
        f"That for single samples is {widths[0]:.1f} mm wide; the narrowest, {widths[short]:.1f} mm, is "
        f"that for blocks of {blocks[short]}, the widest, {widths[long]:.1f} mm, that for blocks of "
        f"{blocks[long]}."
    )


def _verdicts(submission, title):
    recorded = _recordings()
    real = twins.measured(recorded)
    everything = [run.id for run in recorded]
    cases = (
        ("good", {"calibrated_on": ["a"]}),
        ("a fifth too heavy", {"mass": 1.2 * twins.MASS}),
        ("50 ms late", {"late": 0.05}),
        ("0.1 m/s too fast", {"offset": 0.1}),
        ("good, and calibrated on every run", {"calibrated_on": everything}),
    )
    calls = [(twins.simulated(recorded, **changes), real, SPEC) for _, changes in cases]
    rows = []
    keys = ("rmse", "bias", "lag_s", "coverage")
    for (name, _), value in zip(cases, submission.call_each("validate", calls), strict=True):
        verdict = kit.as_record(value, ("accepted", "reasons", *keys, "intervals", "runs_used"), "the report")
        ends = dict.fromkeys(keys)
        if verdict["intervals"] is not None:
            ends = kit.as_record(verdict["intervals"], keys, "`intervals`")
        cells = tuple(_cell(verdict[key], ends[key], key) for key in keys)
        reasons = ", ".join(kit.as_text(r, "a reason") for r in kit.as_list(verdict["reasons"], "reasons"))
        rows.append((name, "yes" if verdict["accepted"] is True else "no", *cells, reasons or "-"))
    return kit.Section(
        title,
        text=f"Four runs of the cart, margins fixed beforehand: rmse up to {SPEC['rmse_max']} m/s, bias "
        f"within {SPEC['bias_max']} m/s, lag within {SPEC['lag_max_s']} s, coverage from "
        f"{SPEC['coverage_min']} to {SPEC['coverage_max']}. Each number is followed by its interval, from "
        "leaving out one run at a time. The interval is compared with the margin.",
        columns=("twin", "accepted", "rmse m/s", "bias m/s", "lag s", "coverage", "reasons"),
        rows=tuple(rows),
    )


def _cell(number, interval, key):
    """A number and its interval."""
    if number is None:
        return "-"
    shown = f"{kit.as_number(number, key):.3f}"
    if interval is None:
        return shown
    lo, hi = kit.as_vector(kit.as_tuple(interval, ("lo", "hi")), 2, f"the interval of {key}")
    return f"{shown} ({lo:.3f}, {hi:.3f})"
