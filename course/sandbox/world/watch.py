"""Which bodies left the scene, and which came to rest."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from course.sandbox.scene.parts import Part
    from course.sandbox.world.ledger import Floats

__all__ = ["Watch"]

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
