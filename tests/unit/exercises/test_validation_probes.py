"""Where the probes of ``validation`` must not speak, and what its checks stand on.

What known wrong programs are told is in ``solutions/validation/record.json``, which the audit keeps.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.scoring import kit

PATH = Path(__file__).resolve().parents[3] / "solutions" / "validation" / "validation.py"
SOLUTION = LocalSubmission(PATH.read_text())

probes = kit.companion("validation", "probes")
twins = kit.companion("validation", "twins")
verdict = kit.companion("validation", "probes_verdict")
intervals = kit.companion("validation", "intervals")
bundles = kit.companion("validation", "bundles")


@pytest.mark.parametrize(
    ("dof", "alpha", "printed"),
    [(1, 0.1, (0.00393, 3.841)), (2, 0.05, (0.0506, 7.378)), (40, 0.05, (24.433, 59.342))],
)
def test_bands_are_those_of_printed_tables(dof, alpha, printed):
    assert kit.reference("validation", "formulas").exactly()(dof, 1, alpha) == pytest.approx(
        printed, abs=5.1e-4
    )


def test_the_speed_of_the_cart_obeys_its_equation_of_motion():
    drive, t = twins.record(np.random.default_rng(3), "a", 8.0, 0.01, 0.0).drive, np.linspace(1.0, 2.0, 50)
    force = np.sum(drive.amplitude * np.sin(np.multiply.outer(t, drive.omega) + drive.phase), axis=-1)
    slope = (drive.speed(t + 1e-5) - drive.speed(t - 1e-5)) / 2e-5
    assert np.allclose(twins.MASS * slope, force - twins.FRICTION * drive.speed(t), atol=1e-6)


@pytest.mark.parametrize(
    "ends",
    [
        lambda whole, answers: 2 * whole - np.quantile(answers, [0.9, 0.1]),
        # Of a normal distribution, and Student's t: about the whole, about the mean, and basic.
        *(
            lambda whole, answers, factor=factor, share=share: (
                (1 - share) * whole
                + share * np.mean(answers)
                + factor * np.std(answers, ddof=1) * np.array([-1, 1])
            )
            for factor in (1.2816, 1.3195)
            for share in (0, 1, -1)
        ),
    ],
)
def test_a_basic_and_a_normal_interval_are_as_right_as_the_plain_one(ends):
    """They are told by their middle and their width: of 24 values, they may lie on any quantiles."""
    e = 1.0 + np.arange(250.0)
    for seed in range(300):
        answers = np.mean(np.random.default_rng(seed).choice(e, (24, 20)) ** 2, axis=1)
        seen = kit.Inspected(ends(np.mean(e**2), answers), [e], shared=False)
        assert probes.of_ends(probes.Resampled(e, [e[::-1]] * 24, list(answers), seen)) is None


@pytest.mark.parametrize("rule", ["fits", "circular", "random"])
def test_only_blocks_of_one_length_are_told_to_be_cut_short(rule):
    def resample(n, block, rng):
        parts = []
        while sum(map(len, parts)) < n:
            start = rng.integers(n - block + 1 if rule == "fits" else n)
            length = rng.geometric(1 / block) if rule == "random" else block
            places = start + np.arange(length)
            parts.append(places % n if rule == "circular" else places[places < n])
        return 1.0 + np.concatenate(parts)[:n]

    e = 1.0 + np.arange(250)
    for seed in range(60):
        rng = np.random.default_rng(seed)
        asked = [resample(250, 12, rng) for _ in range(24)]
        found = probes.Resampled(e, asked, [0.0] * 24, kit.Inspected((0.0, 1.0), [e], shared=False))
        assert probes.of_resamples(found) is None


FOLDS = probes.Folds([{"id": "a", "u": np.ones(5), "y": np.ones(5)}])
NUMBERS = {"rmse": 0.2, "bias": 0.2, "coverage": 0.2, "lag_s": -0.05}
ENDS, SWAPPED = {key: [0.1, 0.3] for key in NUMBERS}, {key: [0.3, 0.1] for key in NUMBERS}
FACTS = verdict.Facts(["a", "b"], NUMBERS, ENDS, steps=[0.02], means={}, averages=[], alone=0.0)
IN_FLOAT32 = LocalSubmission(
    "", replaced={"bias_variance": lambda e: (float(np.mean(e)), float(np.var(e.astype(np.float32))))}
)


def asked(call):
    """The code with which a callback refuses a call."""
    with pytest.raises(kit.CheckFailed) as refused:
        call()
    return refused.value.finding.diagnosis


@pytest.mark.parametrize(
    ("find", "code"),
    [
        (lambda: asked(lambda: FOLDS.predict({"model": 0}, FOLDS.runs[0])), "NOT_A_MODEL"),
        (lambda: asked(lambda: FOLDS.fit([{"u": np.zeros(5)}])), "NOT_A_RUN"),
        (lambda: asked(lambda: probes.callback("energy(q_i, v_i)", FOLDS)(1)), "CALLED_WRONGLY"),
        (lambda: asked(lambda: probes.callback("energy(q_i, v_i)", FOLDS)(1, v=2)), "CALLED_WRONGLY"),
        (lambda: probes.of_digits(1.6249696, 1.62496964).code, "FEW_DIGITS"),
        (lambda: probes.of_digits(1.625, 1.62496964), None),
        (lambda: probes.of_offset(IN_FLOAT32, np.array([0.3, 1.1, -0.7, 0.5, 1.9])).code, "SINGLE_PRECISION"),
        (lambda: verdict.of_reasons([(["bias", "lag", "rmse"], ["bias", "lag"])]).code, "REASON_TOO_MANY"),
        (lambda: verdict.of_reasons([(["bias", "lag_s"], ["bias", "lag"])]).code, "REASON_UNKNOWN"),
        (lambda: verdict.of_reasons([(["bias", "lag", "lag"], ["bias", "lag"])]).code, "REASON_TWICE"),
        (lambda: verdict.of_lag(SOLUTION, 0.0, 0.0, FACTS).code, "LAG_NOT_NEGATIVE"),
    ],
)
def test_what_no_known_program_gives_is_told(find, code):
    assert find() == code


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


def test_an_interval_that_is_far_too_narrow_does_not_come_from_its_resamples():
    source = (
        "import numpy as np\ndef block_bootstrap_ci(e, statistic, block, n_boot, alpha, rng):\n"
        "    n, m = len(e), float(statistic(e))\n"
        "    starts = rng.integers(0, n - block + 1, size=(n_boot, -(-n // block)))\n"
        "    rows = (starts[:, :, None] + np.arange(block)).reshape(n_boot, -1)[:, :n]\n"
        "    values = [statistic(e[row]) for row in rows]\n    return m - 1e-3 * abs(m), m + 1e-3 * abs(m)\n"
    )
    with pytest.raises(kit.CheckFailed, match="does not come from what the statistic says"):
        intervals.expect_resamples(LocalSubmission(source), 3)
