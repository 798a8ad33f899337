"""The references of ``validation`` and its README's numbers against other sources, and probes' limits.

What known wrong programs are told is in ``solutions/validation/record.json``, which the audit keeps.
"""

from __future__ import annotations

import functools
import math
import re
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

PATH = Path(__file__).resolve().parents[3] / "solutions" / "validation" / "validation.py"
SOLUTION = LocalSubmission(PATH.read_text())
WRONG = {one.name: one for one in kit.reference("validation", "mistakes").mistakes.wrong}

probes = kit.companion("validation", "probes")
shared = kit.companion("validation", "expectations")
twins = kit.companion("validation", "twins")
verdict = kit.companion("validation", "probes_verdict")
intervals = kit.companion("validation", "intervals")
bundles = kit.companion("validation", "bundles")
report = kit.companion("validation", "report")
formulas = kit.reference("validation", "formulas")


@pytest.mark.parametrize(
    ("dof", "alpha", "printed"),
    [(1, 0.1, (0.00393, 3.841)), (2, 0.05, (0.0506, 7.378)), (40, 0.05, (24.433, 59.342))],
)
def test_bands_are_those_of_printed_tables(dof, alpha, printed):
    assert formulas.exactly()(dof, 1, alpha) == pytest.approx(printed, abs=5.1e-4)


def test_the_spread_of_the_mean_is_that_of_many_series():
    means = shared.correlated(5, 4000, 60, 0.8).mean(axis=1)
    assert np.std(means) == pytest.approx(shared.spread_of_mean(60, 0.8), rel=0.05)


def test_the_speed_of_the_cart_obeys_its_equation_of_motion():
    drive, t = twins.record(np.random.default_rng(3), "a", 8.0, 0.01, 0.0).drive, np.linspace(1.0, 2.0, 50)
    force = np.sum(drive.amplitude * np.sin(np.multiply.outer(t, drive.omega) + drive.phase), axis=-1)
    slope = (drive.speed(t + 1e-5) - drive.speed(t - 1e-5)) / 2e-5
    assert np.allclose(twins.MASS * slope, force - twins.FRICTION * drive.speed(t), atol=1e-6)


@pytest.mark.parametrize(("block", "share", "slack"), [(1, 0.34, 0.085), (40, 0.81, 0.07)])
def test_a_nominal_interval_covers_what_the_readme_says(block, share, slack):
    """The README's row for 400 errors: 34 % with single errors, 81 % with blocks of 40, each to 3 sigma."""
    held = []
    for i, e in enumerate(shared.correlated(99, 300, 400, 0.9)):
        rng = np.random.default_rng(i)
        lo, hi = SOLUTION.call("block_bootstrap_ci", e, np.mean, block, 200, 0.05, rng)
        held.append(lo <= 0 <= hi)
    assert np.mean(held) == pytest.approx(share, abs=slack)


@pytest.mark.parametrize("each", [0.0, 0.3])
def test_the_interval_from_runs_left_out_covers_what_the_readme_says(each):
    """89 to 91 % for the bias, of errors that resemble their neighbours, off as a whole or not; 3 sigma."""
    rng, held = np.random.default_rng(5), []
    solution = LocalSubmission(PATH.read_text(), replaced={"best_shift": lambda pairs: 0.0})
    for _ in range(400):
        e = shared.correlated(int(rng.integers(2**31)), 4, 400, 0.9)
        pairs = [
            ({"y": row[:n] + each * rng.standard_normal(), "sigma": np.ones(n)}, {"y": np.zeros(n)})
            for row, n in zip(e, rng.integers(200, 401, 4), strict=True)
        ]
        lo, hi = solution.call("interval_of_each", pairs)["bias"]
        held.append(lo <= 0 <= hi)
    assert np.mean(held) == pytest.approx(0.9, abs=0.05)


@pytest.mark.parametrize(("levels", "code"), [([0.9, 0.1], None), ([0.1, 0.9], "RETURNS_SWAPPED")])
def test_a_basic_interval_is_as_right_as_the_plain_one(levels, code):
    e, rng = np.arange(250.0), np.random.default_rng(0)
    asked = [rng.choice(e, 250) for _ in range(24)]
    answers = [float(np.mean(samples**2)) for samples in asked]
    ends = 2 * np.mean(e**2) - np.quantile(answers, levels)
    found = probes.Resampled(e, asked, answers, kit.Inspected(ends, [e], shared=False))
    assert probes.of_ends(found) == code


@pytest.mark.parametrize(
    "middle", [lambda whole, mean: whole, lambda whole, mean: mean, lambda w, m: 2 * w - m]
)
@pytest.mark.parametrize("factor", [1.2816, 1.3195])  # of a normal distribution, and Student's t
def test_a_normal_interval_is_right_of_whatever_resamples(middle, factor):
    """It is told by its middle and its width: of 24 values, it may lie on any quantiles."""
    e = 1.0 + np.arange(250.0)
    for seed in range(300):
        rng = np.random.default_rng(seed)
        answers = np.mean(rng.choice(e, (24, 20)) ** 2, axis=1)
        centre = middle(np.mean(e**2), np.mean(answers))
        ends = centre + factor * np.std(answers, ddof=1) * np.array([-1, 1])
        found = probes.Resampled(e, [e[::-1]] * 24, list(answers), kit.Inspected(ends, [e], shared=False))
        assert probes.of_ends(found) is None


def blocks(n, block, rng, rule):
    """One resample of a series whose values are 1, 2, ..., n; rule: fits, circular, cut or random."""
    parts = []
    while sum(map(len, parts)) < n:
        start = rng.integers(n - block + 1 if rule == "fits" else n)
        length = rng.geometric(1 / block) if rule == "random" else block
        places = start + np.arange(length)
        parts.append(places % n if rule == "circular" else places[places < n])
    return 1.0 + np.concatenate(parts)[:n]


@pytest.mark.parametrize(
    ("rule", "code"), [("fits", None), ("circular", None), ("random", None), ("cut", "BLOCKS_CUT_SHORT")]
)
def test_only_blocks_of_one_length_are_told_to_be_cut_short(rule, code):
    e = 1.0 + np.arange(250)
    for seed in range(60):
        rng = np.random.default_rng(seed)
        asked = [blocks(250, 12, rng, rule) for _ in range(24)]
        found = probes.Resampled(e, asked, [0.0] * 24, kit.Inspected((0.0, 1.0), [e], shared=False))
        assert probes.of_resamples(found) == code


def test_intervals_that_are_points_are_told_to_be_points():
    """A distance in widths of zero is no number, and was once printed as 1.2e+11."""
    with pytest.raises(kit.CheckFailed) as failed:
        intervals.expect_centred(SOLUTION, np.full((8, 2), 3.0), np.full(8, 2.9), {})
    assert failed.value.finding.message.startswith("Both ends of the interval are the same number")


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (lambda folds: folds.predict({"model": 0}, folds.runs[0]), "NOT_A_MODEL"),
        (lambda folds: folds.fit([{"u": np.zeros(5)}]), "NOT_A_RUN"),
        (lambda folds: probes.callback("energy(q_i, v_i)", folds)(1), "CALLED_WRONGLY"),
        (lambda folds: probes.callback("energy(q_i, v_i)", folds)(1, v=2), "CALLED_WRONGLY"),
    ],
)
def test_callbacks_refuse_what_they_cannot_use(call, code):
    with pytest.raises(kit.CheckFailed) as refused:
        call(probes.Folds([{"id": "a", "u": np.ones(5), "y": np.ones(5)}]))
    assert refused.value.finding.diagnosis == code


NUMBERS = {"rmse": 0.2, "bias": 0.2, "coverage": 0.2, "lag_s": -0.05}
ENDS, SWAPPED = {key: [0.1, 0.3] for key in NUMBERS}, {key: [0.3, 0.1] for key in NUMBERS}
FACTS = verdict.Facts(["a", "b"], NUMBERS, ENDS, steps=[0.02], means={}, averages=[], alone=0.0)
FAR = verdict.Facts(
    ["a", "b"], NUMBERS | {"lag_s": -0.12}, ENDS, [0.02], {}, [], 0.0, {"outside": [[-0.09, 0.0]]}
)
SEARCHES_SHORT = LocalSubmission(PATH.read_text().replace("MAX_LAG = 0.25", "MAX_LAG = 0.1"))
IN_FLOAT32 = LocalSubmission(
    "", replaced={"bias_variance": lambda e: (float(np.mean(e)), float(np.var(e.astype(np.float32))))}
)


@pytest.mark.parametrize(
    ("find", "code"),
    [
        (lambda: probes.of_digits(1.6249696, 1.62496964), "FEW_DIGITS"),
        (lambda: probes.of_digits(1.625, 1.62496964), None),
        (lambda: probes.of_offset(IN_FLOAT32, np.array([0.3, 1.1, -0.7, 0.5, 1.9])), "SINGLE_PRECISION"),
        (lambda: verdict.of_reasons([(["bias", "lag", "rmse"], ["bias", "lag"])]), "REASON_TOO_MANY"),
        (lambda: verdict.of_reasons([(["bias", "lag_s"], ["bias", "lag"])]), "REASON_UNKNOWN"),
        (lambda: verdict.of_reasons([(["bias", "lag", "lag"], ["bias", "lag"])]), "REASON_TWICE"),
        (lambda: verdict.of_lag(SOLUTION, 0.0, 0.0, FACTS), "LAG_NOT_NEGATIVE"),
        (lambda: verdict.of_lag(SOLUTION, -0.02, 0.0, FACTS), "LAG_NOT_BEST"),
        (lambda: verdict.of_lag(SOLUTION, -0.09, 0.0, FAR), "LAG_PAST_THE_END"),
        (lambda: verdict.of_lag(SEARCHES_SHORT, -0.09, 0.0, FAR), "LAG_SEARCH_SHORT"),
        (lambda: verdict.of_lag_interval(SEARCHES_SHORT, -0.09, 0.0001, FAR), "LAG_SEARCH_SHORT"),
        (lambda: verdict.of_interval("rmse", SWAPPED, FACTS), "RETURNS_SWAPPED"),
    ],
)
def test_what_no_known_program_gives_is_told(find, code):
    found = find()
    assert (found and found.code) == code


def test_of_two_mistakes_a_check_names_the_one_that_its_own_number_shows():
    """A lag of -0.047 that should be 0.047 was once told of an interval of one sigma."""
    wrong = NUMBERS | {"lag_s": 0.05, "runs_used": FACTS.used, "intervals": SWAPPED}
    with pytest.raises(kit.CheckFailed) as failed:
        bundles.expect_measures(SOLUTION, wrong, None, FACTS, {})
    assert failed.value.guess.code == "LAG_SIGN"
    # None of these is said of checks that do not show it.
    for code in ("LAG_SIGN", "WRONG_SIGN", "JACKKNIFE_FACTOR", "NOT_STUDENTS_T"):
        assert kit.words("validation").kind(code) != "cause"


(CASE, RIGHT), *_ = bundles.public("validate_margins_apart", None)


@pytest.mark.parametrize("bad", [None, 3, "abc", [1, [2]], np.zeros(3), {"a": 1}, 10**400, [None], math.nan])
@pytest.mark.parametrize("key", bundles.KEYS)
def test_a_report_with_any_one_value_spoilt_fails_as_the_student_s(key, bad):
    spoilt = SOLUTION.call("validate", CASE.sim, CASE.real, bundles.LENIENT) | {key: bad}
    program = LocalSubmission("", replaced={"validate": lambda *_: spoilt})
    for expect in (bundles.expect_report, bundles.expect_nothing):
        with pytest.raises(kit.CheckFailed) as failed:
            expect(program, CASE, bundles.LENIENT, RIGHT, {})
        assert not failed.value.broke


@functools.cache
def descriptions(mutant=""):
    """What the report says of its figures, by section."""
    source = WRONG[mutant].composed(PATH.read_text(), PATH) if mutant else PATH.read_text()
    return [section.plot.description for section in report.report(LocalSubmission(source)).sections[:3]]


def test_the_report_describes_the_figures_of_right_code():
    """Of a filter with the right noise the mean NEES is 2; of one that believes another noise it is not."""
    errors, consistency, intervals = descriptions()
    good_twin = r"good twin: .* your coverage finds 9\d\.\d% inside\. Below, a fifth too heavy: "
    assert re.search(good_twin, errors)
    right, half, twice = (float(x) for x in re.findall(r"is (\d\.\d\d) on average", consistency))
    assert right == pytest.approx(2.0, abs=0.3)
    assert twice < 1.5
    assert half > 4.0
    assert "noise believed to be right" in consistency
    one, narrowest, widest = (float(x) for x in re.findall(r"(\d+\.\d) mm", intervals))
    assert one == narrowest < widest / 2.5


@pytest.mark.parametrize(
    ("mutant", "place", "now"),
    [
        ("coverage.OUTSIDE_COUNTED", 0, r"good twin: .*finds \d\.\d% inside"),
        ("nees.DIVIDED_BY_D", 1, r"your NEES is [01]\.\d\d on average.* 0% above and at (9\d|100)% below"),
        ("block_bootstrap_ci.IID_BOOTSTRAP", 2, r"0 of them hold\. All are 9\.\d mm wide"),
    ],
)
def test_the_report_describes_the_figures_that_wrong_code_gives(mutant, place, now):
    """The words are the figure for whoever does not see it: they follow the rows, not the right answer."""
    said = descriptions(mutant)[place]
    assert said != descriptions()[place]
    assert re.search(now, said), said
    for promise in ("stays around 2", "mostly inside", "hardly leave", "three or four times"):
        assert promise not in said


@pytest.mark.parametrize(
    ("ends", "said"),
    [
        ("None", "is None, not"),
        ("(m - 1e-3 * abs(m), m + 1e-3 * abs(m))", "does not come from what the statistic says"),
        ("tuple(np.quantile(values, [alpha / 2, 1 - alpha / 2]))", None),
    ],
)
def test_an_interval_comes_from_the_resamples_that_it_asked_about(ends, said):
    source = (
        "import numpy as np\ndef block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):\n"
        "    n, m = len(e), float(statistic(e))\n"
        "    starts = rng.integers(0, n - block + 1, size=(n_boot, -(-n // block)))\n"
        "    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]\n"
        f"    values = [statistic(e[row]) for row in rows]\n    return {ends}\n"
    )
    ask = functools.partial(intervals.expect_resamples, LocalSubmission(source), 3)
    if said is None:
        ask()
    else:
        with pytest.raises(kit.CheckFailed, match=said):
            ask()
