"""The program behind the view in a terminal: what keys and the mouse do, and one frame after the other."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import Horizontal
from textual.geometry import Size

from course.errors import UsageError
from course.full_screen import FullScreenApp
from course.sandbox.scene.loading import Chosen, Comparison
from course.sandbox.scene.rules import SETTINGS
from course.sandbox.views.story import Experiment, Narrator
from course.sandbox.views.terminal.asking import Page, PageOverlay, QuestionOverlay, comparison, help_pages
from course.sandbox.views.terminal.hand import Pointer, Stage
from course.sandbox.views.terminal.words import (
    KEYS,
    Canvas,
    Line,
    Lines,
    Pacer,
    clean,
    head,
    keys_line,
    panel,
    setting,
    speed_in_words,
    wrapped,
)
from course.sandbox.world.world import World

#: A run that is over sooner than this, in s, starts in slow motion, so that it can be seen.
_BLINK, _SEEN = 0.5, 3.0
#: How often numbers and curves are written anew, in s: the eye reads no faster.
_READ = 0.2
#: Pictures a second for those who asked for little motion.
_CALM_FPS = 4.0
#: Below this many columns there is no room beside the picture.
_NARROW = 60
_LOWEST = 12
#: Slowest and fastest, in simulated seconds a second.
_SLOWEST, _FASTEST = 1 / 1024, 16.0

_COLOURS = {"ink": "#d5dae1", "paper": "#1b2028", "bar": "#2a323d"}


class SandboxApp(FullScreenApp):
    """A world, its picture, and everything that a user can do to it.

    Args:
        world: before its first step, with a receipt.
        chosen: its scene, with the parameters that went into it.
        fps: pictures a second.
        guess: an answer to the scene's question; None to ask for one.
        keep: called with each comparison that has a guess.
        clock: real time, in s.
    """

    CSS = """
    Screen { layout: vertical; overflow: hidden; }
    #head, #keys { height: 1; width: 100%; }
    #middle { height: 1fr; width: 100%; }
    #panel { height: 100%; }
    #events { width: 100%; }
    """

    BINDINGS: ClassVar[list[Any]] = [
        Binding("ctrl+c,ctrl+q", "quit", priority=True, show=False),
        Binding("q", "quit", show=False),
        Binding("space", "pause", show=False),
        Binding("full_stop", "single", show=False),
        Binding("r", "reset", show=False),
        Binding("minus,underscore", "speed(0.5)", show=False),
        Binding("plus,equals_sign", "speed(2.0)", show=False),
        Binding("question_mark,f1", "help", show=False),
        Binding("c", "spawn('circle')", show=False),
        Binding("b", "spawn('box')", show=False),
        Binding("n", "names", show=False),
        Binding("l", "events", show=False),
        Binding("p", "question", show=False),
        Binding("m", "calm", show=False),
        Binding("tab", "panel", priority=True, show=False),
        Binding("enter", "take", show=False),
        *(
            Binding(f"{prefix}{name}", f"point({dx * far}, {dy * far})", show=False)
            for name, dx, dy in (("left", -1, 0), ("right", 1, 0), ("up", 0, -1), ("down", 0, 1))
            for prefix, far in (("", 1), ("shift+", 5))
        ),
        *(
            Binding(key, f"notch('{name}', {way})", show=False)
            for name, (less, more, _) in KEYS.items()
            for key, way in ((less, -1), (more, 1))
        ),
    ]

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
        super().__init__(clock)
        self.world, self.chosen = world, chosen
        self.experiment = Experiment(world, chosen, guess, keep)
        self.pacer = Pacer(world, 0.5 / max(fps, 1.0), clock)
        self.stage = Stage(world, colour=self.in_colour)
        self.pointer = Pointer(world, self.stage, on_touch=self.experiment.touch)
        self.calm = self.animation_level != "full"
        self._fps = fps
        self._last = clock()
        self._narrator = Narrator()
        self._lines: list[str] = []
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
        """A headline, the picture with a panel beside it, events, and a line of keys."""
        yield self.head
        with Horizontal(id="middle"):
            yield self.canvas
            yield self.panel
        yield self.events
        yield self.keys

    def on_mount(self) -> None:
        """Start."""
        self.begin()

    def begin(self) -> None:
        """Start the frames; first ask the scene's question, if it has one."""
        self._last = self._clock()
        self.set_interval(1 / self._fps, self.tick)
        self.world.paused = self.calm
        if self.experiment.stage == "ask":
            self.ask()

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
            self._write()

    def _hear(self, now: float) -> None:
        """Take in the events."""
        events = self.world.drain_events()
        self.experiment.take(events)
        if self.experiment.passed():
            self.world.paused = self._stopped = True
            self.compare()
        told = self._narrator.tell(events, now)
        self._lines = [*self._lines, *(clean(line["text"]) for line in told)][-400:]
        if not self.calm:
            self.stage.flash(events, now)

    def _draw(self, now: float) -> None:
        width, height = self.canvas.size
        if width and height:
            self.canvas.show(
                self.stage.draw(width, height, now, pointer=self.pointer.shown, aim=self.pointer.aim)
            )
        self.head.show([head(self.world, self._state(), self.pacer.pace, self._room.width)])

    def _state(self) -> str:
        if self.pointer.aim is not None:
            return f"aiming: {self.pointer.aim_in_words()}"
        if self._stopped and self.world.paused:
            return "the run is over"
        return "paused" if self.world.paused else ""

    def _write(self) -> None:
        """Numbers, curves, events and keys."""
        if self.panel.display:
            width, height = self.panel.size
            rule = "│ " if width > 2 else ""
            lines = panel(self.world, width - len(rule) - 1, height) if height else []
            lines += [((" ", ""),)] * (height - len(lines))
            self.panel.show([((rule, "dim"), *line) for line in lines])
        self.events.show(self._told(self.events.size.width, self.events.size.height))
        if self.message:
            self.keys.show([((f" {self.message}", "bold"),)])
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
        super().say(clean(message))
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

        self.push_screen(QuestionOverlay(self.experiment.question, asked.unit, calm=self.calm), answered)

    def compare(self) -> None:
        """Theory, guess and simulation side by side."""
        result = self.experiment.report()["comparison"]
        if result is None:
            return

        def read(key: str | None) -> None:
            if key == "r":
                self.action_reset()
            elif key == "?":
                self.action_help()

        page = comparison(result, self.chosen.scene.after)
        hint = "Enter: go on   r: once more   ?: keys"
        self.push_screen(PageOverlay("Predicted, run, compared", page, keys=("r", "?"), hint=hint), read)

    def action_question(self) -> None:
        """Show the question again, or its result."""
        stage, asked = self.experiment.stage, self.chosen.scene.prediction
        if stage == "ask":
            self.ask()
        elif stage == "done":
            self.compare()
        elif asked is None:
            self.say("This scene does not ask for a number.")
        elif stage == "touched":
            self.say("You changed this run, so there is nothing to compare with. r: start it again.")
        else:
            guess = "no guess" if self.experiment.guess is None else f"your guess {self.experiment.guess:g}"
            page: Page = [(clean(self.experiment.question), ""), "", f"{guess}, {clean(asked.unit)}", ""]
            self.push_screen(PageOverlay("The question", page))

    def action_help(self) -> None:
        """All keys."""
        wheels = "left" in self.world.settings
        self.push_screen(PageOverlay("Keys, and this scene", help_pages(self.chosen.scene, wheels=wheels)))

    def action_events(self) -> None:
        """The list of events."""
        page = self._lines or ["Nothing happened yet."]
        self.push_screen(PageOverlay("What happened", page, at_end=True))

    # -- keys ------------------------------------------------------------------------------------

    def action_pause(self) -> None:
        """Run or pause."""
        self.world.paused = not self.world.paused
        self._stopped = False
        self.renew()

    def action_single(self) -> None:
        """One step, and pause."""
        self.world.paused = True
        self.world.step()
        self.renew()

    def action_reset(self) -> None:
        """Begin again; settings stay."""
        self.pointer.drop()
        self.world.reset()
        self.experiment.again()
        self.stage.forget()
        self._narrator.forget()
        self._lines = []
        if self._stopped:
            self.world.paused = self._stopped = False
        self.say("From the start.")
        if self.experiment.stage == "ask":
            self.ask()

    def action_speed(self, factor: float) -> None:
        """Slower or faster."""
        self.world.speed = min(_FASTEST, max(_SLOWEST, self.world.speed * factor))
        self.say(f"Time passes at {speed_in_words(self.world.speed)}.")

    def action_notch(self, key: str, way: int) -> None:
        """A setting, one notch up or down."""
        spec = SETTINGS[key]
        if key in {"left", "right"} and key not in self.world.settings:
            self.say("Nothing here has wheels.")
            return
        now = self.world.settings.get(key)
        if now is None:
            # Until then each body has its own; the first press starts from the value that most of them have.
            now = self.stage.usual(key)
        value = now * spec.notch**way if spec.times else now + way * spec.notch
        value = float(round(value)) if spec.whole else round(value, 9)
        value = min(spec.high, max(spec.low, value))
        self.world.set(key, value)
        self.experiment.changed()
        self.say(f"{KEYS[key][2]}: {setting(key, value)} ({spec.meaning})")

    def action_spawn(self, shape: str) -> None:
        """A new body at the pointer."""
        self._attempt(lambda: self.pointer.spawn(shape))

    def action_take(self) -> None:
        """Grab the body near the keyboard's pointer, or let it go."""
        self._attempt(self.pointer.toggle)

    def action_point(self, dx: int, dy: int) -> None:
        """Move the keyboard's pointer by this many cells."""
        self.pointer.move_by(dx, dy)
        self.renew()

    def action_names(self) -> None:
        """Label every body, or only the large ones."""
        self.stage.names = not self.stage.names
        self.say("Names on." if self.stage.names else "Names only where there is room.")

    def action_calm(self) -> None:
        """Switch between little motion and full motion."""
        self.calm = not self.calm
        self.say("Calm: four pictures a second, no flashes." if self.calm else "All pictures, all flashes.")

    def action_panel(self) -> None:
        """Hide or show the panel beside the picture."""
        self._panel_wanted = not self._panel_wanted
        self.renew(layout=True)

    def _attempt(self, deed: Callable[[], str | None]) -> None:
        try:
            message = deed()
        except UsageError as error:
            message = error.message
        if message:
            self.say(message)

    # -- the mouse -------------------------------------------------------------------------------

    def on_mouse_down(self, event: Any) -> None:
        """Grab a body that is near, or add a new ball there."""
        place = self._cell(event)
        if place is None or len(self.screen_stack) > 1:
            return
        if event.button == 1:
            self.canvas.capture_mouse()
            self._attempt(lambda: self.pointer.press(*place))
        else:
            self.pointer.at, self.pointer.by_keys = place, False
            self._attempt(lambda: self.pointer.spawn("circle"))

    def on_mouse_move(self, event: Any) -> None:
        """Drag, or aim; without a button only remember where the pointer is."""
        place = self._cell(event)
        if self.pointer.pressed:
            region = self.canvas.region
            self.pointer.drag(event.screen_x - region.x, event.screen_y - region.y)
        elif place is not None and len(self.screen_stack) == 1 and not self.pointer.by_keys:
            self.pointer.at = place

    def on_mouse_up(self) -> None:
        """Let go."""
        if self.pointer.pressed:
            self.canvas.release_mouse()
            self._attempt(self.pointer.lift)

    def _cell(self, event: Any) -> tuple[int, int] | None:
        """Column and row in the picture of a mouse's event; None beside it."""
        region = self.canvas.region
        inside = region.contains(event.screen_x, event.screen_y)
        return (event.screen_x - region.x, event.screen_y - region.y) if inside else None
