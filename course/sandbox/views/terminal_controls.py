"""What keys and the mouse do to a world in a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from textual.app import App
from textual.binding import Binding

from course.errors import UsageError
from course.sandbox.settings import SETTINGS
from course.sandbox.views.terminal_pace import speed_in_words
from course.sandbox.views.terminal_words import KEYS, setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.sandbox.views.story import Experiment, Teller
    from course.sandbox.views.terminal_hand import Pointer
    from course.sandbox.views.terminal_lines import Canvas
    from course.sandbox.views.terminal_scene import Stage
    from course.sandbox.world import World

__all__ = ["Controls"]

#: Slowest and fastest, in simulated seconds a second.
_SLOWEST, _FASTEST = 1 / 1024, 16.0


class Controls(App[None]):
    """The part of the view that acts; see ``course.sandbox.views.terminal_app.SandboxApp``."""

    world: World
    experiment: Experiment
    stage: Stage
    pointer: Pointer
    canvas: Canvas
    calm: bool
    _stopped: bool
    _panel_wanted: bool
    _lines: list[str]
    _teller: Teller

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

    def say(self, message: str) -> None:
        """Show something in the last line for a moment."""
        raise NotImplementedError

    def ask(self) -> None:
        """The scene's question."""
        raise NotImplementedError

    def renew(self, *, layout: bool = False) -> None:
        """Draw and write everything with the next frame, or give each part its room anew."""
        raise NotImplementedError

    # -- keys ------------------------------------------------------------------------------------

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Keys of the world do nothing while something is laid over it."""
        del parameters
        return action == "quit" or len(self.screen_stack) == 1 or not hasattr(self, f"action_{action}")

    def action_pause(self) -> None:
        """Run, or stand still."""
        self.world.paused = not self.world.paused
        self._stopped = False
        self.renew()

    def action_single(self) -> None:
        """One step, and pause."""
        self.world.paused = True
        self.world.step()
        self.renew()

    def action_reset(self) -> None:
        """From the start; settings stay."""
        self.pointer.drop()
        self.world.reset()
        self.experiment.again()
        self.stage.forget()
        self._teller.forget()
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
            # Each body has its own until then; the first press says one for all, where those that move are.
            now = self.stage.usual(key)
        value = now * spec.notch**way if spec.times else now + way * spec.notch
        value = float(round(value)) if spec.whole else round(value, 9)
        value = min(spec.high, max(spec.low, value))
        self.world.set(key, value)
        self.experiment.changed()
        self.say(f"{KEYS[key][2]}: {setting(key, value)} ({spec.meaning})")

    def action_spawn(self, shape: str) -> None:
        """A new body at the pointer."""
        self._try(lambda: self.pointer.spawn(shape))

    def action_take(self) -> None:
        """Take what is near the keyboard's pointer, or let it go."""
        self._try(self.pointer.toggle)

    def action_point(self, dx: int, dy: int) -> None:
        """Move the keyboard's pointer by this many cells."""
        self.pointer.move_by(dx, dy)
        self.renew()

    def action_names(self) -> None:
        """Label every body, or only the large ones."""
        self.stage.names = not self.stage.names
        self.say("Names on." if self.stage.names else "Names only where there is room.")

    def action_calm(self) -> None:
        """Little motion, or all of it."""
        self.calm = not self.calm
        self.say("Calm: four pictures a second, no flashes." if self.calm else "All pictures, all flashes.")

    def action_panel(self) -> None:
        """Hide or show what is beside the picture."""
        self._panel_wanted = not self._panel_wanted
        self.renew(layout=True)

    def _try(self, deed: Callable[[], str | None]) -> None:
        try:
            message = deed()
        except UsageError as error:
            message = error.message
        if message:
            self.say(message)

    # -- the mouse -------------------------------------------------------------------------------

    def on_mouse_down(self, event: Any) -> None:
        """Take what is near, or put a new ball there."""
        place = self._cell(event)
        if place is None or len(self.screen_stack) > 1:
            return
        if event.button == 1:
            self.canvas.capture_mouse()
            self._try(lambda: self.pointer.press(*place))
        else:
            self.pointer.at, self.pointer.by_keys = place, False
            self._try(lambda: self.pointer.spawn("circle"))

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
            self._try(self.pointer.lift)

    def _cell(self, event: Any) -> tuple[int, int] | None:
        """Column and row in the picture of a mouse's event; None beside it."""
        region = self.canvas.region
        inside = region.contains(event.screen_x, event.screen_y)
        return (event.screen_x - region.x, event.screen_y - region.y) if inside else None
