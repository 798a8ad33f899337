"""Hidden graders of ``sim-to-real``: the plan is executed on three carts drawn from the seed of the run.

A part of the plan that does not hold by itself is replaced by a sound one before the others are executed, so
that a mistake costs its own points only. Thresholds: ``tests/benchmarks/calibration/sim-to-real.md``.
"""

from __future__ import annotations

import numpy as np
import pytest

from course.scoring import kit

cart = kit.companion("sim-to-real", "cart")
words = kit.companion("sim-to-real", "words")
probes = kit.companion("sim-to-real", "probes")
judge = kit.companion("sim-to-real", "judge")
reference = kit.sibling(__file__, "reference")
execution = kit.sibling(__file__, "execution")
named = words.named

# -- plan -----------------------------------------------------------------------------------------------


@pytest.mark.task("plan")
@pytest.mark.points(7)
def test_plan_gaps_kept(submission):
    """Each gap measured as the plan says, and its threshold"""
    plan = execution.plan(submission)
    gaps = words.gaps_of(plan)
    judge.expect_enough(gaps)
    for i, gap in enumerate(gaps):
        judge.expect_words(i, gap)
        seconds, carts = words.budget_of(plan), reference.realities(submission.seed)
        judge.expect_kept(i, gap, seconds, carts, (submission.seed, 5))


@pytest.mark.task("plan")
@pytest.mark.points(5)
def test_plan_executed(submission):
    """The plan's promise on three fleets, with the other parts correct"""
    plan = kit.as_record(execution.plan(submission), words.PLAN_KEYS)
    box, threshold = words.box_of(plan), kit.as_number(plan["threshold"], "threshold")
    kit.expect_bounded(
        reference.box_success(submission.seed, box),
        low=max(0.90, threshold),
        source="the plan's own threshold, 0.90 at least",
        quantity="success over three fleets",
        message="With the plan's box, the fleets settle later than the plan promises."
        if threshold >= 0.90
        else "With the plan's box, the success over the fleets is below the least that a plan may promise.",
        diagnose=lambda: _of_promise(box, threshold),
    )


def _of_promise(box, threshold):
    if not threshold < 1.0:
        return words.of_promise("success", threshold)
    fits = all(words.inside(k, *box[k]) >= 0.95 and words.width(k, *box[k]) <= 1.5 for k in cart.NAMES)
    return named("PROMISE_NOT_KEPT") if fits else words.of_box(box)


# -- design_excitation ----------------------------------------------------------------------------------


@pytest.mark.task("design_excitation")
@pytest.mark.points(6)
def test_excitation_shows_all(submission):
    """What the excitation shows of three unknown carts"""
    u, carts = execution.command(submission), reference.realities(submission.seed)
    judge.expect_shows(u, carts)
    judge.expect_fitted(u, carts)


@pytest.mark.task("design_excitation")
@pytest.mark.points(3)
def test_excitation_other_bench(submission, rng):
    """The excitation on a bench with other limits"""
    others = [(_uneven(rng, count), float(rng.uniform(1.7, 3.0))) for count in _COUNTS]
    (seconds, force), _ = others  # this length with two forces from the README's range, the larger one first
    others += [(seconds, max(force, 4.7 - force)), (seconds, min(force, 4.7 - force))]
    values = submission.call_each("design_excitation", [(*other, rng) for other in others])
    for value, other in zip(values, others, strict=True):
        probes.command_of(value, *other)
    # Where the README's range is hardest, and more than once: what shows enough by chance is not enough.
    case = round(float(rng.uniform(15.0, 15.5)), 2), float(rng.uniform(2.4, 2.5))
    for value in submission.call_each("design_excitation", [(*case, rng)] * 3):
        judge.expect_shows(probes.command_of(value, *case), reference.realities(submission.seed), case[1])


#: Two ways to count the hundredths of a time, each of which is one off at some times.
_COUNTS = (lambda s: int(100 * s), lambda s: len(np.arange(0, s, cart.H)))


def _uneven(rng, count):
    """A time between 8 and 20 s in hundredths of a second, of which ``count`` gives another number."""
    return float(rng.choice([k / 100 for k in range(800, 2001) if count(k / 100) != k]))


# -- identify -------------------------------------------------------------------------------------------


@pytest.mark.task("identify")
@pytest.mark.points(11)
def test_identify_accurate(submission):
    """Mass, both frictions and lag of three unknown carts, from two recordings each"""
    estimates, carts = execution.bench(submission)
    recordings, single = reference.recordings(submission.seed), (estimates, carts)
    judge.expect_accurate(execution.means(estimates), carts[:3], recordings, submission, single)


@pytest.mark.task("identify")
@pytest.mark.points(10)
def test_identify_honest(submission):
    """The intervals for strong and weak recordings, and the true values"""
    estimates, carts = execution.bench(submission)
    recordings, weak = reference.recordings(submission.seed), execution.weak(submission)
    judge.expect_intervals(estimates, carts, recordings)
    judge.expect_growth(estimates, weak, carts, recordings)
    judge.expect_honest_widths(estimates, recordings, carts)
    judge.expect_errors(estimates, weak, recordings, reference.weak_recordings(submission.seed))
    judge.expect_truth(estimates, carts, recordings, 2, 8)
    judge.expect_own_lag(estimates)


# -- tune: the plan, executed ---------------------------------------------------------------------------


@pytest.mark.task("tune")
@pytest.mark.points(11)
def test_tune_executed(submission):
    """The whole plan executed: how soon three unknown fleets settle"""
    box = execution.box(submission)
    asked = [(estimate, box) for estimate in execution.estimates(submission)]
    _expect_success(submission, asked, reference.success, "fleets that nobody has seen settle")


@pytest.mark.task("tune")
@pytest.mark.points(7)
def test_tune_other_boxes(submission):
    """The gains for other boxes, one for each of three carts"""
    asked = [
        (cart.with_intervals(each, 0.7, 1.9), box)
        for each, box in zip(reference.realities(submission.seed), reference.OTHER_BOXES, strict=True)
    ]
    _expect_success(
        submission, asked, reference.other_success, "carts drawn from the box it was given settle"
    )


def _expect_success(submission, asked, success, who):
    """The mean success of the gains for each (estimate, box); the worst of them is looked into."""
    values = probes.patient(lambda: submission.call_each("tune", asked), "TUNE_TOO_SLOW")
    gains = [probes.gains_of(value) for value in values]
    shares = [success(submission.seed, i, *pair) for i, pair in enumerate(gains)]
    worst = int(np.argmin(shares))
    kit.expect_bounded(
        float(np.mean(shares)),
        low=judge.PASS,
        source="the README's",
        quantity="success: mean of best over own settling",
        message=f"With the gains from tune, {who} later than they could. "
        "The worst of the three is looked into.",
        help=judge.LEAST_MEAN,
        input={"success on each": shares},
        diagnose=lambda: probes.of_gains(
            submission, *asked[worst], gains[worst], lambda kp, kd: success(submission.seed, worst, kp, kd)
        ),
    )
