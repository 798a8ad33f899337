"""The course's own questions, and their numbers against the physics."""

import re
from collections import Counter
from functools import cache

import numpy as np
import pytest

from course.authoring.audit import audit_quiz
from course.authoring.report import Findings
from course.catalog.load import Catalog
from course.physics import integrators as steppers
from course.physics.contact.models import Constraint, drop
from course.physics.systems import FreeFall, Oscillator
from course.quizzing.bank import Bank, pose_case


@pytest.fixture(scope="module")
def bank():
    return Bank.of(Catalog())


def cases(bank, question, variant):
    """Each case of a variant: its numbers as they are shown, and the question as it is posed."""
    document = next(document for document in bank.documents if document.value.id == question)
    index = next(i for i, entry in enumerate(document.value.variant) if entry.id == variant)
    for case in range(document.value.variant[index].cases):
        yield pose_case(document, index, case)


def numbers(text):
    return [float(found.replace(",", "")) for found in re.findall(r"\d[\d,]*(?:\.\d+)?", text)]


def test_the_audit_finds_nothing(bank):
    catalog = Catalog()
    findings = Findings(catalog.content.root)
    assert audit_quiz(catalog, findings) == bank.ids
    assert findings.sorted() == ()


def test_every_variant_is_reached_in_a_thousand_seeds(bank):
    for document in bank.documents:
        question = document.value
        reached = Counter(bank.variant(question.id, seed) for seed in range(1000))
        for variant in question.variant:
            assert reached[variant.id] > 0.6 * 1000 / len(question.variant)


def test_every_option_is_explained_and_every_wrong_one_has_its_belief(bank):
    for document in bank.documents:
        for index in range(len(document.value.variant)):
            for choice in pose_case(document, index, 0).choices:
                assert len(choice.explanation.split()) >= 8
                assert bool(choice.belief) is not choice.right
                assert "{" not in choice.text + choice.explanation


def test_the_key_cannot_be_told_by_its_length(bank):
    """The key is the longest of four, or the shortest, hardly more often than by chance; in a first attempt,
    which asks the first variants, whoever takes the longest gets no more than one of five."""
    ranks = []
    for document in bank.documents:
        rows = [pose_case(document, index, 0) for index in range(len(document.value.variant))]
        ranks.append([sum(len(c.text) < len(shown.key.text) for c in shown.choices) for shown in rows])
    every = [rank for rows in ranks for rank in rows]
    assert every.count(3) < 0.3 * len(every)
    assert every.count(0) < 0.5 * len(every)
    assert [rows[0] for rows in ranks].count(3) <= 1


def test_whoever_picks_ode_reads_the_claim_and_what_its_manual_says(bank):
    (document,) = [document for document in bank.documents if document.value.id == "which-engine"]
    shown = [pose_case(document, index, 0) for index in range(len(document.value.variant))]
    history = [one for one in shown if any(choice.text == "ODE" for choice in one.choices)]
    for one in history:
        (ode,) = [choice for choice in one.choices if choice.text == "ODE"]
        assert "designed specifically for robots" in ode.explanation
        assert "manual" in ode.explanation
        assert "2006" in ode.explanation + one.source
    assert [one.key.text for one in history] == ["MuJoCo", "ODE", "DART", "PhysX", "ODE"]
    # As many again ask how to choose, and no name of an engine answers those.
    assert len(shown) - len(history) >= len(history)


def test_what_the_questions_on_choosing_say_of_engines_is_in_the_reference():
    from course.engines import reference
    from course.engines.registry import ENGINES

    def value(engine, scenario, setting):
        found = reference.row(engine, scenario, setting).value
        assert found is not None
        return found

    # "Several engines whose ball lies still at first give the right height to a few per cent."
    still = [name for name in ENGINES if value(name, "small-drop", "default") < 0.5]
    assert sum(abs(value(name, "small-drop", "tuned") - 5.0) < 0.2 for name in still) >= 2
    # "All have fallen 0.5 % too far": several do, whatever is set.
    assert sum(abs(value(name, "free-fall", "tuned") - 0.5) < 5e-4 for name in ENGINES) >= 3
    # "May lose its lead": the fastest comes with a stack that moves; one that stands costs half of its rate.
    fast = max(ENGINES, key=lambda name: value(name, "boxes", "default"))
    assert value(fast, "stack", "default") > 1.0
    assert value(fast, "boxes", "tuned") < 0.5 * value(fast, "boxes", "default")
    # "Some engines approximate the cone by a pyramid": 1.41 along the diagonal.
    solid = [name for name in ENGINES if name != "pymunk"]
    assert sum(value(name, "diagonal", "default") > 1.3 for name in solid) >= 2


# -- the numbers, against the physics --------------------------------------------------------------------


def motion(stepper, system, q, h, steps):
    """From rest, so many steps."""
    return steppers.trajectory(stepper, system, steppers.State.at_rest([q]), h, round(steps))


def test_the_energy_of_the_spring_is_what_explicit_euler_gives(bank):
    for shown in cases(bank, "numerical-integration", "growing-spring"):
        omega, h, t_end = numbers(shown.prompt)
        path = motion(steppers.ExplicitEuler(), Oscillator(omega=omega), 1.0, h, t_end / h)
        energy = path.v[:, 0] ** 2 + (omega * path.q[:, 0]) ** 2
        assert numbers(shown.key.text)[0] == pytest.approx(energy[-1] / energy[0], rel=0.006)


@pytest.mark.parametrize(
    ("option", "stepper"), [("too-low", steppers.SemiImplicitEuler), ("too-high", steppers.ExplicitEuler)]
)
def test_the_bias_of_the_falling_ball_is_what_the_methods_give(bank, option, stepper):
    for shown in cases(bank, "numerical-integration", "falling-ball"):
        t_end, h = numbers(shown.prompt)[:2]
        path = motion(stepper(), FreeFall(), 0.0, h, t_end / h)
        off = path.q[-1, 0] + 9.81 * t_end**2 / 2
        choice = shown.choice(option)
        assert abs(off) == pytest.approx(numbers(choice.text)[0], rel=0.006)
        assert ("low" in choice.text) == (off < 0)


def test_the_stiff_contact_blows_up_just_above_the_limit(bank):
    for shown in cases(bank, "numerical-integration", "stiff-contact"):
        k, m = numbers(shown.prompt)[:2]
        limit = numbers(shown.key.text)[0] / 1000
        spring = Oscillator(omega=float(np.sqrt(k / m)))
        paths = [
            motion(steppers.SemiImplicitEuler(), spring, 1.0, h, 500) for h in (0.99 * limit, 1.01 * limit)
        ]
        grown = [np.abs(path.q).max() for path in paths]
        assert grown[0] < 20
        assert grown[1] > 1e20


def test_the_finer_verlet_error_falls_as_the_method_does(bank):
    @cache
    def error(h):
        path = motion(steppers.VelocityVerlet(), Oscillator(omega=1.0), 1.0, h, 6.0 / h)
        return float(abs(path.q[-1, 0] - np.cos(6.0)))

    for shown in cases(bank, "numerical-integration", "finer-verlet"):
        err, finer = numbers(shown.prompt)[:2]
        measured = err * error(0.01 / finer) / error(0.01)
        assert numbers(shown.key.text)[0] == pytest.approx(measured, rel=0.01)


def test_the_block_that_is_moved_first_creeps_as_far_as_the_key_says(bank):
    for shown in cases(bank, "numerical-integration", "moved-first"):
        _, _, h, _, t_end = numbers(shown.prompt)[:5]
        x = v = 0.0
        for _ in range(round(t_end / h)):
            v += h * 9.81 * 0.6
            x += h * v
            v = 0.0  # friction holds up to mu g cos(alpha), more than the slope asks for
        assert numbers(shown.key.text)[0] == pytest.approx(1000 * x, rel=0.006)


def test_the_correction_costs_the_energy_that_the_key_says_at_two_steps(bank):
    for shown in cases(bank, "numerical-integration", "paid-correction"):
        (erp,) = (value for value in numbers(shown.prompt) if 0 < value < 1)
        for h in (0.01, 0.002):
            kept = []
            for phase in (np.arange(50) + 0.5) / 50:
                height = 2.0 + phase * h * np.sqrt(2 * 9.81 * 2.0)
                gaps, v = drop(Constraint(1.0, erp=erp), height, 0.0, h, round(1.7 / h))
                kept.append(gaps[int(np.argmax(v > 0)) :].max() / height)
            # Two digits are shown, and a step of h finds the ball a little deeper than v h/2.
            assert numbers(shown.key.text)[0] / 100 == pytest.approx(np.mean(kept) - 1, rel=0.08)


def test_the_sliding_box_stops_where_friction_says(bank):
    for shown in cases(bank, "sim-to-real-gap", "sliding-box"):
        v, mu_sim, d_sim, d_real = numbers(shown.prompt)[:4]
        assert d_sim == pytest.approx(v**2 / (2 * mu_sim * 9.81), rel=0.006)
        assert numbers(shown.key.text)[0] == pytest.approx(v**2 / (2 * d_real * 9.81), rel=0.006)


def test_the_twin_falls_behind_by_what_it_has_not_computed(bank):
    for shown in cases(bank, "digital-twin", "falling-behind"):
        factor, _, minutes = numbers(shown.prompt)
        simulated = round(minutes * 60_000) * 0.001 * factor
        assert numbers(shown.key.text)[0] == pytest.approx(minutes * 60 - simulated, abs=1e-3)


def test_training_time_is_steps_over_copies_and_speed(bank):
    for shown in cases(bank, "why-simulate", "training-time"):
        millions, step, copies, speed = numbers(shown.prompt)
        days, hours = numbers(shown.key.text)
        assert days == pytest.approx(millions * 1e6 * step / 86_400, rel=0.006)
        assert hours == pytest.approx(24 * millions * 1e6 * step / 86_400 / copies / speed, rel=0.006)
