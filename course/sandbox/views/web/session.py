"""One world and everybody who looks at it through a page.

The state lives here, so a page can be reloaded at any time. Time passes only while the page is visible.
"""

from __future__ import annotations

import asyncio
import math
from collections import deque
from collections.abc import Callable
from time import perf_counter
from typing import Annotated, Any, Literal, assert_never

import msgspec
import numpy as np
from msgspec import Meta

from course.errors import CourseError, UsageError
from course.sandbox.scene.loading import Chosen, Comparison
from course.sandbox.scene.model import Part
from course.sandbox.scene.rules import SETTINGS
from course.sandbox.views.story import Experiment, Narrator
from course.sandbox.world.engine import Floats
from course.sandbox.world.world import World

# ---
# Messages between a page and the world: small JSON requests one way, float32 frames the other.


#: Bytes of one request. The longest that a page ever sends has about 150.
MAX_REQUEST = 1024
#: Requests a second that a page may keep up, and how many at once: a page sends one pointer position for
#: each of its frames, and slider moves on top.
_RATE, _BURST = 200.0, 300.0
#: float32 numbers in front of the bodies; ``world.js`` reads them by the same names.
FRAME_HEAD = 21
#: Columns of the past: time, five energies, two momenta.
_PAST = ("t", "kinetic", "potential", "contacts", "friction", "rods", "residual", "px", "py")

Number = float
Name = Annotated[str, Meta(max_length=60)]


class _Request(msgspec.Struct, forbid_unknown_fields=True, tag_field="do"):
    """One request of a page; ``do`` says which."""


class Grab(_Request, tag="grab"):
    """Take what is nearest."""

    x: Number
    y: Number
    reach: Number = 0.3


class Drag(_Request, tag="drag"):
    """Move the hand."""

    x: Number
    y: Number


class Release(_Request, tag="release"):
    """Let go."""


class Throw(_Request, tag="throw"):
    """Give what is nearest a velocity."""

    x: Number
    y: Number
    vx: Number
    vy: Number
    reach: Number = 0.3


class Push(_Request, tag="push"):
    """Change the velocity of a body that is known by name, as keys do."""

    name: Name
    vx: Number
    vy: Number


class Spawn(_Request, tag="spawn"):
    """A new body."""

    shape: Literal["circle", "box"]
    x: Number
    y: Number


class Set(_Request, tag="set"):
    """Change a setting."""

    key: Annotated[str, Meta(max_length=40)]
    value: Number


class Pause(_Request, tag="pause"):
    """Stop time, or let it run."""

    on: bool


class Speed(_Request, tag="speed"):
    """How many simulated seconds a second."""

    value: Annotated[float, Meta(ge=0.001, le=10.0)]


class Step(_Request, tag="step"):
    """Single steps."""

    count: Annotated[int, Meta(ge=1, le=50)] = 1


class Reset(_Request, tag="reset"):
    """The scene from its start."""


class Guess(_Request, tag="guess"):
    """The answer to the scene's question; None to go without."""

    value: Number | None


class Watch(_Request, tag="watch"):
    """Whether the page is visible. The world waits while it is hidden."""

    on: bool


Request = Grab | Drag | Release | Throw | Push | Spawn | Set | Pause | Speed | Step | Reset | Guess | Watch

_DECODER: msgspec.json.Decoder[Request] = msgspec.json.Decoder(Request)


def read(data: str | bytes) -> Request:
    """One request.

    Raises:
        ValueError: it is too long or is none; the text says why, in one line.
    """
    raw = data.encode("utf-8", "replace") if isinstance(data, str) else data
    if len(raw) > MAX_REQUEST:
        raise ValueError(f"A request has at most {MAX_REQUEST} bytes.")
    try:
        return _DECODER.decode(raw)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise ValueError(f"Not understood: {str(error)[:160]}") from error


class Allowance:
    """How many requests a page may still send: a bucket that fills with time.

    Args:
        now: in s, on any clock.

    Attributes:
        refused: requests that were too many since the page was last well within its rate.
    """

    def __init__(self, now: float) -> None:
        self.refused = 0
        self._left, self._then = _BURST, now

    def take(self, now: float) -> bool:
        """True if one more is within the rate."""
        self._left = min(_BURST, self._left + (now - self._then) * _RATE)
        self._then = now
        if self._left < 1.0:
            self.refused += 1
            return False
        self._left -= 1.0
        # A page that was over its rate is told so again only after it has been quiet for a while.
        self.refused = 0 if self._left > _BURST / 2 else self.refused
        return True


def frame(world: World, pace: float) -> bytes:
    """Where everything is, as little-endian float32.

    ``FRAME_HEAD`` numbers: 1, version, t, pace, bodies, joints, whether a body is held, the four of
    the hand, kinetic, potential, contacts, friction, rods, residual, momentum x and y, angular momentum, row
    of the body that is held or -1. Then x, y, angle, vx, vy of each body, then the two ends of each joint.

    Args:
        pace: simulated seconds per second that were really made, as a part of those asked for.
    """
    shot, receipt, (px, py, angular) = world.snapshot(), world.receipt, world.momentum
    held = world.held
    row = next((i for i, part in enumerate(world.parts) if part.name == held), -1) if held else -1
    head = [
        *(1.0, shot.version, shot.t, pace, len(shot.x), len(shot.joints), shot.hand is not None),
        *(shot.hand or (0.0, 0.0, 0.0, 0.0)),
        *(
            receipt.kinetic,
            receipt.potential,
            receipt.contacts,
            receipt.friction,
            receipt.rods,
            receipt.residual,
        ),
        *(px, py, angular, row),
    ]
    bodies = np.stack([shot.x, shot.y, shot.angle, shot.vx, shot.vy], axis=1)
    return _packed(np.concatenate([np.array(head), bodies.ravel(), shot.joints.ravel()]))


def past(world: World, most: int = 900) -> bytes:
    """The past, for plots in a page that opened later.

    3, version, rows, columns, and then rows of t, kinetic, potential, contacts, friction, rods, residual, px
    and py.

    Args:
        most: rows at most; the last ones, about 60 of them a second.
    """
    history = world.history
    table = np.stack([getattr(history, name)[-most:] for name in _PAST], axis=1)
    return _packed(np.concatenate([np.array([3.0, world.version, *table.shape]), table.ravel()]))


def _packed(numbers: Floats) -> bytes:
    # What does not fit a float32 becomes infinite, which a page does not draw.
    with np.errstate(over="ignore"):
        return numbers.astype("<f4").tobytes()


def finite(value: float | None) -> float | None:
    """A number as JSON can carry it."""
    return value if value is not None and math.isfinite(value) else None


#: Pages that may look at one world at a time.
MAX_PAGES = 8
#: Frames a second, and how much of each may go into stepping; the rest is for drawing and for being quick.
_FPS, _BUDGET = 60.0, 0.012
#: Steps between looks at the clock.
_CHUNK = 16
#: The longest stretch of real time that is made up for, in s.
_GAP = 0.1
#: Texts that may wait for a page that reads slowly; one that is further behind is let go.
_WAITING = 400
#: Requests beyond the allowance, in one go, after which a page is let go.
_PATIENCE = 2000
#: A run that is over sooner than this, in s, starts in slow motion so that it can be seen.
_BLINK = 0.5


class Page:
    """One page's end: texts in order, and only the newest of the frames.

    Args:
        now: in s, on the session's clock.

    Attributes:
        watching: the page is visible.
        lost: it is not talked to any more.
    """

    def __init__(self, now: float) -> None:
        self.watching = True
        self.lost = False
        self.allowance = Allowance(now)
        self._texts: deque[str | bytes] = deque()
        self._frame: bytes | None = None
        self._news = asyncio.Event()

    def tell(self, message: str | bytes) -> None:
        """Something that must arrive."""
        if len(self._texts) >= _WAITING:
            self.let_go()
            return
        self._texts.append(message)
        self._news.set()

    def let_go(self) -> None:
        """Do not talk to it any more."""
        self.lost = True
        self._news.set()

    def show(self, data: bytes) -> None:
        """A frame; one that was not fetched yet is forgotten."""
        self._frame = data
        self._news.set()

    def take(self) -> str | bytes | None:
        """The next message to send; None if there is none."""
        if self._texts:
            return self._texts.popleft()
        data, self._frame = self._frame, None
        return data

    async def fetch(self) -> str | bytes | None:
        """Wait for the next message to send; None if the page is closed."""
        while not self.lost:
            data = self.take()
            if data is not None:
                return data
            self._news.clear()
            await self._news.wait()
        return None


class Session:
    """A world that pages look at.

    Args:
        world: before its first step, with a receipt.
        chosen: its scene, with the parameters that went into it.
        guess: an answer to the scene's question that was given elsewhere.
        keep: called with each comparison that has a guess.
        clock: real time in s.
    """

    def __init__(
        self,
        world: World,
        chosen: Chosen,
        *,
        guess: float | None = None,
        keep: Callable[[Comparison], None] | None = None,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        self.world = world
        self.scene = chosen.scene
        self.pages: list[Page] = []
        self.experiment = Experiment(world, chosen, guess, keep)
        self._clock = clock
        self._narrator = Narrator()
        self._holder: Page | None = None
        self._wake = asyncio.Event()
        self._seen: tuple[Any, ...] = ()
        self._told: dict[str, Any] = {}
        self._version = -1
        self._pace = 1.0
        if chosen.scene.duration < _BLINK:
            world.speed = float(f"{chosen.scene.duration / 2:.1g}")
        world.paused = self.experiment.stage == "ask"

    # -- pages -----------------------------------------------------------------------------------

    def join(self) -> Page | None:
        """A new page, with everything it has to know; None if there are too many."""
        if len(self.pages) >= MAX_PAGES:
            return None
        page = Page(self._clock())
        page.tell(_json(self._introduction()))
        page.tell(_json(self._bodies()))
        page.tell(past(self.world))
        page.show(frame(self.world, self._pace))
        self.pages.append(page)
        self._wake.set()
        return page

    def leave(self, page: Page) -> None:
        """A page is gone; what it held is let go."""
        if page in self.pages:
            self.pages.remove(page)
        self._drop(page)

    def receive(self, page: Page, data: str | bytes) -> None:
        """A request of a page: done, or answered with what is wrong with it. Never raises for its content."""
        if not page.allowance.take(self._clock()):
            if page.allowance.refused == 1:
                page.tell(_json({"type": "error", "message": "Too many requests at once; some are dropped."}))
            elif page.allowance.refused > _PATIENCE:
                page.let_go()
            return
        try:
            self._do(page, read(data))
        except UsageError as error:
            page.tell(_json({"type": "error", "message": error.message}))
        except ValueError as error:
            page.tell(_json({"type": "error", "message": str(error)}))
        self._wake.set()

    def _drop(self, page: Page) -> None:
        if self._holder is page:
            self._holder = None
            self.world.release()
            self._wake.set()

    # -- requests --------------------------------------------------------------------------------

    def _do(self, page: Page, request: Request) -> None:  # noqa: C901, PLR0912 - one line for each
        world = self.world
        match request:
            case Grab(x, y, reach):
                if world.grab(x, y, reach):
                    self._holder = page
                    self.experiment.touch()
            case Drag(x, y):
                if self._holder is page:
                    world.drag(x, y)
            case Release():
                self._drop(page)
            case Throw(x, y, vx, vy, reach):
                if world.throw(x, y, vx, vy, reach):
                    self.experiment.touch()
            case Push(name, vx, vy):
                self._push(name, vx, vy)
            case Spawn(shape, x, y):
                world.spawn(shape, x, y)
                self.experiment.touch()
            case Set(key, value):
                world.set(key, value)
                self.experiment.changed()
            case Pause(on):
                world.paused = on
                if not on:
                    self.experiment.answer(None)
            case Speed(value):
                world.speed = value
            case Step(count):
                self.experiment.answer(None)
                world.paused = True
                world.step(count)
            case Reset():
                self._holder = None
                world.reset()
                self.experiment.again()
                self._narrator.forget()
                self._tell({"type": "events", "events": [], "anew": True})
            case Guess(value):
                self.experiment.answer(value)
                world.paused = False
            case Watch(on):
                page.watching = on
            case _:
                assert_never(request)

    def _push(self, name: str, vx: float, vy: float) -> None:
        world = self.world
        row = next((i for i, part in enumerate(world.parts) if part.name == name), None)
        if row is None or world.parts[row].fixed:
            raise UsageError(f"There is no {name!r} that moves.", code="bad_parameter")
        self.experiment.touch()
        shot = world.snapshot()
        x, y = float(shot.x[row]), float(shot.y[row])
        world.throw(x, y, float(shot.vx[row]) + vx, float(shot.vy[row]) + vy, 0.0)

    # -- time ------------------------------------------------------------------------------------

    async def run(self) -> None:
        """Let time pass, until cancelled."""
        last = self._clock()
        due = last
        while True:
            if not any(page.watching for page in self.pages) or not self._moves():
                self._wake.clear()
                if not self._moves():
                    self.tick(0.0)
                await self._wake.wait()
                last = due = self._clock()
            now = self._clock()
            self.tick(now - last)
            last = now
            due = max(due + 1.0 / _FPS, self._clock())
            # At least a moment for everybody else, however long the stepping took.
            await asyncio.sleep(max(due - self._clock(), 0.001))

    def _moves(self) -> bool:
        return not self.world.paused

    def tick(self, real_dt: float) -> None:
        """Let real time pass, and show pages what became of it."""
        self._advance(min(real_dt, _GAP))
        events = self.world.drain_events()
        self.experiment.take(events)
        try:
            if self.experiment.passed():
                self.world.paused = True
        except CourseError as error:
            # The comparison stands, it only could not be kept.
            self.world.paused = True
            self._tell({"type": "error", "message": error.message})
        lines = self._narrator.tell(events, self._clock())
        if lines:
            self._tell({"type": "events", "events": lines})
        if self.world.version != self._version:
            self._version = self.world.version
            self._tell(self._bodies())
        status = self._status()
        if status != self._told:
            self._told = status
            self._tell(status)
        seen = (self.world.ticks, self.world.version, self.world.held)
        if seen != self._seen or not self._moves():
            self._seen = seen
            data = frame(self.world, self._pace)
            for page in self.pages:
                if page.watching:
                    page.show(data)

    def _advance(self, dt: float) -> None:
        """Step for this long, but not longer than a frame has time for."""
        world = self.world
        if world.paused or dt <= 0.0:
            return
        left = self.experiment.left()
        stop = left is not None and dt * world.speed >= left
        if stop and left is not None:
            dt = left / world.speed
        parts = max(1, math.ceil(dt * world.speed / world.settings["step"] / _CHUNK))
        began, made = self._clock(), parts
        for number in range(1, parts + 1):
            world.advance(dt / parts)
            if self._clock() - began > _BUDGET:
                made = number
                break
        if stop and made == parts:
            world.run_until(self.scene.duration)
        self._pace += 0.1 * (made / parts - self._pace)

    # -- what is said ----------------------------------------------------------------------------

    def _tell(self, message: dict[str, Any]) -> None:
        text = _json(message)
        for page in self.pages:
            page.tell(text)

    def _status(self) -> dict[str, Any]:
        world = self.world
        return {
            "type": "status",
            "settings": dict(world.settings),
            "paused": world.paused,
            "speed": world.speed,
            **self.experiment.report(),
        }

    def _bodies(self) -> dict[str, Any]:
        return {
            "type": "bodies",
            "version": self.world.version,
            "bodies": [_body(part) for part in self.world.parts],
        }

    def _introduction(self) -> dict[str, Any]:
        scene, world = self.scene, self.world
        offered = {
            key: setting
            for key, setting in SETTINGS.items()
            if key in world.settings or key not in {"left", "right"}
        }
        asked = scene.prediction
        return {
            "type": "scene",
            "title": scene.title,
            "teaches": scene.teaches,
            "note": " ".join(scene.note.split()),
            "after": scene.after,
            "view": scene.view,
            "duration": scene.duration,
            "above": scene.floor is not None or not any(scene.gravity),
            "knobs": [msgspec.to_builtins(setting) for setting in offered.values()],
            "unit": asked.unit if asked else "",
            "events": self._narrator.told(),
            "status": self._status(),
        }


def _body(part: Part) -> dict[str, Any]:
    return {
        "name": part.name,
        "shape": part.shape,
        "outline": part.outline,
        "radius": part.radius,
        "fixed": part.fixed,
        "colour": part.colour,
        "mass": finite(part.mass),
        "track": part.wheels.track if part.wheels else 0.0,
    }


def _json(message: dict[str, Any]) -> str:
    # Numbers that are none become null here, so a page's JSON.parse never meets them.
    return msgspec.json.encode(message).decode()
