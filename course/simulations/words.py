"""Words that several simulations share."""

from __future__ import annotations

__all__ = ["METHOD_NAMES", "digits", "percent", "times"]

METHOD_NAMES = {
    "explicit_euler": "explicit Euler",
    "semi_implicit_euler": "semi-implicit Euler",
    "velocity_verlet": "velocity Verlet",
    "rk4": "Runge-Kutta 4",
}


def digits(value: float, count: int = 3) -> str:
    """A number with so many significant digits, zeros at the end included: 0.0890 says more than 0.089."""
    return f"{value:#.{count}g}".removesuffix(".")


def percent(share: float) -> str:
    """A share as a percentage that a person reads: "28 %", "0.084 %"; beyond a thousandfold as a multiple."""
    return f"{100 * share:.3g} %" if abs(share) < 1000 else f"{share:.3g} times as much"


def times(number: int) -> str:
    """How often: "once", "4 times"."""
    return "once" if number == 1 else "twice" if number == 2 else f"{number} times"
