"""How reports on the engines of ``engine-comparison`` are judged, and what is known of real ones.

What known wrong programs are told is in ``solutions/engine-comparison/record.json``, which the audit keeps.
"""

import contextlib
import dataclasses
import math
import types
from pathlib import Path

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission
from course.catalog.load import Catalog
from course.engines import reference
from course.scoring import kit
from course.scoring.judging.submission import Submission
from course.scoring.verdict import format_input
from tests.benchmarks.calibration.seeds import Seeded

ROOT = Path(__file__).resolve().parents[3]
HIDDEN = str(ROOT / "tests/graders/engine-comparison/checks.py")
bench = kit.companion("engine-comparison", "bench")
boxes = kit.companion("engine-comparison", "boxes")
choosing = kit.companion("engine-comparison", "choosing")
judging = kit.companion("engine-comparison", "judging")
listing = kit.companion("engine-comparison", "listing")
measured = kit.companion("engine-comparison", "measured")
probing = kit.companion("engine-comparison", "probing")
lab = kit.reference("engine-comparison", "lab")
right = kit.reference("engine-comparison", "choosing")
choices = kit.sibling(HIDDEN, "choices")
facts = kit.sibling(HIDDEN, "facts")

THREE = {"anvil": boxes.ANVIL, "balsa": boxes.BALSA, "cork": boxes.CORK}


def cases_of(report, run=lambda box: [("free", (0.0,), (0.0,), 0.1, 1, (0.0,))]):
    """The three known engines with what ``report(truth)`` makes of their right reports, and runs of each."""
    return [
        bench.Case(name, box, boxes.TRUTH[name], runs=run(box), report=report(dict(boxes.TRUTH[name])))
        for name, box in THREE.items()
    ]


def finding(check, *given):
    """What a check finds where it fails."""
    with pytest.raises(kit.CheckFailed) as failed:
        check(*given)
    return failed.value.finding


# -- judging ----------------------------------------------------------------------------------------------


def test_the_hidden_engines_are_the_same_for_every_submission_of_a_run_noise_included():
    for first, second in zip(lab.population(3), lab.population(3), strict=True):
        runs = [box.run("wall", [-1.0], [3.0], box.dt, 50, [0.0]) for box in (first, second)]
        assert np.array_equal(*runs)


def test_an_engine_that_brings_the_measurement_down_does_not_take_the_others_with_it():
    def characterise(engine):
        omega = engine.info()["omega"]
        if omega == boxes.BALSA.omega:
            raise ZeroDivisionError
        return dict(boxes.TRUTH["anvil" if omega == boxes.ANVIL.omega else "cork"])

    fake = LocalSubmission("", replaced={"characterise": characterise})
    found = bench.cases(fake, "x", lambda: [bench.Case(n, b, boxes.TRUTH[n]) for n, b in THREE.items()])
    judging.expect_key(found, "order", 1)
    with pytest.raises(kit.StudentFailure):
        judging.expect_key(found, "order", 0)
    with pytest.raises(kit.StudentFailure):
        judging.expect_complete(fake, found)


@pytest.mark.parametrize(
    ("key", "wrong"),
    [
        *((key, bad) for key in bench.KEYS for bad in (None, "two", [2], {"p": 2}, math.nan, -1.5, 1e9)),
        *(("order", bad) for bad in (1.5, 2.0011)),
    ],
)
def test_a_value_that_is_none_of_its_kind_or_off_costs_its_own_points_and_not_those_of_the_form(key, wrong):
    found = cases_of(lambda truth: truth | {key: wrong})
    said = finding(judging.expect_key, found, key, 0).message
    assert key in said or said.startswith(judging.MESSAGES[key])
    for other in set(bench.KEYS) - {key}:
        judging.expect_key(found, other, 0)
    judging.expect_complete(types.SimpleNamespace(call_each=lambda *_: None), found)


def springs(box):
    """Runs of a spring over the same time, of an order one above a wrong one, and not two."""
    return [("spring", (0.6,), (0.9 * box.omega,), 1 / box.omega / n, n, (0.0,)) for n in (10, 20, 40)]


def hits(box):
    """A run that ends after the wall is hit."""
    return [("wall", (-box.radius - box.wall_thickness / 2 - 0.1,), (2.0,), box.dt, 60, (0.0,))]


@pytest.mark.parametrize(
    ("key", "slip", "code", "runs"),
    [
        # Nothing that was run speaks for any of the mistakes with such values.
        ("order", lambda t: min(t["order"], 3), None, ()),
        ("order", lambda t: t["order"] + (t["order"] == 1), None, ()),
        ("order", lambda t: t["order"] - 2 * (t["order"] == 4), None, (springs,)),
        ("linear_damping", lambda t: 3.3, None, ()),
        ("tunnelling_speed", lambda t: 0.8 * t["tunnelling_speed"], None, ()),
        ("friction_anisotropy", lambda t: 1.0, "ANISOTROPY_ASSUMED", ()),  # no sign of rounding
        ("friction_anisotropy", lambda t: float(round(t["friction_anisotropy"] + 0.2)), None, ()),
        ("symplectic", lambda t: t["order"] > 1, None, ()),
        ("restitution", lambda t: 0.97, None, (hits,)),
        # Twice the rate with the wrong sign, and a ratio at another speed: of two mistakes, the sign is seen.
        ("linear_damping", lambda t: -2.0 * t["linear_damping"], "DAMPING_SIGN", ()),
        (
            "restitution",
            lambda t: -0.8 * t["restitution"] * (t["restitution"] != 0.6),
            "RESTITUTION_SIGN",
            (),
        ),
    ],
)
def test_a_probe_says_what_it_sees_and_no_more(key, slip, code, runs):
    found = cases_of(lambda truth: {**truth, key: slip(truth)}, *runs)
    assert finding(judging.expect_key, found, key, 0).diagnosis == code


@pytest.mark.parametrize("scope", ["public", "full"])
def test_of_two_keys_that_are_wrong_each_is_told_its_own_mistake(scope):
    catalog = Catalog()
    exercise = catalog.exercise("engine-comparison")
    source = (ROOT / "solutions/engine-comparison/engine_comparison.py").read_text() + (
        "\n_o, _d = _order, _linear_damping\n_order = lambda engine, omega: _o(engine, omega) + 1\n"
        "_linear_damping = lambda engine, dt: 2 * _d(engine, dt)\n"
    )
    with Seeded(exercise, catalog, scope=scope) as session:
        session.here = True
        checks = session.grade(Submission({exercise.module: source.encode()})).checks
    told = {check.id.removeprefix("hidden_"): check.diagnosis for check in checks if check.status != "pass"}
    assert told == {"order": "ORDER_LOCAL", "linear_damping": "DAMPING_OF_ENERGY"}


def test_a_value_is_called_kept_only_where_it_is_that_of_an_engine_that_shows_the_same():
    found, truth = cases_of(dict), {**boxes.TRUTH["balsa"], "linear_damping": 2.1}
    other = dataclasses.replace(boxes.BALSA, damping=2.1, omega=2.5)
    found.append(bench.Case("twin", other, truth, runs=found[0].runs, report=dict(boxes.TRUTH["balsa"])))
    assert finding(judging.expect_key, found, "linear_damping", 0).diagnosis is None


def test_a_value_that_is_a_small_whole_number_of_info_by_chance_is_not_shown_beside_it():
    truth = {**boxes.TRUTH["anvil"], "friction_anisotropy": 1.0}
    case = bench.Case("anvil", boxes.ANVIL, truth, report={**truth, "friction_anisotropy": boxes.ANVIL.mass})
    shown = finding(judging.expect_key, [case], "friction_anisotropy", 0).input
    assert boxes.ANVIL.mass not in shown.values()


# -- choosing ---------------------------------------------------------------------------------------------


def chooser(function):
    """A submission whose ``choose_engine`` is the given function."""
    return LocalSubmission("", replaced={"choose_engine": function})


def test_an_exception_that_comes_where_everything_was_measured_too_is_shown_with_its_call():
    reports, needs = {"a": {"noise_db": None, "limit": 0.5, "cost": 1.0}}, [measured.need("limit", "<=", 1)]
    asked = []

    def choose(*args):
        asked.append(args)
        return args[1]["key"]

    with pytest.raises(kit.StudentFailure):  # which says nothing of missing values
        choosing.expect_choices(chooser(choose), [(reports, needs, "a"), (reports, needs, None)])
    assert asked[-1] == (reports, needs)


@pytest.mark.parametrize(
    ("value", "costs", "shown"),
    [
        (0.6000000000000001, (1.0, 2.0), ["0.6000000000000001"]),
        (0.6, (17.9157, 17.91570001), ["17.9157", "17.91570001"]),
        (0.6, (2**53, 2**53 + 1), ["9007199254740992", "9007199254740993"]),
    ],
)
def test_digits_that_decide_are_shown(value, costs, shown):
    reports = {name: {"restitution": 0.6, "cost": cost} for name, cost in zip("ab", costs, strict=True)}
    needs = [measured.need("restitution", "==", value)]
    found = finding(choosing.expect_choices, chooser(lambda *_: "b"), [(reports, needs, "a")])
    told = format_input(found.input)
    assert all(f": {digits}}}" in told for digits in shown)


def test_an_argument_that_was_changed_is_seen_whatever_was_put_there():
    spoils = chooser(lambda reports, needs: reports.update(a=np.zeros(3)))
    given = {"a": {"cost": 1.0}}, [measured.need("order", ">=", 2)]
    assert finding(choosing.expect_untouched, spoils, *given).diagnosis == "MUTATES_INPUT"


REAL_QUESTIONS = [*measured.QUESTIONS.values(), *choices.REAL]


def test_every_question_about_real_engines_has_one_cheapest_answer():
    reports = measured.reports()
    for needs, answer in REAL_QUESTIONS:
        fitting = [n for n, report in reports.items() if all(right.meets(report, need) for need in needs)]
        costs = sorted(reports[name]["cost"] for name in fitting)
        assert right.choose(reports, needs) == answer
        # Rates differ by up to a quarter from one measurement to the next; that must decide nothing.
        assert len(costs) < 2 or costs[1] > 1.5 * costs[0]
        # Each that is cheaper and not chosen fails a requirement by a tenth at least.
        cost = reports[answer]["cost"] if answer else math.inf
        for other in (report for report in reports.values() if report["cost"] < cost):
            assert any(_fails_clearly(other, need) for need in needs), (answer, other)


def _fails_clearly(report, need):
    value, op, limit = report.get(need["key"]), need["op"], need["value"]
    if value is None or op == "==":
        return value is None or value != limit
    return value > 1.1 * limit if op == "<=" else value < 0.9 * limit


#: What is measured in a scenario, by key of a report, and in which unit it is told.
SCENARIOS = {
    "slope_error": ("slide", 0.01), "rebound_m": ("bounce", 1.0), "clash_error": ("clash", 0.01),
    "pendulum_loss": ("double-pendulum", 0.01), "stack_mm": ("stack", 1.0), "rate": ("boxes", 1.0),
    "tonne_mm": ("mass-ratio", 1.0), "diagonal": ("diagonal", 1.0), "fall_error": ("free-fall", 0.01),
}  # fmt: skip


def shipped(setting, key):
    """The measurement that a key of a report comes from, and how a value of it is told."""
    (engine, words), (scenario, unit) = setting.split(", "), SCENARIOS[key]
    row = reference.row(engine, scenario, measured.SETTINGS[words])
    return row, lambda value: unit * (abs(value) if "error" in key else value)


def test_what_is_chosen_meets_its_requirements_in_every_phase_and_from_every_start():
    for needs, answer in REAL_QUESTIONS:
        for need in needs if answer else ():
            if (key := need["key"]) in SCENARIOS:
                row, told = shipped(answer, key)
                reach = map(told, (row.lowest, row.highest))
                assert all(right.meets({key: x}, need) for x in reach), (answer, need)


def test_the_reports_of_real_engines_are_the_measurements_that_ship():
    for setting, report in measured.reports().items():
        for key in ("rebound_m", "fall_error", "slope_error", "pendulum_loss", "rate", "clash_error"):
            row, told = shipped(setting, key)
            found = max(map(abs, row.samples)) if key == "clash_error" else row.value
            assert report[key] == pytest.approx(told(found), rel=0.006)
        assert report["cost"] == pytest.approx(1 / report["rate"], rel=0.006)
    keys = {need["key"] for needs, _ in REAL_QUESTIONS for need in needs} - {"price_eur"}
    assert keys <= set(next(iter(measured.reports().values())))


# -- facts ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("judge", "asked", "found"),
    [
        # A licence is right if every choice it offers is.
        (facts.right_licence, ("ode", "(LGPL-2.1-or-later OR BSD-3-Clause)"), True),
        (facts.right_licence, ("ode", "BSD-3-Clause"), True),
        (facts.right_licence, ("ode", "BSD-3-Clause OR GPL-3.0-only"), False),
        (facts.right_licence, ("bullet", "zlib"), True),
        (facts.right_licence, ("mujoco", "Apache 2.0"), False),
        (facts.licence_mistake, ("ode", "LGPL"), "NOT_SPDX"),
        (facts.licence_mistake, ("bullet", "free"), None),
        # A language is right if the engine is written in it, with a little C beside it.
        (facts.right_language, ("ode", "C/C++"), True),
        (facts.right_language, ("ode", "C"), False),
        (facts.right_language, ("bullet", "c++ and C"), True),
        (facts.right_language, ("physx", "C++17"), True),
        (facts.right_language, ("physx", "C#"), False),
        (facts.right_language, ("mujoco", "C, C++"), True),
        (facts.right_language, ("mujoco", "C and Python"), False),
        # Gazebo counts for ODE only by its old name.
        (facts.right_user, ("ode", "Gazebo Classic"), True),
        (facts.right_user, ("ode", "Gazebo"), False),
    ],
)
def test_a_fact_is_judged_by_what_it_says(judge, asked, found):
    assert judge(*asked) == found


@pytest.mark.parametrize("value", ["None", "0.002"])
def test_a_step_in_quotation_marks_is_told_as_that(value):
    found = finding(listing.step_of, value, "the default_step_s of ode")
    assert found.actual == repr(value)
    assert "quotation marks" in found.help


@pytest.mark.parametrize("bad", [None, 3, [1, [2]], np.zeros(3), {"a": 1}, 10**400, "", True])
@pytest.mark.parametrize("key", listing.KEYS)
def test_an_entry_with_any_one_value_spoilt_is_the_students(key, bad):
    """Or right all the same: a list of users may be an array, a step may be None."""
    entries = [
        {"engine": e, "field": f, "value": v, "source": "https://ode.org/manual", "as_of": "2026-01-02"}
        for e in listing.ENGINES
        for f, v in zip(listing.FIELDS, ("MIT", "C++", "rk4", 0.01, ["x"]), strict=True)
    ]
    for place, entry in enumerate(entries):
        for judge in (listing.expect_complete, listing.expect_sources):
            with contextlib.suppress(kit.CheckFailed):
                judge([*entries[:place], entry | {key: bad}, *entries[place + 1 :]])
