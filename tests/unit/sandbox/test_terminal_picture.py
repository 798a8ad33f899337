"""The terminal's picture: what is where, and what is sent; and the numbers, curves and lines beside it."""

from dataclasses import replace

import numpy as np
import pytest

from course.sandbox.scene.loading import choose
from course.sandbox.views.stage import Stage
from course.sandbox.views.terminal.picture import PAPER, Camera, Overlay, Picture, Spark, label_of
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

SIZE = (52, 19)


def pictured(scene, *, colour=True):
    world = World(choose(scene).scene)
    return world, Picture(world.parts, Camera.fit(world.scene.view, *SIZE), colour=colour)


def text(cells):
    return "\n".join("".join(map(chr, row)) for row in cells.char)


def test_a_place_is_drawn_in_the_cell_that_stands_for_it():
    camera = Camera.fit((-2.0, -1.5, 2.0, 1.5), 80, 24)
    for column, row in ((0, 0), (79, 23), (40, 12), (7, 20)):
        assert camera.cell(*camera.place(column, row)) == (column, row)


@pytest.mark.parametrize("size", [(10, 4), (52, 19), (114, 40), (200, 5)])
def test_all_of_the_view_fits_into_any_window(size):
    camera = Camera.fit((-3.0, -6.0, 3.0, 1.0), *size)
    for x, y in ((-2.999, -5.999), (2.999, 0.999)):
        column, row = camera.cell(x, y)
        assert 0 <= column < size[0]
        assert 0 <= row < size[1]


def test_a_ball_is_drawn_where_it_is_and_nowhere_else():
    world, picture = pictured("head-on")
    cells = picture.draw(world.snapshot(), Overlay())
    shot = world.snapshot()
    at = {picture.camera.cell(float(x), float(y)) for x, y in zip(shot.x, shot.y, strict=True)}
    for column, row in at:
        assert int(cells.paper[row, column]) != PAPER
    filled = int(((cells.paper != PAPER) | (cells.char != ord(" "))).sum())
    # Two discs of a radius of 0.2 m, in cells of one by two pixels, and a rim of one cell around each.
    radius = 0.2 * picture.camera.scale
    assert 2 * np.pi * radius**2 / 2 * 0.8 < filled < 2 * np.pi * (radius + 1.5) ** 2 / 2


def test_only_rows_that_differ_are_named_and_only_as_far_as_they_do():
    world, picture = pictured("head-on")
    before = picture.draw(world.snapshot(), Overlay())
    assert picture.draw(world.snapshot(), Overlay()).changes(before) == []
    world.run_until(0.2)
    after = picture.draw(world.snapshot(), Overlay())
    changes = after.changes(before)
    assert 0 < len(changes) < SIZE[1] / 2
    rows = {row for row, _, _ in changes}
    for row in range(SIZE[1]):
        same = (before.paper[row] == after.paper[row]).all() and (before.ink[row] == after.ink[row]).all()
        assert (row not in rows) == (same and (before.char[row] == after.char[row]).all())
    for row, first, count in changes:
        for column in (first, first + count - 1):
            assert (before.paper[row, column], before.ink[row, column]) != (
                after.paper[row, column],
                after.ink[row, column],
            ) or before.char[row, column] != after.char[row, column]


def test_without_colour_characters_tell_shapes_apart_and_no_colour_is_used():
    world, picture = pictured("robot-boxes", colour=False)
    world.spawn("circle", 1.5, 1.0, size=0.3)
    picture = Picture(world.parts, picture.camera, colour=False)
    cells = picture.draw(world.snapshot(), Overlay())
    assert not cells.ink.any()
    assert not cells.paper.any()
    shown = text(cells)
    assert "o" in shown
    assert "#" in shown
    assert "→" in shown  # the robot looks along x
    world, picture = pictured("newtons-cradle", colour=False)
    shown = text(picture.draw(world.snapshot(), Overlay()))
    assert "▒" in shown  # the beam, which is fixed
    assert "·" in shown  # rods
    assert "1" in shown  # ball-1


@pytest.mark.parametrize("colour", [True, False])
def test_what_is_smaller_than_a_pixel_is_seen_nevertheless(colour):
    world, picture = pictured("bullet-wall", colour=colour)
    assert 0.02 * picture.camera.scale < 0.5  # the wall is thin, the bullet small
    cells = picture.draw(world.snapshot(), Overlay())
    shot = world.snapshot()
    for x, y in zip(shot.x, shot.y, strict=True):
        column, row = picture.camera.cell(float(x), float(y))
        near = (slice(max(0, row - 1), row + 2), slice(max(0, column - 1), column + 2))
        seen = (cells.char[near] != ord(" ")).any() or (colour and (cells.paper[near] != PAPER).any())
        assert seen


def test_a_body_that_is_nowhere_or_far_away_is_left_out():
    world, picture = pictured("head-on")
    shot = world.snapshot()
    x = shot.x.copy()
    x[0], x[1] = np.nan, 1e300
    cells = picture.draw(replace(shot, x=x, hand=(0.0, 0.0, np.inf, 0.0)), Overlay(names=True))
    assert (cells.paper == PAPER).all()


@pytest.mark.parametrize("colour", [True, False])
def test_a_hand_a_pointer_and_a_flash_are_drawn(colour):
    world, picture = pictured("head-on", colour=colour)
    bare = picture.draw(world.snapshot(), Overlay())
    for over in (
        Overlay(pointer=(0.0, 1.0)),
        Overlay(pull=(0.0, 1.0, 0.5, 1.2)),
        Overlay(sparks=(Spark(0.0, 1.0, 1.0),)),
    ):
        assert picture.draw(world.snapshot(), over).changes(bare)


def test_labels_are_short_and_keep_the_number():
    assert [label_of(name) for name in ("ball-12", "left-puck", "robot")] == ["12", "l", "r"]


# -- what stands beside it -------------------------------------------------------------------------------


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


def test_where_room_is_short_every_setting_is_still_there():
    lines = [plain(line) for line in panel(Stage(choose("newtons-cradle")), (), 23, 15)]
    for name in ("gravity", "restitution", "friction", "step h", "iterations", "along y"):
        assert any(name in line for line in lines), name
