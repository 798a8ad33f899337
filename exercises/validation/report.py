"""What ``course report validation`` shows: the student's own instruments on public data."""

from __future__ import annotations

import numpy as np

from course.grading import kit
from course.physics.systems import AveragePolynomial

dataset = kit.companion("validation", "dataset")
twins = kit.companion("validation", "twins")

SPEC = {"rmse_max": 0.06, "bias_max": 0.03, "lag_max_s": 0.012, "coverage_min": 0.9}


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
    rows, panels = [], []
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
    return kit.Section(
        title,
        text="A cart was driven for 9 s and its speed recorded. Two twins simulate the same drive, and both "
        "claim the same sigma. An honest band holds about 95 % of the errors.",
        columns=("twin", "rmse", "bias", "variance", "coverage"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="Simulated minus real speed, and what the twin claims",
            panels=tuple(panels),
            description="Above, the errors of the good twin fill their band and hardly leave it. Below, "
            "those of the heavy twin swing far out of the same band, up and down.",
        ),
    )


def _consistency(submission, title):
    runs = 25
    lo, hi = kit.as_vector(submission.call("consistency_band", 2, runs, 0.05), 2, "(lo, hi)")
    rows, series = [], []
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
    series += [
        kit.Series("95 % band", [], lo, kind="level", quiet=True),
        kit.Series("", [], hi, kind="level", quiet=True),
    ]
    return kit.Section(
        title,
        text=f"Three filters track the same {runs} runs of a cart; they differ in how noisy they believe "
        f"the sensor to be. Honest errors give an average NEES of 2, between {lo:.2f} and {hi:.2f} at "
        "95 % of the moments, and an average NIS of 1. The filter that trusts its sensor too much is far "
        "above.",
        columns=("noise believed", "mean NEES", "moments in the band", "mean NIS"),
        rows=tuple(rows),
        plot=kit.Plot(
            title="NEES over time, averaged over 25 runs",
            panels=(kit.Panel("time / s", "NEES", tuple(series)),),
            description="The filter with the right noise stays around 2, mostly inside the band. The one "
            "that believes in half the noise stays far above the band, the one with twice the noise at its "
            "lower edge.",
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
    words = [str(block) for block in blocks]
    return kit.Section(
        title,
        text="400 errors with a bias of 0.02 m, each of which keeps 0.9 of the one before. With blocks of "
        "one sample the interval pretends that all 400 are independent; it is narrow, and wrong. It grows "
        "with the block until the blocks are longer than the memory of the errors. With very long blocks "
        "there are too few of them to draw from.",
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
                        kit.Series("true bias", [], 0.02, kind="level", quiet=True),
                    ),
                ),
            ),
            description="Seven intervals around the same mean. That for single samples is the shortest; they "
            "grow up to blocks of about 40 samples, to some three or four times that length.",
        ),
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
        verdict = kit.as_record(value, ("accepted", "reasons", *keys, "runs_used"), "the report")
        numbers = tuple("-" if verdict[k] is None else f"{kit.as_number(verdict[k], k):.3f}" for k in keys)
        reasons = ", ".join(kit.as_text(r, "a reason") for r in kit.as_list(verdict["reasons"], "reasons"))
        rows.append((name, "yes" if verdict["accepted"] is True else "no", *numbers, reasons or "-"))
    return kit.Section(
        title,
        text=f"Four runs of the cart, limits fixed beforehand: rmse {SPEC['rmse_max']} m/s, bias "
        f"{SPEC['bias_max']} m/s, lag {SPEC['lag_max_s']} s, coverage at least {SPEC['coverage_min']}.",
        columns=("twin", "accepted", "rmse m/s", "bias m/s", "lag s", "coverage", "reasons"),
        rows=tuple(rows),
    )
