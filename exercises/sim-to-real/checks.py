"""Public checks of ``sim-to-real``: run as often as you like, and once more when you submit."""

from __future__ import annotations

import numpy as np
import pytest

from course.scoring import kit

cart = kit.companion("sim-to-real", "cart")
words = kit.companion("sim-to-real", "words")
probes = kit.companion("sim-to-real", "probes")
judge = kit.companion("sim-to-real", "judge")
named = words.named


@pytest.mark.task("plan")
@pytest.mark.points(4)
def test_plan_complete(submission):
    """The plan's gaps, sources and words"""
    plan, again = submission.call_each("plan", [(), ()])
    gaps = words.gaps_of(plan)
    for i, gap in enumerate(gaps):
        judge.expect_words(i, gap)
    judge.expect_enough(gaps)
    sources = sorted({gap["source"] for gap in gaps})
    kit.expect_true(
        len(sources) >= 3,
        "The plan names too few sources of the gap.",
        diagnose=named("TOO_FEW_SOURCES"),
        actual=sources,
    )
    words.budget_of(plan)
    threshold = kit.as_number(plan["threshold"], "threshold")
    kit.expect_true(
        plan["metric"] == "success" and 0.90 <= threshold < 1.0,
        "The plan's metric is not success, or its threshold is not one from 0.90 to below 1.",
        diagnose=lambda: words.of_promise(plan["metric"], threshold),
        expected=["success", "0.90 or more and below 1"],
        actual=[plan["metric"], threshold],
    )
    once_more = kit.as_record(again, words.PLAN_KEYS)
    differs = [key for key in plan if repr(once_more[key]) != repr(plan[key])]
    kit.expect_true(
        not differs,
        "Called again, plan returns another plan.",
        diagnose=named("PLAN_VARIES"),
        input={"what differs": differs},
    )


@pytest.mark.task("plan")
@pytest.mark.points(2)
def test_plan_gaps_at_home(submission):
    """Each gap on three public carts, and its threshold"""
    plan = submission.call("plan")
    seconds = words.budget_of(plan)
    for i, gap in enumerate(words.gaps_of(plan)):
        judge.expect_words(i, gap)
        judge.expect_kept(i, gap, seconds, cart.PUBLIC_TYPES, (0, 5))


@pytest.mark.task("plan")
@pytest.mark.points(4)
def test_plan_box(submission):
    """The randomisation box beside the fleet"""
    box = words.box_of(submission.call("plan"))
    for name in cart.NAMES:
        for fits, expected in (
            (words.inside(name, *box[name]) >= 0.95, "95 % of the fleet's draws inside"),
            (words.width(name, *box[name]) <= 1.5, "at most 1.5 times the fleet's range in the logarithm"),
        ):
            kit.expect_true(
                fits,
                "The randomisation box does not match the fleet.",
                diagnose=lambda name=name: words.of_box(box, [name]),
                input={"parameter": name},
                expected=expected,
                actual=list(box[name]),
            )


@pytest.mark.task("design_excitation")
@pytest.mark.points(3)
def test_excitation_obeys(submission):
    """The excitation's length and force"""
    # 100 * 8.2 is 819.9999999999999, and np.arange(0, 8.13, 0.01) has one command too many.
    # The last has the second one's length and less force.
    cases = [(20.0, 3.0), (12.5, 3.0), (8.2, 1.7), (8.13, 2.6), (12.5, 2.1)]
    given = [(*case, np.random.default_rng(7)) for case in cases]
    for case, value in zip(cases, submission.call_each("design_excitation", given), strict=True):
        probes.command_of(value, *case)


@pytest.mark.task("design_excitation")
@pytest.mark.points(6)
def test_excitation_shows(submission):
    """What twenty seconds of the excitation show of the public cart"""
    value = submission.call("design_excitation", 20.0, 3.0, np.random.default_rng(8))
    u = probes.command_of(value, 20.0, 3.0)
    judge.expect_shows(u, [cart.PUBLIC])
    judge.expect_fitted(u, [cart.PUBLIC])


@pytest.mark.task("design_excitation")
@pytest.mark.points(0)
def test_excitation_shorter_and_weaker(submission):
    """What fifteen seconds at less force show of three carts"""
    case = 15.35, 2.4
    given = [(*case, np.random.default_rng(seed)) for seed in (9, 10, 11)]
    for value in submission.call_each("design_excitation", given):
        judge.expect_shows(probes.command_of(value, *case), cart.PUBLIC_TYPES, 2.4)


@pytest.mark.task("identify")
@pytest.mark.points(7)
def test_identify_public(submission):
    """Mass, both frictions and lag of the public carts, from bench recordings"""
    recordings, carts = judge.public_recordings()
    # The heavier cart first: what is kept of the lighter one, whose recordings say more, shows afterwards.
    asked = [recordings[-1], recordings[-1], *recordings, *judge.far_recordings()[0]]
    values = probes.patient(lambda: submission.call_each("identify", asked), "IDENTIFY_TOO_SLOW")
    first, second, *found = [probes.estimate_of(value) for value in values]
    found, far = found[: len(carts)], found[len(carts) :]
    judge.expect_accurate(found, carts, recordings, submission)
    judge.expect_forgetful(first, second, found[-1])
    judge.expect_far(far, found, carts)


@pytest.mark.task("identify")
@pytest.mark.points(4)
def test_identify_intervals(submission):
    """The intervals: their values and their widths"""
    recordings, carts = judge.public_recordings()
    both = [*recordings, *judge.weak_recordings()]
    values = probes.patient(lambda: submission.call_each("identify", both), "IDENTIFY_TOO_SLOW")
    estimates = [probes.estimate_of(value) for value in values]
    full, weak = estimates[: len(carts)], estimates[len(carts) :]
    judge.expect_intervals(full, carts, recordings)
    # Widths that follow from nothing are told so before they are too wide.
    judge.expect_growth(full, weak, carts, recordings)
    judge.expect_honest_widths(full, recordings, carts)
    judge.expect_errors(full, weak, recordings, judge.weak_recordings())
    judge.expect_truth(full, carts, recordings, 1, 4)
    judge.expect_own_lag(full)


@pytest.mark.task("tune")
@pytest.mark.points(7)
def test_tune_public(submission):
    """How soon a fleet of the public type settles with the gains from tune"""
    _expect_tuned(submission, "fleet", "the fleet settles later than it")


@pytest.mark.task("tune")
@pytest.mark.points(3)
def test_tune_other_fleets(submission):
    """The gains for other boxes: heavy and late, light and prompt, light and late"""
    for kind in ("loaded", "prompt", "late"):
        _expect_tuned(submission, kind, "carts drawn from this box settle later than they")


def _expect_tuned(submission, kind, who):
    """Gains for the public cart and a box of this kind, on carts drawn from it."""
    estimate = cart.with_intervals(cart.PUBLIC, *(() if kind == "fleet" else (0.7, 1.9)))
    box = cart.BOXES[kind]
    value = probes.patient(lambda: submission.call("tune", estimate, box), "TUNE_TOO_SLOW")
    gains = probes.gains_of(value)
    kit.expect_bounded(
        cart.public_success(*gains, kind)[0],
        low=judge.PASS,
        source="the README's",
        quantity="success: best mean settling over own",
        message=f"With these gains {who} could.",
        help=judge.LEAST_MEAN,
        input={"kp": gains[0], "kd": gains[1], "box": box, "best mean settling, s": cart.PUBLIC_BEST_S[kind]},
        diagnose=lambda: probes.of_gains(
            submission, estimate, box, gains, lambda kp, kd: cart.public_success(kp, kd, kind)[0]
        ),
    )
