"""The view in a terminal, played with textual's pilot: keys, mouse, questions, sizes, ends."""

import asyncio
from threading import Event

import pytest
from textual.widgets import Input, OptionList, Static

from course.errors import MissingCapabilityError, UsageError
from course.sandbox.runs.tape import Tape
from course.sandbox.scene.loading import choose, scene_ids
from course.sandbox.views.stage import Desk, Stage
from course.sandbox.views.terminal import view as terminal
from course.sandbox.views.terminal.app import SandboxApp
from course.sandbox.views.terminal.asking import Gallery, LineOverlay, PageOverlay
from tests.piloted import as_test


class Played(SandboxApp):
    """The view with a clock of its own: frames come when a test asks for them."""

    def __init__(self, scene):
        self.now = 0.0
        self.kept = []
        self.saved = {}

        def clock():
            return self.now

        stage = Stage(choose(scene), keep=self.kept.append, clock=clock) if scene else None

        def save(name, data):
            self.saved[name] = data
            return f"/home/me/{name}"

        super().__init__(stage, Desk(save=save, played={"free-fall"}), clock=clock)
        # A machine under load is no reason to step less here.
        self._budget = 1e9

    def begin(self):
        if self._gallery_first:
            self.action_scenes()

    def frames(self, count):
        for _ in range(count):
            self.now += 1 / 30
            self.tick()

    async def pressed(self, *keys, frames=1):
        """Keys are pressed, and so many frames are drawn after them."""
        await self.pilot.press(*keys)
        self.frames(frames)

    def at(self, name):
        """Column and row on the screen of a body."""
        shot = self.world.snapshot()
        row = [part.name for part in self.world.parts].index(name)
        column, line = self.sight.camera.cell(float(shot.x[row]), float(shot.y[row]))
        return column + self.canvas.region.x, line + self.canvas.region.y

    def point(self, name):
        """The pointer of the keys lies on a body."""
        column, row = self.at(name)
        self.pointer.at = column - self.canvas.region.x, row - self.canvas.region.y


def on(scene, size=(80, 24)):
    """Make a script a test that plays this scene."""

    async def played(script):
        app = Played(scene)
        async with app.run_test(size=size) as app.pilot:
            await app.pilot.pause()
            app.frames(1)
            await script(app, app.pilot)

    return lambda script: as_test(script, lambda given, **_: asyncio.run(played(given)))


@on("newtons-cradle")
async def test_keys_act_on_time_and_settings(app, pilot):
    world = app.world
    app.frames(3)
    assert world.t > 0
    await pilot.press("space")
    assert world.paused
    steps = world.steps
    app.frames(3)
    assert world.steps == steps
    await pilot.press("colon", "colon")
    assert world.steps == steps + 2
    await pilot.press("full_stop")
    assert world.t == pytest.approx((steps + 2) * 0.0005 + 1 / 60, abs=1e-3)
    await pilot.press("minus")
    assert world.speed == 0.5
    await pilot.press("plus", "equals_sign")
    assert world.speed == 2.0
    await pilot.press("G", "g", "g")
    assert world.settings["gravity"] == pytest.approx(9.81 - 0.5)
    await pilot.press("e", "F")
    # Steel has a restitution of 1 and no friction.
    assert world.settings["restitution"] == pytest.approx(0.95)
    assert world.settings["friction"] == pytest.approx(0.05)
    await pilot.press("h", "I")
    assert world.settings["step"] == pytest.approx(0.00025)
    assert world.settings["iterations"] == 60
    await pilot.press("r")
    assert world.steps == 0
    assert world.settings["gravity"] == pytest.approx(9.31)


@on("head-on")
async def test_settings_stop_at_their_ends(app, pilot):
    await pilot.press(*"EEE", *"g" * 3)
    assert app.world.settings["restitution"] == 1.0
    assert app.world.settings["gravity"] == 0.0


@on("robot-boxes")
async def test_wheels_have_keys_and_arrows(app, pilot):
    await pilot.press("A", "A", "d")
    assert app.world.settings["left"] == pytest.approx(0.65)
    assert app.world.settings["right"] == pytest.approx(0.4)
    assert "left wheel" in app.panel.text
    await pilot.press("up", "right")
    assert app.world.settings["left"] == pytest.approx(0.85)
    assert app.world.settings["right"] == pytest.approx(0.4)
    app.frames(1)
    assert "Wheels: left 0.85" in app.keys.text


@on("head-on")
async def test_where_there_are_no_wheels_their_keys_say_so(app, pilot):
    await app.pressed("A")
    assert "wheels" in app.keys.text


@on("head-on")
async def test_a_drag_moves_a_body_and_letting_go_throws_it(app, pilot):
    x, y = app.at("right-puck")
    # Beside its rim is near enough.
    near = (x + 2 + round(0.2 * app.sight.camera.scale), y)
    await pilot.mouse_down(offset=near)
    assert app.world.held == "right-puck"
    for i in range(1, 9):
        await pilot.hover(offset=(near[0], near[1] - i // 2))
        app.frames(1)
    assert "right-puck" in app.keys.text
    await pilot.mouse_up(offset=(near[0], near[1] - 4))
    assert app.world.held is None
    shot = app.world.snapshot()
    row = [part.name for part in app.world.parts].index("right-puck")
    assert shot.y[row] > 0.2
    assert shot.vy[row] > 0.1
    app.frames(1)
    assert "a hand takes the right puck" in app.events.text
    assert app.experiment.stage == "touched"


@on("head-on")
async def test_a_drag_while_time_stands_still_places_and_the_other_button_aims(app, pilot):
    await pilot.press("space")
    x, y = app.at("left-puck")
    await pilot.mouse_down(offset=(x, y))
    await pilot.hover(offset=(x, y - 3))
    app.frames(1)
    said = " ".join(app.keys.text.split())
    assert "course sandbox play head-on --web" in said, "by eye it is better done in the page"
    await pilot.mouse_up(offset=(x, y - 3))
    assert app.at("left-puck") == (x, y - 3)
    await pilot.mouse_down(offset=(x, y - 3), button=3)
    await pilot.hover(offset=(x + 8, y - 3))
    app.frames(1)
    assert "aiming" in app.head.text
    await pilot.mouse_up(offset=(x + 8, y - 3))
    vx = float(app.world.snapshot().vx[0])
    assert vx == pytest.approx(3.0 * 8 / app.sight.camera.scale, rel=0.15)
    assert app.world.paused
    await app.pressed("u", "u", frames=2)
    assert app.at("left-puck") == (x, y)
    assert float(app.world.snapshot().vx[0]) == 2.0


@on("head-on")
async def test_keys_place_and_aim_copy_and_take_away(app, pilot):
    await pilot.press("space")
    app.point("left-puck")
    app.pointer.by_keys = True
    before = app.at("left-puck")
    await pilot.press("enter", "up", "up", "enter")
    assert app.at("left-puck") == (before[0], before[1] - 2)
    await app.pressed("v")
    assert "point where it should fly" in app.keys.text
    await app.pressed("shift+up", "v")
    assert "will fly" in app.keys.text
    await pilot.press("shift+down", "y")
    assert "new-1" in {part.name for part in app.world.parts}
    await pilot.press("delete")
    assert "left-puck" not in {part.name for part in app.world.parts}
    await pilot.press("s")
    assert app.world.receipt.kinetic == 0.0


@on("head-on")
async def test_the_past_is_looked_at_played_backwards_and_gone_on_from(app, pilot):
    app.frames(30)
    await app.pressed("less_than_sign")
    assert app.stage.t == pytest.approx(0.5, abs=0.1)
    assert "of 1.0" in app.head.text
    await app.pressed("c")
    assert "You look at" in app.keys.text
    await app.pressed("j", frames=6)
    assert app.stage.t == pytest.approx(0.3, abs=0.1)
    assert "◀" in app.head.text
    await app.pressed("space", "enter", frames=6)
    assert app.stage.at is None
    assert app.world.t == pytest.approx(0.5, abs=0.15)
    await app.pressed("Z", "t")
    assert app.sight.ghost
    await pilot.press("comma", "k")
    assert app.stage.at is None


@on("head-on")
async def test_a_step_while_another_moment_is_being_made_is_refused_in_words(app, pilot, monkeypatch):
    def busy():
        raise UsageError("One moment.")

    app.frames(30)
    await pilot.press("less_than_sign")
    monkeypatch.setattr(app.stage, "_must_be_idle", busy)
    await app.pressed("full_stop")
    assert "One moment." in app.keys.text


@on(None)
async def test_the_gallery_opens_any_scene_and_back(app, pilot):
    assert isinstance(app.screen, Gallery)
    app.screen.move()
    words = [str(option.prompt) for option in app.screen.query_one(OptionList).options]
    assert len(words) == len(scene_ids())
    assert [word for word in words if word.startswith("✓")] == ["✓ Free fall"]
    await app.pressed("down", "down", "enter", frames=3)
    assert app.stage.chosen.scene.id == "newtons-cradle"
    assert app.world.t > 0
    await pilot.press("escape")
    assert isinstance(app.screen, Gallery)
    t = app.world.t
    app.frames(3)
    assert app.world.t == t
    await app.pressed("escape", frames=3)
    assert app.world.t > t, "back in the same run"


@on("head-on")
async def test_a_line_changes_a_parameter_a_setting_or_a_body_and_makes_the_scene_ones_own(app, pilot):
    async def say(line):
        await pilot.press("slash")
        assert isinstance(app.screen, LineOverlay)
        app.screen.query_one(Input).value = line
        await app.pressed("enter")

    await say("speed 5")
    assert app.stage.chosen.parameters["speed"] == 5
    assert "5 m/s" in app.panel.text
    assert app.world.t < 0.1
    await say("gravity = 2")
    assert app.world.settings["gravity"] == 2
    app.point("left-puck")
    await say("mass 3")
    assert app.world.number_of("left-puck", "mass") == 3
    for wrong in ("speed", "speed fast", "warp 9", "speed 1e9"):
        await say(wrong)
        assert app.screen.query_one(Input).value == wrong, "what was typed stays"
        await app.pressed("escape")
    assert app.stage.chosen.parameters["speed"] == 5
    await pilot.press("ctrl+s")
    app._film.wait(60)
    app.frames(1)
    assert app.saved["head-on.gif"][:6] == b"GIF89a"


@on("head-on")
async def test_a_film_says_how_far_it_is_and_can_be_stopped(app, pilot, monkeypatch):
    drawn, go = Event(), Event()

    def slow(self, scene, kind, width, told):
        told(0.25)
        drawn.set()
        go.wait(20)
        if not told(0.5):
            raise UsageError("The film was stopped.")
        return b"GIF89a"

    monkeypatch.setattr(Tape, "film", slow)
    await pilot.press("ctrl+s")
    assert drawn.wait(20)
    app.frames(1)
    assert "Making the film: 25 %, k stops it" in app.head.text
    await pilot.press("k")
    go.set()
    app._film.wait(20)
    app.frames(1)
    assert "The film was stopped." in app.keys.text
    assert app.saved == {}


@on("head-on")
async def test_the_other_button_and_keys_put_new_bodies_in(app, pilot):
    before = len(app.world.parts)
    await pilot.click(app.canvas, offset=(10, 5), button=3)
    assert len(app.world.parts) == before + 1
    await pilot.press("up", "up", "b")
    assert len(app.world.parts) == before + 2
    assert app.world.parts[-1].shape == "polygon"
    app.frames(1)
    assert app.canvas.cells is not None


@on("head-on")
async def test_everything_a_mouse_does_keys_can_do(app, pilot):
    x, y = app.at("left-puck")
    await pilot.press("right")
    column, row = app.pointer.at or (0, 0)
    dx, dy = x - app.canvas.region.x - column, y - app.canvas.region.y - row
    await pilot.press(*["left" if dx < 0 else "right"] * abs(dx), *["up" if dy < 0 else "down"] * abs(dy))
    await pilot.press("enter")
    assert app.world.held == "left-puck"
    await app.pressed("shift+up", frames=6)
    await pilot.press("enter")
    assert app.world.held is None
    assert app.world.snapshot().y[0] > 0.05


@pytest.mark.parametrize("size", [(80, 24), (160, 50), (60, 20), (40, 10), (12, 4), (1, 1)])
@on("newtons-cradle", size=(100, 30))
async def test_any_size_works_and_a_resize_lays_everything_out_again(app, pilot, size):
    app.frames(2)
    await pilot.resize_terminal(*size)
    await pilot.pause()
    app.frames(6)
    await pilot.pause()
    assert app.panel.display == (size[0] >= 60)
    if size[0] >= 60:
        assert "motion" in app.panel.text
        assert app.canvas.size.width >= 30
        assert app.sight.camera.columns == app.canvas.size.width
    for lines in (app.head, app.panel, app.events, app.keys):
        if lines.display and size[0] >= 12:
            assert all(len(line) <= lines.size.width for line in lines.text.split("\n"))


@on("head-on", size=(40, 20))
async def test_a_sentence_longer_than_a_line_takes_lines_from_the_events_and_none_from_the_picture(
    app, pilot
):
    room = app.canvas.size
    app.say("Theory and simulation agree, and this is what comes of it. p: the numbers")
    app.frames(8)
    await pilot.pause()
    assert "p: the numbers" in app.keys.text
    assert (app.keys.size.height, app.canvas.size) == (2, room)
    app.now += 60
    app.frames(8)
    await pilot.pause()
    assert (app.keys.size.height, app.canvas.size) == (1, room)
    assert "? all keys" in app.keys.text, "on forty columns, too"


@on(None, size=(40, 20))
async def test_the_gallery_says_what_a_scene_is_about_on_forty_columns(app, pilot):
    await pilot.pause()
    about = app.screen.query_one("#about", Static)
    app.screen.move()
    await pilot.pause()
    assert about.size.width > 30
    assert app.screen.query_one(OptionList).size.width > 30


@on("free-fall")
async def test_when_everything_has_left_the_picture_the_headline_says_so(app, pilot):
    app.frames(30)
    assert "out of view" not in app.head.text
    app.frames(60)
    assert "out of view: r" in app.head.text
    await app.pressed("r")
    assert "out of view" not in app.head.text


@on("head-on")
async def test_tab_hides_what_stands_beside_and_shows_it_again(app, pilot):
    width = app.canvas.size.width
    await pilot.press("tab")
    await pilot.pause()
    assert app.canvas.size.width == 80
    await pilot.press("tab")
    await pilot.pause()
    assert app.canvas.size.width == width


@on(None)
async def test_the_box_for_a_guess_holds_the_question_alone_and_the_help_what_the_scene_is_about(app, pilot):
    await pilot.press("escape")
    for scene in ("newtons-cradle", "unequal-masses"):
        app.put_on(app.desk.stage(scene))
        await pilot.press("p")
        assert isinstance(app.screen, LineOverlay)
        said = " ".join(str(one.content) for one in app.screen.query("Static").results(Static)).split()
        assert said == app.experiment.question.split()
        assert len(said) < 45
        note = app.stage.chosen.scene.note.split()[:6]
        await pilot.press("escape", "question_mark")
        assert " ".join(note) in " ".join(app.screen.words.split())
        await pilot.press("escape")


@on("head-on")
async def test_a_guess_starts_the_run_and_the_comparison_is_a_line_while_time_goes_on(app, pilot):
    app.frames(5)
    assert app.world.t > 0, "nothing is asked before it runs"
    await pilot.press("p")
    assert isinstance(app.screen, LineOverlay)
    app.screen.query_one(Input).value = "two"
    await pilot.press("enter")
    assert isinstance(app.screen, LineOverlay)
    app.screen.query_one(Input).value = "2,0"
    await pilot.press("enter")
    assert not isinstance(app.screen, LineOverlay)
    app.frames(63)
    assert app.world.t > 2.0
    assert "Your guess is right" in app.keys.text
    app.frames(30)
    assert app.world.t > 3.0, "no run ends"
    await pilot.press("p")
    assert isinstance(app.screen, PageOverlay)
    page = app.screen.words
    for words in ("your guess", "theory", "simulation", "Your guess is right", "And now:"):
        assert words in page
    await app.pressed("r", frames=3)
    assert 0 < app.world.t < 1
    assert [kept.guess for kept in app.kept] == [2.0]


@on("head-on")
async def test_a_run_without_a_guess_is_compared_with_theory_and_kept_nowhere(app, pilot):
    app.frames(90)
    assert app.experiment.stage == "done"
    assert app.world.t > 2.5
    assert app.kept == []


@on("head-on")
async def test_a_run_that_a_hand_was_in_is_compared_with_nothing_and_goes_on(app, pilot):
    await app.pressed("c", frames=90)
    await pilot.pause()
    assert app.world.t > 2.5
    assert not isinstance(app.screen, PageOverlay)
    await app.pressed("p")
    assert isinstance(app.screen, LineOverlay), "a guess begins anew"


@on("newtons-cradle")
async def test_help_names_every_key_and_time_stands_still_meanwhile(app, pilot):
    await pilot.press("question_mark")
    assert isinstance(app.screen, PageOverlay)
    page = app.screen.words
    keys = {key.strip() for binding in app.BINDINGS for key in binding.key.split(",")}
    named = {"full_stop": ".", "minus": "-", "plus": "+", "tab": "Tab", "enter": "Enter", "comma": ","}
    named |= {"less_than_sign": "<", "greater_than_sign": ">", "colon": ":", "slash": "/", "home": "Home"}
    named |= {"delete": "Delete", "backspace": "Backspace", "pageup": "PgUp", "pagedown": "PgDn"}
    named |= {"ctrl+s": "Ctrl+S", "escape": "Escape"}
    silent = {"ctrl+q", "ctrl+c", "underscore", "equals_sign", "question_mark", "f1", "ctrl+z", "ctrl+y"}
    arrows = {prefix + way for prefix in ("", "shift+") for way in ("left", "right", "up", "down")}
    words = page.split()
    for key in keys - silent - arrows - {"a", "A", "d", "D"}:
        assert named.get(key, key) in words, key
    steps = app.world.steps
    await app.pressed("g", "r", "tab", frames=5)
    assert app.world.steps == steps
    assert app.panel.display
    await app.pressed("escape", frames=5)
    assert app.world.steps > steps


@on("head-on")
async def test_the_list_of_events_tells_what_happened(app, pilot):
    app.frames(30)
    await pilot.press("l")
    assert isinstance(app.screen, PageOverlay)
    page = app.screen.words
    assert "the left puck and the right puck meet at 3.00 m/s" in page


@on("head-on")
async def test_in_the_past_nothing_is_told_that_is_still_to_come(app, pilot):
    app.frames(30)
    assert "meet at 3.00 m/s" in app.events.text
    await app.pressed("less_than_sign", "less_than_sign", frames=2)
    assert app.stage.t < 0.5
    assert "meet at" not in app.events.text
    await app.pressed("k", frames=2)
    assert "meet at 3.00 m/s" in app.events.text


@on("head-on")
async def test_frames_in_which_nothing_moves_send_nothing(app, pilot):
    await app.pressed("space", frames=2)
    sent = app.canvas.sent
    app.frames(20)
    assert app.canvas.sent == sent


@on("head-on")
async def test_calm_means_four_pictures_a_second_and_no_flashes(app, pilot):
    await pilot.press("m")
    assert app.calm
    app.frames(1)
    drawn, draw = [], app._draw
    app._draw = lambda now: drawn.append(now) or draw(now)
    app.frames(30)
    assert 3 <= len(drawn) <= 5
    assert app.sight._flashes == []


@pytest.fixture
def without_colour(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")


@pytest.mark.usefixtures("without_colour")
@on("head-on")
async def test_no_color_is_honoured(app, pilot):
    app.frames(2)
    cells = app.canvas.cells
    assert not cells.paper.any()
    for y in range(app.canvas.size.height):
        for segment in app.canvas.render_line(y):
            assert segment.style is None or segment.style.color is None
    for lines in (app.head, app.panel, app.events, app.keys):
        for y in range(lines.size.height):
            for segment in lines.render_line(y):
                assert segment.style is None or (segment.style.color or segment.style.bgcolor) is None


@pytest.mark.parametrize("keys", [["q"], ["ctrl+c"], ["ctrl+q"], ["p", "ctrl+c"]])
@on("head-on")
async def test_there_are_keys_to_leave_also_from_a_question(app, pilot, keys):
    await pilot.press(*keys)
    await pilot.pause()
    assert app._exit


def test_without_a_terminal_the_way_out_is_named(capsys):
    with pytest.raises(MissingCapabilityError) as caught:
        terminal.play(choose("head-on"))
    assert "--describe" in caught.value.help
    assert "--headless" in caught.value.help
