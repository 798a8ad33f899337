"""The probes of ``validation``: what shows a mistake is recognised, what is right for nothing.

What known wrong programs are told is in ``solutions/validation/record.json``, which the audit keeps; here
are the pieces that it cannot reach, and the references that the hidden checks stand on.
"""

from __future__ import annotations

import functools
import json
import math
import re
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest

from course.scoring import kit

ROOT = Path(__file__).resolve().parents[3]

probes = kit.companion("validation", "probes")
shared = kit.companion("validation", "expectations")
twins = kit.companion("validation", "twins")
dataset = kit.companion("validation", "dataset")
verdict = kit.companion("validation", "probes_verdict")
bundles = kit.companion("validation", "bundles")
formulas = kit.reference("validation", "formulas")


def leaves(value):
    """Keys and plain values of nested JSON, in order."""
    if isinstance(value, dict):
        yield from value
        value = list(value.values())
    if isinstance(value, list):
        for item in value:
            yield from leaves(item)
    else:
        yield value


def code(diagnosis):
    return diagnosis and diagnosis.code


@pytest.mark.parametrize(
    ("dof", "alpha", "printed"),
    [(1, 0.1, (0.00393, 3.841)), (2, 0.05, (0.0506, 7.378)), (40, 0.05, (24.433, 59.342))],
)
def test_bands_are_those_of_printed_tables(dof, alpha, printed):
    assert formulas.exactly()(dof, 1, alpha) == pytest.approx(printed, abs=5.1e-4)


def test_the_spread_of_the_mean_is_that_of_many_series():
    means = shared.correlated(5, 4000, 60, 0.8).mean(axis=1)
    assert np.std(means) == pytest.approx(shared.spread_of_mean(60, 0.8), rel=0.05)


def blocks(length, count=24):
    """24 resamples of 250 positions in blocks that start anywhere."""
    rng = np.random.default_rng(0)
    starts = rng.integers(0, 250 - length + 1, (count, -(-250 // length)))
    return list((starts[:, :, None] + np.arange(length)).reshape(count, -1)[:, :250].astype(float))


def resampled(asked, ends=None):
    """What the bootstrap's probe finds where the statistic, the mean square, is asked about these."""
    e = np.arange(250.0)
    answers = [float(np.mean(samples**2)) for samples in asked]
    return probes.Resampled(e, asked, answers, kit.Inspected(ends, [e], shared=False))


ITSELF = np.arange(250.0)


def quantiles(values, low, high):
    return np.quantile(values, [low, high])


@pytest.mark.parametrize(
    ("make", "expected"),
    [
        (lambda v, whole, means: quantiles(v, 0.1, 0.9), None),
        (lambda v, whole, means: 2 * whole - quantiles(v, 0.1, 0.9)[::-1], None),
        (lambda v, whole, means: quantiles(v, 0.1, 0.9)[::-1], "RETURNS_SWAPPED"),
        (lambda v, whole, means: 2 * whole - quantiles(v, 0.1, 0.9), "RETURNS_SWAPPED"),
        (lambda v, whole, means: quantiles(v, 0.2, 0.8), "ONE_SIDED"),
        (lambda v, whole, means: quantiles(v, 0.4, 0.6), "LEVEL_FOR_ALPHA"),
        (lambda v, whole, means: np.percentile(v, [0.1, 0.9]), "ENDS_ON_ONE_SIDE"),
        (lambda v, whole, means: quantiles(means, 0.1, 0.9), "STATISTIC_IGNORED"),
        (lambda v, whole, means: quantiles(v, 0.1, 0.9) - whole, "NOT_CENTRED"),
        (lambda v, whole, means: [math.nan, math.nan], None),
        (lambda v, whole, means: "an interval", None),
    ],
)
def test_ends_of_an_interval_are_recognised(make, expected):
    found = resampled(blocks(12))
    ends = make(np.array(found.answers), np.mean(ITSELF**2), [np.mean(row) for row in found.asked])
    assert probes.of_ends(resampled(blocks(12), ends)) == expected


def folds(fitted, asked):
    rng = np.random.default_rng(1)
    data = [{"id": str(i), "u": rng.standard_normal(5), "y": rng.standard_normal(5)} for i in range(4)]
    seen = probes.Folds(data)
    for training, questions in zip(fitted, asked, strict=True):
        model = seen.fit([data[i] for i in training])
        for i in questions:
            seen.predict(model, {"u": data[i]["u"]})
    return seen


def test_predict_and_fit_refuse_what_they_cannot_use():
    seen = folds([], [])
    with pytest.raises(kit.CheckFailed) as refused:
        seen.predict({"model": 0}, seen.runs[0])
    assert refused.value.finding.diagnosis == "NOT_A_MODEL"
    with pytest.raises(kit.CheckFailed) as refused:
        seen.fit([{"u": np.zeros(5)}])
    assert refused.value.finding.diagnosis == "NOT_A_RUN"


def three_runs(lates=(0.05, 0.05, 0.05), offset=-0.02):
    """Carts that a simulation follows so much later, and the facts about it."""
    rng = np.random.default_rng(3)
    recorded = [twins.record(rng, name, 6.0 + i, 0.02, 0.03) for i, name in enumerate("abc")]
    sim, real = twins.simulated(recorded, late=lates, offset=offset), twins.measured(recorded)
    case = bundles.Case(recorded, sim, real, lates)
    return case, bundles.facts(case)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (lambda number, half: (number - 0.45 * half, number + 0.45 * half), "INTERVALS_SCALED"),
        (lambda number, half: (number + half, number - half), "RETURNS_SWAPPED"),
        (lambda number, half: (number - 0.1 * half - 0.1, number + 0.1 * half + 0.1), None),
        (lambda number, half: (number, number + half), None),
    ],
)
def test_wrong_intervals_are_recognised_by_what_they_have_in_common(change, expected):
    _, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, 0.01))
    ends = {key: change(right.numbers[key], right.half(key)) for key in verdict.NUMBERS}
    assert code(verdict.of_interval("rmse", ends, right)) == expected


def test_a_mean_over_runs_is_told_whatever_else_is_wrong():
    case, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, 0.01))
    errors = verdict.together(case.sim, case.real, right.used)
    assert code(verdict.of_number("rmse", right.means["rmse"], right, *errors)) == "MEAN_OF_RUNS"
    assert verdict.of_number("rmse", 1.01 * right.means["rmse"], right, *errors) is None


def changed(report, **new):
    """A report with other numbers, and another factor of the width where ``times`` has one."""
    times = new.pop("times", None)
    ends = {
        key: (lo, hi)
        if times is None
        else ((lo + hi) / 2 - times * (hi - lo) / 2, (lo + hi) / 2 + times * (hi - lo) / 2)
        for key, (lo, hi) in report["intervals"].items()
    }
    return {**report, **new, "intervals": ends}


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ({"lag_s": lambda lag: -lag, "times": math.sqrt(3 / 2)}, "LAG_SIGN"),
        ({"bias": lambda bias: -bias, "coverage": lambda share: share / 2}, "WRONG_SIGN"),
        ({"times": math.sqrt(3 / 2)}, "JACKKNIFE_FACTOR"),
        ({"times": 2.353 / 2.920}, "NOT_STUDENTS_T"),
    ],
)
def test_of_two_mistakes_a_check_names_the_one_that_its_own_number_shows(new, expected):
    """A lag of -0.047 that should be 0.047 was once told of an interval of one sigma."""
    case, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, 0.01))
    report = Fake().call("validate", case.sim, case.real, SPEC)
    new = {key: of(report[key]) if callable(of) else of for key, of in new.items()}
    with pytest.raises(kit.CheckFailed) as failed:
        bundles.expect_measures(changed(report, **new), case, right, {})
    assert failed.value.guess.code == expected
    assert kit.words("validation").kind(expected) != "cause"  # it is not said of checks that do not show it


def test_what_alpha_leaves_out_is_told_before_the_length_of_the_resamples():
    """A width that grows too much with alpha is not explained by resamples that are two errors too long."""
    long = [np.append(row, row[:2]) for row in blocks(12)]
    ends = np.quantile([np.mean(row**2) for row in long], [0.2, 0.8])
    found = resampled(long, ends)
    assert probes.of_resamples(found) == "RESAMPLE_SIZE"
    assert probes.of_ends(found) == "ONE_SIDED"


SPEC = {"rmse_max": 1.0, "bias_max": 0.01, "lag_max_s": 0.01, "coverage_min": 0.0, "coverage_max": 1.1}


@pytest.mark.parametrize(
    ("reasons", "expected"),
    [
        (["lag", "bias"], "NOT_SORTED"),
        (["bias"], "REASON_MISSING"),
        (["bias", "lag", "rmse"], "REASON_TOO_MANY"),
        (["bias", "lag_s"], "REASON_UNKNOWN"),
    ],
)
def test_wrong_reasons_are_recognised(reasons, expected):
    _, right = three_runs((-0.05,) * 3)
    assert right.reasons(SPEC) == ["bias", "lag"]
    assert code(verdict.of_reasons([(reasons, right.reasons(SPEC))])) == expected


def test_the_interval_of_the_facts_is_the_jackknife_of_the_model_solution():
    case, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, 0.01))
    report = Fake().call("validate", case.sim, case.real, SPEC)
    for key in verdict.NUMBERS:
        assert report[key] == pytest.approx(right.numbers[key], rel=1e-9)
        assert report["intervals"][key] == pytest.approx(right.intervals[key], rel=1e-9)
    assert report["lag_s"] == pytest.approx(right.numbers["lag_s"], abs=0.001)
    assert report["intervals"]["lag_s"] == pytest.approx(right.intervals["lag_s"], abs=0.003)


@pytest.mark.parametrize("check", ["validate_late", "validate_accepts", "validate_margins_apart"])
def test_at_home_where_there_is_no_model_the_facts_are_those_of_the_model(monkeypatch, check):
    run = [right for _, right in bundles.public(check, None)]
    monkeypatch.setattr(kit, "reference", lambda *_: None)
    home = [right for _, right in bundles.public(check, None)]
    for known, right in zip(home, run, strict=True):
        one, other = ([*leaves(json.loads(json.dumps(asdict(facts))))] for facts in (known, right))
        # Rounding differs from machine to machine.
        near = functools.partial(pytest.approx, rel=1e-10, abs=1e-12)
        assert one == [near(value) if isinstance(value, float) else value for value in other]


@pytest.mark.parametrize("bad", [None, 3, "abc", [1, [2]], np.zeros(3), {"a": 1}, 10**400, [None], math.nan])
@pytest.mark.parametrize("key", [*bundles.KEYS, None])
def test_whatever_a_report_holds_is_judged(key, bad):
    """A report with any one value spoilt fails as the student's, never as the grader's."""
    case, right = three_runs()
    report = Fake().call("validate", case.sim, case.real, SPEC)
    spoilt = bad if key is None else {**report, key: bad}

    class Spoilt:
        def call(self, *_):
            return spoilt

        def call_inspect(self, *_):
            return kit.Inspected(spoilt, [case.sim, case.real, SPEC], shared=False)

    with pytest.raises(kit.CheckFailed):
        bundles.expect_report(Spoilt(), case, SPEC, right, {})
    with pytest.raises(kit.CheckFailed):
        bundles.expect_nothing(Spoilt(), case, SPEC, right, {})


def test_a_nominal_interval_covers_what_the_readme_says():
    """The README's row for 400 errors: 34 % with single errors, 81 % with blocks of 40, each to 3 sigma."""
    bootstrap = Fake()
    series = shared.correlated(99, 300, 400, 0.9)
    for block, share, slack in ((1, 0.34, 0.085), (40, 0.81, 0.07)):
        ends = np.array([
            bootstrap.call("block_bootstrap_ci", e, np.mean, block, 200, 0.05, np.random.default_rng(i))
            for i, e in enumerate(series)
        ])  # fmt: skip
        assert np.mean((ends[:, 0] <= 0) & (ends[:, 1] >= 0)) == pytest.approx(share, abs=slack)


@pytest.mark.parametrize("each", [0.0, 0.3])
def test_the_interval_from_runs_left_out_covers_what_the_readme_says(each):
    """89 to 91 % for the bias, of errors that resemble their neighbours, off as a whole or not; 3 sigma."""
    rng, solution = np.random.default_rng(5), Fake()
    solution.set("best_shift", lambda pairs: 0.0)
    held = []
    for _ in range(400):
        e = shared.correlated(int(rng.integers(2**31)), 4, 400, 0.9)
        pairs = [
            ({"y": row[:n] + each * rng.standard_normal(), "sigma": np.ones(n)}, {"y": np.zeros(n)})
            for row, n in zip(e, rng.integers(200, 401, 4), strict=True)
        ]
        lo, hi = solution.call("interval_of_each", pairs)["bias"]
        held.append(lo <= 0 <= hi)
    assert np.mean(held) == pytest.approx(0.9, abs=0.05)


def test_the_speed_of_the_cart_obeys_its_equation_of_motion():
    run = twins.record(np.random.default_rng(3), "a", 8.0, 0.01, 0.0)
    drive, t = run.drive, np.linspace(1.0, 2.0, 50)
    force = np.sum(drive.amplitude * np.sin(np.multiply.outer(t, drive.omega) + drive.phase), axis=-1)
    slope = (drive.speed(t + 1e-5) - drive.speed(t - 1e-5)) / 2e-5
    assert np.allclose(twins.MASS * slope, force - twins.FRICTION * drive.speed(t), atol=1e-6)


def test_the_filter_of_the_report_is_honest_only_with_the_right_noise():
    def average(factor):
        track = dataset.track(factor * dataset.NOISE, runs=200, seed=1)
        return np.mean(np.einsum("rni,nij,rnj->rn", track.err, np.linalg.inv(track.P), track.err))

    assert average(1.0) == pytest.approx(2.0, abs=0.1)
    assert average(0.5) > 4.5
    assert average(2.0) < 1.4


#: Wrong programs by name.
WRONG = {one.name: one for one in kit.reference("validation", "mistakes").mistakes.wrong}


class Fake:
    """A submission that runs here: the solution, or a mutant of it."""

    def __init__(self, mutant=""):
        path = ROOT / "solutions" / "validation" / "validation.py"
        source = path.read_text()
        if mutant:
            source = WRONG[mutant].composed(source, path)
        self._functions = {}
        exec(compile(source, "validation.py", "exec"), self._functions)

    def set(self, name, value):
        self._functions[name] = value

    def call(self, name, *arguments):
        return self._functions[name](*arguments)

    def call_each(self, name, calls):
        return [self.call(name, *arguments) for arguments in calls]


@functools.cache
def descriptions(mutant=""):
    """What the report says of its figures, by section."""
    shown = kit.companion("validation", "report").report(Fake(mutant)).sections
    return [section.plot.description if section.plot else "" for section in shown]


def test_the_report_describes_the_figures_of_right_code():
    errors, consistency, intervals, _ = descriptions()
    assert re.search(
        r"good twin: .* your coverage finds 9\d\.\d% inside\. Below, a fifth too heavy: ", errors
    )
    right, half, twice = re.findall(r"is (\d\.\d\d) on average", consistency)
    assert float(right) == pytest.approx(2.0, abs=0.3)
    assert float(half) > 4.0
    assert float(twice) < 1.5
    assert "noise believed to be right" in consistency
    one, narrowest, widest = (float(x) for x in re.findall(r"(\d+\.\d) mm", intervals))
    assert one == narrowest < widest / 2.5


@pytest.mark.parametrize(
    ("mutant", "place", "now"),
    [
        ("coverage.OUTSIDE_COUNTED", 0, r"good twin: .*finds \d\.\d% inside"),
        ("rmse.ROOT_MISSING", 0, r"good twin: .*your rmse is 0\.00\d m/s"),
        (
            "nees.DIVIDED_BY_D",
            1,
            r"right, your NEES is [01]\.\d\d on average.* 0% above and at (9\d|100)% below",
        ),
        (
            "consistency_band.NOT_DIVIDED_BY_RUNS",
            1,
            r"your band from 3\d\.\d\d to 7\d\.\d\d.* at 0% above and at 100% below",
        ),
        ("block_bootstrap_ci.BLOCK_IGNORED", 2, r"7 of them hold\. All are 24\.\d mm wide"),
        ("block_bootstrap_ci.IID_BOOTSTRAP", 2, r"0 of them hold\. All are 10\.\d mm wide"),
    ],
)
def test_the_report_describes_the_figures_that_wrong_code_gives(mutant, place, now):
    """The words are the figure for whoever does not see it: they follow the rows, not the right answer."""
    said = descriptions(mutant)[place]
    assert said != descriptions()[place]
    assert re.search(now, said), said
    for promise in ("stays around 2", "mostly inside", "hardly leave", "three or four times"):
        assert promise not in said


@pytest.mark.parametrize("call", [lambda f: f(1), lambda f: f(1, 2, 3), lambda f: f(1, v=2)])
def test_a_callback_refuses_any_other_number_of_arguments(call):
    with pytest.raises(kit.CheckFailed) as refused:
        call(probes.callback("energy(q_i, v_i)", lambda q, v: 0.0))
    assert refused.value.finding.diagnosis == "CALLED_WRONGLY"


def test_a_variance_that_is_right_near_zero_is_told_from_one_in_single_precision():
    e = 1e7 + np.array([0.3, 1.1, -0.7, 0.5, 1.9])
    for variance, expected in (
        (lambda e: np.mean(e**2) - np.mean(e) ** 2, "CANCELLATION"),
        (lambda e: float(np.var(e.astype(np.float32))), "SINGLE_PRECISION"),
        (lambda e: float(np.var(e, ddof=1)), None),
    ):
        solution = Fake()
        solution.set("bias_variance", lambda e, variance=variance: (np.mean(e), variance(e)))
        assert code(probes.of_offset(solution, e)) == expected


def test_a_lag_is_told_by_the_runs_that_count_alike_and_by_its_sign():
    _, right = three_runs((-0.02, -0.08, -0.05))
    lag, half = right.even
    assert abs(lag - right.numbers["lag_s"]) > 1e-5
    assert code(verdict.of_lag_interval(lag, half, right)) == "LAG_OF_EVEN_RUNS"
    assert code(verdict.of_lag_interval(lag, 3 * half, right)) == "LAG_OF_PARTS"
    assert code(verdict.of_lag(0.0, 0.0, right)) == "LAG_NOT_NEGATIVE"
    assert code(verdict.of_lag(-0.02, 0.0, right)) == "LAG_NOT_BEST"


@pytest.mark.parametrize("size", [np.resize, lambda row, n: np.append(row, ITSELF[: n - len(row)])])
def test_a_resample_that_is_filled_up_by_its_own_beginning_is_told_from_others(size):
    asked = [size(row[:240], 250) for row in blocks(12)]
    expected = "BEGINNING_REPEATED" if size is np.resize else None
    assert probes.of_resamples(resampled(asked)) == expected
    assert probes.of_resamples(resampled(blocks(12))) is None


def test_a_number_that_has_its_first_digits_is_told_from_one_that_has_none():
    assert code(probes.of_digits(1.6249696, 1.62496964)) == "FEW_DIGITS"
    assert probes.of_digits(1.625, 1.62496964) is None
    assert probes.of_digits(math.nan, 1.62496964) is None


@pytest.mark.parametrize("of", [lambda f: np.percentile(f, 95), probes._vertex])
def test_a_peak_that_is_no_sample_is_told(of):
    t = 0.001 * np.arange(61)
    sim, real = shared.pulse(t, 0.017, 0.016, 88.0, 0.6), shared.pulse(t, 0.012, 0.019, 80.0, 0.4)
    assert code(probes.of_force("peak", of(sim) / of(real) - 1, sim, real, 0.001)) == "PEAK_NOT_LARGEST"


def test_the_width_by_squares_about_the_number_is_told():
    _, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, 0.01))
    ends = {
        key: (number - right.about[key], number + right.about[key]) for key, number in right.numbers.items()
    }
    assert code(verdict.of_interval("rmse", ends, right)) == "ABOUT_THE_NUMBER"
