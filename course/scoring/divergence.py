"""Where a trajectory left the right one; a separate module, so that reading a verdict does not load numpy."""

from __future__ import annotations

import msgspec

__all__ = ["Divergence"]


class Divergence(msgspec.Struct, frozen=True):
    """The first place where a trajectory left the reference. ``t`` in s."""

    t: float
    step: int
    quantity: str
