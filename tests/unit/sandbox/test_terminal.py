"""The view in a terminal, played with textual's pilot: keys, mouse, questions, sizes, ends."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest
from textual.pilot import Pilot
from textual.widgets import Input, Static

from course.errors import MissingCapabilityError
from course.sandbox.scene.loading import choose
from course.sandbox.views.terminal import view as terminal
from course.sandbox.views.terminal.app import SandboxApp
from course.sandbox.views.terminal.asking import PageOverlay, QuestionOverlay
from course.sandbox.world.world import World


class Played(SandboxApp):
    """The view with a clock of its own: frames come when a test asks for them."""

    def __init__(self, scene: str, **more: Any) -> None:
        self.now = 0.0
        self.kept: list[Any] = []
        chosen = choose(scene)
        world = World(chosen.scene, chosen.settings)
        more = {"keep": self.kept.append, **more}
        super().__init__(world, chosen, clock=lambda: self.now, **more)
        # A machine under load is no reason to step less here.
        self.pacer._budget = 1e9

    def begin(self) -> None:
        if self.experiment.stage == "ask":
            self.ask()

    def frames(self, count: int) -> None:
        for _ in range(count):
            self.now += 1 / 30
            self.tick()

    def at(self, name: str) -> tuple[int, int]:
        """Column and row on the screen of a body."""
        shot = self.world.snapshot()
        row = [part.name for part in self.world.parts].index(name)
        column, line = self.stage.camera.cell(float(shot.x[row]), float(shot.y[row]))
        return column + self.canvas.region.x, line + self.canvas.region.y


def play(
    scene: str,
    script: Callable[[Played, Pilot[None]], Awaitable[None]],
    size: tuple[int, int] = (80, 24),
    **more: Any,
) -> Played:
    """Run a script against the view; without a question unless the script wants one."""
    more = {"guess": 1.0, **more}

    async def run() -> Played:
        app = Played(scene, **more)
        async with app.run_test(size=size) as pilot:
            await pilot.pause()
            app.frames(1)
            await script(app, pilot)
        return app

    return asyncio.run(run())


def test_keys_act_on_time_and_settings():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        world = app.world
        app.frames(3)
        assert world.t > 0
        await pilot.press("space")
        assert world.paused
        steps = world.steps
        app.frames(3)
        assert world.steps == steps
        await pilot.press("full_stop", "full_stop")
        assert world.steps == steps + 2
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

    play("newtons-cradle", script)


def test_settings_stop_at_their_ends():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press(*"EEE", *"g" * 3)
        assert app.world.settings["restitution"] == 1.0
        assert app.world.settings["gravity"] == 0.0

    play("head-on", script)


def test_wheels_have_keys_where_there_are_wheels():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("A", "A", "d")
        assert app.world.settings["left"] == pytest.approx(0.65)
        assert app.world.settings["right"] == pytest.approx(0.4)
        assert "left wheel" in app.panel.text

    play("robot-boxes", script)

    async def none(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("A")
        app.frames(1)
        assert "wheels" in app.keys.text

    play("head-on", none)


def test_a_drag_moves_a_body_and_letting_go_throws_it():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        x, y = app.at("right-puck")
        # Beside its rim is near enough.
        near = (x + 2 + round(0.2 * app.stage.camera.scale), y)
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
        assert "a hand takes right-puck" in app.events.text
        assert app.experiment.stage == "touched"

    play("head-on", script)


def test_a_drag_while_time_stands_still_aims_a_throw():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("space")
        x, y = app.at("left-puck")
        await pilot.mouse_down(offset=(x, y))
        await pilot.hover(offset=(x + 8, y))
        app.frames(1)
        assert "aiming" in app.head.text
        await pilot.mouse_up(offset=(x + 8, y))
        vx = float(app.world.snapshot().vx[0])
        assert vx == pytest.approx(3.0 * 8 / app.stage.camera.scale, rel=0.15)
        assert app.world.steps == app.world.ticks
        assert app.world.paused

    play("head-on", script)


def test_the_other_button_and_keys_put_new_bodies_in():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        before = len(app.world.parts)
        await pilot.click(app.canvas, offset=(10, 5), button=3)
        assert len(app.world.parts) == before + 1
        await pilot.press("up", "up", "b")
        assert len(app.world.parts) == before + 2
        assert app.world.parts[-1].shape == "polygon"
        app.frames(1)
        assert app.canvas.cells is not None

    play("head-on", script)


def test_everything_a_mouse_does_keys_can_do():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        x, y = app.at("left-puck")
        await pilot.press("right")
        column, row = app.pointer.at or (0, 0)
        dx, dy = x - app.canvas.region.x - column, y - app.canvas.region.y - row
        await pilot.press(*["left" if dx < 0 else "right"] * abs(dx), *["up" if dy < 0 else "down"] * abs(dy))
        await pilot.press("enter")
        assert app.world.held == "left-puck"
        await pilot.press("shift+up")
        app.frames(6)
        await pilot.press("enter")
        assert app.world.held is None
        assert app.world.snapshot().y[0] > 0.05

    play("head-on", script)


@pytest.mark.parametrize("size", [(80, 24), (160, 50), (60, 20), (40, 10), (12, 4), (1, 1)])
def test_any_size_works_and_a_resize_lays_everything_out_again(size: tuple[int, int]):
    async def script(app: Played, pilot: Pilot[None]) -> None:
        app.frames(2)
        await pilot.resize_terminal(*size)
        await pilot.pause()
        app.frames(6)
        await pilot.pause()
        assert app.panel.display == (size[0] >= 60)
        if size[0] >= 60:
            assert "motion" in app.panel.text
            assert app.canvas.size.width >= 30
            assert app.stage.camera.columns == app.canvas.size.width
        for lines in (app.head, app.panel, app.events, app.keys):
            if lines.display and size[0] >= 12:
                assert all(len(line) <= lines.size.width for line in lines.text.split("\n"))

    play("newtons-cradle", script, size=(100, 30))


def test_tab_hides_what_stands_beside_and_shows_it_again():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        width = app.canvas.size.width
        await pilot.press("tab")
        await pilot.pause()
        assert app.canvas.size.width == 80
        await pilot.press("tab")
        await pilot.pause()
        assert app.canvas.size.width == width

    play("head-on", script)


@pytest.mark.parametrize("scene", ["newtons-cradle", "unequal-masses"])
def test_the_box_before_a_run_holds_the_question_alone_and_the_help_what_the_scene_is_about(
    scene: str,
) -> None:
    async def script(app: Played, pilot: Pilot[None]) -> None:
        assert isinstance(app.screen, QuestionOverlay)
        said = " ".join(str(one.content) for one in app.screen.query("Static").results(Static)).split()
        assert said == app.experiment.question.split()
        assert len(said) < 45
        note = app.chosen.scene.note.split()[:6]
        await pilot.press("escape", "question_mark")
        assert " ".join(note) in " ".join(app.screen.words.split())

    play(scene, script, guess=None)


def test_the_question_comes_first_and_the_comparison_after_and_both_can_be_left():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        assert isinstance(app.screen, QuestionOverlay)
        app.frames(5)
        assert app.world.steps == 0
        app.screen.query_one(Input).value = "two"
        await pilot.press("enter")
        assert isinstance(app.screen, QuestionOverlay)
        app.screen.query_one(Input).value = "2,0"
        await pilot.press("enter")
        assert not isinstance(app.screen, QuestionOverlay)
        app.frames(90)
        await pilot.pause()
        assert app.world.t == pytest.approx(2.0, abs=1 / 240)
        assert app.world.paused
        assert isinstance(app.screen, PageOverlay)
        page = app.screen.words
        for words in ("your guess", "theory", "simulation", "Your guess is right", "And now:"):
            assert words in page
        await pilot.press("question_mark")
        assert "reset: from the start" in app.screen.words, "the keys, not the picture"
        await pilot.press("escape", "p")
        assert "Your guess is right" in app.screen.words
        await pilot.press("r")
        assert not isinstance(app.screen, PageOverlay)
        app.frames(3)
        assert 0 < app.world.t < 1
        assert not app.world.paused

    app = play("head-on", script, guess=None)
    assert [kept.guess for kept in app.kept] == [2.0]


def test_a_run_without_a_guess_is_compared_with_theory_and_kept_nowhere():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("escape")
        app.frames(90)
        await pilot.pause()
        assert isinstance(app.screen, PageOverlay)
        await pilot.press("escape")
        await pilot.press("space")
        app.frames(30)
        assert app.world.t > 2.5

    assert play("head-on", script, guess=None).kept == []


def test_a_run_that_a_hand_was_in_is_compared_with_nothing_and_goes_on():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("c")
        app.frames(90)
        await pilot.pause()
        assert app.world.t > 2.5
        assert not isinstance(app.screen, PageOverlay)
        await pilot.press("p")
        app.frames(1)
        assert "You changed this run" in app.keys.text

    play("head-on", script)


def test_a_run_that_is_over_in_a_blink_starts_in_slow_motion():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        assert app.world.speed < 0.05

    play("bullet-wall", script)


def test_help_says_how_to_set_what_has_no_key():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        assert isinstance(app.screen, PageOverlay)
        assert (
            "course sandbox play newtons-cradle --set gap=NUMBER; also angle, backwards" in app.screen.words
        )

    play("newtons-cradle", script)


def test_help_names_every_key_and_time_stands_still_meanwhile():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("question_mark")
        assert isinstance(app.screen, PageOverlay)
        page = app.screen.words
        keys = {key.strip() for binding in app.BINDINGS for key in binding.key.split(",")}
        named = {"full_stop": ".", "minus": "-", "plus": "+", "tab": "Tab", "enter": "Enter"}
        silent = {"ctrl+q", "ctrl+c", "underscore", "equals_sign", "question_mark", "f1"}
        arrows = {prefix + way for prefix in ("", "shift+") for way in ("left", "right", "up", "down")}
        words = page.split()
        for key in keys - silent - arrows - {"a", "A", "d", "D"}:
            assert named.get(key, key) in words, key
        steps = app.world.steps
        await pilot.press("g", "r", "tab")
        app.frames(5)
        assert app.world.steps == steps
        assert app.panel.display
        await pilot.press("escape")
        app.frames(5)
        assert app.world.steps > steps

    play("newtons-cradle", script)


def test_the_list_of_events_tells_what_happened():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        app.frames(30)
        await pilot.press("l")
        assert isinstance(app.screen, PageOverlay)
        page = app.screen.words
        assert "the left puck and the right puck meet at 3.00 m/s" in page

    play("head-on", script)


def test_frames_in_which_nothing_moves_send_nothing():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("space")
        app.frames(2)
        sent = app.canvas.sent
        app.frames(20)
        assert app.canvas.sent == sent

    play("head-on", script)


def test_calm_means_four_pictures_a_second_and_no_flashes():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("m")
        assert app.calm
        app.frames(1)
        drawn = 0
        draw = app._draw

        def counted(now: float) -> None:
            nonlocal drawn
            drawn += 1
            draw(now)

        app._draw = counted  # type: ignore[method-assign]
        app.frames(30)
        assert 3 <= drawn <= 5
        assert app.stage._flashes == []

    play("head-on", script)


def test_no_color_is_honoured(monkeypatch):
    monkeypatch.setenv("NO_COLOR", "1")

    async def script(app: Played, pilot: Pilot[None]) -> None:
        app.frames(2)
        cells = app.canvas.cells
        assert cells is not None
        assert not cells.paper.any()
        for y in range(app.canvas.size.height):
            for segment in app.canvas.render_line(y):
                assert segment.style is None or segment.style.color is None
        for lines in (app.head, app.panel, app.events, app.keys):
            for y in range(lines.size.height):
                for segment in lines.render_line(y):
                    assert segment.style is None or (segment.style.color or segment.style.bgcolor) is None

    play("head-on", script)


@pytest.mark.parametrize("key", ["q", "ctrl+c", "ctrl+q"])
def test_there_are_keys_to_leave(key: str):
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press(key)
        await pilot.pause()
        assert not app.is_running or app._exit

    play("head-on", script)


def test_ctrl_c_leaves_the_question_as_well():
    async def script(app: Played, pilot: Pilot[None]) -> None:
        await pilot.press("ctrl+c")
        await pilot.pause()
        assert app._exit

    play("head-on", script, guess=None)


def test_without_a_terminal_the_way_out_is_named(capsys):
    scene = choose("head-on").scene
    with pytest.raises(MissingCapabilityError) as caught:
        terminal.play(World(scene), scene)
    assert "--describe" in caught.value.help
    assert "--headless" in caught.value.help
