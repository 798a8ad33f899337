"""Hands: where the pointer is, what it holds, and where it aims while the world is paused."""

from __future__ import annotations

import math
from collections.abc import Iterable
from statistics import median

import numpy as np

from course.printable import command
from course.sandbox.runs.tape import shot_of
from course.sandbox.scene.model import Part
from course.sandbox.views.stage import Stage
from course.sandbox.views.terminal.picture import Camera, Cells, Overlay, Picture, Spark, reaches
from course.sandbox.world.accounts import Event
from course.sandbox.world.engine import Floats
from course.sandbox.world.world import Snapshot

#: How far from a body a press still takes it, in cells. A hand hits a cell, not a pixel.
REACH = 4.0
#: An aim as long as the view is high gives this many view heights a second.
_SLING = 3.0


class Pointer:
    """A mouse, or a cross moved by arrows, over a picture of a world.

    Args:
        sight: its camera maps cells to places.

    Attributes:
        at: column and row in the picture; None before anything pointed anywhere.
        by_keys: arrows moved it last, so it is drawn.
        pressed: the mouse's button is down over the picture.
        placing: the body that is carried while time stands.
        aim: where a throw starts and where it points, in m: ax, ay, bx, by; None if nothing is aimed.
        panning: the cell by which the picture itself is dragged.
    """

    def __init__(self, stage: Stage, sight: Sight) -> None:
        self.at: tuple[int, int] | None = None
        self.by_keys = False
        self.pressed = False
        self.placing: str | None = None
        self.aim: tuple[float, float, float, float] | None = None
        self.panning: tuple[int, int] | None = None
        self._aimed = ""
        self._stage, self._sight = stage, sight

    @property
    def reach(self) -> float:
        """In m."""
        return REACH / self._sight.camera.scale

    @property
    def shown(self) -> tuple[float, float] | None:
        """Where the keyboard's pointer is, in m, if it is in use."""
        return self._place() if self.by_keys else None

    def near(self) -> str | None:
        """The movable body near the pointer."""
        found = self._sight.nearest(*self._place(), self.reach)
        return found[0] if found else None

    def _place(self) -> tuple[float, float]:
        camera = self._sight.camera
        if self.at is None:
            self.at = camera.columns // 2, camera.rows // 2
        return camera.place(*self.at)

    # -- mouse -----------------------------------------------------------------------------------

    def press(self, column: int, row: int, *, aims: bool = False) -> str | None:
        """The button goes down; the other one aims. Returns a message, or None."""
        self.at, self.by_keys, self.pressed = (column, row), False, True
        if self.near() is None:
            self.panning = None if aims else (column, row)
            return self.spawn("circle") if aims else None
        return self.aim_at() if aims else self._take()

    def drag(self, column: int, row: int) -> None:
        """The pointer moves with the button down."""
        if self.panning is not None:
            self._sight.pan(self.panning[0] - column, self.panning[1] - row)
            self.panning = column, row
        self.at = column, row
        self._follow()

    def lift(self) -> str | None:
        """The button goes up."""
        self.pressed, self.panning = False, None
        return self._let_go()

    # -- keys ------------------------------------------------------------------------------------

    def move_by(self, dx: int, dy: int) -> None:
        """Arrows move the pointer by cells; at an edge they move the picture."""
        self._place()
        camera = self._sight.camera
        column, row = self.at or (0, 0)
        if self.by_keys:
            column, row = column + dx, row + dy
        self.at = min(max(column, 0), camera.columns - 1), min(max(row, 0), camera.rows - 1)
        if self.at != (column, row):
            self._sight.pan(column - self.at[0], row - self.at[1])
        self.by_keys = True
        self._follow()

    def toggle(self) -> str | None:
        """Grab a body that is near, or let go of the one held."""
        self.by_keys = True
        return self._let_go() if self._stage.world.held or self.aim or self.placing else self._take()

    # -- both ------------------------------------------------------------------------------------

    def spawn(self, shape: str) -> str | None:
        """A new body at the pointer."""
        return f"{self._stage.act('spawn', shape, *self._place())} appears."

    def aim_at(self) -> str | None:
        """Aim the body that is near, or let it have what it is aimed at."""
        if self.aim is not None:
            return self._let_go()
        near = self._sight.nearest(*self._place(), self.reach)
        if near is None:
            return "Nothing to aim there."
        self._aimed, ax, ay = near
        self.aim = ax, ay, ax, ay
        return f"{self._aimed}: point where it should fly, and let go."

    def drop(self) -> None:
        """Forget everything that is held or aimed."""
        self.aim = self.placing = None
        self.pressed = False
        if self._stage.world.held:
            self._stage.act("release")

    def aim_in_words(self) -> str:
        """How fast and which way a throw would go."""
        vx, vy = self._velocity()
        return f"{math.hypot(vx, vy):.2f} m/s at {math.degrees(math.atan2(vy, vx)):.0f}°"

    def status(self) -> str:
        """The held body and its speed, for the last line; "" if no body is held."""
        world = self._stage.world
        name = world.held
        if name is None:
            return ""
        mass, vx, vy = (world.number_of(name, key) for key in ("mass", "vx", "vy"))
        return f"{name}: {math.hypot(vx, vy):.2f} m/s, {mass:.3g} kg. Let go to throw it."

    def _take(self) -> str | None:
        if self._stage.world.paused:
            # A hand cannot pull while time stands: it carries.
            self.placing = self.near()
            if self.placing is not None:
                page = command("sandbox", "play", self._stage.chosen.scene.id, "--web").strip("`")
                return f"{self.placing} is carried, cell by cell; by eye it goes in the page: {page}"
        elif self._stage.act("grab", *self._place(), self.reach) is not None:
            return None
        return "Nothing to hold there. Right button or c: a new ball, b: a new box."

    def _follow(self) -> None:
        x, y = self._place()
        if self.aim is not None:
            self.aim = *self.aim[:2], x, y
        elif self.placing is not None and self._stage.world.moves(self.placing):
            self._stage.act("place", self.placing, x, y)
        elif self._stage.world.held:
            self._stage.act("drag", x, y)

    def _velocity(self) -> tuple[float, float]:
        if self.aim is None:
            return 0.0, 0.0
        ax, ay, bx, by = self.aim
        return _SLING * (bx - ax), _SLING * (by - ay)

    def _let_go(self) -> str | None:
        if self.placing is not None:
            name, self.placing = self.placing, None
            return f"{name} stays there. Space lets time run, u takes it back."
        if self.aim is None:
            if self._stage.world.held:
                self._stage.act("release")
            return None
        vx, vy = self._velocity()
        self.aim = None
        if vx == 0.0 and vy == 0.0:
            return None
        self._stage.act("aim", self._aimed, vx, vy)
        return f"{self._aimed} will fly at {math.hypot(vx, vy):.2f} m/s."


# ---
# The world as it looks now: which picture, through which camera, with which flashes.


#: How long a contact flashes, in s of real time, and how many flash at once.
_FLASH, _MOST = 0.3, 40


class Sight:
    """Draws a stage into the room that there is.

    Attributes:
        names: label every body.
        trace: the body whose path is drawn.
        ghost: draw the run before as well.
        empty: nothing that moves was in the last frame.
    """

    def __init__(self, stage: Stage, *, colour: bool) -> None:
        self.names = self.ghost = self.empty = False
        self.trace: str | None = None
        self.follow: str | None = None
        self._stage, self._colour = stage, colour
        self._zoom, self._off = 1.0, (0.0, 0.0)
        self._room = 80, 24
        self._pictures: dict[tuple[int, Camera], Picture] = {}
        #: Places and strengths of contacts, and when they were, in s.
        self._flashes: list[tuple[float, float, float, float]] = []
        self._aim_camera()

    def _aim_camera(self) -> None:
        left, bottom, right, top = self._stage.chosen.scene.view
        (x, y), half = self._off, 0.5 / self._zoom
        cx, cy = (left + right) / 2 + x, (bottom + top) / 2 + y
        wide, high = (right - left) * half, (top - bottom) * half
        self.camera = Camera.fit((cx - wide, cy - high, cx + wide, cy + high), *self._room)

    def zoom(self, factor: float) -> None:
        """Closer or farther; 0 shows all of it."""
        if factor == 0:
            self._zoom, self._off, self.follow = 1.0, (0.0, 0.0), None
        self._zoom = min(20.0, max(0.25, self._zoom * (factor or 1.0)))
        self._aim_camera()

    def pan(self, columns: int, rows: int) -> None:
        """Move the picture by cells."""
        scale = self.camera.scale
        self._off = self._off[0] + columns / scale, self._off[1] - 2 * rows / scale
        self.follow = None
        self._aim_camera()

    def draw(
        self,
        columns: int,
        rows: int,
        now: float,
        *,
        pointer: tuple[float, float] | None = None,
        aim: tuple[float, float, float, float] | None = None,
    ) -> Cells:
        """The next frame.

        Args:
            now: real time, in s.
            pointer: where the keyboard's pointer is, in m, if it is in use.
            aim: where a throw starts and where it points, in m, if one is aimed.
        """
        stage = self._stage
        shot, parts = self._shot()
        if self.follow is not None:
            row = next((i for i, part in enumerate(parts) if part.name == self.follow), None)
            if row is not None:
                left, bottom, right, top = stage.chosen.scene.view
                self._off = float(shot.x[row]) - (left + right) / 2, float(shot.y[row]) - (bottom + top) / 2
                self._aim_camera()
        if (columns, rows) != self._room:
            self._room = columns, rows
            self._aim_camera()
        self.empty = self._empty(shot, parts)
        key = shot.version, self.camera
        if key not in self._pictures:
            self._pictures = {key: Picture(parts, self.camera, self._colour)}
        self._flashes = [flash for flash in self._flashes if now - flash[3] < _FLASH]
        sparks = tuple(Spark(x, y, glow * (1 - (now - at) / _FLASH)) for x, y, glow, at in self._flashes)
        over = Overlay(pointer=pointer, pull=aim, sparks=sparks, names=self.names, dots=self._dots())
        return self._pictures[key].draw(shot, over)

    def _empty(self, shot: Snapshot, parts: tuple[Part, ...]) -> bool:
        free = np.array([not part.fixed for part in parts], dtype=bool)
        x, y = self.camera.pixels(shot.x, shot.y)
        wide, high = self.camera.columns, 2 * self.camera.rows
        if not free.any() or (free & (x >= 0) & (x <= wide) & (y >= 0) & (y <= high)).any():
            return False
        size = reaches(parts) * self.camera.scale
        return not (free & (x > -size) & (x < wide + size) & (y > -size) & (y < high + size)).any()

    def _shot(self) -> tuple[Snapshot, tuple[Part, ...]]:
        shown = self._stage.frame()
        return shot_of(shown), self._stage.parts(shown)

    def _dots(self) -> Floats:
        """A path, and where bodies were at this time of the run before; (k, 2)."""
        stage, found = self._stage, [np.zeros((0, 2))]
        if self.trace is not None:
            path = stage.tape.path(self.trace, 400)
            found.append(path[path[:, 0] <= stage.t + 1e-6, 1:].astype(float))
        if self.ghost and stage.ghost is not None:
            kept = stage.ghost.frame_at(stage.t)
            shot, cast = shot_of(kept), stage.ghost.casts[int(kept[1])]
            free = [not part.fixed for part in cast]
            found.append(np.stack([shot.x, shot.y], axis=1)[free])
        return np.concatenate(found)

    def flash(self, events: Iterable[Event], now: float) -> None:
        """Let contacts flash, harder ones more; soft ones do not."""
        _, bottom, _, top = self._stage.world.scene.view
        for event in events:
            if event.kind == "contact" and not event.minor:
                # As bright as can be at a speed that would cross the picture in a second.
                glow = 0.2 + 0.8 * min(1.0, abs(event.approach) / (top - bottom))
                self._flashes.append((event.x, event.y, glow, now))
        del self._flashes[:-_MOST]

    def forget(self) -> None:
        """The world was reset: stop all flashes."""
        self._flashes = []

    def nearest(self, x: float, y: float, reach: float) -> tuple[str, float, float] | None:
        """Name and place of the movable body nearest to a place; None if none is within ``reach`` m."""
        shot, parts = self._shot()
        gaps = np.hypot(shot.x - x, shot.y - y) - reaches(parts)
        gaps[[part.fixed for part in parts]] = np.inf
        if not len(gaps) or not np.nanmin(gaps) <= reach:
            return None
        row = int(np.nanargmin(gaps))
        return parts[row].name, float(shot.x[row]), float(shot.y[row])

    def usual(self, key: str) -> float:
        """The value that most moving bodies have, for a setting that each has of its own."""
        values = [getattr(part, key) for part in self._stage.world.parts if not part.fixed]
        return float(median(values or [0.5]))
