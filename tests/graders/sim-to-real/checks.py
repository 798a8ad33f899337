"""Hidden graders of ``sim-to-real``: the plan is executed on three carts drawn from the seed of the run.

A part of the plan that does not hold by itself is replaced by a sound one before the others are executed, so
that a mistake costs its own points only. Thresholds: ``tests/benchmarks/calibration/sim-to-real.md``.
"""

from __future__ import annotations

import numpy as np
import pytest

from course.grading import kit

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
    """Each gap is measured as the plan says, and its threshold is one that can be kept and that matters"""
    plan = execution.plan(submission)
    gaps = words.gaps_of(plan)
    judge.expect_enough(gaps)
    for i, gap in enumerate(gaps):
        judge.expect_words(i, gap)
        seconds, asked = words.budget_of(plan), (gap["excitation"], gap["parameter"])
        reach = reference.reach(submission.seed, *asked, seconds)
        threshold, needed = words.threshold_of(gap), words.NEEDED[gap["parameter"]]
        if reach > needed:
            enough = reference.reach(submission.seed, *asked, cart.BUDGET_S) <= needed
            wrong = "BUDGET_TOO_SHORT" if enough else "EXCITATION_CANNOT_SHOW"
        elif threshold > needed * (1 + 1e-9):
            wrong = "PROMISES_TOO_LITTLE"
        elif not threshold >= reach:
            wrong = "PROMISES_TOO_MUCH"
        else:
            continue
        kit.fail(
            "A gap of the plan was executed, and its measurement did not come out as the plan says.",
            diagnose=named(wrong),
            input={"gap": i, "parameter": gap["parameter"], "excitation": gap["excitation"]},
            expected=[reach, needed],
            actual=threshold,
            units="1",
        )


@pytest.mark.task("plan")
@pytest.mark.points(5)
def test_plan_executed(submission):
    """Executed on three fleets with sound parts, the plan keeps what it promises"""
    plan = kit.as_record(execution.plan(submission), words.PLAN_KEYS)
    box = words.box_of(plan)
    kit.expect_bounded(
        reference.box_success(submission.seed, box),
        low=max(0.90, kit.as_number(plan["threshold"], "threshold")),
        source="the plan's own threshold, 0.90 at least",
        quantity="success over three fleets",
        message="The fleets settle later than the plan promises.",
        diagnose=lambda: _of_promise(box),
    )


def _of_promise(box):
    fits = all(words.inside(k, *box[k]) >= 0.95 and words.width(k, *box[k]) <= 1.5 for k in cart.NAMES)
    return named("PROMISE_NOT_KEPT") if fits else words.of_box(box)


# -- design_excitation ----------------------------------------------------------------------------------


@pytest.mark.task("design_excitation")
@pytest.mark.points(6)
def test_excitation_shows_all(submission):
    """The excitation shows every parameter of three carts nobody has told about"""
    judge.expect_shows(execution.command(submission), reference.realities(submission.seed))


@pytest.mark.task("design_excitation")
@pytest.mark.points(3)
def test_excitation_other_bench(submission, rng):
    """On a bench with other limits it keeps to them and still shows everything"""
    seconds, u_max = round(float(rng.uniform(15.0, 18.0)), 2), float(rng.uniform(2.4, 2.8))
    value = submission.call("design_excitation", seconds, u_max, rng)
    judge.expect_shows(probes.command_of(value, seconds, u_max), reference.realities(submission.seed)[1:2])


# -- identify -------------------------------------------------------------------------------------------


@pytest.mark.task("identify")
@pytest.mark.points(11)
def test_identify_accurate(submission):
    """identify finds mass, frictions and lag of three unknown carts, as the mean of two recordings each"""
    estimates, carts = execution.bench(submission)
    judge.expect_accurate(execution.means(estimates), carts[:3])


@pytest.mark.task("identify")
@pytest.mark.points(10)
def test_identify_honest(submission):
    """The intervals of identify are useful, and twice as wide they hold the truth"""
    estimates, carts = execution.bench(submission)
    judge.expect_intervals(estimates)
    missed, total = judge.misses(estimates, carts)
    kit.expect_bounded(
        missed,
        high=2,
        source="of 24; those of correct solutions missed none in the calibration",
        quantity="intervals that miss the truth when doubled",
        message="The intervals promise more than the recordings hold.",
        diagnose=named("INTERVAL_OVERCONFIDENT"),
        input={"intervals": total},
    )


# -- tune: the plan, executed ---------------------------------------------------------------------------


@pytest.mark.task("tune")
@pytest.mark.points(18)
def test_tune_executed(submission):
    """The whole plan executed: three unknown fleets settle nearly as soon as any gains allow"""
    box = execution.box(submission)
    shares, worst = [], None
    for i, estimate in enumerate(execution.estimates(submission)):
        value = probes.patient(lambda estimate=estimate: submission.call("tune", estimate, box))
        gains = probes.gains_of(value)
        shares.append(reference.success(submission.seed, i, *gains))
        if worst is None or shares[-1] <= min(shares):
            worst = i, estimate, gains

    def diagnose():
        i, estimate, gains = worst
        return probes.of_gains(
            submission, estimate, box, gains, lambda kp, kd: reference.success(submission.seed, i, kp, kd)
        )

    kit.expect_bounded(
        float(np.mean(shares)),
        low=judge.PASS,
        source="correct solutions 0.97 and more, hard-coded gains 0.92 and less",
        quantity="success: mean of best over own settling",
        message="With the gains from tune, fleets that nobody has seen settle later than they could.",
        input={"success on each": shares},
        diagnose=diagnose,
    )
