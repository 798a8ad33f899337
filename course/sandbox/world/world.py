"""A scene that runs: fixed steps, one stream of events, and an account of energy and momentum.

Views know nothing of the engine. They say how much real time has passed (``advance``), draw ``snapshot()``,
read ``drain_events()`` and ``receipt``, and pass on the user's actions. Each action also goes
to ``on_input``, with the tick before which it happened: all that a replay needs.
"""

import hashlib
import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from course.errors import UsageError
from course.sandbox.scene.model import Material, Part, Scene, layout, spawned, wall
from course.sandbox.scene.rules import SETTINGS, checked, number
from course.sandbox.world.accounts import Accounts, Clock, Event, Hand, Receipt, contact_events
from course.sandbox.world.engine import Block, Floats, Space

# ---
# Which bodies left the scene, and which came to rest.


#: A body farther out than this many views has left.
_OUTSKIRTS = 20.0
#: Below these a body counts as still, in m/s and rad/s; above ten times that it moves.
_STILL = 0.01
_STILL_SPIN = 0.05


class Watch:
    """Looks at all bodies now and then.

    Args:
        view: left, bottom, right, top, in m.
    """

    def __init__(self, view: tuple[float, float, float, float]) -> None:
        left, bottom, right, top = view
        self._centre = (left + right) / 2, (bottom + top) / 2
        self._far = _OUTSKIRTS * max(right - left, top - bottom)
        #: By name: 0 at rest or never moved, 1 moving, 2 was still when last looked at.
        self._seen: dict[str, int] = {}

    def look(self, parts: Sequence[Part], state: Floats) -> tuple[list[int], list[int]]:
        """Rows of bodies that left, and of those that came to rest since the last look.

        Twice still in a row is at rest: the top of a flight is still only once.
        """
        speed = np.hypot(state[:, 3], state[:, 4])
        turning = np.abs(state[:, 5])
        out = np.hypot(state[:, 0] - self._centre[0], state[:, 1] - self._centre[1]) > self._far
        moves = (speed > 10 * _STILL) | (turning > 10 * _STILL_SPIN)
        still = (speed < _STILL) & (turning < _STILL_SPIN)
        left, resting = [], []
        for i, part in enumerate(parts):
            if part.fixed:
                continue
            if out[i]:
                left.append(i)
                self._seen.pop(part.name, None)
            elif moves[i]:
                self._seen[part.name] = 1
            elif still[i] and self._seen.get(part.name, 0):
                self._seen[part.name] = (self._seen[part.name] + 1) % 3
                if self._seen[part.name] == 0:
                    resting.append(i)
        return left, resting


MAX_BODIES = 1000
#: Steps between looking for bodies that left or came to rest.
_TIDY = 64
#: A gap in real time that a stalled view makes up for, at most, in s.
_MAX_GAP = 0.25
#: The names of the walls that the setting puts up.
_WALLS = ("wall-below", "wall-right", "wall-above", "wall-left")
#: A body's numbers that can be changed: unit, lowest and highest.
NUMBERS = {
    "mass": ("kg", 1e-3, 1e4),
    "restitution": ("1", 0.0, 1.0),
    "friction": ("1", 0.0, 10.0),
    "vx": ("m/s", -1e3, 1e3),
    "vy": ("m/s", -1e3, 1e3),
    "spin": ("rad/s", -1e3, 1e3),
}
#: Events kept until they are drained; older ones are dropped and counted.
_MAX_EVENTS = 5000


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A frame to draw. Rows are in the order of ``World.parts`` as long as ``version`` is the same.

    Attributes:
        version: changes when bodies were added or removed: fetch ``World.parts`` again.
        x, y, angle, vx, vy: (n,), in m, rad, m/s.
        joints: ends of each joint, (m, 4): ax, ay, bx, by, in m.
        hand: where a body is held and where the pointer is: ax, ay, px, py, in m; None if nothing is held.
    """

    t: float
    version: int
    x: Floats
    y: Floats
    angle: Floats
    vx: Floats
    vy: Floats
    joints: Floats
    hand: tuple[float, float, float, float] | None


class World:
    """A running scene.

    Args:
        settings: values for ``SETTINGS``; the scene's own where left out.
        receipt: keep the account of energy. Without it no contact is told, and stepping is faster.

    Raises:
        UsageError: a setting is unknown or out of range.

    Attributes:
        ticks: steps since the world was made; a reset does not turn it back.
        paused, speed: for views: ``advance`` does nothing while paused, and runs ``speed`` times real time.
        dropped: events that were not drained in time.
        on_input: each is called with the tick, the method and its arguments of anything done by hand.
        on_tick: every how many steps, and the function to call then, for each.
        on_block: called with every stretch of steps that was booked.
    """

    def __init__(
        self, scene: Scene, settings: Mapping[str, float] | None = None, *, receipt: bool = True
    ) -> None:
        self.scene = scene
        self.settings: dict[str, float] = {}
        self.ticks = 0
        self.version = 0
        self.dropped = 0
        self.paused = False
        self.speed = 1.0
        self.on_input: list[Callable[[int, str, tuple[Any, ...]], None]] = []
        self.on_tick: list[tuple[int, Callable[[], None]]] = []
        self.on_block: list[Callable[[Block], None]] = []
        self._with_receipt = receipt
        self._events: deque[Event] = deque()
        self._build({key: checked(key, value) for key, value in (settings or {}).items()})

    def _build(self, settings: Mapping[str, float]) -> None:
        """Build the scene, with the settings in force."""
        scene = self.scene
        parts = layout(scene)
        self.settings = scene.settings | dict(settings)
        self._wheeled = [part for part in parts if part.wheels is not None]
        ordered = parts[::-1] if scene.reverse else parts
        self._waiting = sorted((part for part in ordered if part.appears > 0.0), key=lambda p: -p.appears)
        self._space = Space(
            [part for part in ordered if part.appears == 0.0],
            scene.joint,
            iterations=int(self.settings["iterations"]),
            slop=scene.slop,
        )
        self._space.set_material(self.settings)
        self._space.space.gravity = self._gravity()
        self._wall()
        self._clock = Clock(self.settings["step"])
        self._accounts = Accounts(self._space, self._gravity(), self._clock)
        self._watch = Watch(scene.view)
        self._hand: Hand | None = None
        self._spawned = 0
        self._debt = 0.0
        self.version += 1

    def _gravity(self) -> tuple[float, float]:
        return self.scene.pull(self.settings["gravity"])

    # -- what views read -------------------------------------------------------------------------

    @property
    def t(self) -> float:
        """Simulated time since the last reset, in s."""
        return self._clock.t

    @property
    def steps(self) -> int:
        """Steps since the last reset."""
        return self._clock.steps

    @property
    def parts(self) -> tuple[Part, ...]:
        """The bodies, in the order of the rows of every snapshot."""
        return self._space.parts

    @property
    def held(self) -> str | None:
        return self._hand.name if self._hand else None

    def state(self) -> Floats:
        """All bodies, (n, 6): x, y, angle, vx, vy, spin."""
        return self._space.state()

    def snapshot(self) -> Snapshot:
        hand = None
        if self._hand is not None:
            place = self._space.body(self._hand.name).local_to_world(self._hand.anchor)
            hand = (float(place.x), float(place.y), self._hand.x, self._hand.y)
        x, y, angle, vx, vy, _ = self._space.state().T
        return Snapshot(self.t, self.version, x, y, angle, vx, vy, self._space.ends_of_joints(), hand)

    def drain_events(self) -> list[Event]:
        """The events since the last call, oldest first."""
        self._settle()
        events = list(self._events)
        self._events.clear()
        return events

    @property
    def receipt(self) -> Receipt:
        """Where the energy is now.

        Raises:
            UsageError: the world was made without a receipt.
        """
        if not self._with_receipt:
            raise UsageError("This world keeps no receipt.", help="Make it with receipt=True.")
        self._settle()
        return self._accounts.receipt()

    @property
    def sums(self) -> tuple[float, ...]:
        """What the account holds now, for ``resume``."""
        self._settle()
        return self._accounts.ledger.sums

    def skip(self) -> None:
        """From here on, keep no account: steps are the same ones, and quicker."""
        self._settle()
        self._with_receipt = False

    def resume(self, sums: tuple[float, ...]) -> None:
        """Keep the account again, with what it held at this moment when the same steps were made before."""
        self._accounts.resume(sums)
        self._with_receipt = True

    @property
    def momentum(self) -> tuple[float, float, float]:
        """Along x and y in kg m/s, and angular about the origin in kg m²/s."""
        return self._accounts.ledger.momentum(self._space.state())

    def state_hash(self) -> str:
        """Sixteen letters that stand for every bit of every body's state."""
        names = "\n".join(part.name for part in self.parts).encode()
        return hashlib.blake2b(self._space.state().tobytes() + names, digest_size=8).hexdigest()

    # -- time ------------------------------------------------------------------------------------

    def advance(self, real_dt: float) -> int:
        """Let real time pass: make as many whole steps as fit; the rest is kept for the next call.

        Args:
            real_dt: since the last call, in s; a long gap is cut, so that a stalled view does not race.

        Returns:
            steps made.
        """
        if self.paused:
            self._debt = 0.0
            return 0
        self._debt += min(max(number(real_dt, "real_dt"), 0.0), _MAX_GAP) * self.speed
        count = int(self._debt / self._clock.size + 1e-9)
        self._debt = max(0.0, self._debt - count * self._clock.size)
        self.step(count)
        return count

    def step(self, count: int = 1) -> None:
        """Make this many steps, whatever ``paused`` says."""
        space, recorder, clock, size = self._space, self._accounts.recorder, self._clock, self._clock.size
        pushed = bool(self._wheeled) or self.scene.floor is not None
        for _ in range(count):
            if self._waiting and self._waiting[-1].appears <= clock.t:
                self._let_in()
            if pushed or self._hand is not None:
                speeds = self.settings.get("left", 0.0), self.settings.get("right", 0.0)
                self._accounts.push(self._hand, self._wheeled, speeds, self.scene.floor)
            space.space.step(size)
            clock.steps += 1
            self.ticks += 1
            if self._with_receipt:
                recorder.take()
                if self._accounts.full:
                    self._settle()
            if self.ticks % _TIDY == 0:
                self._tidy()
            for every, tell in self.on_tick:
                if self.ticks % every == 0:
                    tell()

    def run_until(self, t: float) -> None:
        """Step until this time, in s, is reached; a time that steps do not hit is passed by less than one."""
        remaining = (t - self.t) / self._clock.size
        if remaining > 0:
            self.step(math.ceil(remaining - 1e-6))

    # -- what is done to it -----------------------------------------------------------------------

    def reset(self) -> None:
        """Back to the start of the scene; settings that were changed stay changed."""
        self._input("reset")
        self._events.clear()
        self._build(dict(self.settings))

    def set(self, key: str, value: float) -> None:
        """Change a setting; see ``course.sandbox.scene.rules.SETTINGS``.

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
        elif key in {"restitution", "friction"}:
            self._space.set_material({key: amount})
        elif key == "iterations":
            self._space.space.iterations = int(amount)
        elif key == "step":
            self._clock.resize(amount)
        elif key == "walls":
            self._wall()
            self._recast()
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
        self._accounts.recast(self._gravity())
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
        self._must_have_room()
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

    # -- what is done to one body, known by its name ---------------------------------------------------

    def place(self, name: str, x: float, y: float) -> bool:
        """Put a body's centre at a place, or as near as its rods and its neighbours let it.

        Its velocity stays.

        Returns:
            whether it fits there; else it stays where it was.
        """
        self._movable(name)
        x, y = self._place(x, y)
        if self.held == name:
            self.release()
        self._settle()
        if not self._space.place(name, x, y):
            return False
        self._input("place", name, x, y)
        self._accounts.recast(self._gravity())
        self._say(f"{name} is put elsewhere", name)
        return True

    def aim(self, name: str, vx: float, vy: float) -> None:
        """Give a body this velocity, in m/s."""
        self._movable(name)
        vx, vy = _bounded(vx, "vx"), _bounded(vy, "vy")
        self._input("aim", name, vx, vy)
        self._settle()
        self._space.body(name).velocity = vx, vy
        self._accounts.recast(self._gravity())
        self._say(f"{name} now moves at {math.hypot(vx, vy):.2f} m/s", name)

    def change(self, name: str, key: str, value: float) -> None:
        """Change one of a body's ``NUMBERS``; of a mass, its moment changes with it.

        Raises:
            UsageError: there is no such body or number, or it is out of range.
        """
        self._movable(name)
        if key not in NUMBERS:
            raise UsageError(
                f"A body has no {str(key)[:20]!r}.",
                help=f"It has {', '.join(NUMBERS)}.",
                code="bad_parameter",
            )
        unit, low, high = NUMBERS[key]
        amount = number(value, key)
        if not low <= amount <= high:
            raise UsageError(
                f"{key} must be from {low:g} to {high:g}, and {amount:g} is not.", code="bad_parameter"
            )
        self._input("change", name, key, amount)
        self._settle()
        self._space.change(name, key, amount)
        self._accounts.recast(self._gravity())
        if key in {"mass", "restitution", "friction"}:
            self.version += 1
        self._say(f"{key} of {name} is now {amount:g} {unit}".removesuffix(" 1"), name)

    def remove(self, name: str) -> None:
        """Take a body out, and the joints that hold it."""
        self._movable(name)
        self._input("remove", name)
        self._settle()
        self._say(f"{name} is taken away", name)
        self._take_out(name)

    def copy(self, name: str) -> str:
        """Another body like this one, beside it, as fast as it is. Returns the name of the new one.

        Raises:
            UsageError: there is no such body, no room beside it, or there are too many.
        """
        self._movable(name)
        self._must_have_room()
        self._settle()
        made = f"new-{self._spawned + 1}"
        if not self._space.copy(name, made):
            raise UsageError(f"There is no room beside {name} for another one.", code="no_room")
        self._input("copy", name)
        self._spawned += 1
        if self._space.part(made).wheels is not None:
            self._wheeled.append(self._space.part(made))
        self._recast()
        self._say(f"{made} appears, like {name}", made, name)
        return made

    def stop(self) -> None:
        """Let everything stand still; wheels stop as well."""
        self._input("stop")
        self._settle()
        for part in self._space.parts:
            if not part.fixed:
                body = self._space.body(part.name)
                body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
        if self._wheeled:
            self.settings |= {"left": 0.0, "right": 0.0}
        self._accounts.recast(self._gravity())
        self._say("everything is stopped")

    def number_of(self, name: str, key: str) -> float:
        """One of a body's ``NUMBERS`` now."""
        return self._space.number_of(name, key)

    def moves(self, name: str) -> bool:
        """Whether there is a body of this name that can move."""
        return any(part.name == name and not part.fixed for part in self._space.parts)

    def _movable(self, name: str) -> None:
        if not self.moves(name):
            raise UsageError(f"There is no {str(name)[:60]!r} that moves.", code="bad_parameter")

    def _must_have_room(self) -> None:
        if len(self._space.parts) >= MAX_BODIES:
            raise UsageError(f"There are {MAX_BODIES} bodies; that is enough.", code="too_many_bodies")

    def _wall(self) -> None:
        """Put walls around what is shown, or take them away, as the settings say."""
        left, bottom, right, top = self.scene.view
        corners = [(left, bottom), (right, bottom), (right, top), (left, top)]
        there = [part.name for part in self._space.parts if part.name in _WALLS]
        for name in there:
            self._space.remove(name)
        if self.settings.get("walls"):
            for name, a, b in zip(_WALLS, corners, corners[1:] + corners[:1], strict=True):
                self._space.add(wall(name, a, b, (top - bottom) / 100), {})

    def _place(self, x: float, y: float) -> tuple[float, float]:
        """A place the user points at, kept within a view's size around what is drawn."""
        left, bottom, right, top = self.scene.view
        width, height = right - left, top - bottom
        x = min(max(number(x, "x"), left - width), right + width)
        return x, min(max(number(y, "y"), bottom - height), top + height)

    def _input(self, what: str, *arguments: Any) -> None:
        for tell in self.on_input:
            tell(self.ticks, what, arguments)

    def _say(self, text: str, name: str = "", other: str = "") -> None:
        self._report(Event(kind="input", t=self._clock.t, step=self._clock.steps, a=name, b=other, text=text))

    # -- inside ----------------------------------------------------------------------------------

    def _report(self, event: Event) -> None:
        if len(self._events) >= _MAX_EVENTS:
            self._events.popleft()
            self.dropped += 1
        self._events.append(event)

    def _settle(self) -> None:
        """Book the steps that were only copied so far, and report their contacts."""
        block = self._accounts.close()
        if block is None:
            if not self._with_receipt:
                self._accounts.base = self._space.state()
            return
        for event in contact_events(block, self.parts, self._accounts.ledger):
            self._report(event)
        for listener in self.on_block:
            listener(block)

    def _let_in(self) -> None:
        """Add the bodies whose time has come."""
        self._settle()
        while self._waiting and self._waiting[-1].appears <= self.t:
            self._space.add(self._waiting.pop(), self.settings)
        self._recast()

    def _recast(self) -> None:
        self._accounts.recast(self._gravity())
        self.version += 1

    def _tidy(self) -> None:
        """Report bodies that came to rest, and remove those that left."""
        state, parts = self._space.state(), self.parts
        gone, resting = self._watch.look(parts, state)
        if gone or resting:
            self._settle()
        for kind, rows in (("rest", resting), ("gone", gone)):
            for i in rows:
                x, y = float(state[i, 0]), float(state[i, 1])
                self._report(Event(kind=kind, t=self.t, step=self.steps, a=parts[i].name, x=x, y=y))
        for name in [parts[i].name for i in gone]:
            self._take_out(name)

    def _take_out(self, name: str) -> None:
        if self.held == name:
            self._hand = None
        self._wheeled = [part for part in self._wheeled if part.name != name]
        self._space.remove(name)
        self._recast()


def _bounded(value: float, what: str) -> float:
    return min(max(number(value, what), -1e3), 1e3)
