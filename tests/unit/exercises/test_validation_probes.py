"""The diagnosis of ``validation``: wrong values are recognised for what they are, right ones for nothing.

That every mutant gets its code is proven by ``course author mutants``; here are the pieces that it cannot
reach, and the references that the hidden checks stand on.
"""

from __future__ import annotations

import ast
import math
import re
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest

from course.grading import kit

ROOT = Path(__file__).resolve().parents[3]
GRADERS = ROOT / "tests" / "graders" / "validation" / "checks.py"

probes = kit.companion("validation", "probes")
runs = kit.companion("validation", "probes_runs")
shared = kit.companion("validation", "expectations")
twins = kit.companion("validation", "twins")
dataset = kit.companion("validation", "dataset")
verdict = kit.companion("validation", "probes_verdict")
verdicts = kit.companion("validation", "verdicts")
words = kit.companion("validation", "diagnosis").WORDS
chi_square = kit.sibling(str(GRADERS), "chi_square")

E = np.array([0.4, -0.3, 1.7, 0.2, 0.9])


def code(diagnosis):
    return diagnosis and diagnosis.code


def test_every_code_that_is_named_has_words_and_every_word_is_used():
    folder = ROOT / "exercises" / "validation"
    sources = [*folder.glob("*.py"), *GRADERS.parent.glob("*.py")]
    text = "".join(path.read_text() for path in sources if "diagnosis" not in path.name)
    spoken = set(re.findall(r'"([A-Z][A-Z_]{3,})"', text))
    others = {
        "NOT_A_MODEL",
        "NOT_A_RUN",
        "CALLED_WRONGLY",
        "NEES",
    }  # findings that say what they are; an axis
    assert spoken - others == set(words)


def test_right_values_are_given_no_code():
    assert probes.of_rmse(math.sqrt(np.mean(E**2)), E) is None
    assert probes.of_bias(np.mean(E), np.var(E), E) is None
    angles = np.array([3.0, -9.0, 40.0, 4.0])
    assert probes.of_wrapped((angles + np.pi) % (2 * np.pi) - np.pi, angles) is None
    assert probes.of_energies((E[0] - E) / abs(E[0]), -E) is None


@pytest.mark.parametrize(
    ("wrong", "expected"),
    [
        (np.mean(E**2), "ROOT_MISSING"),
        (np.std(E, ddof=1), "MEAN_REMOVED"),
        (math.sqrt(np.sum(E**2) / 4), "DDOF_ONE"),
        (abs(np.mean(E)), "BIAS_FOR_RMSE"),
        (12.3, None),
        (math.nan, None),
    ],
)
def test_a_wrong_rmse_is_recognised(wrong, expected):
    assert code(probes.of_rmse(wrong, E)) == expected


def test_a_bias_that_is_wrong_is_named_before_a_variance_that_follows_from_it():
    assert code(probes.of_bias(np.median(E), np.mean(E**2), E)) == "MEDIAN_FOR_MEAN"
    assert code(probes.of_bias(np.var(E), np.mean(E), E)) == "RETURNS_SWAPPED"


def test_an_impulse_by_another_rule_is_no_mistake_and_the_integral_of_the_difference_is():
    t = 0.001 * np.arange(100)
    real, sim = shared.pulse(t, 0.02, 0.03, 100.0), shared.pulse(t, 0.04, 0.03, 100.0)
    assert code(probes.of_forces("impulse", np.sum(np.abs(sim - real)) / np.sum(real), sim, real)) == (
        "IMPULSE_OF_ABSOLUTE"
    )
    assert code(probes.of_forces("peak", np.max(sim - real) / np.max(real), sim, real)) == "PEAK_OF_ERROR"


@pytest.mark.parametrize(
    ("dof", "p", "printed"),
    [(1, 0.95, 3.841), (2, 0.025, 0.0506), (20, 0.025, 9.591), (40, 0.975, 59.342), (100, 0.05, 77.929)],
)
def test_quantiles_of_the_chi_square_distribution_are_those_of_printed_tables(dof, p, printed):
    assert chi_square.quantile(dof, p) == pytest.approx(printed, abs=5.1e-4)


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
    return runs.Resampled(e, asked, answers, kit.Inspected(ends, [e], shared=False))


ITSELF = np.arange(250.0)


@pytest.mark.parametrize(
    ("asked", "expected"),
    [
        (blocks(12), None),
        (blocks(1), "IID_BOOTSTRAP"),
        (blocks(4), "BLOCK_IGNORED"),
        (blocks(60), "BLOCK_IGNORED"),
        ([row[:12] for row in blocks(12)], "RESAMPLE_SIZE"),
        ([row[:240] for row in blocks(12)], "RESAMPLE_SIZE"),
        ([ITSELF] * 24, "NOT_RESAMPLED"),
        (blocks(12)[:1], "STATISTIC_IGNORED"),
        ([], "STATISTIC_IGNORED"),
        (blocks(12)[:1] * 24, "DRAWN_ONCE"),
        (blocks(12, 2000), "OTHER_NUMBER_OF_RESAMPLES"),
        (blocks(12)[:23], "OTHER_NUMBER_OF_RESAMPLES"),
        ([*blocks(12), *[ITSELF] * 24], "OTHER_NUMBER_OF_RESAMPLES"),
        ([ITSELF, *blocks(12)], None),
    ],
    ids=[
        "right",
        "single",
        "short",
        "long",
        "one block",
        "whole blocks",
        "itself",
        "asked once",
        "never asked",
        "drawn once",
        "too many",
        "too few",
        "asked twice",
        "basic interval",
    ],
)
def test_resamples_are_recognised(asked, expected):
    assert runs.of_resamples(resampled(asked)) == expected


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
    assert runs.of_ends(resampled(blocks(12), ends)) == expected


def folds(fitted, asked):
    rng = np.random.default_rng(1)
    data = [{"id": str(i), "u": rng.standard_normal(5), "y": rng.standard_normal(5)} for i in range(4)]
    seen = runs.Folds(data)
    for training, questions in zip(fitted, asked, strict=True):
        model = seen.fit([data[i] for i in training])
        for i in questions:
            seen.predict(model, {"u": data[i]["u"]})
    return seen


@pytest.mark.parametrize(
    ("fitted", "asked", "expected"),
    [
        ([[2, 3], [0, 1]], [[0, 1], [2, 3]], None),
        ([[0, 1], [2, 3], [0, 1, 2, 3]], [[3, 2], [1, 0], []], None),
        ([[0, 1, 2, 3]], [[0, 1, 2, 3]], "FITS_ONCE"),
        ([[1, 2, 3], [0, 1]], [[0, 1], [2, 3]], "LEAKS_HELD_OUT"),
        ([[0, 1], [2, 3]], [[0, 1], [2, 3]], "SCORES_TRAINING"),
        ([[1, 3], [0, 2]], [[0, 2], [1, 3]], "NOT_CONTIGUOUS"),
        ([[1, 2, 3], [0]], [[0], [1, 2, 3]], "FOLDS_UNEVEN"),
        ([[2, 3], [0, 1]], [[0, 1], [2]], "FOLDS_UNEVEN"),
        ([[2], [0, 1]], [[0, 1], [2, 3]], "TRAINS_ON_TOO_LITTLE"),
        ([[0], [1, 2], [3]], [[1, 2, 3], [0, 3], [0, 1, 2]], "FITS_THE_FOLD"),
        ([[0], [1, 2], [3]], [[0], [1, 2], [3]], "FITS_THE_FOLD"),
        ([], [], "FOLDS_UNEVEN"),
    ],
)
def test_folds_are_recognised_by_who_was_fitted_to_what(fitted, asked, expected):
    assert folds(fitted, asked).fault(2) == expected


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
    return sim, real, verdicts.facts(recorded, sim, real, lates)


@pytest.mark.parametrize(
    ("lates", "value", "expected"),
    [
        ((0.05, 0.05, 0.05), -0.05, "LAG_SIGN"),
        ((0.05, 0.05, 0.05), 0.04, "LAG_WHOLE_SAMPLES"),
        ((0.05, 0.05, 0.05), 2.5, "LAG_IN_SAMPLES"),
        ((0.05, 0.05, 0.05), 0.123, "LAG_NOT_BEST"),
        ((0.05, 0.05, 0.05), 0.25, "LAG_AT_THE_END"),
        # Where the simulation is neither late nor early, no wrong lag is a number of samples.
        *(((0.0, 0.0, 0.0), value, "LAG_NOT_BEST") for value in (0.011, 0.09, -0.15)),
        ((0.0, 0.0, 0.0), 0.7, "LAG_AT_THE_END"),
    ],
)
def test_a_wrong_lag_is_recognised(lates, value, expected):
    *_, right = three_runs(lates)
    assert code(verdict.of_lag(value, math.nan, right)) == expected


def test_a_mean_of_lags_is_told_from_the_lag_of_all():
    *_, right = three_runs((0.01, 0.05, 0.09))
    alone = np.array([run["lag_s"] for run in right.single])
    half = verdict.T95[1] * math.sqrt(2) * np.std([np.mean(np.delete(alone, i)) for i in range(3)])
    assert code(verdict.of_lag(float(np.mean(alone)), half, right)) == "LAG_MEAN_OF_RUNS"
    assert code(verdict.of_lag(float(np.mean(alone)), math.nan, right)) == "LAG_NOT_BEST"


SPEC = {"rmse_max": 1.0, "bias_max": 0.01, "lag_max_s": 0.01, "coverage_min": 0.0, "coverage_max": 1.1}


@pytest.mark.parametrize(
    ("reasons", "lates", "expected"),
    [
        (["lag", "bias"], (-0.05,) * 3, "NOT_SORTED"),
        (["bias"], (-0.05,) * 3, "SIGN_OF_LIMIT_IGNORED"),
        (["bias"], (0.05,) * 3, "REASON_MISSING"),
        (["bias", "lag", "rmse"], (0.05,) * 3, "REASON_TOO_MANY"),
    ],
)
def test_wrong_reasons_are_recognised(reasons, lates, expected):
    *_, right = three_runs(lates)
    assert right.reasons(SPEC) == ["bias", "lag"]
    assert code(verdict.of_verdicts([(reasons, right, SPEC)])) == expected


def test_a_number_within_its_margin_is_told_from_an_interval_within_it():
    *_, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, -0.03))
    number, half = right.numbers["bias"], right.half("bias")
    spec = SPEC | {"bias_max": abs(number) + half / 2, "lag_max_s": 1.0}
    assert right.reasons(spec) == ["bias"]
    wide = SPEC | {"bias_max": abs(number) / 2, "lag_max_s": 1.0}
    assert code(verdict.of_verdicts([([], right, spec), (["bias"], right, wide)])) == "POINT_ESTIMATE_JUDGED"


def test_the_interval_of_the_facts_is_the_jackknife_of_the_model_solution():
    sim, real, right = three_runs((0.02, 0.05, 0.08), offset=(0.0, -0.03, 0.01))
    report = Fake().call("validate", sim, real, SPEC)
    for key in verdict.NUMBERS:
        assert report[key] == pytest.approx(right.numbers[key], rel=1e-9)
        assert report["intervals"][key] == pytest.approx(right.interval(key), rel=1e-9)
    assert report["lag_s"] == pytest.approx(right.numbers["lag_s"], abs=0.001)
    assert report["intervals"]["lag_s"] == pytest.approx(right.interval("lag_s"), abs=0.003)


@pytest.mark.parametrize("bad", [None, 3, "abc", [1, [2]], np.zeros(3), {"a": 1}, 10**400, [None], math.nan])
@pytest.mark.parametrize("key", [*verdicts.KEYS, None])
def test_whatever_a_report_holds_is_judged(key, bad):
    """A report with any one value spoilt fails as the student's, never as the grader's."""
    sim, real, right = three_runs()
    report = Fake().call("validate", sim, real, SPEC)
    spoilt = bad if key is None else {**report, key: bad}

    class Spoilt:
        def call(self, *_):
            return spoilt

        def call_inspect(self, *_):
            return kit.Inspected(spoilt, [sim, real, SPEC], shared=False)

    with pytest.raises(kit.CheckFailed):
        verdicts.expect_report(Spoilt(), sim, real, SPEC, right, {})
    with pytest.raises(kit.CheckFailed):
        verdicts.expect_nothing(Spoilt(), sim, real, SPEC, right, {})


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


class Fake:
    """A submission that runs here: the solution, or a mutant of it."""

    def __init__(self, mutant=""):
        folder = ROOT / "solutions" / "validation"
        path = folder / "mutants" / f"{mutant}.py" if mutant else folder / "validation.py"
        self._functions = {}
        exec(compile((folder / "validation.py").read_text(), "validation.py", "exec"), self._functions)
        if mutant:
            exec(compile(path.read_text(), path.name, "exec"), self._functions)

    def set(self, name, value):
        self._functions[name] = value

    def call(self, name, *arguments):
        return self._functions[name](*arguments)

    def call_each(self, name, calls):
        return [self.call(name, *arguments) for arguments in calls]


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
        ("coverage_outside", 0, r"good twin: .*finds \d\.\d% inside"),
        ("rmse_without_root", 0, r"good twin: .*your rmse is 0\.00\d m/s"),
        ("nees_divided", 1, r"right, your NEES is [01]\.\d\d on average.* 0% above and at (9\d|100)% below"),
        ("band_of_the_sum", 1, r"your band from 3\d\.\d\d to 7\d\.\d\d.* at 0% above and at 100% below"),
        ("bootstrap_own_block", 2, r"7 of them hold\. All are 24\.\d mm wide"),
        ("bootstrap_iid", 2, r"0 of them hold\. All are 10\.\d mm wide"),
    ],
)
def test_the_report_describes_the_figures_that_wrong_code_gives(mutant, place, now):
    """The words are the figure for whoever does not see it: they follow the rows, not the right answer."""
    said = descriptions(mutant)[place]
    assert said != descriptions()[place]
    assert re.search(now, said), said
    for promise in ("stays around 2", "mostly inside", "hardly leave", "three or four times"):
        assert promise not in said


def test_every_hidden_check_hides_its_numbers_in_fields():
    """Messages and advice are literal text: nothing is formatted into them but names of arguments."""
    allowed = {"key", "name", "task", "function", "signature"}
    for path in [*(ROOT / "exercises" / "validation").glob("*.py"), *GRADERS.parent.glob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.keyword) and node.arg in ("message", "help"):
                names = {n.id for n in ast.walk(node.value) if isinstance(n, ast.Name)}
                assert all(re.fullmatch("|".join([*allowed, "names"]), name) for name in names), (path, names)


@pytest.mark.parametrize("call", [lambda f: f(1), lambda f: f(1, 2, 3), lambda f: f(1, v=2)])
def test_a_callback_refuses_any_other_number_of_arguments(call):
    with pytest.raises(kit.CheckFailed) as refused:
        call(probes.callback("energy(q_i, v_i)", lambda q, v: 0.0))
    assert refused.value.finding.diagnosis == "CALLED_WRONGLY"


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [(0.95, 1.0, "ROUGH_QUANTILES"), (1.0, 1.05, "ROUGH_QUANTILES"), (0.5, 1.0, None)],
)
def test_a_band_of_one_run_is_never_told_that_it_ignores_the_runs(low, high, expected):
    for dof in (20, 35, 60):
        lo, hi = (factor * chi_square.quantile(dof, p) for factor, p in ((low, 0.025), (high, 0.975)))
        found = probes.of_band(lo, hi, dof, 1, 0.05, chi_square.quantile, NormalDist().inv_cdf)
        assert code(found) == expected
