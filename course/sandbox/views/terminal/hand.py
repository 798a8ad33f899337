"""Hands: where the pointer is, what it holds, and where it aims while the world is paused."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from statistics import median

import numpy as np

from course.sandbox.views.terminal.picture import Camera, Cells, Overlay, Picture, Spark, reaches
from course.sandbox.world.accounts import Event
from course.sandbox.world.world import World

#: How far from a body a press still takes it, in cells. A hand hits a cell, not a pixel.
REACH = 4.0
#: An aim as long as the view is high gives this many view heights a second.
_SLING = 3.0


class Pointer:
    """A mouse, or a cross moved by arrows, over a picture of a world.

    Args:
        stage: its camera maps cells to places.
        on_touch: called before anything is done to a body.

    Attributes:
        at: column and row in the picture; None before anything pointed anywhere.
        by_keys: arrows moved it last, so it is drawn.
        pressed: the mouse's button is down over the picture.
        aim: where a throw starts and where it points, in m: ax, ay, bx, by; None if nothing is aimed.
    """

    def __init__(self, world: World, stage: Stage, *, on_touch: Callable[[], None]) -> None:
        self.at: tuple[int, int] | None = None
        self.by_keys = False
        self.pressed = False
        self.aim: tuple[float, float, float, float] | None = None
        self._world, self._stage, self._touch = world, stage, on_touch

    @property
    def reach(self) -> float:
        """In m."""
        return REACH / self._stage.camera.scale

    @property
    def shown(self) -> tuple[float, float] | None:
        """Where the keyboard's pointer is, in m, if it is in use."""
        return self._place() if self.by_keys else None

    def _place(self) -> tuple[float, float]:
        camera = self._stage.camera
        if self.at is None:
            self.at = camera.columns // 2, camera.rows // 2
        return camera.place(*self.at)

    # -- mouse -----------------------------------------------------------------------------------

    def press(self, column: int, row: int) -> str | None:
        """The button goes down. Returns a message, or ""."""
        self.at, self.by_keys, self.pressed = (column, row), False, True
        return self._take()

    def drag(self, column: int, row: int) -> None:
        """The pointer moves with the button down."""
        self.at = column, row
        self._follow()

    def lift(self) -> str | None:
        """The button goes up."""
        self.pressed = False
        return self._let_go()

    # -- keys ------------------------------------------------------------------------------------

    def move_by(self, dx: int, dy: int) -> None:
        """Arrows move the pointer by cells; it stays in the picture."""
        self._place()
        camera = self._stage.camera
        column, row = self.at or (0, 0)
        if self.by_keys:
            column, row = column + dx, row + dy
        self.at = min(max(column, 0), camera.columns - 1), min(max(row, 0), camera.rows - 1)
        self.by_keys = True
        self._follow()

    def toggle(self) -> str | None:
        """Grab a body that is near, or let go of the one held."""
        self.by_keys = True
        return self._let_go() if self._world.held or self.aim else self._take()

    # -- both ------------------------------------------------------------------------------------

    def spawn(self, shape: str) -> str | None:
        """A new body at the pointer."""
        self._touch()
        x, y = self._place()
        return f"{self._world.spawn(shape, x, y)} appears."

    def drop(self) -> None:
        """Forget everything that is held or aimed."""
        self.aim = None
        self.pressed = False
        self._world.release()

    def aim_in_words(self) -> str:
        """How fast and which way a throw would go."""
        vx, vy = self._velocity()
        return f"{math.hypot(vx, vy):.2f} m/s at {math.degrees(math.atan2(vy, vx)):.0f}°"

    def status(self) -> str:
        """The held body and its speed, for the last line; "" if no body is held."""
        name = self._world.held
        if name is None:
            return ""
        shot = self._world.snapshot()
        row = next((i for i, part in enumerate(self._world.parts) if part.name == name), None)
        if row is None:
            return ""
        vx, vy = float(shot.vx[row]), float(shot.vy[row])
        return (
            f"{name}: {math.hypot(vx, vy):.2f} m/s, {self._world.parts[row].mass:.3g} kg. Let go to throw it."
        )

    def _take(self) -> str | None:
        x, y = self._place()
        if self._world.paused:
            # The world is paused, so a hand cannot pull: it aims instead.
            near = self._stage.nearest(x, y, self.reach)
            if near is not None:
                name, ax, ay = near
                self.aim = ax, ay, ax, ay
                return f"{name}: pull to where it shall fly, and let go. Space lets time run."
        elif self._world.grab(x, y, self.reach) is not None:
            self._touch()
            return None
        return "Nothing to hold there. Right button or c: a new ball, b: a new box."

    def _follow(self) -> None:
        x, y = self._place()
        if self.aim is not None:
            self.aim = *self.aim[:2], x, y
        else:
            self._world.drag(x, y)

    def _velocity(self) -> tuple[float, float]:
        if self.aim is None:
            return 0.0, 0.0
        ax, ay, bx, by = self.aim
        return _SLING * (bx - ax), _SLING * (by - ay)

    def _let_go(self) -> str | None:
        world = self._world
        if self.aim is None:
            world.release()
            return None
        (ax, ay), (vx, vy) = self.aim[:2], self._velocity()
        self.aim = None
        if vx == 0.0 and vy == 0.0:
            return None
        self._touch()
        name = world.throw(ax, ay, vx, vy, 0.0)
        return f"{name} will fly at {math.hypot(vx, vy):.2f} m/s. Space lets time run." if name else None


# ---
# The world as it looks now: which picture, through which camera, with which flashes.


#: How long a contact flashes, in s of real time, and how many flash at once.
_FLASH, _MOST = 0.3, 40


class Stage:
    """Draws a world into the room that there is.

    Attributes:
        camera: of the last frame.
        names: label every body.
    """

    def __init__(self, world: World, *, colour: bool) -> None:
        self.camera = Camera.fit(world.scene.view, 80, 24)
        self.names = False
        self._world, self._colour = world, colour
        self._picture: Picture | None = None
        self._version = -1
        #: Places and strengths of contacts, and when they were, in s.
        self._flashes: list[tuple[float, float, float, float]] = []

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
        shot = self._world.snapshot()
        if (columns, rows) != (self.camera.columns, self.camera.rows):
            self.camera = Camera.fit(self._world.scene.view, columns, rows)
            self._picture = None
        if self._picture is None or shot.version != self._version:
            self._picture = Picture(self._world.parts, self.camera, self._colour)
            self._version = shot.version
        self._flashes = [flash for flash in self._flashes if now - flash[3] < _FLASH]
        sparks = tuple(Spark(x, y, glow * (1 - (now - at) / _FLASH)) for x, y, glow, at in self._flashes)
        over = Overlay(pointer=pointer, pull=aim, sparks=sparks, names=self.names)
        return self._picture.draw(shot, over)

    def flash(self, events: Iterable[Event], now: float) -> None:
        """Let contacts flash, harder ones more; soft ones do not."""
        _, bottom, _, top = self._world.scene.view
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
        shot, parts = self._world.snapshot(), self._world.parts
        gaps = np.hypot(shot.x - x, shot.y - y) - reaches(parts)
        gaps[[part.fixed for part in parts]] = np.inf
        if not len(gaps) or not np.nanmin(gaps) <= reach:
            return None
        row = int(np.nanargmin(gaps))
        return parts[row].name, float(shot.x[row]), float(shot.y[row])

    def usual(self, key: str) -> float:
        """The value that most moving bodies have, for a setting that each has of its own."""
        return float(median([getattr(part, key) for part in self._world.parts if not part.fixed] or [0.5]))
