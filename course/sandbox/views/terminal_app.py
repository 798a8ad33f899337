"""The program behind the view in a terminal: what keys and the mouse do, and one frame after the other."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from time import perf_counter
from typing import TYPE_CHECKING, Any

from textual.containers import Horizontal
from textual.geometry import Size

from course.sandbox.views.story import Experiment, Teller
from course.sandbox.views.terminal_asking import Ask, Told, comparison, help_pages
from course.sandbox.views.terminal_controls import Controls
from course.sandbox.views.terminal_hand import Pointer
from course.sandbox.views.terminal_lines import Canvas, Lines
from course.sandbox.views.terminal_pace import Pacer
from course.sandbox.views.terminal_scene import Stage
from course.sandbox.views.terminal_words import clean, head, keys_line, panel, wrapped

if TYPE_CHECKING:
    from collections.abc import Callable

    from textual.app import ComposeResult

    from course.sandbox.loading import Chosen
    from course.sandbox.predicting import Comparison
    from course.sandbox.views.terminal_asking import Page
    from course.sandbox.views.terminal_words import Line
    from course.sandbox.world import World

__all__ = ["SandboxApp"]

#: A run that is over sooner than this, in s, starts in slow motion, so that it can be seen.
_BLINK, _SEEN = 0.5, 3.0
#: How often numbers and curves are written anew, in s: faster than that nobody reads.
_READ = 0.2
#: Pictures a second for those who asked for little motion.
_CALM_FPS = 4.0
#: How long a message stays in the last line, in s.
_MESSAGE = 3.0
#: Below this many columns there is no room beside the picture.
_NARROW = 60
_LOWEST = 12

_COLOURS = {"ink": "#d5dae1", "paper": "#1b2028", "bar": "#2a323d"}


class SandboxApp(Controls):
    """A world, a picture of it, and everything that can be done to it.

    Args:
        world: before its first step, with a receipt.
        chosen: its scene, with the parameters that went into it.
        fps: pictures a second.
        guess: an answer to the scene's question; None to ask for one.
        keep: called with each comparison that has a guess.
        clock: real time, in s.

    Attributes:
        failure: what went wrong inside; raised again by ``terminal.play`` once the terminal is clean.
    """

    CSS = """
    Screen { layout: vertical; overflow: hidden; }
    #head, #keys { height: 1; width: 100%; }
    #middle { height: 1fr; width: 100%; }
    #panel { height: 100%; }
    #events { width: 100%; }
    """
    ENABLE_COMMAND_PALETTE = False

    def __init__(
        self,
        world: World,
        chosen: Chosen,
        *,
        fps: float = 30.0,
        guess: float | None = None,
        keep: Callable[[Comparison], None] | None = None,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        # Without colour the terminal's own colours stay, rather than shades of grey.
        self.in_colour = not os.environ.get("NO_COLOR")
        if self.in_colour:
            super().__init__()
        else:
            super().__init__(ansi_color=True)
        self.world, self.chosen = world, chosen
        self.failure: BaseException | None = None
        self.experiment = Experiment(world, chosen, guess, keep)
        self.pacer = Pacer(world, 0.5 / max(fps, 1.0), clock)
        self.stage = Stage(world, colour=self.in_colour)
        self.pointer = Pointer(world, self.stage, on_touch=self.experiment.touch)
        self.calm = self.animation_level != "full"
        self._fps = fps
        self._clock = clock
        self._last = clock()
        self._teller = Teller()
        self._lines: list[str] = []
        self._message: tuple[float, str] = (0.0, "")
        self._read_at = -1.0
        self._drawn_at = -1.0
        self._panel_wanted = True
        self._room = Size(80, 24)
        self._stopped = False
        ink, paper, bar = (_COLOURS[name] if self.in_colour else None for name in ("ink", "paper", "bar"))
        self.canvas = Canvas(colour=self.in_colour, id="canvas")
        self.head = Lines(ink, bar, id="head")
        self.panel = Lines(ink, paper, id="panel")
        self.events = Lines(ink, paper, id="events")
        self.keys = Lines(ink, bar, id="keys")
        if chosen.scene.duration < _BLINK:
            world.speed = float(f"{chosen.scene.duration / _SEEN:.1g}")

    # -- coming and going ------------------------------------------------------------------------

    def compose(self) -> ComposeResult:
        """A line, the picture with what stands beside it, events, and a line of keys."""
        yield self.head
        with Horizontal(id="middle"):
            yield self.canvas
            yield self.panel
        yield self.events
        yield self.keys

    def on_mount(self) -> None:
        """Start."""
        loop = asyncio.get_running_loop()
        for name in ("SIGINT", "SIGTERM", "SIGHUP"):
            # A closed window or a plain kill leaves the terminal as clean as a key does. Where signals cannot
            # be caught here (Windows, another thread) the keys remain.
            with contextlib.suppress(NotImplementedError, AttributeError, RuntimeError, ValueError):
                loop.add_signal_handler(getattr(signal, name), self.exit)
        self.begin()

    def begin(self) -> None:
        """Start the frames, and ask first if there is something to ask."""
        self._last = self._clock()
        self.set_interval(1 / self._fps, self.tick)
        self.world.paused = self.calm
        if self.experiment.stage == "ask":
            self.ask()

    def _handle_exception(self, error: Exception) -> None:
        # Whoever called ``play`` reports errors; a picture of the stack on the screen would be a second one.
        if self.failure is None:
            self.failure = error
        if self.is_headless:
            super()._handle_exception(error)
        else:
            self._return_code = 1
            self._close_messages_no_wait()

    def on_resize(self, event: Any) -> None:
        """Give each part its room."""
        self._room = event.size
        self._lay_out()

    def _lay_out(self) -> None:
        width, height = self._room
        beside = self._panel_wanted and width >= _NARROW
        self.panel.display = beside
        self.panel.styles.width = 26 if width < 76 else 30 if width < 110 else 46
        self.events.display = height >= _LOWEST
        self.events.styles.height = 2 if height < 20 else 3 if height < 30 else 5 if height < 40 else 8
        self._read_at = self._drawn_at = -1.0

    # -- time ------------------------------------------------------------------------------------

    def tick(self) -> None:
        """One frame."""
        now = self._clock()
        dt, self._last = now - self._last, now
        left = self.experiment.left()
        until = None if left is None else self.chosen.scene.duration
        if len(self.screen_stack) == 1:
            self.pacer.advance(dt, until)
        self._hear(now)
        if not self.calm or now - self._drawn_at >= 1 / _CALM_FPS or self._drawn_at < 0:
            self._drawn_at = now
            self._draw(now)
        if now - self._read_at >= _READ or self._read_at < 0:
            self._read_at = now
            self._write(now)

    def _hear(self, now: float) -> None:
        """Take in what happened."""
        events = self.world.drain_events()
        self.experiment.take(events)
        if self.experiment.passed():
            self.world.paused = self._stopped = True
            self.compare()
        told = self._teller.tell(events, now)
        self._lines = [*self._lines, *(clean(line["text"]) for line in told)][-400:]
        if not self.calm:
            self.stage.flash(events, now)

    def _draw(self, now: float) -> None:
        width, height = self.canvas.size
        if width and height:
            self.canvas.show(self.stage.draw(width, height, self.pointer, now))
        self.head.show([head(self.world, self._state(), self.pacer.pace, self._room.width)])

    def _state(self) -> str:
        if self.pointer.aim is not None:
            return f"aiming: {self.pointer.aim_in_words()}"
        if self._stopped and self.world.paused:
            return "the run is over"
        return "paused" if self.world.paused else ""

    def _write(self, now: float) -> None:
        """Numbers, curves, events and keys."""
        if self.panel.display:
            width, height = self.panel.size
            rule = "│ " if width > 2 else ""
            lines = panel(self.world, width - len(rule) - 1, height) if height else []
            lines += [((" ", ""),)] * (height - len(lines))
            self.panel.show([((rule, "dim"), *line) for line in lines])
        self.events.show(self._told(self.events.size.width, self.events.size.height))
        since, message = self._message
        if message and now - since < _MESSAGE:
            self.keys.show([((f" {message}", "bold"),)])
        elif self.pointer.status():
            self.keys.show([((f" {self.pointer.status()}", "bold"),)])
        else:
            self.keys.show([keys_line(self._room.width, paused=self.world.paused)])

    def _told(self, width: int, height: int) -> list[Line]:
        """The latest events, whole ones, newest at the bottom."""
        lines: list[Line] = []
        for text in reversed(self._lines[-height:] if height else []):
            pieces = wrapped(text, max(10, width - 3))
            if lines and len(lines) + len(pieces) > height:
                break
            lines[:0] = [(((" " if i == 0 else "   ") + piece, ""),) for i, piece in enumerate(pieces)]
        return lines[-height:] if height else []

    def renew(self, *, layout: bool = False) -> None:
        """Draw and write everything with the next frame, or give each part its room anew."""
        self._read_at = self._drawn_at = -1.0
        if layout:
            self._lay_out()

    def say(self, message: str) -> None:
        """Show something in the last line for a moment."""
        self._message = (self._clock(), clean(message))
        self._read_at = -1.0

    # -- asking ----------------------------------------------------------------------------------

    def ask(self) -> None:
        """The scene's question; time stands still meanwhile."""
        asked = self.chosen.scene.prediction
        if asked is None:
            return
        self.world.paused = True

        def answered(guess: float | None) -> None:
            self.experiment.answer(guess)
            self.world.paused = False
            if guess is not None:
                self.say(f"Your guess: {guess:g} {'' if asked.unit == '1' else asked.unit}")

        self.push_screen(
            Ask(self.chosen.scene, self.experiment.question, asked.unit, calm=self.calm), answered
        )

    def compare(self) -> None:
        """Theory, guess and simulation side by side."""
        result = self.experiment.report()["comparison"]
        if result is None:
            return

        def read(key: str | None) -> None:
            if key == "r":
                self.action_reset()

        page = comparison(result, self.chosen.scene.after)
        hint = "Enter: go on from here   r: once more"
        self.push_screen(Told("Predicted, run, compared", page, keys=("r",), hint=hint), read)

    def action_question(self) -> None:
        """The question again, or what came of it."""
        stage, asked = self.experiment.stage, self.chosen.scene.prediction
        if stage == "ask":
            self.ask()
        elif stage == "done":
            self.compare()
        elif asked is None:
            self.say("This scene asks for no number.")
        elif stage == "touched":
            self.say("A hand was in it, so this run is compared with nothing. r: once more from the start.")
        else:
            guess = "no guess" if self.experiment.guess is None else f"your guess {self.experiment.guess:g}"
            page: Page = [(clean(self.experiment.question), ""), "", f"{guess}, {clean(asked.unit)}", ""]
            self.push_screen(Told("The question", page))

    def action_help(self) -> None:
        """All keys."""
        wheels = "left" in self.world.settings
        self.push_screen(Told("Keys, and this scene", help_pages(self.chosen.scene, wheels=wheels)))

    def action_events(self) -> None:
        """The list of events."""
        page = self._lines or ["Nothing happened yet."]
        self.push_screen(Told("What happened", page, at_end=True))
