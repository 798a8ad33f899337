"""The world as it looks now: which picture, through which camera, with which flashes."""

from __future__ import annotations

from statistics import median
from typing import TYPE_CHECKING

import numpy as np

from course.sandbox.views.terminal.camera import Camera
from course.sandbox.views.terminal.picture import Overlay, Picture, Spark
from course.sandbox.views.terminal.shapes import reaches

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.sandbox.views.terminal.picture import Cells
    from course.sandbox.world.events import Event
    from course.sandbox.world.world import World

__all__ = ["Stage"]

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
