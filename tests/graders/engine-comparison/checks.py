"""Hidden graders of ``engine-comparison``: eight engines drawn anew from the seed of each grading run.

Thresholds come from sweeps over seeds of every accepted solution; the table is in
``tests/benchmarks/calibration/engine-comparison.md``.
"""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
named = kit.words("engine-comparison")
judging = kit.companion("engine-comparison", "judging")
choosing = kit.companion("engine-comparison", "choosing")
listing = kit.companion("engine-comparison", "listing")
measured = kit.companion("engine-comparison", "measured")
lab = kit.reference("engine-comparison", "lab")
right = kit.reference("engine-comparison", "choosing")
choices = kit.sibling(__file__, "choices")
facts = kit.sibling(__file__, "facts")

#: Of the eight engines so many may bring a measurement down without taking the others with them.
SPARED = 2


unknown = lab.cases


# -- the report -----------------------------------------------------------------------------------------


@pytest.mark.task("characterise")
@pytest.mark.points(5)
def test_hidden_order(submission):
    """The order of eight unknown engines"""
    judging.expect_key(unknown(submission), "order", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_hidden_symplectic(submission):
    """Which of eight unknown engines conserve area"""
    judging.expect_key(unknown(submission), "symplectic", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(5)
def test_hidden_linear_damping(submission):
    """The damping of eight unknown engines"""
    judging.expect_key(unknown(submission), "linear_damping", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(6)
def test_hidden_max_stable_step(submission):
    """The largest stable step of eight unknown engines, zero and infinity among them"""
    judging.expect_key(unknown(submission), "max_stable_step", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(5)
def test_hidden_friction_anisotropy(submission):
    """The kind of friction cone of eight unknown engines"""
    judging.expect_key(unknown(submission), "friction_anisotropy", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_hidden_rest_penetration(submission):
    """How deep a body sinks into the floor, for eight unknown engines"""
    judging.expect_key(unknown(submission), "rest_penetration", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_hidden_restitution(submission):
    """The restitution of eight unknown engines"""
    judging.expect_key(unknown(submission), "restitution", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(5)
def test_hidden_tunnelling_speed(submission):
    """The speed at which bodies get through the wall, for eight unknown engines"""
    judging.expect_key(unknown(submission), "tunnelling_speed", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_hidden_deterministic(submission):
    """Which of eight unknown engines never repeat themselves"""
    judging.expect_key(unknown(submission), "deterministic", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_hidden_report_complete(submission):
    """The nine keys of the reports on eight unknown engines"""
    judging.expect_complete(submission, unknown(submission))


# -- the choice -----------------------------------------------------------------------------------------


@functools.lru_cache(maxsize=256)
def _questions(seed):
    """What is asked of ``choose_engine`` in one grading run, the same of every submission."""
    rng, truths = np.random.default_rng([seed, 0x63686F]), lab.truths(seed)
    reports = measured.reports()
    real = [(reports, needs, answer) for needs, answer in choices.REAL]
    real += [(reports, needs, answer) for needs, answer in measured.QUESTIONS.values()]
    telling = choices.questions(rng, truths, 12, choices.telling)
    return {
        "plain": [
            *telling[:8],
            *map(choices.passed_round, telling[:2]),
            choices.at_the_limit(rng, truths),
            choices.beyond_the_limit(rng, truths),
            choices.other_types(rng, truths),
            choices.priced_high(rng, telling[0]),
            choices.priced_in_whole_numbers(telling[3]),
            choices.priced_alike(rng, telling[1]),
            choices.priced_at_nothing(rng, telling[2]),
            *choices.questions(rng, truths, 1, choices.all_count),
        ],
        "gaps": [
            *(choices.with_gaps(rng, q) for q in telling[8:]),
            choices.beyond_reach(rng, truths),
            *(choices.nothing_told(rng, truths, op) for op in ("==", ">=")),
        ],
        "renamed": [*right.retold(rng, real), *choices.famous(telling[:4])],
    }


@pytest.mark.task("choose_engine")
@pytest.mark.points(4)
def test_choose_drawn(submission):
    """The cheapest of eight engines that meets all of several requirements"""
    choosing.expect_choices(submission, _questions(submission.seed)["plain"])


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
@pytest.mark.requires("choose_by_report")
def test_choose_gaps(submission):
    """Requirements that were not measured, and where nothing fits"""
    choosing.expect_choices(submission, _questions(submission.seed)["gaps"])


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
@pytest.mark.requires("choose_by_report")
def test_choose_real_again(submission):
    """The four real engines as measured, for other jobs"""
    reports = measured.reports()
    choosing.expect_choices(submission, [(reports, needs, answer) for needs, answer in choices.REAL])


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
@pytest.mark.requires("choose_by_report")
def test_choose_by_numbers_only(submission):
    """Other names, another order, a second call, and the reports"""
    choosing.expect_choices(submission, _questions(submission.seed)["renamed"])
    needs = [measured.need("slope_error", "<=", 0.001), measured.need("pendulum_loss", "<=", 0.09)]
    choosing.expect_untouched(submission, measured.reports(), needs)


# -- the facts ------------------------------------------------------------------------------------------


@pytest.mark.task("engine_facts")
@pytest.mark.points(2)
def test_facts_licences(submission):
    """The licences, their SPDX names and their dates"""
    entries = listing.entries(submission)
    for engine in listing.ENGINES:
        entry = listing.expect_pair(entries, (engine, "licence"))
        text = kit.as_text(entry["value"], "a licence")
        if not facts.right_licence(engine, text):
            kit.fail(
                f"The licence of {engine} is not right.",
                help="Read the licence file in the engine's present repository.",
                diagnose=lambda engine=engine, text=text: _of_licence(engine, text),
                input={"engine": engine},
                expected=sorted(facts.LICENCES[engine]),
                actual=text,
            )
        day = listing.date_of(entry)
        if engine in facts.SINCE and day is not None and day < facts.SINCE[engine]:
            kit.fail(
                f"The licence of {engine} has a date on which the engine had another licence.",
                diagnose=named("DATE_BEFORE_FACT"),
                input={"engine": engine},
                expected=f"{facts.SINCE[engine]} or later",
                actual=entry["as_of"],
            )


@pytest.mark.task("engine_facts")
@pytest.mark.points(2)
def test_facts_defaults(submission):
    """Default integrators and default steps"""
    entries = listing.entries(submission)
    for engine in listing.ENGINES:
        entry = listing.expect_pair(entries, (engine, "default_integrator"))
        integrator = facts.plain(kit.as_text(entry["value"], "a default integrator"))
        if integrator != facts.INTEGRATOR:
            option = (engine, integrator) in {("mujoco", "rk4"), ("mujoco", "implicit_euler")}
            slip = "OPTION_TAKEN_FOR_DEFAULT" if option else None
            slip = "INTEGRATOR_BY_NAME" if integrator == "explicit_euler" else slip
            kit.fail(
                f"The default integrator of {engine} is not right.",
                help="Find out which half of the state is updated first, and what the other half uses.",
                diagnose=named(slip) if slip else None,
                input={"engine": engine},
                expected=facts.INTEGRATOR,
                actual=integrator,
            )
        entry = listing.expect_pair(entries, (engine, "default_step_s"))
        _expect_step(engine, entry["value"])


@pytest.mark.task("engine_facts")
@pytest.mark.points(2)
def test_facts_users(submission):
    """The languages, and the projects in the lists of users"""
    entries = listing.entries(submission)
    for engine in listing.ENGINES:
        language = kit.as_text(listing.expect_pair(entries, (engine, "language"))["value"], "a language")
        if not facts.right_language(engine, language):
            binding = facts.languages(language) <= facts.INTERFACES[engine]
            kit.fail(
                f"The language of {engine} is not the one that the engine is written in.",
                help="Look at the files of the engine itself, not of an interface in another language.",
                diagnose=named("LANGUAGE_OF_INTERFACE") if binding else None,
                input={"engine": engine},
                expected=sorted(facts.LANGUAGES[engine]),
                actual=language,
            )
        names = kit.as_list(listing.expect_pair(entries, (engine, "used_by"))["value"], "the list of users")
        names = [kit.as_text(name, "a user of an engine") for name in names]
        stale = engine == "ode" and any(map(facts.is_new_gazebo, names))
        if stale or not any(facts.right_user(engine, name) for name in names):
            kit.fail(
                "A project in the list of users does not use this engine."
                if stale
                else "None of the projects in the list of users is known to use this engine.",
                help="Name projects whose own documentation says that they run on it.",
                diagnose=named("GAZEBO_SIM_USES_DART") if stale else None,
                input={"engine": engine},
                actual=names,
            )


def _of_licence(engine, text):
    code = facts.licence_mistake(engine, text)
    return code and named(code)


def _expect_step(engine, value):
    """The engine's own step, or None where its caller has to choose."""
    own = facts.STEPS[engine]
    if value is None and None in own:
        return
    number = None if value is None else listing.step_of(value, "a default step")
    close = number is not None and any(
        step is not None and math.isclose(number, step, rel_tol=0.005) for step in own
    )
    if not close:
        in_ms = any(
            step is not None and number is not None and math.isclose(number, 1000 * step, rel_tol=0.005)
            for step in own
        )
        slip = "STEP_IS_THERE" if value is None else "STEP_IN_MILLISECONDS" if in_ms else "STEP_OF_OTHERS"
        kit.fail(
            f"The default step of {engine} is not the engine's own.",
            help="Find where the step is set, as an argument or as an option, and whether it has a "
            "default there.",
            diagnose=named("STEP_OF_A_HABIT" if own == (None,) else slip),
            input={"engine": engine},
            expected=list(own),
            actual=value,
        )
