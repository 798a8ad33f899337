"""Events that a world reports: contacts, bodies that stop or leave, and the user's actions."""

from __future__ import annotations

import msgspec

__all__ = ["Event", "Receipt"]


class Event(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One thing that happened.

    Attributes:
        kind: "contact", "rest" (a body came to a stop), "gone" (it left the world), or "input" (the user
            did something).
        t: in s; step: number of the step, the first is 1.
        a, b: names of the bodies; ``a`` moves, ``b`` is "" unless it is a contact.
        x, y: where, in m.
        nx, ny: unit normal of a contact, from ``a`` to ``b``.
        approach, leave: speed along the normal before and after, in m/s; both positive for a bounce. A
            contact in which they stay together leaves at about 0. One whose approach is below 0 was found too
            late: the bodies were already inside each other.
        slip: speed along the surface before, in m/s.
        impulse: size of the impulse of the first step of contact, in N s.
        before, after: kinetic energy of the two together, in J; None in a world without a receipt, as are
            ``leave`` and ``impulse``.
        shared: both of them can move.
        minor: too soft to be worth a sentence.
        text: what was done, for "input".
    """

    kind: str
    t: float
    step: int
    a: str = ""
    b: str = ""
    x: float = 0.0
    y: float = 0.0
    nx: float = 0.0
    ny: float = 0.0
    approach: float = 0.0
    leave: float | None = None
    slip: float = 0.0
    impulse: float | None = None
    before: float | None = None
    after: float | None = None
    shared: bool = False
    minor: bool = False
    text: str = ""

    @property
    def lost(self) -> float | None:
        """The share of the kinetic energy that this contact took, 0 to 1; None where it is not known."""
        if self.before is None or self.after is None or self.before <= 0.0:
            return None
        return 1.0 - self.after / self.before


class Receipt(msgspec.Struct, frozen=True, kw_only=True):
    """Where the energy is. All in J; the parts always add up: ``start + given`` equals all the others.

    Attributes:
        start: the energy at time 0.
        given: added since by hands, motors, spawned bodies and changes of gravity.
        kinetic, potential: now; potential energy is zero at y = 0 (x = 0).
        contacts: lost across contacts, along their normals.
        friction: lost along surfaces, and to the floor of a scene seen from above.
        rods: lost in joints that stopped a body which was thrown against them.
        residual: missing without a known loss. Below zero: the solver made energy.
        integrator: the part of ``residual`` that comes from moving bodies before accelerating them: half a
            step's worth of gravity's power, -m g (v - v at the start) h/2. It comes back with the velocity.
    """

    start: float
    given: float
    kinetic: float
    potential: float
    contacts: float
    friction: float
    rods: float
    residual: float
    integrator: float
