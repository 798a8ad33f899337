"""Public checks of ``engine-comparison``: run as often as you like, and once more when you submit.

At home the engines are the three of ``boxes.py`` and the questions those below. In a grading run the
engines are three of the eight that are drawn for it, and names, order and costs in the questions are others.
"""

from __future__ import annotations

import math

import pytest

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
boxes = kit.companion("engine-comparison", "boxes")
judging = kit.companion("engine-comparison", "judging")
choosing = kit.companion("engine-comparison", "choosing")
listing = kit.companion("engine-comparison", "listing")
measured = kit.companion("engine-comparison", "measured")

questions = kit.companion("engine-comparison", "questions")

need = measured.need

#: One of the three may bring a measurement down without taking the other two with it.
SPARED = 1


def known(submission, draw):
    """The three engines of ``boxes.py``, each characterised once; in a grading run three drawn ones."""
    if draw is not None:
        return kit.reference("engine-comparison", "lab").three(submission)
    return bench.cases(
        submission,
        "known",
        lambda: [bench.Case(name, box, boxes.TRUTH[name]) for name, box in questions.KNOWN.items()],
    )


#: What is known of ``questions.ENDS``. Largest stable steps: none; any; the first limit, where the
#: eigenvalues of two unequal steps leave the unit circle; three times the root of three, Kutta's limit, which
#: is more than ten seconds here. The
#: last one misses the wall where a step is as long as wall and body, 0.28 m.
ENDS = (
    {"max_stable_step": 0.0},
    {"max_stable_step": math.inf},
    {"max_stable_step": 2.2195 / boxes.ANVIL.omega},
    {"max_stable_step": 2.3781 / boxes.ANVIL.omega},
    {"max_stable_step": 5.1962 / 0.4, "order": 3, "tunnelling_speed": 168.0},
)


def ends(submission):
    """Engines that are unlike the three, most of all in their largest stable step, at home."""
    made = zip(questions.ENDS.items(), ENDS, strict=True)
    return bench.cases(
        submission,
        "ends",
        lambda: [bench.Case(name, box, dict(truth)) for (name, box), truth in made],
    )


def known_and(key, submission, draw):
    """The three, and at home also those of ``ENDS`` of which this key is known."""
    others = ends(submission) if draw is None else []
    return known(submission, draw) + [case for case in others if key in case.truth]


def asked(draw, told):
    """Questions about choosing; in a grading run with other names, another order and other costs."""
    return told if draw is None else kit.reference("engine-comparison", "choosing").retold(draw, told)


@pytest.mark.task("characterise")
@pytest.mark.points(4)
def test_order(submission, draw):
    """The order of three engines, and at home of one of third order"""
    judging.expect_key(known_and("order", submission, draw), "order", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_symplectic(submission, draw):
    """Which of three engines conserve area"""
    judging.expect_key(known(submission, draw), "symplectic", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(4)
def test_linear_damping(submission, draw):
    """The damping of three engines"""
    judging.expect_key(known(submission, draw), "linear_damping", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(3)
def test_max_stable_step(submission, draw):
    """The largest stable step of three engines"""
    judging.expect_key(known(submission, draw), "max_stable_step", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(0)
def test_max_stable_step_at_its_ends(submission, draw):
    """The largest stable step, at home also where it is zero, infinite or the first of two"""
    found = known(submission, draw) if draw is not None else ends(submission)
    judging.expect_key(found, "max_stable_step", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_friction_anisotropy(submission, draw):
    """How much harder a diagonal push must be, for three engines"""
    judging.expect_key(known(submission, draw), "friction_anisotropy", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_rest_penetration(submission, draw):
    """How deep a body sinks into the floor, for three engines"""
    judging.expect_key(known(submission, draw), "rest_penetration", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_restitution(submission, draw):
    """The restitution of three engines"""
    judging.expect_key(known(submission, draw), "restitution", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_tunnelling_speed(submission, draw):
    """The speed at which bodies get through the wall"""
    judging.expect_key(known_and("tunnelling_speed", submission, draw), "tunnelling_speed", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_deterministic(submission, draw):
    """Which of three engines never repeats itself"""
    judging.expect_key(known(submission, draw), "deterministic", SPARED)


@pytest.mark.task("characterise")
@pytest.mark.points(2)
def test_report_complete(submission, draw):
    """The nine keys of a report, and whether it stays as it was"""
    judging.expect_complete(submission, known(submission, draw))


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
def test_choose_by_report(submission, draw):
    """The cheapest of three engines that meets every requirement"""
    reports = _priced(cork=5.0, anvil=8.0, balsa=1.0)
    needs = [need("order", ">=", 2)]
    told = asked(
        draw,
        [
            (_priced(cork=4.0, anvil=4.1, balsa=1.0), needs, "cork"),
            (_priced(cork=7.1, anvil=7.0, balsa=1.0), needs, "anvil"),
            (_priced(cork=7.0 + 1e-9, anvil=7.0, balsa=1.0), needs, "anvil"),
            (_priced(cork=7.0, anvil=7.0 + 1e-9, balsa=1.0), needs, "cork"),
            (_priced(cork=0.0, anvil=7.0, balsa=1e-9), needs, "cork"),
            (reports, [], "balsa"),
            (reports, [need("order", ">=", 2)], "cork"),
            (reports, [need("symplectic", "==", True)], "anvil"),
            (reports, [need("restitution", "==", 0.6)], "anvil"),
            (reports, [need("order", "==", 2.0)], "anvil"),  # 2, too
            (reports, [need("deterministic", "==", 1), need("order", ">=", 2)], "anvil"),
            (reports, [need("order", "<=", 2), need("order", ">=", 2)], "anvil"),
            (reports, [need("tunnelling_speed", ">=", 100.0)], "anvil"),
            (_priced(cork=5e9, anvil=8e9, balsa=1e9), needs, "cork"),
            (reports, [need("order", ">=", 2), need("deterministic", "==", True)], "anvil"),
            (reports, [need("max_stable_step", ">=", 0.6), need("linear_damping", "<=", 2.0)], "balsa"),
            (
                reports,
                [need("rest_penetration", "<=", 0.0), need("tunnelling_speed", ">=", 100)],
                "anvil",
            ),
        ],
    )
    # Each in both orders: whichever of two engines comes first, it is not chosen for that.
    turned = [(dict(reversed(given.items())), needs, answer) for given, needs, answer in told]
    # Whole costs of which floats are the same: these stay in a grading run.
    dear = _priced(cork=2**53 + 1, anvil=2**53, balsa=1)
    close = [(given, needs, "anvil") for given in (dear, dict(reversed(dear.items())))]
    close.append((_priced(cork=2**53, anvil=2**53 + 1, balsa=1), needs, "cork"))
    choosing.expect_choices(submission, [*told, *turned, *close])


def _priced(**costs):
    """The right reports of anvil, balsa and cork, in the order given, with what each costs."""
    return {name: {**boxes.TRUTH[name], "cost": cost} for name, cost in costs.items()}


@pytest.mark.task("choose_engine")
@pytest.mark.points(2)
def test_choose_nothing(submission, draw):
    """The choice where no engine meets all requirements, and where one does"""
    reports = {
        "anvil": {**boxes.TRUTH["anvil"], "cost": 2.0, "noise_db": None},
        "balsa": {**boxes.TRUTH["balsa"], "cost": 1.0},
    }
    choosing.expect_choices(
        submission,
        asked(
            draw,
            [
                (reports, [need("order", ">=", 3)], None),
                (reports, [need("order", "==", 2), need("symplectic", "==", False)], None),
                (reports, [need("noise_db", "<=", 60.0)], None),
                (reports, [need("noise_db", ">=", 60.0)], None),
                (reports, [need("order", ">=", 2)], "anvil"),
                (reports, [need("noise_db", "==", 0.0)], None),
                (reports, [need("noise_db", "==", False)], None),
                (reports, [need("restitution", "==", 0.6003)], None),
                (reports, [need("restitution", "==", math.nextafter(0.6, 1.0))], None),
                (reports, [need("restitution", ">=", math.nextafter(0.6, 1.0))], None),
                (reports, [need("restitution", ">=", 0.6004)], None),
                (reports, [need("restitution", "<=", 0.3886)], None),
                (reports, [need("restitution", "<=", math.nextafter(0.389, 0.0))], None),
                (reports, [need("linear_damping", "<=", 2.0)], "balsa"),
                (
                    reports,
                    [need("order", ">=", 2), need("symplectic", "==", True), need("restitution", ">=", 0.9)],
                    None,
                ),
            ],
        ),
    )
    choosing.expect_choices(submission, [({}, [], None), ({}, [need("order", ">=", 1)], None)])


@pytest.mark.task("choose_engine")
@pytest.mark.points(3)
def test_choose_real_engines(submission, draw):
    """ODE, Bullet, PhysX and MuJoCo as measured, for six jobs"""
    told = [(measured.reports(), needs, name) for needs, name in measured.QUESTIONS.values()]
    choosing.expect_choices(submission, asked(draw, told))


@pytest.mark.task("choose_engine")
@pytest.mark.points(1)
def test_choose_by_numbers(submission, draw):
    """Other names, another order, and the arguments"""
    reports = {name: {**boxes.TRUTH[name], "cost": cost} for name, cost in
               (("cork", 5.0), ("anvil", 8.0), ("balsa", 1.0))}  # fmt: skip
    needs = [need("order", ">=", 2), need("linear_damping", "<=", 0.5)]
    swapped = {"balsa": reports["anvil"], "ode": reports["balsa"], "mujoco": reports["cork"]}
    # One requirement and three names, with the reports passed round: whoever keeps answers by names is wrong.
    alike = [need("order", ">=", 2)]
    passed = {"cork": reports["balsa"], "anvil": reports["cork"], "balsa": reports["anvil"]}
    told = asked(
        draw,
        [
            (reports, needs, "cork"),
            (swapped, needs, "mujoco"),
            (reports, alike, "cork"),
            (passed, alike, "anvil"),
        ],
    )
    # Famous names that fit and are not the cheapest; these names stay in a grading run.
    told += [
        ({name: reports["anvil"], "kifo": reports["cork"], "zaru": reports["balsa"]}, needs, "kifo")
        for name in measured.ENGINES
    ]
    choosing.expect_choices(submission, told)
    choosing.expect_untouched(submission, *told[0][:2])


@pytest.mark.task("engine_facts")
@pytest.mark.points(3)
def test_facts_complete(submission):
    """The entries for four engines and five fields"""
    listing.expect_complete(listing.entries(submission))


@pytest.mark.task("engine_facts")
@pytest.mark.points(3)
def test_facts_sources(submission):
    """The sources and the dates of the facts"""
    listing.expect_sources(listing.entries(submission))
