"""Hands: where the pointer is, what it holds, and where it aims while the world is paused."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from course.sandbox.views.terminal.stage import Stage
    from course.sandbox.world.world import World

__all__ = ["Pointer"]

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
