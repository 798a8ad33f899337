"""Public checks of ``engine-comparison``: run as often as you like, and once more when you submit.

The engines here are the three of ``boxes.py``; those of the grading run are others.
"""

from __future__ import annotations

import copy

import pytest

from course.grading import kit

bench = kit.companion("engine-comparison", "bench")
boxes = kit.companion("engine-comparison", "boxes")
judging = kit.companion("engine-comparison", "judging")
choosing = kit.companion("engine-comparison", "choosing")
listing = kit.companion("engine-comparison", "listing")
measured = kit.companion("engine-comparison", "measured")

#: One of the three may bring a measurement down without taking the other two with it.
SPARED = 1


def known(submission):
    """The three engines of ``boxes.py``, each characterised once."""
    three = {"anvil": boxes.ANVIL, "balsa": boxes.BALSA, "cork": boxes.CORK}
    return bench.cases(
        submission,
        "public",
        lambda: [bench.Case(name, box, boxes.TRUTH[name]) for name, box in three.items()],
    )


@pytest.mark.task("characterise")
@pytest.mark.points(4)
def test_order(submission):
    """The order of anvil, balsa and cork is found"""
    judging.expect_key(known(submission), "order", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_symplectic(submission):
    """Of anvil, balsa and cork it is known which one keeps area"""
    judging.expect_key(known(submission), "symplectic", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(4)
def test_linear_damping(submission):
    """The damping of anvil, balsa and cork is found"""
    judging.expect_key(known(submission), "linear_damping", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_max_stable_step(submission):
    """The largest stable step of anvil, balsa and cork is found"""
    judging.expect_key(known(submission), "max_stable_step", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_friction_anisotropy(submission):
    """Of anvil, balsa and cork it is known how much harder a diagonal push must be"""
    judging.expect_key(known(submission), "friction_anisotropy", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_rest_penetration(submission):
    """Of anvil, balsa and cork it is known how deep a body sinks into the floor"""
    judging.expect_key(known(submission), "rest_penetration", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_restitution(submission):
    """The restitution of anvil, balsa and cork is found"""
    judging.expect_key(known(submission), "restitution", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_tunnelling_speed(submission):
    """Of anvil, balsa and cork it is known at which speed bodies get through the wall"""
    judging.expect_key(known(submission), "tunnelling_speed", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_deterministic(submission):
    """Of anvil, balsa and cork it is known which one never repeats itself"""
    judging.expect_key(known(submission), "deterministic", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_report_complete(submission):
    """The report has its nine keys and no other, each with a value"""
    judging.expect_complete(known(submission))


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
def test_choose_by_report(submission):
    """Of anvil, balsa and cork the cheapest that meets every requirement is chosen"""
    reports = {name: {**boxes.TRUTH[name], "cost": cost} for name, cost in
               (("cork", 5.0), ("anvil", 8.0), ("balsa", 1.0))}  # fmt: skip
    need = measured.need
    choosing.expect_choices(
        submission,
        [
            (reports, [], "balsa"),
            (reports, [need("order", ">=", 2)], "cork"),
            (reports, [need("symplectic", "==", True)], "anvil"),
            (reports, [need("order", ">=", 2), need("deterministic", "==", True)], "anvil"),
            (reports, [need("max_stable_step", ">=", 0.6), need("linear_damping", "<=", 2.0)], "balsa"),
            (reports, [need("rest_penetration", "<=", 0.0), need("tunnelling_speed", ">=", 100)], "anvil"),
        ],
    )


@pytest.mark.task("choose_engine")
@pytest.mark.points(2)
def test_choose_nothing(submission):
    """Where no engine meets every requirement, or one was not measured, none is chosen"""
    reports = {
        "anvil": {**boxes.TRUTH["anvil"], "cost": 2.0, "noise_db": None},
        "balsa": {**boxes.TRUTH["balsa"], "cost": 1.0},
    }
    need = measured.need
    choosing.expect_choices(
        submission,
        [
            (reports, [need("order", ">=", 3)], None),
            (reports, [need("order", "==", 2), need("symplectic", "==", False)], None),
            (reports, [need("noise_db", "<=", 60.0)], None),
            (
                reports,
                [need("order", ">=", 2), need("symplectic", "==", True), need("restitution", ">=", 0.9)],
                None,
            ),
        ],
    )


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
def test_choose_real_engines(submission):
    """Among ODE, Bullet, PhysX and MuJoCo as measured, the cheapest that fits is chosen for six jobs"""
    reports = measured.reports()
    choosing.expect_choices(
        submission,
        [(copy.deepcopy(reports), requirements, name) for requirements, name in measured.QUESTIONS.values()],
    )


@pytest.mark.task("choose_engine")
@pytest.mark.points(1)
def test_choose_by_numbers(submission):
    """Other names and another order change nothing, and reports and requirements stay as they were"""
    reports = {name: {**boxes.TRUTH[name], "cost": cost} for name, cost in
               (("cork", 5.0), ("anvil", 8.0), ("balsa", 1.0))}  # fmt: skip
    needs = [measured.need("order", ">=", 2)]
    swapped = {"balsa": reports["anvil"], "ode": reports["balsa"], "mujoco": reports["cork"]}
    choosing.expect_choices(submission, [(reports, needs, "cork"), (swapped, needs, "mujoco")])
    choosing.expect_untouched(submission, reports, needs)


@pytest.mark.task("engine_facts")
@pytest.mark.points(3)
def test_facts_complete(submission):
    """Each of four engines has one entry for each of five fields, in the form the README gives"""
    listing.expect_complete(listing.entries(submission))


@pytest.mark.task("engine_facts")
@pytest.mark.points(3)
def test_facts_sources(submission):
    """Every fact names an address as its source and a day on which it held"""
    listing.expect_sources(listing.entries(submission))
