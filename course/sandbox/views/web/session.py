"""The stages that pages look at, and everybody who does.

The state lives here, so a page can be reloaded at any time. Time passes only while the page is visible.
"""

import asyncio
import contextlib
import functools
import operator
from collections import deque
from collections.abc import Callable
from time import perf_counter
from typing import Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta

from course.errors import CourseError, UsageError
from course.sandbox.runs.tape import Filming, Frame, preview
from course.sandbox.scene.loading import choose, scene_ids, scenes
from course.sandbox.scene.model import Part
from course.sandbox.scene.rules import SEED, settings_of
from course.sandbox.views.stage import BUDGET, Desk, Stage
from course.sandbox.world.engine import Floats
from course.sandbox.world.world import NUMBERS

# ---
# Messages between a page and the world: small JSON requests one way, float32 frames the other.


#: The modules of the page, each after those that it needs; a notebook takes them in as one.
SCRIPTS = ("camera", "plots", "draw", "cards", "tools", "world")
#: Bytes of one request. The longest that a page ever sends has about 150.
MAX_REQUEST = 1024
#: Requests a second that a page may keep up, and how many at once: a page sends one pointer position for
#: each of its frames, and slider moves on top.
_RATE, _BURST = 200.0, 300.0
#: Columns of the past that plots show: time, six energies, two momenta.
_PAST = 9

_Name = Annotated[str, Meta(max_length=80)]
_Key = Annotated[str, Meta(max_length=40)]
_Reach = (float, 0.3)
#: What a page may ask, by ``do``: its fields, each with its type and what it is if left out.
REQUESTS: dict[str, dict[str, Any]] = {
    # Hands: each is a method of the world, with the same arguments.
    "grab": {"x": float, "y": float, "reach": _Reach},
    "drag": {"x": float, "y": float},
    "release": {},
    "throw": {"x": float, "y": float, "vx": float, "vy": float, "reach": _Reach},
    "spawn": {"shape": Literal["circle", "box"], "x": float, "y": float},
    "place": {"name": _Name, "x": float, "y": float},
    "aim": {"name": _Name, "vx": float, "vy": float},
    "change": {"name": _Name, "key": _Key, "value": float},
    "remove": {"name": _Name},
    "copy": {"name": _Name},
    "stop": {},
    "set": {"key": _Key, "value": float},
    "reset": {},
    # To change the velocity of a body, as keys do.
    "push": {"name": _Name, "vx": float, "vy": float},
    # Time.
    "pause": {"on": bool},
    "speed": {"value": Annotated[float, Meta(ge=0.001, le=10.0)]},
    "step": {"kind": (Literal["picture", "back", "contact", "solver"], "picture")},
    "undo": {},
    "redo": {},
    "look": {"t": float | None},
    "play": {"way": Annotated[int, Meta(ge=-1, le=1)]},
    "go": {},
    "cancel": {},
    "ghost": {"on": bool},
    "trace": {"name": _Name},
    "film": {"kind": Literal["gif", "mp4", "png"], "width": (Annotated[int, Meta(ge=64, le=1920)], 960)},
    # The scene: its question, its parameters, another one, one's own.
    "guess": {"value": float | None},
    "parameter": {"key": _Name, "value": float},
    "scenes": {},
    "open": {"id": _Name},
    "mine": {},
    # Whether the page is visible; the world waits while it is hidden.
    "watch": {"on": bool},
}


#: Of these, what a stage does itself.
_STAGES = {name: name for name in ("step", "undo", "redo", "guess")} | {"play": "play_back", "go": "go_on"}


def _struct(name: str, fields: dict[str, Any]) -> type[msgspec.Struct]:
    shaped = [(field, *kind) if isinstance(kind, tuple) else (field, kind) for field, kind in fields.items()]
    return msgspec.defstruct(name, shaped, tag_field="do", tag=name, forbid_unknown_fields=True)


_UNION: Any = functools.reduce(operator.or_, (_struct(*one) for one in REQUESTS.items()))
_DECODER: msgspec.json.Decoder[msgspec.Struct] = msgspec.json.Decoder(_UNION)


def read(data: str | bytes) -> tuple[str, tuple[Any, ...]]:
    """One request: what to do, and with which values.

    Raises:
        ValueError: it is too long or is none; the text says why, in one line.
    """
    raw = data.encode("utf-8", "replace") if isinstance(data, str) else data
    if len(raw) > MAX_REQUEST:
        raise ValueError(f"A request has at most {MAX_REQUEST} bytes.")
    try:
        request = _DECODER.decode(raw)
        return type(request).__name__, msgspec.structs.astuple(request)
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


def past(stage: Stage) -> bytes:
    """The past, for plots in a page that opened later: at most 900 rows, 60 a second or more.

    3, rows, columns, and then rows of t, kinetic, potential, contacts, friction, rods, residual, px
    and py. A first number of 2 says that these rows come after what was sent before.
    """
    return _rows(3.0, stage.tape.samples()[-900:])


def _rows(kind: float, rows: Frame) -> bytes:
    return _packed(np.concatenate([np.array([kind, len(rows), _PAST]), rows[:, :_PAST].ravel()]))


def _packed(numbers: Floats | Frame) -> bytes:
    # What does not fit a float32 becomes infinite, which a page does not draw.
    with np.errstate(over="ignore"):
        return numbers.astype("<f4").tobytes()


#: Pages that may look at one world at a time.
MAX_PAGES = 8
_FPS = 60.0
#: Between two frames at least, in s.
_MOMENT = 0.004
#: Texts that may wait for a page that reads slowly; one that is further behind is let go.
_WAITING = 400
#: Rows for the plots that may wait: a minute of them.
_MOST_ROWS = 3600
#: Requests beyond the allowance, in one go, after which a page is let go.
_PATIENCE = 2000
#: What the first number of a message says besides a frame (1) and the past (2, 3).
_CARD, _PATH, _FILM = 4.0, 5.0, 6.0


class Page:
    """One page's end: texts in order, of each world only the newest frame, and all rows for the plots.

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
        self._frames: dict[int, bytes] = {}
        self._rows: list[Frame] = []
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

    def show(self, data: bytes, number: int = 0) -> None:
        """A frame of a world; one that was not fetched yet is forgotten."""
        self._frames[number] = data
        self._news.set()

    def take(self) -> str | bytes | None:
        """The next message to send; None if there is none."""
        if self._texts:
            return self._texts.popleft()
        if self._frames:
            return self._frames.pop(next(iter(self._frames)))
        rows, self._rows = self._rows, []
        return _rows(2.0, np.array(rows)) if rows else None

    def add(self, rows: Frame) -> None:
        """Rows for the plots, which go out together when the page has time for them."""
        self._rows = [*self._rows, *rows][-_MOST_ROWS:]
        self._news.set()

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
    """Stages that pages look at.

    Args:
        stage: what is played; the first scene, with the gallery open, if there is none.
        clock: real time in s.

    Attributes:
        gallery: pages open with the gallery.
    """

    def __init__(
        self,
        stage: Stage | None = None,
        desk: Desk | None = None,
        *,
        clock: Callable[[], float] = perf_counter,
    ) -> None:
        self.desk = desk or Desk()
        self.pages: list[Page] = []
        self._clock = clock
        self._wake = asyncio.Event()
        self._told: dict[str, Any] = {}
        self._cards: dict[str, tuple[str, bytes]] = {}
        self._wanted: deque[tuple[Page, str]] = deque()
        self._film: tuple[Page, Filming] | None = None
        self._put_on(stage or self.desk.stage(scenes()[0].id), gallery=stage is None)
        self.stage.world.paused = self.gallery

    def _put_on(self, stage: Stage, *, gallery: bool = False) -> None:
        """Play this from now on, in place."""
        self.stage, self.gallery = stage, gallery
        if not gallery:
            self.desk.opens(stage)
        self._holder: Page | None = None
        self._seen: tuple[Any, ...] = ()
        self._ghost, self._cast_of_ghost, self._version = False, -1, stage.world.version
        self._anew, self._sent, self._marked = stage.anew, stage.world.t, len(stage.tape.marks)
        for page in self.pages:
            self._introduce(page)

    # -- pages -----------------------------------------------------------------------------------

    def join(self) -> Page | None:
        """A new page, with everything it has to know; None if there are too many."""
        if len(self.pages) >= MAX_PAGES:
            return None
        page = Page(self._clock())
        self._introduce(page)
        self.pages.append(page)
        self._wake.set()
        return page

    def _introduce(self, page: Page) -> None:
        page.tell(_json(self._introduction()))
        page.tell(_json(self._bodies()))
        page.tell(past(self.stage))
        page.show(_packed(self.stage.frame()))

    def leave(self, page: Page) -> None:
        """A page is gone; what it held is let go."""
        if page in self.pages:
            self.pages.remove(page)
        self._drop(page)

    def receive(self, page: Page, data: str | bytes) -> None:
        """A request of a page: done, or answered with what is wrong with it. Never raises for its content."""
        if not page.allowance.take(self._clock()):
            if page.allowance.refused == 1:
                self._warn(page, "Too many requests at once; some are dropped.")
            elif page.allowance.refused > _PATIENCE:
                page.let_go()
            return
        try:
            self._do(page, *read(data))
        except CourseError as error:
            self._warn(page, error.message)
        except ValueError as error:
            self._warn(page, str(error))
        self._wake.set()

    def _drop(self, page: Page) -> None:
        if self._holder is page:
            self._holder = None
            if self.stage.world.held:
                self.stage.act("release")
            self._wake.set()

    # -- requests --------------------------------------------------------------------------------

    def _do(self, page: Page, what: str, given: tuple[Any, ...]) -> None:
        own = getattr(self, f"_do_{what}", None)
        if own is not None:
            own(page, *given)
        elif what in _STAGES:
            getattr(self.stage, _STAGES[what])(*given)
        else:
            self.stage.act(what, *given)

    def _do_grab(self, page: Page, x: float, y: float, reach: float) -> None:
        if self.stage.act("grab", x, y, reach):
            self._holder = page

    def _do_drag(self, page: Page, x: float, y: float) -> None:
        if self._holder is page:
            self.stage.act("drag", x, y)

    def _do_release(self, page: Page) -> None:
        self._drop(page)

    def _do_push(self, _: Page, name: str, vx: float, vy: float) -> None:
        world = self.stage.world
        now = [world.number_of(name, key) if world.moves(name) else 0.0 for key in ("vx", "vy")]
        self.stage.act("aim", name, now[0] + vx, now[1] + vy)

    def _do_reset(self, _: Page) -> None:
        self._holder = None
        self.stage.present()
        self.stage.act("reset")

    def _do_pause(self, _: Page, on: bool) -> None:
        self.stage.run(on=not on)

    def _do_speed(self, _: Page, value: float) -> None:
        self.stage.world.speed = value

    def _do_look(self, _: Page, t: float | None) -> None:
        self._holder = None
        self.stage.look(t)

    def _do_cancel(self, _: Page) -> None:
        self.stage.stop_work()
        if self._film is not None:
            self._film[1].stopped = True

    def _do_ghost(self, _: Page, on: bool) -> None:
        if on and self.stage.ghost is None:
            raise UsageError("There is no run before this one: start it again first.", code="no_ghost")
        self._ghost, self._seen = on, ()

    def _do_trace(self, page: Page, name: str) -> None:
        rows = self.stage.tape.path(name)
        page.tell(_packed(np.concatenate([np.array([_PATH, len(rows)]), rows.ravel()])))

    def _do_film(self, page: Page, kind: str, width: int) -> None:
        if self._film is not None:
            raise UsageError("One film is being made already.", code="busy")
        self._film = page, self.stage.film(kind, width)

    def _do_parameter(self, _: Page, key: str, value: float) -> None:
        if key not in self.stage.chosen.parameters:
            raise UsageError(f"This scene has no {key!r}.", code="bad_parameter")
        self.stage.present()
        self.stage.set_parameter(key, value)

    def _do_open(self, _: Page, name: str) -> None:
        if name not in scene_ids():
            raise UsageError(f"There is no scene called {name!r}.", code="scene_not_found")
        self._put_on(self.desk.stage(name))

    def _do_watch(self, page: Page, on: bool) -> None:
        page.watching = on

    def _do_scenes(self, page: Page) -> None:
        """Every scene, and then their previews, one after the other."""
        stage = self.stage
        if stage.at is None:
            stage.run(on=False)
        found = scenes()
        listed = [
            {"id": one.id, "title": one.title, "teaches": one.teaches, "view": one.view}
            | {"played": one.id in self.desk.played}
            for one in found
        ]
        page.tell(_json({"type": "scenes", "scenes": listed}))
        self._wanted.extend((page, one.id) for one in found)

    def _draw_card(self) -> None:
        """The next preview that somebody waits for."""
        page, name = self._wanted.popleft()
        if name not in self._cards:
            cast, places, joints = preview(choose(name))
            head = np.array([_CARD, len(places), len(cast), joints.shape[1]])
            numbers = np.concatenate([head, places.ravel(), joints.ravel()])
            card = {"type": "card", "id": name, "bodies": cast}
            self._cards[name] = _json(card), _packed(numbers)
        if page in self.pages:
            text, data = self._cards[name]
            page.tell(text)
            page.tell(data)

    def _do_mine(self, page: Page) -> None:
        made, says = self.desk.mine(self.stage)
        self._put_on(made)
        self._warn(page, says)

    @staticmethod
    def _warn(page: Page, message: str) -> None:
        page.tell(_json({"type": "error", "message": message}))

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
            self._wake.clear()
            # At least a moment for everybody else, and hands are answered at once.
            await asyncio.sleep(_MOMENT)
            # Not ``wait_for``: before Python 3.12 it swallows a cancelling that comes with what it waits for.
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(max(due - self._clock(), 0.0)):
                    await self._wake.wait()
                due = self._clock()

    def _moves(self) -> bool:
        return not self.stage.still or bool(self._wanted) or self._film is not None

    def tick(self, real_dt: float) -> None:
        """Let real time pass, and show pages what became of it."""
        stage = self.stage
        lines = stage.tick(real_dt, BUDGET)
        if self._wanted:
            self._draw_card()
        if stage.anew != self._anew:
            self._begin_anew()
            lines = []
        elif lines:
            self._tell({"type": "events", "events": lines})
        for text in stage.news:
            self._tell({"type": "error", "message": text})
        stage.news.clear()
        if stage.world.version != self._version:
            self._version = stage.world.version
            self._tell(self._bodies())
        self._tell_marks()
        if stage.at is None and not stage.working and stage.tape.times[-1] > self._sent:
            rows, self._sent = stage.tape.samples(self._sent), stage.tape.times[-1]
            for page in self.pages:
                page.add(rows)
        self._tell_film()
        status = self._status()
        if status != self._told:
            self._told = status
            self._tell(status)
        shown = stage.frame()
        seen = (stage.world.ticks, shown[1], stage.world.held, stage.at, self._ghost)
        if seen != self._seen or stage.still:
            self._seen = seen
            self._show(shown)

    def _show(self, shown: Frame) -> None:
        version = int(shown[1])
        data = _packed(shown)
        if version != self._version:  # bodies that were there at the time
            self._version = version
            self._tell(self._bodies(self.stage.parts(shown), version))
        watching = [page for page in self.pages if page.watching]
        for page in watching:
            page.show(data)
        ghost = self.stage.ghost
        if not self._ghost or ghost is None:
            return
        kept = ghost.frame_at(self.stage.t)
        if int(kept[1]) != self._cast_of_ghost:
            self._cast_of_ghost = int(kept[1])
            self._tell(self._bodies(ghost.casts[int(kept[1])], int(kept[1]), 1))
        kept = kept.copy()
        kept[21] = 1.0
        for page in watching:
            page.show(_packed(kept), 1)

    # -- what is said --------------------------------------------------------------------------------

    def _begin_anew(self) -> None:
        """The story does not go on from what was told: another run, or an earlier moment."""
        stage = self.stage
        self._anew, self._seen, self._cast_of_ghost = stage.anew, (), -1
        self._tell({"type": "events", "events": stage.narrator.told(), "anew": True})
        self._marked = -1
        self._sent = stage.world.t
        for page in self.pages:
            page.tell(past(stage))

    def _tell_marks(self) -> None:
        marks, told = self.stage.tape.marks, self._marked
        if len(marks) != told:
            self._marked = len(marks)
            self._tell({"type": "marks", "marks": marks[max(told, 0) :], "anew": told < 0})

    def _tell_film(self) -> None:
        if self._film is None or self._film[1].running:
            return
        (page, film), self._film = self._film, None
        if film.failed:
            self._warn(page, film.failed)
            return
        page.tell(_json({"type": "file", "name": film.name}))
        # Four bytes that say so, and then the file.
        page.tell(np.array([_FILM], dtype="<f4").tobytes() + film.data)

    def _tell(self, message: dict[str, Any]) -> None:
        text = _json(message)
        for page in self.pages:
            page.tell(text)

    def _status(self) -> dict[str, Any]:
        stage, working = self.stage, self.stage.working
        undo, redo = stage.undoable()
        if working is None and self._film is not None:
            working = "Making the film", self._film[1].share
        return {
            "type": "status",
            "settings": dict(stage.world.settings),
            "parameters": stage.chosen.parameters,
            "paused": stage.world.paused if stage.at is None else stage.way == 0,
            "speed": stage.world.speed,
            "at": stage.at,
            "now": None if stage.at is None else stage.world.t,
            "undo": undo,
            "redo": redo,
            "ghost": None if stage.ghost is None else self._ghost,
            "working": None if working is None else {"says": working[0], "share": round(working[1], 2)},
            **stage.experiment.report(),
        }

    def _bodies(
        self, parts: tuple[Part, ...] | None = None, version: int | None = None, number: int = 0
    ) -> dict[str, Any]:
        return {
            "type": "bodies",
            "world": number,
            "version": self.stage.world.version if version is None else version,
            "bodies": self.stage.world.parts if parts is None else parts,
        }

    def _introduction(self) -> dict[str, Any]:
        stage = self.stage
        scene = stage.chosen.scene
        asked = scene.prediction
        return {
            "type": "scene",
            "id": scene.id,
            "own": stage.chosen.own,
            "gallery": self.gallery,
            "title": scene.title,
            "teaches": scene.teaches,
            "note": " ".join(scene.note.split()),
            "after": scene.after,
            "view": scene.view,
            "duration": scene.duration,
            "above": scene.floor is not None or not any(scene.gravity),
            "parameters": scene.parameter,
            "knobs": [setting for setting in settings_of(scene) if setting is not SEED],
            "numbers": [
                {"name": name, "unit": unit, "low": low, "high": high}
                for name, (unit, low, high) in NUMBERS.items()
                if name != "spin"  # which no frame shows
            ],
            "marks": stage.tape.marks,
            "unit": asked.unit if asked else "",
            "events": stage.narrator.told(),
            "status": self._status(),
        }


def _json(message: dict[str, Any]) -> str:
    # Numbers that are none become null here, so a page's JSON.parse never meets them.
    return msgspec.json.encode(message).decode()
