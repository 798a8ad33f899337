"""Pushes from outside the contacts: a hand that drags, wheels that drive, a floor that rubs.

Wheels and floor are impulses before a step, sized for that step. A hand is a force inside it, because rods
and contacts answer it there. So the account of energy knows exactly what each did.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pymunk

    from course.sandbox.scene.model import Floor, Wheels

__all__ = ["Hand", "brake", "drive"]

#: How fast a hand closes the gap to where it is, in 1/s, unless the step is too long for that.
_EAGERNESS = 20.0
#: The strongest pull, as an acceleration of what is held, in m/s²: a hand does not go through walls.
_STRENGTH = 500.0
#: How fast turning dies down while something is held, in 1/s.
_CALM = 4.0


@dataclass(slots=True)
class Hand:
    """Holds a body at a point and pulls that point to where the pointer is.

    Attributes:
        name: of the body.
        anchor: in the body's frame, in m.
        x, y: where the pointer is, in m.
    """

    name: str
    anchor: tuple[float, float]
    x: float
    y: float

    def pull(self, body: pymunk.Body, step: float) -> tuple[float, float, float]:
        """Put the hand's force on the body for one step, and return its impulses: in N s, N s and N m s."""
        place = body.local_to_world(self.anchor)
        velocity = body.velocity_at_local_point(self.anchor)
        eager = min(_EAGERNESS, 0.5 / step)
        rx, ry = place.x - body.position.x, place.y - body.position.y
        inertia = 0.0 if math.isinf(body.moment) else (rx * rx + ry * ry) / body.moment
        heavy = 1.0 / (1.0 / body.mass + inertia)
        jx = heavy * ((self.x - place.x) * eager - velocity.x) / 2
        jy = heavy * ((self.y - place.y) * eager - velocity.y) / 2
        size, most = math.hypot(jx, jy), body.mass * _STRENGTH * step
        if size > most:
            jx, jy = jx * most / size, jy * most / size
        turn = rx * jy - ry * jx
        if not math.isinf(body.moment):
            turn -= body.moment * body.angular_velocity * (1.0 - math.exp(-_CALM * step))
        body.force += jx / step, jy / step
        body.torque += turn / step
        return jx, jy, turn


def brake(body: pymunk.Body, floor: Floor, step: float, gyration: float) -> None:
    """Let the floor rub for one step: Coulomb's friction on the sliding and the turning.

    Args:
        gyration: radius at which the body's weight rubs when it turns, in m.
    """
    speed = body.velocity.length
    change = floor.friction * floor.gravity * step
    if speed > 0.0:
        body.velocity = body.velocity * max(0.0, 1.0 - change / speed)
    spin = body.angular_velocity
    if spin != 0.0 and not math.isinf(body.moment):
        slower = change * body.mass * gyration / body.moment
        body.angular_velocity = math.copysign(max(0.0, abs(spin) - slower), spin)


def drive(
    body: pymunk.Body, wheels: Wheels, speeds: tuple[float, float], gravity: float, step: float
) -> float:
    """Let two wheels roll for one step; neither slips sideways before its grip is used up.

    Args:
        speeds: of the left and the right rim, in m/s.
        gravity: presses the wheels onto the floor, in m/s².

    Returns:
        the work of the motors in J; what it did not turn into motion was rubbed off.
    """
    work = 0.0
    most = wheels.grip * body.mass * gravity * step / 2
    for side, speed in zip((0.5, -0.5), speeds, strict=True):
        ahead = body.rotation_vector
        place = body.local_to_world((0.0, side * wheels.track))
        slip = ahead * speed - body.velocity_at_world_point(place)
        # Half the body's mass rests on each wheel; a wheel that took all of it would fight the other.
        push = slip * (body.mass / 2)
        if push.length > most:
            push = push * (most / push.length)
        body.apply_impulse_at_world_point(push, place)
        work += push.dot(ahead) * speed
    return work
