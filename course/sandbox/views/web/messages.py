"""Messages between a page and the world: small JSON requests one way, float32 frames the other."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal

import msgspec
import numpy as np
from msgspec import Meta

if TYPE_CHECKING:
    from course.sandbox.world.ledger import Floats
    from course.sandbox.world.world import World

__all__ = ["FRAME_HEAD", "MAX_REQUEST", "Allowance", "Request", "frame", "past", "read"]

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
