"""Contacts as events, from the account's blocks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from course.sandbox.scene.model import Part
from course.sandbox.world.accounts import Event
from course.sandbox.world.engine import Block, Floats, Ledger

#: Contacts softer than this, in m/s, belong to resting and rolling.
MINOR = 0.05


def contact_events(block: Block, parts: Sequence[Part], ledger: Ledger) -> list[Event]:
    """One event for each pair that began to touch in these steps, in a fixed order.

    The numbers of all of them are worked out at once.
    """
    contacts = block.contacts
    found = np.flatnonzero(contacts.first)
    if not len(found):
        return []
    k, a, b = contacts.row[found], contacts.a[found], contacts.b[found]
    normal, point = contacts.normal[:, found].T, contacts.point[:, found].T
    swap = np.array([_goes_second(parts[i], parts[j]) for i, j in zip(a.tolist(), b.tolist(), strict=True)])
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    normal = np.where(swap[:, None], -normal, normal)
    rows = np.stack([block.before[k, a], block.before[k, b], block.states[k, a, 3:], block.states[k, b, 3:]])
    # The engine moves bodies first, so it looks for contacts where they are after the step.
    arm_a, arm_b = point - block.states[k, a, :2], point - block.states[k, b, :2]
    came = _relative(rows[0], rows[1], arm_a, arm_b)
    left = _relative(rows[2], rows[3], arm_a, arm_b)
    nx, ny = normal.T
    weights = [np.stack([ledger.mass[i], ledger.mass[i], ledger.inertia[i]], axis=1) / 2 for i in (a, b)]
    energies = [
        (weights[0] * rows[i] ** 2).sum(axis=1) + (weights[1] * rows[i + 1] ** 2).sum(axis=1) for i in (0, 2)
    ]
    columns = (
        k,
        a,
        b,
        *point.T,
        nx,
        ny,
        -(came[:, 0] * nx + came[:, 1] * ny),
        left[:, 0] * nx + left[:, 1] * ny,
        np.abs(came[:, 1] * nx - came[:, 0] * ny),
        np.hypot(*contacts.impulse[:, found]),
        *energies,
    )
    events = [_event(block, parts, row) for row in zip(*(column.tolist() for column in columns), strict=True)]
    # The engine lists contacts by memory address; names make the order the same in every run.
    return sorted(events, key=lambda event: (event.step, event.a, event.b))


def _event(block: Block, parts: Sequence[Part], row: tuple[Any, ...]) -> Event:
    k, a, b, x, y, nx, ny, approach, leave, slip, impulse, before, after = row
    return Event(
        kind="contact",
        t=float(block.times[k]),
        step=block.first_step + k,
        a=parts[a].name,
        b=parts[b].name,
        x=x,
        y=y,
        nx=nx,
        ny=ny,
        approach=approach,
        leave=leave,
        slip=slip,
        impulse=impulse,
        before=before,
        after=after,
        shared=not parts[b].fixed,
        minor=abs(approach) < MINOR,
    )


def _goes_second(a: Part, b: Part) -> bool:
    """Whether a sentence about the two begins with ``b``: a moving body before a fixed one, then by name."""
    return (a.fixed, a.name) > (b.fixed, b.name)


def _relative(row_a: Floats, row_b: Floats, arm_a: Floats, arm_b: Floats) -> Floats:
    """Velocities of ``b`` against ``a`` at points of contact, (m, 2), in m/s.

    Args:
        row_a, row_b: vx, vy and spin, (m, 3).
        arm_a, arm_b: from the centres to the points, (m, 2).
    """
    vx = row_b[:, 0] - row_b[:, 2] * arm_b[:, 1] - row_a[:, 0] + row_a[:, 2] * arm_a[:, 1]
    vy = row_b[:, 1] + row_b[:, 2] * arm_b[:, 0] - row_a[:, 1] - row_a[:, 2] * arm_a[:, 0]
    return np.column_stack([vx, vy])
