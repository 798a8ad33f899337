"""Scenes are data: the course's own hold together, and a wrong one is refused with its line."""

import math
from pathlib import Path

import pytest

import course
from course.errors import ContentError, NotFoundError, UsageError
from course.sandbox.runs.running import run
from course.sandbox.scene.loading import FOLDER, choose, read_scene, scene_ids, scenes
from course.sandbox.scene.model import layout

GOOD = """format_version = 1
id = "mine"
title = "Mine"
order = 1
teaches = "Something."
note = "A note."
after = "And then?"
view = [-1, -1, 1, 1]
gravity = [0, -9.81]

[[material]]
name = "wood"
restitution = 0.5

[[body]]
name = "floor"
shape = "box"
material = "wood"
size = [2, 0.1]
fixed = true

[[body]]
name = "ball"
shape = "circle"
material = "wood"
radius = 0.1
position = [0, 0.5]

[[probe]]
name = "height"
quantity = "y"
of = "ball"

[prediction]
question = "How high?"
probe = "height"
unit = "m"
theory = "ball.y - g * duration ** 2 / 2"
why = "It falls."
agrees_abs = 1.0
agrees_because = "A test."
"""
#: A parameter, and a formula with it: at one end of its range, which is 0.1, no scene takes a radius of -0.9.
DEEP = (
    '\n[[parameter]]\nname = "deep"\nmeaning = "How deep."\nunit = "m"\ndefault = 2\nlow = 0.1\nhigh = 5'
    '\n[sets]\n{} = "{}"'
)


def write(folder, text):
    path = folder / "mine.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_there_are_at_least_twelve_scenes_in_an_order_without_gaps():
    found = scenes()
    assert len(found) >= 12
    assert [scene.order for scene in found] == list(range(1, len(found) + 1))
    assert {scene.id for scene in found} == set(scene_ids())


@pytest.mark.parametrize("scene", scenes(), ids=lambda scene: scene.id)
def test_every_scene_teaches_asks_and_shows_what_it_holds(scene):
    assert scene.note.strip()
    assert scene.prediction is not None
    left, bottom, right, top = scene.view
    for part in layout(scene):
        assert left - 1 <= part.x <= right + 1, part.name
        assert bottom - 1 <= part.y <= top + 1, part.name


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("radius = 0.1", "radius = -0.1", 26, "radius"),
        ('material = "wood"\nradius', 'material = "would"\nradius', 25, "no material called would"),
        ('name = "ball"', 'name = "floor"', 23, "is taken"),
        ("radius = 0.1", "size = [1, 1]", 22, "lacks `radius`"),
        ('of = "ball"', 'of = "bell"', 32, "no body called bell"),
        ('probe = "height"', 'probe = "hight"', 36, "no probe called hight"),
        ('theory = "ball.y', 'theory = "bell.y', 38, "bell.y"),
        ('theory = "ball.y', "theory = \"__import__('os')", 38, "formula"),
        ('theory = "ball.y', 'theory = "9**9**9**9 * ball.y', 38, "has no value"),
        ("view = [-1, -1, 1, 1]", "view = [1, -1, -1, 1]", 8, "view is empty"),
        ("fixed = true", "fixed = true\nvelocity = [1, 0]", 15, "cannot move"),
        ("gravity = [0, -9.81]", "gravity = [0, -9810]", 9, "gravity"),
        ("radius = 0.1", "radius = 0.1\nbounciness = 1", 27, "unknown key `bounciness`"),
        ("agrees_abs = 1.0\n", "", 34, "how far may theory be off"),
        ("restitution = 0.5", "restitution = 1.5", 13, "restitution"),
        ("[[probe]]", "[probe]", 29, "`probe` is one table"),
        ("radius = 0.1", 'radius = 0.1\ncolour = "#FF0000"', 27, "six hexadecimal digits"),
        ('name = "ball"', 'name = "The ball"', 23, "small letters and digits"),
        ('A test."', 'A test."' + DEEP.format("ball.position.1", "deep"), 50, "divide it"),
        ('A test."', 'A test."' + DEEP.format('"ball.radius"', "deep - 1"), 50, "-0.9"),
        ('A test."', 'A test."' + DEEP.format("duration", "2"), 42, "depends on deep"),
        ('A test."', 'A test."' + DEEP.format("duration", "1 / (deep - 2)"), 49, "float division by zero"),
        ('A test."', 'A test."\n[[joint]]\nkind = "rod"\na = "ball"\nb = "ball"', 42, "two"),
    ],
)
def test_a_wrong_scene_is_refused_with_its_line(tmp_path, old, new, line, words):
    assert GOOD.count(old) == 1
    path = write(tmp_path, GOOD.replace(old, new))
    with pytest.raises(ContentError) as caught:
        read_scene(path)
    assert caught.value.line == line
    assert words in caught.value.message
    assert caught.value.help


def test_a_body_too_light_to_count_is_refused(tmp_path):
    """Its moment was rounded to 0, which the engine answered with an assertion of its own."""
    path = write(tmp_path, GOOD.replace("radius = 0.1", "radius = 0.1\nmass = 5e-324"))
    with pytest.raises(UsageError, match=r"ball has a mass of 4\.94066e-324 kg"):
        choose(str(path))


@pytest.mark.parametrize(
    "points", ["[[0, 0], [1, 0]]", "[[0,0],[1,0],[0.2,0.2],[0,1]]", "[[0,0],[1,1],[1,0],[0,1]]"]
)
def test_a_polygon_that_is_not_convex_is_refused(tmp_path, points):
    text = GOOD.replace('shape = "circle"', 'shape = "polygon"').replace("radius = 0.1", f"points = {points}")
    with pytest.raises(ContentError, match="not convex"):
        read_scene(write(tmp_path, text))


def test_a_polygon_stays_where_it_was_drawn_and_turns_about_its_middle(tmp_path):
    text = GOOD.replace('shape = "circle"', 'shape = "polygon"').replace(
        "radius = 0.1", "points = [[0, 0], [0.3, 0], [0, 0.3]]"
    )
    ball = layout(read_scene(write(tmp_path, text)))[1]
    assert (ball.x, ball.y) == pytest.approx((0.1, 0.6))
    assert sum(x for x, _ in ball.outline) == pytest.approx(0)
    # A right triangle of legs a about its centroid: m a²/9.
    assert ball.moment == pytest.approx(ball.mass * 0.3**2 / 9)


def test_an_unknown_scene_is_not_found_and_a_close_one_suggested():
    with pytest.raises(NotFoundError) as caught:
        choose("newton-cradle")
    assert caught.value.exit_code == 5
    assert "newtons-cradle" in caught.value.help


@pytest.mark.parametrize(
    "settings", [{"angle": 91}, {"wind": 1}, {"gravity": -1}, {"iterations": 2.5}, {"step": math.nan}]
)
def test_parameters_out_of_range_or_unknown_are_refused(settings):
    with pytest.raises(UsageError):
        choose("incline", settings)


def test_the_note_on_the_cradle_is_so():
    def last(**settings):
        return run(choose("newtons-cradle", settings), duration=1.0).probes["last-fastest"]

    pressed = {"gap": -1e-4}
    assert last(gap=0.0) == pytest.approx(last(), rel=1e-4)
    assert last(**pressed) < 0.5 * last()
    assert last(**pressed, iterations=1) > 2 * last(**pressed, iterations=1, backwards=1)


def test_the_seed_alone_decides_the_jitter():
    def places(seed):
        return [part.x for part in layout(choose("galton-board", {"seed": seed}).scene)]

    assert places(3) == places(3) != places(4)


def test_no_file_of_the_scenes_is_forgotten():
    assert {path.suffix for path in FOLDER.iterdir()} == {".toml"}


def test_the_template_of_a_new_scene_runs_as_it_is(tmp_path):
    template = Path(course.__file__).parent / "authoring" / "templates" / "scene.toml.tmpl"
    text = template.read_text(encoding="utf-8").replace("{{ id }}", "mine").replace("{{ order }}", "99")
    comparison = run(choose(str(write(tmp_path, text)))).comparison
    assert comparison.agree


def test_a_scene_has_its_number_in_the_list_too():
    assert [choose(str(number)).scene.id for number in (1, len(scenes()))] == [
        scenes()[0].id,
        scenes()[-1].id,
    ]
    with pytest.raises(NotFoundError):
        choose(str(len(scenes()) + 1))


def test_balls_that_bounce_far_do_not_agree_with_galton():
    """What the scene's last question is about; at its own restitution they do."""
    for restitution, agrees in ((0.5, True), (0.6, False)):
        compared = run(choose("galton-board", {"restitution": restitution})).comparison
        assert compared.agree == agrees
