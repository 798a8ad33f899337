"""The program behind the view in a terminal: what keys and the mouse do, and one frame after the other."""

from collections.abc import Callable
from functools import partial
from time import perf_counter
from typing import Any, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding
from textual.containers import Horizontal
from textual.geometry import Size

from course.errors import CourseError, UsageError
from course.full_screen import FullScreenApp
from course.sandbox.runs.tape import Filming
from course.sandbox.scene.loading import NO_GUESS, guess_of, scenes
from course.sandbox.scene.rules import SETTINGS
from course.sandbox.views.stage import Desk, Stage
from course.sandbox.views.story import Experiment
from course.sandbox.views.terminal import asking, words
from course.sandbox.views.terminal.hand import Pointer, Sight
from course.sandbox.world.world import NUMBERS, World

#: Of a film, in pixels.
_FILM_WIDTH = 640
#: How often numbers and curves are written anew, in s: the eye reads no faster.
_READ = 0.2
#: Pictures a second, and for those who asked for little motion.
_FPS, _CALM_FPS = 30.0, 4.0
_LOWEST = 12
#: Slowest and fastest, in simulated seconds a second.
_SLOWEST, _FASTEST = 1 / 1024, 16.0

_COLOURS = {"ink": "#d5dae1", "paper": "#1b2028", "bar": "#2a323d"}


class SandboxApp(FullScreenApp):
    """A stage, its picture, and everything that a user can do to it.

    Args:
        stage: what is played; None to begin with the gallery.
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
        Binding("full_stop", "stage('step', 'picture')", show=False),
        Binding("comma", "stage('step', 'back')", show=False),
        Binding("less_than_sign", "jump(-0.5)", show=False),
        Binding("greater_than_sign", "jump(0.5)", show=False),
        Binding("colon", "stage('step', 'solver')", show=False),
        Binding("x", "stage('step', 'contact')", show=False),
        Binding("j", "stage('play_back', -1)", show=False),
        Binding("k", "now", show=False),
        Binding("u,ctrl+z", "stage('undo')", show=False),
        Binding("U,ctrl+y", "stage('redo')", show=False),
        Binding("v", "pointer('aim_at')", show=False),
        Binding("y", "near('copy')", show=False),
        Binding("delete,backspace", "near('remove')", show=False),
        Binding("s", "stop", show=False),
        Binding("slash", "change", show=False),
        Binding("o,escape", "scenes", show=False),
        Binding("pageup", "zoom(1.25)", show=False),
        Binding("pagedown", "zoom(0.8)", show=False),
        Binding("home", "zoom(0)", show=False),
        Binding("z", "follow", show=False),
        Binding("t", "trace", show=False),
        Binding("Z", "ghost", show=False),
        Binding("ctrl+s", "film", show=False),
        Binding("r", "reset", show=False),
        Binding("minus,underscore", "speed(0.5)", show=False),
        Binding("plus,equals_sign", "speed(2.0)", show=False),
        Binding("question_mark,f1", "help", show=False),
        Binding("c", "pointer('spawn', 'circle')", show=False),
        Binding("b", "pointer('spawn', 'box')", show=False),
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
            for name, (less, more, _) in words.KEYS.items()
            for key, way in ((less, -1), (more, 1))
        ),
    ]

    def __init__(
        self,
        stage: Stage | None = None,
        desk: Desk | None = None,
        *,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        super().__init__(clock)
        self.desk = desk or Desk()
        self._first = self._gallery_first = stage is None
        self._budget = 0.5 / _FPS
        self.put_on(stage or self.desk.stage(scenes()[0].id, clock))
        self.calm = self.animation_level != "full"
        self._last = clock()
        self._film: Filming | None = None
        self._read_at = -1.0
        self._drawn_at = -1.0
        self._panel_wanted = True
        self._room, self._below = Size(80, 24), 1  # lines below the picture
        ink, paper, bar = (_COLOURS[name] if self.in_colour else None for name in ("ink", "paper", "bar"))
        self.canvas = words.Canvas(colour=self.in_colour, id="canvas")
        self.head = words.Lines(ink, bar, id="head")
        self.panel = words.Lines(ink, paper, id="panel")
        self.events = words.Lines(ink, paper, id="events")
        self.keys = words.Lines(ink, bar, id="keys")

    def put_on(self, stage: Stage) -> None:
        self.stage = stage
        self.sight = Sight(stage, colour=self.in_colour)
        self.pointer = Pointer(stage, self.sight)
        self._lines: list[tuple[float, str]] = []
        self._anew = stage.anew
        self._compared = ""
        if not self._first:
            self.desk.opens(stage)
        self._first = False

    @property
    def world(self) -> World:
        return self.stage.world

    @property
    def experiment(self) -> Experiment:
        return self.stage.experiment

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
        self.begin()

    def begin(self) -> None:
        self._last = self._clock()
        self.set_interval(1 / _FPS, self.tick)
        self.world.paused = self.calm
        if self._gallery_first:
            self.action_scenes()

    def on_resize(self, event: Any) -> None:
        self._room = event.size
        self._lay_out()

    def _lay_out(self) -> None:
        width, height = self._room
        beside = self._panel_wanted and width >= asking.NARROW
        self.panel.display = beside
        self.panel.styles.width = 26 if width < 76 else 30 if width < 110 else 46
        self.events.display = height >= _LOWEST
        events = 2 if height < 20 else 3 if height < 30 else 5 if height < 40 else 8
        self._below = 1 + (events if self.events.display else 0)
        self.keys.styles.height, self.events.styles.height = 1, events
        self.renew()

    # -- time ------------------------------------------------------------------------------------

    def tick(self) -> None:
        now = self._clock()
        dt, self._last = now - self._last, now
        if len(self.screen_stack) == 1:
            self._hear(self.stage.tick(dt, self._budget), now)
        if not self.calm or now - self._drawn_at >= 1 / _CALM_FPS or self._drawn_at < 0:
            self._drawn_at = now
            self._draw(now)
        if now - self._read_at >= _READ or self._read_at < 0:
            self._read_at = now
            self._write()

    def _hear(self, told: list[dict[str, Any]], now: float) -> None:
        stage = self.stage
        if stage.anew != self._anew:
            self._anew, self._lines, told = stage.anew, [], stage.narrator.told()
            self.sight.forget()
            self.renew()
        heard = ((line.get("t", self.world.t), words.clean(line["text"])) for line in told)
        self._lines = [*self._lines, *heard][-400:]
        if not self.calm:
            self.sight.flash(stage.heard, now)
        stage.heard = []
        for text in stage.news:
            self.say(text)
        stage.news.clear()
        result = self.experiment.report()["comparison"]
        verdict = f"{result['verdict']} p: the numbers" if result else ""
        if verdict and verdict != self._compared:
            self.say(verdict)
        self._compared = verdict
        if self._film is not None and not self._film.running:
            film, self._film, save = self._film, None, self.desk.save
            self._attempt(lambda: film.failed or (save and f"Saved: {save(film.name, film.data)}"))

    def _draw(self, now: float) -> None:
        width, height = self.canvas.size
        if width and height:
            hand = self.pointer
            self.canvas.show(self.sight.draw(width, height, now, pointer=hand.shown, aim=hand.aim))
        self.head.show(
            [words.head(self.world, self.stage.t, self._state(), self.stage.pace, self._room.width)]
        )

    def _state(self) -> str:
        if self.pointer.aim is not None:
            return f"aiming: {self.pointer.aim_in_words()}"
        if self.stage.working is not None:
            says, share = self.stage.working
            return f"{says}: {100 * share:.0f} %, k stops it"
        if self._film is not None:
            return f"Making the film: {100 * self._film.share:.0f} %, k stops it"
        if self.stage.at is not None:
            return f"of {self.world.t:.3f} s {('', '▶', '◀')[self.stage.way]}"
        if self.world.paused:
            return "paused"
        return "all out of view: r or Home" if self.sight.empty else ""

    def _write(self) -> None:
        if self.panel.display:
            width, height = self.panel.size
            rule = "│ " if width > 2 else ""
            room = width - len(rule) - 1
            lines = words.panel(self.stage, self._parameters(), room, height) if height else []
            lines += [((" ", ""),)] * (height - len(lines))
            self.panel.show([((rule, "dim"), *line) for line in lines])
        text = self.message or self.pointer.status()
        said = words.wrapped(text, max(10, self._room.width - 2))[: self._below]
        if self.keys.styles.height is None or self.keys.styles.height.value != len(said):
            # A longer sentence takes its lines from the events: the picture keeps its size.
            self.keys.styles.height, self.events.styles.height = len(said), self._below - len(said)
        self.events.show(self._told(self.events.size.width, self.events.size.height))
        if text:
            self.keys.show([((f" {piece}", "bold"),) for piece in said])
        else:
            paused = self.world.paused if self.stage.at is None else not self.stage.way
            past, compared = self.stage.at is not None, self.experiment.stage == "done"
            self.keys.show([words.keys_line(self._room.width, paused=paused, past=past, compared=compared)])

    def _told(self, width: int, height: int) -> list[words.Line]:
        """The latest events before the time that is shown, whole ones, newest at the bottom."""
        lines: list[words.Line] = []
        for text in reversed([text for t, text in self._lines if t <= self.stage.t]):
            pieces = words.wrapped(text, max(10, width - 3))
            if lines and len(lines) + len(pieces) > height:
                break
            lines[:0] = [(((" " if i == 0 else "   ") + piece, ""),) for i, piece in enumerate(pieces)]
        return lines[-height:] if height else []

    def renew(self) -> None:
        """Draw and write everything with the next frame."""
        self._read_at = self._drawn_at = -1.0

    def say(self, message: str) -> None:
        super().say(words.clean(message))
        self._read_at = -1.0

    def _parameters(self) -> list[tuple[str, str]]:
        """The scene's own numbers, in words."""
        values = self.stage.chosen.parameters
        units = {one.name: one.unit.removesuffix("1") for one in self.stage.chosen.scene.parameter}
        return [
            (words.clean(name), words.clean(f"{values[name]:.4g} {unit}")) for name, unit in units.items()
        ]

    # -- asking ----------------------------------------------------------------------------------

    def action_question(self) -> None:
        """The scene's question, or its answer; a guess starts the run that is compared."""
        scene = self.stage.chosen.scene
        result, asked = self.experiment.report()["comparison"], scene.prediction
        if asked is None:
            self.say("This scene does not ask for a number.")
            return
        if self.experiment.stage == "done" and result is not None:
            page = asking.comparison(result, scene.after)
            hint = "Escape: back   r: again   p: guess"

            def read(key: str | None) -> None:
                if key == "r":
                    self.action_reset()
                elif key == "p":
                    self._ask(asked.unit)

            self.push_screen(
                asking.PageOverlay("Predicted, run, compared", page, keys=("r", "p"), hint=hint), read
            )
        else:
            self._ask(asked.unit)

    def _ask(self, unit: str) -> None:
        def answered(guess: float | None) -> None:
            if guess is not None:
                self._attempt(lambda: self.stage.guess(guess))
                self.say(f"Your guess: {guess:g} {'' if unit == '1' else unit}")

        def guessed(line: str) -> float:
            guess = guess_of(line, unit)
            if guess is None:
                raise UsageError(NO_GUESS)
            return guess

        # The question and no more: what is said of the scene stands in its help.
        overlay = asking.LineOverlay(
            "Before it runs: your guess",
            [(words.clean(self.experiment.question), "")],
            guessed,
            wanted=f"a number in {words.clean(unit)}",
            below="Enter: run, compare   Escape: back",
            calm=self.calm,
        )
        self.push_screen(overlay, answered)

    def action_scenes(self) -> None:
        """All scenes; time stands meanwhile."""

        def chosen(name: str | None) -> None:
            if name is None:
                return
            self.put_on(self.desk.stage(name, self._clock))
            self.world.paused = self.calm
            self.renew()

        if self.stage.at is None:
            self.pointer.drop()
        current, played = self.stage.chosen.scene.id, self.desk.played
        gallery = asking.Gallery(scenes(), played, current, colour=self.in_colour, calm=self.calm)
        self.push_screen(gallery, chosen)

    def action_change(self) -> None:
        """The scene's own numbers, and those of the body near the pointer."""
        scene, near = self.stage.chosen.scene, self.pointer.near()
        page: list[str | tuple[str, str]] = [("This scene's", "")]
        for one, (name, text) in zip(scene.parameter, self._parameters(), strict=True):
            page.append((name, f"{text} ({one.low:g} to {one.high:g}): {words.clean(one.meaning)}"))
        page += [] if scene.parameter else ["It has none of its own."]
        if near is not None:
            page += ["", (f"Of {near}", "")]
            page += [
                (key, f"{self.world.number_of(near, key):.4g} {'' if unit == '1' else unit}")
                for key, (unit, *_) in NUMBERS.items()
            ]
        page += ["", "mine: the scene as a file of your own.", ""]

        overlay = asking.LineOverlay(
            "Change a number",
            page,
            partial(self._change, near=near),
            wanted="name and number, for example: angle 45",
            below="Enter: change it   Escape: back",
        )
        self.push_screen(overlay, lambda says: self.say(says) if says else None)

    def _change(self, line: str, near: str | None) -> str:
        name, _, text = line.replace("=", " ").strip().rpartition(" ")
        name = name.strip()
        if line == "mine":
            made, says = self.desk.mine(self.stage)
            self.put_on(made)
            return says
        value = guess_of(text, "")
        if value is None:
            said = f"{text[:30]} is not a number: type" if name else "Type"
            raise UsageError(f"{said} a name and a number, for example angle 45.")
        if name in self.stage.chosen.parameters:
            self.stage.set_parameter(name, value)
        elif name in SETTINGS:
            self.stage.act("set", name, value)
        elif near is not None and name in NUMBERS:
            self.stage.act("change", near, name, value)
        else:
            raise UsageError(f"There is no {name[:30]!r} to change here.")
        return f"{name}: {value:g}"

    def action_help(self) -> None:
        pages = asking.help_pages(self.stage.chosen.scene, wheels="left" in self.world.settings)
        self.push_screen(asking.PageOverlay("Keys, and this scene", pages))

    def action_events(self) -> None:
        page = [text for _, text in self._lines] or ["Nothing happened yet."]
        self.push_screen(asking.PageOverlay("What happened", page, at_end=True))

    # -- keys ------------------------------------------------------------------------------------

    def action_pause(self) -> None:
        stage = self.stage
        stage.run(on=stage.world.paused if stage.at is None else not stage.way)
        self.renew()

    def action_stage(self, what: str, *given: Any) -> None:
        """What a stage does by itself, by the name of its method."""
        self._attempt(lambda: getattr(self.stage, what)(*given))
        self.renew()

    def action_jump(self, seconds: float) -> None:
        self._attempt(lambda: self.stage.look(self.stage.t + seconds))
        self.renew()

    def action_now(self) -> None:
        """Back to now, or stop what is being made."""
        if self.stage.working is not None:
            self.stage.stop_work()
        elif self._film is not None:
            self._film.stopped = True
        self.stage.present()
        self.renew()

    def action_reset(self) -> None:
        """Begin again; settings stay."""
        self.stage.present()
        self.pointer.drop()
        self._attempt(lambda: self.stage.act("reset"))
        self.say("From the start.")

    def action_pointer(self, what: str, *given: Any) -> None:
        """What a pointer does by itself, by the name of its method."""
        self._attempt(lambda: getattr(self.pointer, what)(*given))

    def action_near(self, what: str) -> None:
        name = self.pointer.near()
        if name is None:
            self.say("No body is near the pointer.")
            return
        self._attempt(lambda: self.stage.act(what, name))

    def action_stop(self) -> None:
        self._attempt(lambda: self.stage.act("stop") or "Everything stands still.")

    def action_zoom(self, factor: float) -> None:
        """Closer, farther, or all of it."""
        self.sight.zoom(factor)
        self.renew()

    def action_follow(self) -> None:
        self.sight.follow = None if self.sight.follow else self.pointer.near()
        self.say(f"The view follows {self.sight.follow}." if self.sight.follow else "The view stands.")

    def action_trace(self) -> None:
        self.sight.trace = None if self.sight.trace else self.pointer.near()
        self.say(f"The path of {self.sight.trace} is drawn." if self.sight.trace else "No path is drawn.")

    def action_ghost(self) -> None:
        if self.stage.ghost is None:
            self.say("There is no run before this one: start it again first (r).")
            return
        self.sight.ghost = not self.sight.ghost
        self.say("The run before is shown as dots." if self.sight.ghost else "The run before is gone.")

    def action_film(self) -> None:
        if self._film is not None or self.desk.save is None:
            self.say("One film is being made already." if self._film else "Nothing can be saved from here.")
            return
        self._film = self.stage.film("gif", _FILM_WIDTH)

    def action_speed(self, factor: float) -> None:
        self.world.speed = min(_FASTEST, max(_SLOWEST, self.world.speed * factor))
        self.say(f"Time passes at {words.speed_in_words(self.world.speed)}.")

    def action_notch(self, key: str, way: int) -> None:
        spec = SETTINGS[key]
        if key in {"left", "right"} and key not in self.world.settings:
            self.say("Nothing here has wheels.")
            return
        now = self.world.settings.get(key)
        if now is None:
            # Until then each body has its own; the first press starts from the value that most of them have.
            now = 0.0 if key == "walls" else self.sight.usual(key)
        value = now * spec.notch**way if spec.times else now + way * spec.notch
        value = float(round(value)) if spec.whole else round(value, 9)
        value = min(spec.high, max(spec.low, value))
        self._attempt(lambda: self.stage.act("set", key, value))
        self.say(f"{words.KEYS[key][2]}: {words.setting(key, value)} ({spec.meaning})")

    def action_take(self) -> None:
        """Grab the body near the keyboard's pointer, or let it go; of the past, go on from here."""
        self._attempt(self.pointer.toggle if self.stage.at is None else self.stage.go_on)

    def action_point(self, dx: int, dy: int) -> None:
        """Move the keyboard's pointer by this many cells; drive what has wheels."""
        if "left" in self.world.settings and abs(dx) + abs(dy) == 1 and self.pointer.placing is None:
            for key, turn in (("left", dx), ("right", -dx)):
                value = round(min(5.0, max(-5.0, self.world.settings[key] + 0.1 * (turn - dy))), 9)
                self._attempt(partial(self.stage.act, "set", key, value))
            wheels = (f"{key} {self.world.settings[key]:.2g}" for key in ("left", "right"))
            self.say(f"Wheels: {', '.join(wheels)} m/s.")
        else:
            self._attempt(lambda: self.pointer.move_by(dx, dy))
        self.renew()

    def action_names(self) -> None:
        self.sight.names = not self.sight.names
        self.say("Names on." if self.sight.names else "Names only where there is room.")

    def action_calm(self) -> None:
        self.calm = not self.calm
        self.say("Calm: four pictures a second, no flashes." if self.calm else "All pictures, all flashes.")

    def action_panel(self) -> None:
        self._panel_wanted = not self._panel_wanted
        self._lay_out()

    def _attempt(self, deed: Callable[[], Any]) -> None:
        try:
            message = deed()
        except CourseError as error:
            message = error.message
        if isinstance(message, str) and " " in message:
            self.say(message)

    # -- the mouse -------------------------------------------------------------------------------

    def on_mouse_down(self, event: Any) -> None:
        """Take a body that is near, or the picture; the other button aims, or adds a new ball."""
        place = self._cell(event)
        if place is None or len(self.screen_stack) > 1:
            return
        self.canvas.capture_mouse()
        self._attempt(lambda: self.pointer.press(*place, aims=event.button != 1))

    def on_mouse_scroll_up(self) -> None:
        self.action_zoom(1.1)

    def on_mouse_scroll_down(self) -> None:
        self.action_zoom(1 / 1.1)

    def on_mouse_move(self, event: Any) -> None:
        """Drag, or aim; without a button only remember where the pointer is."""
        place = self._cell(event)
        if self.pointer.pressed:
            region = self.canvas.region
            self._attempt(lambda: self.pointer.drag(event.screen_x - region.x, event.screen_y - region.y))
        elif place is not None and len(self.screen_stack) == 1 and not self.pointer.by_keys:
            self.pointer.at = place

    def on_mouse_up(self) -> None:
        if self.pointer.pressed:
            self.canvas.release_mouse()
            self._attempt(self.pointer.lift)

    def _cell(self, event: Any) -> tuple[int, int] | None:
        """Column and row in the picture of a mouse's event; None beside it."""
        region = self.canvas.region
        inside = region.contains(event.screen_x, event.screen_y)
        return (event.screen_x - region.x, event.screen_y - region.y) if inside else None
