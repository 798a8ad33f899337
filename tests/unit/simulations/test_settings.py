"""What --set takes and what it refuses, each refusal with its place and its fix."""

import contextlib
import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.errors import NotFoundError, UsageError
from course.simulations.base import describe, parse, run
from course.simulations.registry import SIMULATIONS, get


def refused(name, *pairs):
    with pytest.raises(UsageError) as caught:
        run(get(name), pairs)
    return caught.value


def test_values_are_read_with_units_fractions_and_spaces():
    fall = get("free-fall")
    assert parse(fall, ["step=1/240"])["step"] == 1 / 240
    assert parse(fall, ["height = 3 m", "gravity=1.62m/s²"]) | {} == {
        **fall.defaults(), "height": 3.0, "gravity": 1.62
    }  # fmt: skip
    assert parse(fall, ["method=rk4"])["method"] == "rk4"
    assert parse(get("substeps"), ["links=7"])["links"] == 7


@given(st.floats(0.01, 1000))
def test_every_number_comes_back_as_it_was_written(value):
    assert parse(get("free-fall"), [f"gravity={value!r}"])["gravity"] == value


def test_an_unknown_key_is_answered_with_all_that_are_known_their_units_ranges_and_defaults():
    error = refused("free-fall", "hight=3")
    assert error.message == "--set hight=3: free-fall has no parameter 'hight'."
    assert "height (m, above 0 to 100000, default 10): where the ball starts" in error.help
    assert "method (explicit_euler | semi_implicit_euler | velocity_verlet | rk4" in error.help


@pytest.mark.parametrize(
    ("name", "pair", "words"),
    [
        ("free-fall", "step=0", "range 1e-05 to 1 s"),
        ("free-fall", "step=-0.01", "range 1e-05 to 1 s"),
        ("free-fall", "step=nan", "must be a finite number"),
        ("free-fall", "step=inf", "must be a finite number"),
        ("free-fall", "step=1/0", "not a number"),
        ("free-fall", "step=0.01 m", "step is in s, not in m"),
        ("free-fall", "step=quick", "'quick' is not a number"),
        ("free-fall", "height=0", "range above 0 to 100000 m"),
        ("free-fall", "method=euler", "method is one of explicit_euler, semi_implicit_euler"),
        ("free-fall", "step", "not of the form key=value"),
        ("free-fall", "=3", "not of the form key=value"),
        ("substeps", "links=7.5", "must be a whole number"),
        ("collision", "restitution=1m", "restitution has no unit, not in m"),
    ],
)
def test_a_value_that_cannot_be_used_is_named_with_its_place(name, pair, words):
    error = refused(name, pair)
    assert error.exit_code == 2
    assert error.message.startswith(f"--set {pair}: ")
    assert words in error.message
    assert error.help


def test_a_key_set_twice_is_refused():
    assert "step is set twice" in refused("free-fall", "step=0.01", "step=0.02").message


def test_a_step_that_does_not_divide_the_duration_names_both_and_what_would_do():
    error = refused("free-fall", "duration=5", "step=0.3")
    assert error.message.startswith(
        "--set duration=5 and --set step=0.3: A step of 0.3 s does not divide 5 s"
    )
    assert "or a step of 5/17 s or 0.3125 s" in error.message
    assert run(get("free-fall"), ["duration=5", "step=5/17"]).settings["step"] == 5 / 17


def test_more_steps_than_anyone_waits_for_are_refused():
    error = refused("free-fall", "duration=1000", "step=1e-5")
    assert "100,000,000 steps; at most 200,000" in error.message
    assert "0.005 s or more" in error.help


@pytest.mark.parametrize(
    ("name", "pairs", "words"),
    [
        ("collision", ["radius=6"], "take a distance above 12 m"),
        ("dynamics", ["end_x=2", "end_y=2"], "reaches places 0 m to 2 m"),
        ("dynamics", ["end_x=2", "end_y=0"], "straight or folded"),
        ("rotation", ["inertia3=4"], "No body has the moments"),
        ("rotation", ["spin=0", "nudge=0"], "does not turn"),
        ("chaos", ["duration=0.05"], "too few to see"),
        ("substeps", ["work=64", "links=100", "duration=60"], "take too long"),
        ("environment", ["speed=20", "gravity=0.1"], "more than 20,000 steps"),
        ("environment", ["speed=0.1", "step=0.05"], "stops within one step"),
        ("projectile", ["speed_z=1000", "drag=1"], "more than the whole speed in one step"),
        ("dynamics", ["payload=10", "step=0.1"], "runs away"),
        ("chaos", ["step=0.05"], "runs away"),
        ("dynamics", ["end_x=1.2", "end_y=-0.8"], "starts where it should end"),
        ("chaos", ["angle1_deg=0", "angle2_deg=0"], "hang straight down"),
    ],
)
def test_values_that_are_impossible_together_are_said(name, pairs, words):
    error = refused(name, *pairs)
    assert words in error.message
    assert f"{name} knows:" in error.help


@pytest.mark.soak
@pytest.mark.parametrize("name", SIMULATIONS)
def test_at_the_ends_of_its_ranges_a_simulation_runs_or_says_what_does_not_fit(name, monkeypatch):
    """Each parameter, and each two, at either end; warnings are errors."""
    monkeypatch.setattr("course.simulations.base.MAX_STEPS", 2000)
    lows = {"step": 1e-3} | {p.name: 1e-6 for p in get(name).parameters if p.above}
    ends = [
        [f"{p.name}={end}" for end in p.choices or (lows.get(p.name, p.low), p.high)]
        for p in get(name).parameters
    ]
    for one, other in itertools.combinations([[None], *ends], 2):
        for pairs in itertools.product(one, other):
            with contextlib.suppress(UsageError):
                assert run(get(name), [pair for pair in pairs if pair]).rows


@pytest.mark.parametrize("name", SIMULATIONS)
def test_every_default_lies_in_its_own_range_and_is_described(name):
    simulation = get(name)
    again = [
        f"{p.name}={p.default!r}" if not p.choices else f"{p.name}={p.default}" for p in simulation.parameters
    ]
    assert parse(simulation, again) == simulation.defaults()
    assert all(p.name in describe(p) and p.meaning in describe(p) for p in simulation.parameters)


def test_an_unknown_simulation_is_answered_with_the_closest():
    with pytest.raises(NotFoundError, match="no simulation 'free_fal'") as caught:
        get("free_fal")
    assert caught.value.exit_code == 5
    assert "Did you mean free-fall?" in caught.value.help
    with pytest.raises(NotFoundError) as caught:
        get("xyzzy")
    assert "Did you mean" not in caught.value.help
