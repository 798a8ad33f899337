"""Engines are set for a test by two written rules, and what the rules chose is what the data say."""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path

import pytest

from course.engines import base, reference
from course.engines.registry import ENGINES
from course.engines.scenarios import BOXES, SCENARIOS

ROOT = Path(__file__).resolve().parents[3]
PAIRS = [(engine, scenario) for engine in ENGINES for scenario in SCENARIOS]


def _script(name: str):
    path = ROOT / "tests" / "benchmarks" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
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


# -- one source --------------------------------------------------------------------------------------------


def test_the_tables_of_the_page_are_made_from_the_measurements():
    pages = _script("engines_pages")
    page = (ROOT / "docs" / "engines.md").read_text(encoding="utf-8")
    assert pages.made(page) == page
    assert page.count("<!-- made: ") == 4


def test_the_direct_scripts_confirm_at_least_four_results_of_every_engine():
    folder = ROOT / "tests" / "benchmarks" / "engines_direct"
    sys.path.insert(0, str(folder))
    try:
        import compare
    finally:
        sys.path.remove(str(folder))
    results = json.loads(compare.RESULTS.read_text(encoding="utf-8"))
    assert set(results) == set(ENGINES)
    for engine, lines in results.items():
        verdicts = {(line["test"], line["setting"]): compare.judged(engine, line)[0] for line in lines}
        assert "differs" not in verdicts.values(), engine
        confirmed = {test for (test, _), verdict in verdicts.items() if verdict == "same"}
        assert len(confirmed) >= 4, (engine, verdicts)


def test_what_is_said_of_single_options_is_what_the_direct_scripts_found():
    path = ROOT / "tests" / "benchmarks" / "engines_direct" / "results.json"
    found = {
        (engine, line["test"], line["setting"]): line
        for engine, lines in json.loads(path.read_text(encoding="utf-8")).items()
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
    folder = ROOT / "tests" / "benchmarks" / "engines_direct"
    scripts = [*folder.glob("direct_*.py"), folder / "measures.py"]
    assert len(scripts) == len(ENGINES) + 1
    for script in scripts:
        text = script.read_text(encoding="utf-8")
        assert "import course" not in text
        assert "from course" not in text
