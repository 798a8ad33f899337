"""What somebody does to a running world: settings, dragging, throwing, new bodies."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from course.errors import UsageError
from course.sandbox.events import Event
from course.sandbox.parts import spawned
from course.sandbox.pushes import Hand
from course.sandbox.scene import Material
from course.sandbox.settings import SETTINGS, checked, number

if TYPE_CHECKING:
    from collections import deque
    from collections.abc import Callable, Mapping

    from course.sandbox.accounts import Accounts, Clock
    from course.sandbox.engine import Space
    from course.sandbox.parts import Part
    from course.sandbox.scene import Scene

__all__ = ["MAX_BODIES", "Hands"]

MAX_BODIES = 1000


class Hands:
    """The part of a world that hands touch; see ``course.sandbox.world.World``."""

    scene: Scene
    settings: dict[str, float]
    ticks: int
    on_input: Callable[[int, str, tuple[Any, ...]], None] | None
    _space: Space
    _accounts: Accounts
    _clock: Clock
    _events: deque[Event]
    _wheeled: list[Part]
    _hand: Hand | None
    _spawned: int

    def reset(self) -> None:
        """Back to the start of the scene; settings that were changed stay changed."""
        self._input("reset")
        self._events.clear()
        self._build(dict(self.settings))

    def set(self, key: str, value: float) -> None:
        """Change a setting; see ``course.sandbox.settings.SETTINGS``.

        Raises:
            UsageError: it is unknown or out of range, or the scene has no wheels.
        """
        amount = checked(key, value)
        if key in {"left", "right"} and not self._wheeled:
            raise UsageError("Nothing in this scene has wheels.", code="bad_parameter")
        self._input("set", key, amount)
        self._settle()
        self.settings[key] = amount
        if key == "gravity":
            self._space.space.gravity = self._gravity()
            self._accounts.recast(self._gravity())
        elif key == "restitution":
            self._space.set_material(restitution=amount)
        elif key == "friction":
            self._space.set_material(friction=amount)
        elif key == "iterations":
            self._space.space.iterations = int(amount)
        elif key == "step":
            self._clock.resize(amount)
        self._say(f"{key} is now {amount:g} {SETTINGS[key].unit}".removesuffix(" 1"))

    def grab(self, x: float, y: float, reach: float = 0.3) -> str | None:
        """Take hold of the body nearest to a place.

        Args:
            x, y: in m.
            reach: how far its surface may be away, in m.

        Returns:
            its name; None if there was nothing to hold.
        """
        x, y = self._place(x, y)
        reach = _bounded(reach, "reach")
        self.release()
        name = self._space.nearest(x, y, reach)
        if name is None:
            return None
        self._input("grab", x, y, reach)
        # A near miss holds the middle: pulling at a point outside would spin it wildly.
        inside = self._space.nearest(x, y, 0.0) == name
        anchor = self._space.body(name).world_to_local((x, y)) if inside else (0.0, 0.0)
        self._hand = Hand(name, (float(anchor[0]), float(anchor[1])), x, y)
        self._say(f"a hand takes {name}", name)
        return name

    def drag(self, x: float, y: float) -> None:
        """Move the hand; nothing happens if it is empty."""
        x, y = self._place(x, y)
        if self._hand is not None:
            self._input("drag", x, y)
            self._hand.x, self._hand.y = x, y

    def release(self) -> None:
        """Let go; the body flies on with the speed it has."""
        if self._hand is not None:
            self._input("release")
            self._say(f"the hand lets go of {self._hand.name}", self._hand.name)
            self._hand = None

    def throw(self, x: float, y: float, vx: float, vy: float, reach: float = 0.3) -> str | None:
        """Give the body nearest to a place this velocity, in m/s. Returns its name, or None."""
        x, y = self._place(x, y)
        vx, vy, reach = _bounded(vx, "vx"), _bounded(vy, "vy"), _bounded(reach, "reach")
        name = self._space.nearest(x, y, reach)
        if name is None:
            return None
        self._input("throw", x, y, vx, vy, reach)
        self._settle()
        self._space.body(name).velocity = vx, vy
        self._accounts.gave()
        self._say(f"{name} is thrown at {math.hypot(vx, vy):.2f} m/s", name)
        return name

    def spawn(
        self, shape: str, x: float, y: float, vx: float = 0.0, vy: float = 0.0, size: float = 0.0
    ) -> str:
        """Put a new body in.

        Args:
            shape: "circle" or "box".
            x, y, vx, vy: in m and m/s.
            size: radius or half the side, in m; a thirtieth of the view's height if 0.

        Returns:
            its name.

        Raises:
            UsageError: another shape, a size out of range, or too many bodies.
        """
        height = self.scene.view[3] - self.scene.view[1]
        size = number(size, "size") or height / 30
        if shape not in {"circle", "box"}:
            raise UsageError(
                f"{str(shape)[:20]!r} cannot be spawned; circle and box can.", code="bad_parameter"
            )
        if len(self._space.parts) >= MAX_BODIES:
            raise UsageError(f"There are {MAX_BODIES} bodies; that is enough.", code="too_many_bodies")
        if not height / 1000 <= size <= height:
            raise UsageError(f"size must be from {height / 1000:g} to {height:g} m.", code="bad_parameter")
        x, y = self._place(x, y)
        vx, vy = _bounded(vx, "vx"), _bounded(vy, "vy")
        self._input("spawn", shape, x, y, vx, vy, size)
        self._settle()
        self._spawned += 1
        name = f"new-{self._spawned}"
        self._space.add(spawned(name, shape, size, (x, y), (vx, vy), Material(name="new")), self.settings)
        self._recast()
        self._say(f"{name} appears", name)
        return name

    def _place(self, x: float, y: float) -> tuple[float, float]:
        """A place somebody points at, kept within a view's size around what is drawn."""
        left, bottom, right, top = self.scene.view
        width, height = right - left, top - bottom
        x = min(max(number(x, "x"), left - width), right + width)
        return x, min(max(number(y, "y"), bottom - height), top + height)

    def _input(self, what: str, *arguments: Any) -> None:
        if self.on_input is not None:
            self.on_input(self.ticks, what, arguments)

    def _say(self, text: str, name: str = "") -> None:
        self._report(Event(kind="input", t=self._clock.t, step=self._clock.steps, a=name, text=text))

    # -- of the world ----------------------------------------------------------------------------

    def _build(self, settings: Mapping[str, float]) -> None:
        raise NotImplementedError

    def _settle(self) -> None:
        raise NotImplementedError

    def _recast(self) -> None:
        raise NotImplementedError

    def _gravity(self) -> tuple[float, float]:
        raise NotImplementedError

    def _report(self, event: Event) -> None:
        raise NotImplementedError


def _bounded(value: float, what: str) -> float:
    return min(max(number(value, what), -1e3), 1e3)
