"""Numbers, curves and lines beside the terminal's picture."""

import numpy as np
import pytest

from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Stage
from course.sandbox.views.terminal.words import (
    bars,
    clean,
    head,
    keys_line,
    panel,
    shown,
    speed_in_words,
    wrapped,
)
from course.sandbox.world.world import World


def plain(line):
    return "".join(text for text, _ in line)


@pytest.mark.parametrize(
    ("value", "scale", "text"),
    [
        (4.905, 5.0, "4.905"),
        (-0.0003, 1.0, "-3.0e-4"),
        (1e-12, 1.0, "0"),
        (0.0, 0.0, "0"),
        (12345.6, 1.0, "12346"),
        (float("nan"), 1.0, "none"),
        (-123456789.0, 1.0, "-1.2e8"),
    ],
)
def test_numbers_are_short_and_a_rounding_error_is_nothing(value, scale, text):
    assert shown(value, scale) == text


def test_no_number_is_wider_than_its_column():
    for exponent in range(-40, 40):
        for mantissa in (-9.99999, -1.0, 1.0, 9.99999):
            assert len(shown(mantissa * 10.0**exponent)) <= 7


def test_bars_rise_with_what_they_show():
    (line,) = bars(np.linspace(0.0, 1.0, 80), 8, 0.0, 1.0)
    assert line == "".join(sorted(line))
    assert (line[0], line[-1]) == ("▁", "█")
    upper, lower = bars(np.array([0.0, 1.0]), 2, 0.0, 1.0, height=2)
    assert (upper, lower) == (" █", "▁█")


def test_bars_fill_their_width_however_few_values_there_are():
    for count in (0, 1, 3, 200):
        assert [len(line) for line in bars(np.ones(count), 12, 0.0, 0.0, height=2)] == [12, 12]


def test_nothing_a_terminal_would_obey_gets_through():
    assert clean("a\x1b[31mb\r\n\tc\u202ed\x9b2J") == "a [31mb c d 2J"


def test_words_wrap_and_too_long_ones_are_cut():
    assert wrapped("one two three", 8) == ["one two", "three"]
    assert wrapped("abcdefghij", 4) == ["abcd", "efgh", "ij"]


@pytest.mark.parametrize("width", [20, 40, 60, 80, 160])
def test_lines_above_and_below_fit(width):
    world = World(choose("newtons-cradle").scene)
    world.speed = 1 / 1024
    assert len(plain(head(world, 0.0, "", 0.3, width))) <= width
    assert len(plain(keys_line(width, paused=True, past=True))) <= width


def test_the_key_of_the_question_names_what_it_shows():
    for compared, word in ((False, "p predict"), (True, "p result")):
        assert word in plain(keys_line(80, paused=True, past=False, compared=compared))


def test_a_slow_machine_is_named_and_a_quick_one_is_not():
    world = World(choose("head-on").scene)
    assert "manages 30 %" in plain(head(world, 0.0, "", 0.3, 120))
    assert "manages" not in plain(head(world, 0.0, "", 1.0, 120))


@pytest.mark.parametrize(("width", "height"), [(23, 10), (23, 19), (27, 19), (43, 40), (43, 60)])
@pytest.mark.parametrize("scene", ["newtons-cradle", "robot-boxes"])
def test_the_panel_fits_and_its_energies_add_up(scene, width, height):
    stage = Stage(choose(scene))
    stage.world.run_until(0.3)
    lines = panel(stage, [("angle", "30 deg")], width, height)
    assert len(lines) <= height
    assert {len(plain(line)) for line in lines if len(line) == 3} == {width}
    if height >= 19:
        values = [
            plain(line).split() for line in lines[: next(i for i, x in enumerate(lines) if "Mom" in plain(x))]
        ]
        parts = {"motion", "height", "contacts", "friction", "solver"}
        named = {words[0]: float(words[-1]) for words in values if words and words[0] in {*parts, "="}}
        assert named.keys() == {*parts, "="}
        assert sum(named[name] for name in parts) == pytest.approx(named["="], abs=0.01)


def test_beside_the_past_stands_what_was_then():
    stage = Stage(choose("pendulum-wall"), clock=lambda: 0.0)
    before = [plain(line) for line in panel(stage, (), 43, 40)]
    for _ in range(20):
        stage.tick(0.07)
    stage.look(0.0)
    past = [plain(line) for line in panel(stage, (), 43, 40)]
    assert [line.split()[-1:] for line in past] == [line.split()[-1:] for line in before]
    stage.present()
    assert past != [plain(line) for line in panel(stage, (), 43, 40)]


def test_speeds_are_said_in_words():
    assert [speed_in_words(s) for s in (1.0, 0.125, 2.0)] == [
        "real time",
        "1/8 of real time",
        "2 x real time",
    ]


def test_a_run_is_compared_exactly_where_it_was_told_to():
    stage = Stage(choose("head-on"), clock=lambda: 0.0)
    while stage.experiment.stage != "done":
        before = stage.world.steps
        stage.tick(0.07)
    assert before < stage.world.steps == 480


def test_where_room_is_short_every_setting_is_still_there():
    lines = [plain(line) for line in panel(Stage(choose("newtons-cradle")), (), 23, 15)]
    for name in ("gravity", "restitution", "friction", "step h", "iterations", "along y"):
        assert any(name in line for line in lines), name
