"""A run in sentences, from the same events that pictures are drawn from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.sandbox.world.contacts import MINOR

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from course.sandbox.runs.running import Run
    from course.sandbox.world.events import Event, Receipt

__all__ = ["account", "momentum", "sentence", "sentences"]

#: A pair that touches again within this time, in s, is not reported each time.
_PATIENCE = 0.05
#: Changes of energy below this share are not worth a clause.
_WORTH = 0.005


def sentence(event: Event) -> str:
    """One event in words, with the time in front: "0.42 s: the ball meets the floor at 4.09 m/s ..."."""
    when = f"{event.t:.2f} s: "
    if event.kind == "contact":
        return when + _contact(event)
    if event.kind == "rest":
        return f"{when}{_the(event.a)} comes to rest at x = {_place(event.x)} m, y = {_place(event.y)} m."
    if event.kind == "gone":
        return f"{when}{_the(event.a)} has left the scene."
    return f"{when}{event.text}."


def _place(value: float) -> str:
    """To the centimetre, and never "-0.00"."""
    return f"{round(value, 2) + 0.0:.2f}"


def sentences(events: Iterable[Event], most: int = 40) -> Iterator[str]:
    """The events worth reporting, and at the end how many were left out.

    Args:
        events: in order.
        most: sentences at most, the last one not counted.
    """
    last: dict[tuple[str, str], float] = {}
    told = left = 0
    for event in events:
        if event.kind == "contact":
            pair = (event.a, event.b)
            since = event.t - last.get(pair, -1.0)
            last[pair] = event.t
            if event.minor or since < _PATIENCE:
                left += not event.minor
                continue
        if told >= most:
            left += 1
            continue
        told += 1
        yield sentence(event)
    if left:
        yield f"{left} more event{'s' if left > 1 else ''} happened; --csv and --json have every one."


def account(receipt: Receipt) -> list[str]:
    """The energy account in sentences."""
    had = receipt.start + receipt.given
    lines = [
        f"Energy at the start {_joule(receipt.start)}"
        + (f", given since {_joule(receipt.given)}" if abs(receipt.given) > 1e-9 else "")
        + f"; now {_joule(receipt.kinetic)} of motion and {_joule(receipt.potential)} of height.",
    ]
    scale = max(abs(had), abs(receipt.kinetic), abs(receipt.contacts), abs(receipt.friction), 1e-12)
    contacts, friction, rods = (
        part if abs(part) > 1e-9 * scale else 0.0
        for part in (receipt.contacts, receipt.friction, receipt.rods)
    )
    in_rods = f", lost in rods {_joule(rods)}" if rods else ""
    lines.append(f"Lost in contacts {_joule(contacts)}, lost to friction {_joule(friction)}{in_rods}.")
    share = abs(receipt.residual) / scale
    if share < 1e-9:
        lines.append("Nothing is unaccounted for.")
    else:
        verb = "is missing without a physical cause" if receipt.residual > 0 else "has no physical source"
        lines.append(f"{_joule(abs(receipt.residual))} {verb}: that is the solver's ({100 * share:.2g} %).")
    return lines


def momentum(done: Run) -> list[str]:
    """The change of momentum, in a sentence."""
    (px, py, _), (qx, qy, _) = done.momentum_before, done.momentum_after
    size = max(abs(px), abs(py), abs(qx), abs(qy), 1e-12)
    now = f"({qx if abs(qx) > 1e-9 * size else 0.0:.4g}, {qy if abs(qy) > 1e-9 * size else 0.0:.4g}) kg m/s"
    if abs(qx - px) <= 1e-9 * size and abs(qy - py) <= 1e-9 * size:
        return [f"Momentum is kept: {now}."]
    was = f"({px:.4g}, {py:.4g})"
    return [f"Momentum went from {was} to {now}: something outside took part."]


def _contact(event: Event) -> str:
    a, b = _the(event.a), _the(event.b)
    if event.approach < -MINOR:
        way = "they move" if event.shared else "moves"
        return f"{a} is found inside {b} and {way} apart at {-event.approach:.2f} m/s."
    # Both speeds are relative: of two bodies that can move, neither is said to be the one that leaves.
    text = f"{a} and {b} meet" if event.shared else f"{a} meets {b}"
    text += f" at {event.approach:.2f} m/s"
    if event.leave is None:
        return f"{text}."
    if event.leave > 0.01:
        text += f" and {'part' if event.shared else 'leaves'} at {event.leave:.2f}"
    else:
        text += " and stay together" if event.shared else " and stays with it"
    share = event.lost
    if share is None or event.before is None or event.before < 1e-9:
        return f"{text}."
    whose = "their" if event.shared else "its"
    if abs(share) < _WORTH:
        return f"{text}; none of {whose} kinetic energy is gone."
    if share < 0:
        return f"{text}; {whose} kinetic energy grew by {-100 * share:.0f} %, pushed by others."
    return f"{text}; {100 * share:.0f} % of {whose} kinetic energy is gone."


def _the(name: str) -> str:
    """A body's name in a sentence: ``ball-3`` is "ball 3", ``floor`` is "the floor"."""
    words = name.replace("-", " ")
    return words if words[-1:].isdigit() else f"the {words}"


def _joule(value: float) -> str:
    return f"{value:.4g} J"
