"""What a scene asks and explains is true whatever was set: numbers are formulas, wrong ones are refused."""

import re

import msgspec
import pytest

from course.errors import ContentError, UsageError
from course.sandbox.runs.running import run
from course.sandbox.scene.expression import evaluate, fill, names, used
from course.sandbox.scene.loading import FOLDER, choose, compare, guess_of, read_scene, unsaid, values_of
from course.sandbox.views.story import Experiment
from course.sandbox.world.world import World

#: Numbers that stand in a question or its explanation although nothing but an edit of the file changes them.
FIXED = {
    "billiards-break": {"0.17"},  # kg
    "box-stack": {"10", "0.95"},  # cm, m
    "bullet-wall": {"2", "6"},  # cm
    "dominoes": {"4", "0.04", "90", "0.24"},  # cm, m, degrees; the pitch from which each falls flat, m
    "free-fall": {"0", "2"},  # where it starts, g t²/2
    "galton-board": {"100", "56", "70", "256", "71"},
    "head-on": {"1"},  # the right puck's speed, and the restitution of which a general sentence speaks
    "incline": {"0"},
    "newtons-cradle": {"1", "2"},  # rods of 1 m, (1 + e)/2
    "pendulum-wall": {"1"},
    "restitution-row": {"2"},
    "robot-boxes": {"0.3"},  # the track, in m
    "unequal-masses": set(),
}
NUMBER = re.compile(r"\d+(?:\.\d+)?")


def texts(name, settings=None):
    """Question and explanation of a scene."""
    chosen = choose(name, settings)
    said = compare(chosen.scene.prediction, 0.0, values_of(chosen), None)
    return f"{said.question} {said.why}"


@pytest.mark.parametrize("name", FIXED)
def test_numbers_that_are_written_out_are_those_that_nothing_changes(name):
    asked = choose(name).scene.prediction
    written = set(NUMBER.findall(re.sub(r"\{[^{}]*\}", "", f"{asked.question} {asked.why}")))
    assert written == FIXED[name]


def test_a_setting_that_changes_the_answer_and_no_word_is_found():
    scene = choose("head-on").scene
    plain = msgspec.structs.replace(scene.prediction, question="How fast?", why="It follows.")
    assert "restitution" in list(unsaid(msgspec.structs.replace(scene, prediction=plain)))


@pytest.mark.parametrize(
    ("name", "settings", "now", "stale"),
    [
        ("billiards-break", {"speed": 12.0}, ["12 m/s", "2.04 kg m/s"], ["6 m/s", "1.02"]),
        ("bullet-wall", {"speed": 10.0}, ["10 m/s", "0.0417 m"], ["100 m/s", "0.42", "one start of seven"]),
        ("bullet-wall", {"step": 0.0004}, ["0.0004 s", "0.04 m"], ["1/240", "0.42"]),
        ("dominoes", {"pitch": 0.2}, ["20 cm", "0.04/0.2"], ["12 cm", "0.12", "1/3"]),
        ("free-fall", {"step": 0.1}, ["0.1 s", "0.491 m"], ["hundredth", "0.049"]),
        ("head-on", {"restitution": 0.0}, ["pair is 0.", "0.5 m/s", "0 times that"], ["nothing is lost"]),
        ("head-on", {"speed": 5.0}, ["5 m/s", "6 m/s"], ["2 m/s, the right"]),
        ("incline", {"friction": 0.1}, ["0.05 of the", "4.48 m/s²"], ["0.4 "]),
        ("incline", {"angle": 45.0}, ["45 degrees", "sin 45°"], ["30"]),
        ("newtons-cradle", {"restitution": 0.9}, ["0.81", "0.905"], ["velocity on whole"]),
        ("newtons-cradle", {"angle": 60.0}, ["60 degrees", "3.13 m/s"], ["30"]),
        ("pendulum-wall", {"restitution": 0.3}, ["0.3 times that"], ["0.8"]),
        ("pendulum-wall", {"angle": 90.0}, ["90 degrees", "cos 90°", "4.43"], ["60"]),
        ("restitution-row", {"restitution": 0.5}, ["0.5 times that", "0.25 m"], ["0.8", "0.64"]),
        ("restitution-row", {"height": 4.0}, ["from 4 m", "2.56 m"], ["from 1 m", "0.64 m"]),
        ("robot-boxes", {"left": 1.0, "right": 0.25}, ["-0.75 m", "-2.5 rad/s"], ["0.05", "0.45", "1/6"]),
        ("unequal-masses", {"ratio": 0.01}, ["0.01 times", "puck at rest"], ["three times", "light one"]),
        ("unequal-masses", {"restitution": 0.5}, ["0.25 times the speed"], ["loses nothing in"]),
    ],
)  # fmt: skip
def test_what_was_set_is_what_is_said(name, settings, now, stale):
    said = texts(name, settings)
    for words in now:
        assert words in said
    for words in stale:
        assert words not in said


@pytest.mark.parametrize("step", [0.0001, 1 / 240, 0.1])
@pytest.mark.parametrize("speed", [1.0, 1000.0])
def test_the_jump_of_the_bullet_is_that_of_one_step_whatever_the_step(step, speed):
    done = run(choose("bullet-wall", {"step": step, "speed": speed}), guess=speed * step)
    assert done.probes["jump"] == pytest.approx(speed * step, rel=1e-9)
    assert done.comparison.theory == pytest.approx(speed * step, rel=1e-12)
    assert done.comparison.guess_right
    assert done.comparison.agree


@pytest.mark.parametrize(
    ("guess", "verdict"),
    [
        (1.621, "right."),
        (1.62, "right."),
        (1.6, "right."),
        (1.46, "close: 10 % too low."),
        (1.7, "close: 5 % too high."),
        (2.0, "23 % too high."),
        (-1.6, "off by 3.22 m/s."),
        (0.0, "off by 1.62 m/s."),
    ],
)
def test_a_guess_is_right_only_if_it_is_the_answer_rounded_to_its_digits(guess, verdict):
    asked = msgspec.structs.replace(
        choose("newtons-cradle").scene.prediction, question="?", why=".", theory="1.62129", agrees=1e-3
    )
    said = compare(asked, 1.6213, {}, guess)
    assert said.verdict == f"Your guess is {verdict} Theory and simulation agree."
    assert said.guess_right == (verdict == "right.")
    assert compare(asked, 1.9, {}, 1.9).verdict.startswith(
        "Your guess is right by the simulation. Theory and"
    )


@pytest.mark.parametrize("speed", [0.5, 3.0, 12.0])
def test_the_momentum_of_the_break_is_read_before_a_cushion_takes_some(speed):
    comparison = run(choose("billiards-break", {"speed": speed})).comparison
    assert comparison.agree, f"{comparison.theory} {comparison.simulation}"


@pytest.mark.parametrize("restitution", [0.9, 0.95])
def test_a_cradle_that_loses_something_is_foretold_as_well(restitution):
    comparison = run(choose("newtons-cradle", {"restitution": restitution}), duration=1.0).comparison
    assert comparison.agree, f"{comparison.theory} {comparison.simulation}"


@pytest.mark.parametrize(("settings", "duration"), [({}, 0.5), ({"step": 0.03}, None), ({}, 2.0)])
def test_theory_is_about_the_time_that_was_run(settings, duration):
    done = run(choose("free-fall", settings), duration=duration)
    assert done.comparison.agree
    assert f"falls for {done.duration:.4g} s" in done.comparison.question


def test_a_views_question_follows_what_is_set_in_it():
    chosen = choose("bullet-wall")
    world = World(chosen.scene, chosen.settings)
    experiment = Experiment(world, chosen, None, None)
    assert "0.004167 s" in experiment.report()["question"]
    world.set("step", 0.0004)
    experiment.felt("set")
    assert "0.0004 s" in experiment.report()["question"]
    experiment.answer(0.04)
    world.run_until(chosen.scene.duration)
    experiment.take(world.drain_events())
    experiment.passed()
    assert experiment.stage == "done"
    comparison = experiment.report()["comparison"]
    assert (comparison["simulation"], comparison["guess_right"]) == (pytest.approx(0.04), True)
    assert "0.0004 s" in comparison["question"]


@pytest.mark.parametrize(
    ("text", "filled"),
    [
        ("{a} and {b}", "0.4 and 30"),
        ("{a * b:.2f} m", "12.00 m"),
        ("{1 / 240}", "0.004167"),
        ("{a - b:+.1e}", "-3.0e+01"),
        ("{0 * -b} {-a / 1000:.1f}", "0 0.0"),
        ("{{a}}", "{a}"),
        ("{the_ball.vx}", "7"),
        ("nothing", "nothing"),
    ],
)
def test_a_text_is_filled_with_values(text, filled):
    assert fill(text, {"a": 0.4, "b": 30.0, "the_ball.vx": 7.0}) == filled


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "}",
        "{}",
        "{a",
        "{c}",
        "{a!r}",
        "{a:>9}",
        "{a:{b}}",
        "{1/(a-a)}",
        "{a.__class__}",
        "{a[0]}",
        "{a:.99f}",
    ],
)
def test_a_text_that_cannot_be_filled_is_refused(text):
    with pytest.raises(UsageError) as caught:
        fill(text, {"a": 0.4, "b": 30.0})
    assert caught.value.help


def test_a_formula_is_a_float_whatever_its_numbers():
    assert type(evaluate("2 * g", {"g": 3})) is float
    assert names("max(a, b.x) + pi") == {"a", "b.x"}


@pytest.mark.parametrize("text", ["", "'a' * 9", "1+" * 400 + "1", "unknown + 1", "1 / 0", "sqrt(1, 2)"])
def test_whatever_is_not_arithmetic_is_refused_in_words(text):
    with pytest.raises(UsageError) as caught:
        evaluate(text, {"a": 1.0, "x": 1.0})
    assert "formula" in caught.value.message
    assert len(caught.value.message) < 200


def test_names_of_a_text():
    assert used("{a * sqrt(b)} {ball.vx:.2f} c {pi}") == {"a", "b", "ball.vx"}


def broken(folder, name, old, new):
    """A scene of the course with one thing wrong, and the line of it."""
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    assert text.count(old) == 1
    path = folder / f"{name}.toml"
    path.write_text(text.replace(old, new), "utf-8")
    return path, text[: text.index(old)].count("\n") + 1


@pytest.mark.parametrize(
    ("name", "old", "new", "words"),
    [
        ("bullet-wall", "flies at {speed}", "flies at {sped}", "sped"),
        ("bullet-wall", "flies at {speed}", "flies at {speed", "brace"),
        ("bullet-wall", "flies at {speed}", "flies at {speed:>99}", "format"),
        ("bullet-wall", "flies at {speed}", "flies at {1 / 0}", "has no value"),
        ("bullet-wall", "{speed * step:.3g}", "{1 / (speed - 100)}", "has no value"),
        ("bullet-wall", "{speed * step:.3g}", "{sqrt(speed - 50)}", "at speed=1"),
        ("bullet-wall", "{speed * step:.3g}", "{left}", "left"),
        ("head-on", "stays {(speed - 1) / 2}", "stays {1 / left_puck.restitution}", "at restitution=0"),
        ("bullet-wall", 'time = "step"', 'time = "stop"', "stop"),
        ("bullet-wall", 'time = "step"', 'time = "1 / (step - step)"', "has no value"),
        ("bullet-wall", 'time = "step"', 'time = "2 * duration"', "which no run sees"),
        ("bullet-wall", 'time = "step"', 'time = "1"', "which no run sees"),
    ],
)
def test_a_scene_with_a_formula_that_has_no_value_is_refused_with_its_line(tmp_path, name, old, new, words):
    path, line = broken(tmp_path, name, old, new)
    with pytest.raises(ContentError) as caught:
        read_scene(path)
    assert caught.value.line == line
    assert words in caught.value.message
    with pytest.raises(UsageError, match=rf"{name}\.toml:{line}"):
        choose(str(path))


@pytest.mark.parametrize(
    ("typed", "guess"),
    [("0.42", 0.42), ("0,42 m", 0.42), (" 2e1m ", 20.0), ("42 cm", None), ("m", None), ("inf m", None)],
)
def test_a_guess_is_a_number_with_its_unit_or_without(typed, guess):
    assert guess_of(typed, "m") == guess
