"""Figures as data: a report says what to draw, not how.

``course.figures.plots`` draws them; nothing here imports matplotlib.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


Kind = Literal["line", "steps", "points", "band", "interval", "bars", "level"]


@dataclass(frozen=True)
class Series:
    """One curve, or anything else with its own name in the legend.

    Attributes:
        name: in the legend; "" leaves it out.
        x: (n,) numbers, or n words for categories. Of a "level" (a line across the panel) empty.
        y: (n,); the lower edge of a "band"; the value of an "interval"; one number for a "level".
        kind: how it is drawn. "interval" is a point with an error bar from ``low`` to ``high``.
        low, high: (n,); ends of intervals. A band needs ``high`` only.
        quiet: drawn thin and grey, as a reference.
    """

    name: str
    x: ArrayLike | Sequence[str]
    y: ArrayLike
    kind: Kind = "line"
    low: ArrayLike | None = None
    high: ArrayLike | None = None
    quiet: bool = False


@dataclass(frozen=True)
class Panel:
    """One pair of axes.

    Attributes:
        x_label, y_label: quantity and unit, like "time / s".
        log: which axes are logarithmic.
        equal: one metre is as long in both directions (for maps).
    """

    x_label: str
    y_label: str
    series: tuple[Series, ...]
    title: str = ""
    log: Literal["", "x", "y", "xy"] = ""
    equal: bool = False


@dataclass(frozen=True)
class Plot:
    """A figure: one or more panels side by side or below each other.

    Attributes:
        title: what it shows, as a sentence.
        description: what the figure shows, in words, for a reader who cannot see it.
        columns: how many panels stand in a row.
    """

    title: str
    panels: tuple[Panel, ...]
    description: str = ""
    columns: int = 1
    height_in: float = 0.0


# ---
# The student's curve and the right one, for a failed check that compared the two over time.
#
# Used only at home. A comparison over time has both curves. For a step function named after a classical
# method, the right curve is that method's result for the same march.


#: Curves closer together than this fraction of the right one's range look like one curve: a picture of
#: fifteen lines has about twenty-five half blocks for it.
_SEEN = 0.04
#: A curve is cut off once it is outside the right one's range by this many times that range.
_PAPER = 1.5
_HEIGHT_IN = 2.6  # fifteen lines of eighty columns
_MOST = 2000  # points that are drawn
#: Turning points of the right curve that are drawn: of more, eighty columns make one grey bar.
_TURNS = 10
#: Points that are handed on: more than a terminal has columns.
_FEW = 200

_METHODS = {
    "explicit_euler": "explicit Euler",
    "semi_implicit_euler": "semi-implicit Euler",
    "velocity_verlet": "velocity Verlet",
    "rk4": "RK4",
}


@dataclass(frozen=True, slots=True)
class Curve:
    """Two curves over the same times.

    Attributes:
        t: (n,), s.
        yours, right: (n,).
        quantity, units: of both.
        right_is: what the right one is, in words.
    """

    t: Array
    yours: Array
    right: Array
    quantity: str
    units: str
    right_is: str = "right"

    @property
    def parts_at(self) -> float:
        """When the student's curve leaves the right one, in s."""
        with np.errstate(all="ignore"):
            off = ~(np.abs(self.yours - self.right) <= _SEEN * _range(self))
        return float(self.t[np.argmax(off)])

    @property
    def description(self) -> str:
        """Where the curves part, and where they end."""
        unit = f" {self.units}" if self.units not in {"", "1"} else ""
        yours, right = f"{self.yours[-1]:.3g}{unit}", f"{self.right[-1]:.3g}{unit}"
        ends = f"both are at {right}" if yours == right else f"yours is at {yours}, the right one at {right}"
        return (
            f"{self.quantity} over time. Your curve is visibly apart from {_as_noun(self)} at "
            f"{self.parts_at:.3g} s; at the end, at {self.t[-1]:.3g} s, {ends}."
        )


def thinned(curve: Curve) -> Curve:
    """The curve with so few points that it can be handed on; the last one stays."""
    if len(curve.t) <= _FEW:
        return curve
    kept = np.unique(np.linspace(0, len(curve.t) - 1, _FEW).round().astype(int))
    return replace(curve, t=curve.t[kept], yours=curve.yours[kept], right=curve.right[kept])


def read_curve(reply: Mapping[str, Any]) -> Curve:
    """The curve that a reply of ``course check --json`` tells of."""
    t, yours, right = (np.array([float(one) for one in reply[name]]) for name in ("t", "yours", "right"))
    return Curve(t, yours, right, reply["quantity"], reply["units"], reply["right_is"])


def compared(t: Any, yours: Array, right: Array, quantity: str, units: str) -> Curve | None:
    """The curves of a comparison; None if they show nothing."""
    times = np.asarray(t, dtype=float)
    if quantity == "t" or times.ndim != 1 or len(times) != len(yours):
        return None
    return _worth_seeing(Curve(times, np.asarray(yours, dtype=float), right, quantity, units))


def marched(name: str, system: Any, t: Any, states: Any) -> Curve | None:
    """The curves of a step of the student's and of the method that it is named for; None if it is none.

    Args:
        t, states: the times and (q, v) of the march.
    """
    from course.physics.integrators import STEPPERS, SemiImplicitEuler, State, trajectory

    q, v = states
    method = name.removesuffix("_step")
    if method not in STEPPERS or len(t) < 2:
        return None
    steppers = {_METHODS[method]: STEPPERS[method]}
    if method == "semi_implicit_euler":  # either order is the method, and the two are soon apart
        steppers |= {f"{_METHODS[method]}, position first": SemiImplicitEuler(position_first=True)}
    start = State.of(q[0], v[0], float(t[0]))
    curves = []
    for right_is, stepper in steppers.items():
        with np.errstate(all="ignore"):
            path = trajectory(stepper, system, start, float(t[1] - t[0]), len(t) - 1)
        curves.append(_worth_seeing(Curve(t, q[:, 0], path.q[:, 0], "q", "m", right_is)))
    seen = [curve for curve in curves if curve is not None]
    return max(seen, key=lambda curve: curve.parts_at) if len(seen) == len(curves) else None


def _worth_seeing(curve: Curve) -> Curve | None:
    if len(curve.t) < 3 or not (np.isfinite(curve.t).all() and np.isfinite(curve.right).all()):
        return None
    with np.errstate(all="ignore"):
        off = np.abs(curve.yours - curve.right)
    return None if np.all(off <= _SEEN * _range(curve)) else curve


def _range(curve: Curve) -> float:
    return float(np.ptp(curve.right)) or float(np.max(np.abs(curve.right))) or 1.0


def plot_of(curve: Curve) -> Plot:
    """The figure: the right curve as a line, the student's as points while they stay within the axes."""
    unit = f" / {curve.units}" if curve.units not in {"", "1"} else ""
    whole, curve = curve, _beginning(curve)
    low, high = float(np.min(curve.right)), float(np.max(curve.right))
    room = _PAPER * _range(curve)
    with np.errstate(all="ignore"):
        there = (curve.yours >= low - room) & (curve.yours <= high + room)
    shown = np.flatnonzero(there)[:: max(1, len(curve.t) // _MOST)]
    # Points that overlap are a band: one for each column of a narrow terminal is enough.
    shown = shown[:: max(1, len(shown) // 40)]
    drawn = slice(None, None, max(1, len(curve.t) // _MOST))
    panel = Panel(
        "time / s",
        f"{curve.quantity}{unit}",
        (
            Series(curve.right_is, curve.t[drawn], curve.right[drawn], quiet=True),
            Series("yours", curve.t[shown], curve.yours[shown], kind="points"),
        ),
    )
    title = f"{curve.quantity} over time: yours, and {_as_noun(curve)}"
    if curve is not whole:
        title += f", until {curve.t[-1]:.3g} s"
    return Plot(title, (panel,), whole.description, height_in=_HEIGHT_IN)


def _beginning(curve: Curve) -> Curve:
    """As much of a swinging motion as can be told apart, and two turns after the curves have parted."""
    rising = np.diff(curve.right) > 0.0
    turns = np.flatnonzero(rising[1:] != rising[:-1]) + 1
    if len(turns) <= _TURNS:
        return curve
    parted = int(np.searchsorted(turns, np.searchsorted(curve.t, curve.parts_at)))
    end = int(turns[min(max(_TURNS, parted + 2), len(turns)) - 1]) + 1
    return replace(curve, t=curve.t[:end], yours=curve.yours[:end], right=curve.right[:end])


def _as_noun(curve: Curve) -> str:
    return "what it should be" if curve.right_is == "right" else f"that of {curve.right_is}"
