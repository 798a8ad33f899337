"""Shared by all exports: the plane becomes a vertical slice of space, and bodies get a depth.

x stays x, y becomes z (up), and y, the third dimension, is held or left alone.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from course.errors import UsageError
from course.sandbox.scene.parts import layout

if TYPE_CHECKING:
    from course.sandbox.scene.loading import Chosen
    from course.sandbox.scene.parts import Part

__all__ = ["DEPTH", "checked_parts", "gravity_of", "moment_3d", "number", "surface_of"]

#: Half the depth of every body, in m, because bodies that are flat here need a depth there.
DEPTH = 0.05
#: Replaces an infinite moment of inertia, as a multiple of the mass, in m².
_NEVER_TURNS = 1e6


def checked_parts(chosen: Chosen, target: str) -> tuple[Part, ...]:
    """The bodies of a scene, if another engine can create all of them at the start.

    Raises:
        UsageError: some appear only later, or are driven by wheels.
    """
    parts = layout(chosen.scene)
    for part in parts:
        problem = "lets bodies in one by one" if part.appears else "drives on wheels" if part.wheels else ""
        if problem:
            raise UsageError(
                f"{chosen.scene.id} {problem}, and {target} describes only how a world begins.",
                help="Export another scene, or a copy of this one without that.",
                code="cannot_export",
            )
    return parts


def gravity_of(chosen: Chosen) -> tuple[float, float]:
    """Gravity in the plane, in m/s², with the setting if there is one."""
    gx, gy = chosen.scene.gravity
    size = math.hypot(gx, gy)
    wanted = chosen.settings.get("gravity", size)
    return (gx * wanted / size, gy * wanted / size) if size else (0.0, -wanted)


def surface_of(chosen: Chosen, part: Part) -> tuple[float, float]:
    """Restitution and friction of a body, with the settings if there are any."""
    if part.fixed:
        return part.restitution, part.friction
    settings = chosen.settings
    return settings.get("restitution", part.restitution), settings.get("friction", part.friction)


def moment_3d(part: Part) -> tuple[float, float, float]:
    """Moments about x, about the axis out of the plane, and about z; in kg m².

    Only the middle one acts in the plane. Engines insist that none is larger than the other two together,
    which these never are.
    """
    turning = part.moment if math.isfinite(part.moment) else _NEVER_TURNS * part.mass
    across = turning / 2 + part.mass * DEPTH**2 / 3
    return across, turning, across


def number(value: float) -> str:
    """A float in the fewest digits that read back as the same float."""
    value = float(value) + 0.0  # no minus zero
    return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
