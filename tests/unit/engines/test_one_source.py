"""No number about an engine is typed: each is computed from the measurements that ship, or is no measurement.

Cells, inline values and the tables of docs/engines.md are computed, and tests of their own compare them. Here
is what is left: sentences that name an engine and hold a number with a unit, in words or in figures; and the
two written rules by which engines are set for a test.
"""

import importlib.util
import json
import re
import sys
from pathlib import Path

import pytest

from course.engines import base, reference
from course.engines.findings import chaos, same_algorithm
from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED
from course.engines.scenarios import BOXES, SCENARIOS
from course.figures import engines as drawn
from course.physics.contact.models import SoftConvex, drop

ROOT = Path(__file__).resolve().parents[3]
DIRECT = ROOT / "tests" / "benchmarks" / "engines_direct"
PAGES = (
    "course/lessons/engines.md",
    "course/lessons/what-contact-leaves-over.md",
    "quiz/which-engine.toml",
    "exercises/engine-comparison/README.md",
    "exercises/engine-comparison/exercise.toml",
    "solutions/engine-comparison/README.md",
    "docs/engines.md",
    "README.md",
    "course/lessons/how-contact-is-solved.md",
)

_NAME = "engines?|pymunk|Chipmunk|MuJoCo|MJX|ODE|Bullet|PyBullet|Rapier|PhysX|DART|Box2D|Jolt"
_ENGINE = re.compile(rf"\b(?:{_NAME})\b")
_DIGITS = r"\d[\d,]*(?:\.\d+)?"
_WORDS = "half|third|quarter|tenth|hundredths?|two|three|four|five|six|seven|eight|nine|ten|hundred|thousand"
_UNIT = "%|mm|cm|km|m|m/s|ms|s|kg|Hz|x|times|digits|per cent|millimetres?|centimetres?|metres?|seconds?"
_MEASURED = re.compile(rf"(?<![\w.])(?:{_DIGITS}|{_WORDS}) (?:of an? )?(?:{_UNIT})(?![\w/])")
#: What is computed or quoted: code, tables made by a script, inline values, formulas, links, front matter.
_COMPUTED = (
    r"(?ms)^```.*?^```$",
    r"(?s)<!-- made: .*?<!-- end -->",
    r"(?ms)\A\+\+\+.*?^\+\+\+$",
    r"(?s)\n## Sources\n.*",
    r"\[[^\]]*\]\(<?=.*?\)(?=[\s.,;:%)]|$)",
    r"\$[^$]*\$",
    r"\]\([^)]*\)",
    r"Bullet (?:2\.84|3)\b|PhysX 5\.3",
)


def typed(page):
    """Numbers with a unit in sentences that name an engine."""
    text = (ROOT / page).read_text(encoding="utf-8")
    for pattern in _COMPUTED:
        text = re.sub(pattern, "Bullet" if "Bullet" in pattern else "", text)
    sentences = re.split(r"(?<=[.!?])\s+|\n\s*\n|\n(?=[-|>#])", text)
    return {
        found[0]
        for sentence in sentences
        if _ENGINE.search(sentence)
        for found in _MEASURED.finditer(" ".join(sentence.split()))
    }


def _default(engine, key):
    (one,) = [option for option in base.options_of(engine).option if option.key == key]
    return one.default


def _rests_mm():
    gaps, _ = drop(SoftConvex(), 0.0, 0.0, h=0.01, n=300)
    return -1000 * gaps[-1]


def _row(engine, scenario, setting=TUNED):
    return reference.row(engine, scenario, setting)


_LESSON, _CONTACT, _QUIZ, _DOCS = PAGES[0], PAGES[1], PAGES[2], PAGES[6]

#: What is no number of an engine: the sizes of a test, said where the test is set, and ways of speaking.
GIVEN = {
    (_QUIZ, "four times"),
    (_QUIZ, "ten times"),
    (_QUIZ, "ten seconds"),
    (_QUIZ, "three digits"),
    ("solutions/engine-comparison/README.md", "2 m/s"),
    # Box2D's and Unity's defaults: the lesson names their documentation.
    (_CONTACT, "1 m/s"),
    (_CONTACT, "2 m/s"),
}
#: What is one, and what it is checked against.
HOLDS = {
    (_LESSON, "2 m/s"): lambda: _default("physx", "bounce_threshold") == "2 m/s",
    (_LESSON, "10 %"): lambda: drawn.LARGE == 10.0,
    (_LESSON, "67 ms"): lambda: round(_row("rapier", "long-step").value) == 67,
    (_CONTACT, "0.37 millimetres"): lambda: round(_rests_mm(), 2) == 0.37,
    (_QUIZ, "0.5 %"): lambda: round(_row("mujoco", "free-fall").value, 2) == 0.5,
    (_DOCS, "two metres"): lambda: _row("physx", "thin-wall").options == {"contact_offset": 2.0},
}


@pytest.mark.parametrize("page", PAGES)
def test_a_number_beside_an_engine_is_computed_or_checked_here(page):
    assert typed(page) == {number for where, number in {*GIVEN, *HOLDS} if where == page}


@pytest.mark.parametrize(("page", "number"), HOLDS)
def test_what_is_typed_beside_an_engine_holds(page, number):
    assert HOLDS[page, number]()


def test_where_nothing_is_set_well_set_is_as_it_comes():
    """The tables say "the same" there."""
    for engine in ENGINES:
        for scenario in SCENARIOS:
            if (engine, scenario) == ("pymunk", "diagonal") or _row(engine, scenario).options:
                continue
            tuned, default = _row(engine, scenario), _row(engine, scenario, DEFAULT)
            if scenario == "boxes":  # a rate is another one each time
                assert abs(tuned.value - default.value) <= max(tuned.spread, default.spread), engine
            else:
                assert (tuned.value, tuned.samples) == (default.value, default.samples), (engine, scenario)


def test_what_the_page_on_engines_says_in_words_is_in_the_measurements():
    rows = reference.load().rows
    # "MuJoCo with its default integrator, Bullet 3 well set and DART end ... with the same energy"
    (same,) = same_algorithm(rows).split("start by start, in ")[1:]
    for name in ("MuJoCo", "Bullet 3", "DART"):
        assert name in same
    # "PhysX well set follows in single precision"
    ends = {e: _row(e, "double-pendulum").details["at_the_end_percent"] for e in ("dart", "physx")}
    assert ends["dart"] == pytest.approx(ends["physx"], rel=0.02)
    # "A ball does not bounce (MuJoCo), a pendulum stops (PhysX), a fall is short (Bullet 3)"
    assert _row("mujoco", "bounce", DEFAULT).value == 0.0 < _row("mujoco", "bounce").value
    assert _row("physx", "double-pendulum", DEFAULT).value > 50
    assert _row("physx", "double-pendulum").value < 10
    assert _row("pybullet", "free-fall", DEFAULT).value < 0 < _row("pybullet", "free-fall").value
    # "Bullet 3 has a switch, and with it off the energy is kept"
    assert _row("pybullet", "clash").options["contact_erp"] == 0.0
    assert abs(_row("pybullet", "clash").value) < 1e-3
    # "two degrees of the start decide whether the energy has grown or shrunk"
    assert min(ends["dart"]) < 0 < max(ends["dart"])
    assert "between -" in chaos(rows)
    # "a thin wall stops only slow ones" in what sweeps no ball, and in MuJoCo without its flag
    for engine in ("ode", "dart", "pymunk"):
        assert _row(engine, "thin-wall").value < 50, engine
    assert _row("mujoco", "thin-wall", DEFAULT).value < 50 < _row("mujoco", "thin-wall").value
    assert _row("mujoco", "thin-wall").options == {"speculative": True}
    # "friction is a pyramid, stronger along the diagonal"
    for engine in ("ode", "dart"):
        assert _row(engine, "diagonal").value == pytest.approx(2**0.5, rel=0.01)


def test_what_the_solution_says_of_four_engines_is_in_the_measurements():
    four = ("ode", "bullet", "physx", "mujoco")
    # Bullet: "a double pendulum swings on in it with the least change of energy of the four" ...
    change = {engine: _row(engine, "double-pendulum", DEFAULT).value for engine in four}
    assert min(change, key=change.get) == "bullet"
    # ... "a rebound depends on where in a step the ball lands, a clash gains energy, a box slides too slowly"
    assert _row("bullet", "bounce").highest > 2 * _row("bullet", "bounce").lowest
    assert _row("bullet", "clash").value > 0 > _row("bullet", "slide").value
    # PhysX: "slow bodies do not bounce; well set, its sliding and its collisions were exact"
    assert _row("physx", "small-drop", DEFAULT).value < 0.01
    assert abs(_row("physx", "slide").value) < 1e-3 > abs(_row("physx", "clash").value)
    # MuJoCo: "well set, it lost no energy worth measuring on a pendulum"
    assert _row("mujoco", "double-pendulum").value < 1e-3


PAIRS = [(engine, scenario) for engine in ENGINES for scenario in SCENARIOS]


def _script(name):
    path = ROOT / "tests" / "benchmarks" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def test_every_scenario_has_a_topic():
    assert set(base.TOPICS) == set(SCENARIOS)


@pytest.mark.parametrize("engine", ENGINES)
def test_every_option_says_what_it_does_where_that_is_written_and_what_is_tried(engine):
    listed = base.options_of(engine)
    assert listed.documented.startswith("https://")
    keys = [option.key for option in listed.option]
    assert len(keys) == len(set(keys))
    for option in listed.option:
        assert option.name
        assert option.default
        assert len(option.does.split()) >= 4
        assert option.values
        assert set(option.values) <= set(base.TOPICS.values())
        assert option.source == "" or option.source.startswith("https://")
    # Nobody reads a list of what is set without asking what is not.
    assert len(listed.left) >= 3
    assert all(left.name and len(left.does.split()) >= 4 for left in listed.left)


@pytest.mark.parametrize("engine", ENGINES)
def test_no_solver_is_offered_more_than_the_budget(engine):
    for option in base.options_of(engine).option:
        if option.key in ("iterations", "substeps"):
            tried = [value for values in option.values.values() for value in values]
            assert max(tried) == base.BUDGET


@pytest.mark.parametrize(("engine", "scenario"), PAIRS)
def test_what_was_chosen_was_tried_is_in_the_reference_and_is_no_worse_than_the_default(engine, scenario):
    chosen, one = base.choices()[engine][scenario], SCENARIOS[scenario]
    tried = list(base.candidates(engine, "stack" if scenario == BOXES else scenario))
    assert chosen.options in tried
    assert chosen.tried == len(tried)
    assert tried[0] == {}
    if (engine, scenario) == ("pymunk", "diagonal"):
        return
    default, tuned = (reference.row(engine, scenario, setting) for setting in ("default", "tuned"))
    assert (default.options, tuned.options) == ({}, chosen.options)
    if one.better == "large":
        assert one.truth is None or tuned.value >= default.value
    elif one.truth is not None:
        # Among errors that look the same on the screen, or nearly, the one that sets least is taken.
        slack = max(0.01 * abs(default.value - one.truth), 0.5 * 10.0**-one.digits)
        assert abs(tuned.value - one.truth) <= abs(default.value - one.truth) + slack


def test_each_option_that_is_set_has_a_reason():
    for engine, scenario in PAIRS:
        tuning = base.tuning(engine, scenario)
        assert len(tuning.why) == len(tuning.options)
    assert "iterations 100 instead of 10" in base.tuning("pymunk", "stack").why[0]


def test_the_boxes_are_stepped_as_the_stack_is():
    for chosen in base.choices().values():
        assert chosen[BOXES] == chosen["stack"]


def test_the_choice_takes_the_least_error_and_among_equals_what_sets_least():
    best = _script("engines_settings")._best
    bounce, wall = SCENARIOS["bounce"], SCENARIOS["thin-wall"]
    assert best(bounce, [(0.1, {}), (0.01, {"a": 1, "b": 2}), (0.01001, {"a": 1})]) == (0.01001, {"a": 1})
    assert best(bounce, [(0.1, {}), (0.1, {"a": 1})]) == (0.1, {})
    assert best(bounce, [(float("inf"), {}), (0.2, {"a": 1})]) == (0.2, {"a": 1})
    assert best(wall, [(-10.0, {}), (-400.0, {"a": 1})]) == (-400.0, {"a": 1})


def test_the_tables_of_the_page_are_made_from_the_measurements():
    pages = _script("engines_pages")
    page = (ROOT / "docs" / "engines.md").read_text(encoding="utf-8")
    assert pages.made(page) == page
    assert page.count("<!-- made: ") == 4


def test_the_direct_scripts_confirm_at_least_four_results_of_every_engine(monkeypatch):
    monkeypatch.syspath_prepend(DIRECT)
    import compare

    results = json.loads(compare.RESULTS.read_text(encoding="utf-8"))
    assert set(results) == set(ENGINES)
    for engine, lines in results.items():
        verdicts = {(line["test"], line["setting"]): compare.judged(engine, line)[0] for line in lines}
        assert "differs" not in verdicts.values(), engine
        confirmed = {test for (test, _), verdict in verdicts.items() if verdict == "same"}
        assert len(confirmed) >= 4, (engine, verdicts)


def test_what_is_said_of_single_options_is_what_the_direct_scripts_found():
    found = {
        (engine, line["test"], line["setting"]): line
        for engine, lines in json.loads((DIRECT / "results.json").read_text(encoding="utf-8")).items()
        for line in lines
    }
    # The older Bullet and the tonne: a hundred iterations are too few, a thousand hold it from every start.
    assert max(found["bullet", "mass-ratio", "100 iterations"]["samples"]) > 100
    assert max(found["bullet", "mass-ratio", "1000 iterations"]["samples"]) < 50
    # Split impulse changes nothing about its clash.
    came, split = (found["bullet", "clash", s]["samples"] for s in ("default", "split impulse"))
    assert split == pytest.approx(came)
    # Its slope is nearer with its own step of 1/60 s.
    own = found["bullet", "slide", "doPhysics(dt), a step of 1/60 s inside"]["value"]
    assert abs(own) < abs(found["bullet", "slide", "default"]["value"])
    # Bullet 3's energy from nowhere is the correction of overlaps; foreseen contacts stop its slow ball.
    assert found["pybullet", "clash", "no air, error correction left on"]["value"] > 5
    assert max(abs(x) for x in found["pybullet", "clash", "tuned"]["samples"]) < 1e-6
    assert found["pybullet", "small-drop", "no air, contacts foreseen"]["value"] < 0.5
    assert found["pybullet", "small-drop", "no air, contacts only where bodies touch"]["value"] > 5
    # PhysX: the friction of a joint costs more than the damping of its link, and both cost.
    swing = {s: line["value"] for (e, t, s), line in found.items() if (e, t) == ("physx", "pendulum")}
    assert swing["neither"] < swing["no friction in the joint"] < swing["no damping of the link"]
    # MuJoCo: with the damping ratio of a spring that may pull, the ball bounces too high.
    assert found["mujoco", "bounce", "damping ratio of a spring that may pull"]["value"] > 0.28


def test_a_direct_script_imports_nothing_of_the_course():
    scripts = [*DIRECT.glob("direct_*.py"), DIRECT / "measures.py"]
    assert len(scripts) == len(ENGINES) + 1
    for script in scripts:
        text = script.read_text(encoding="utf-8")
        assert "import course" not in text
        assert "from course" not in text
