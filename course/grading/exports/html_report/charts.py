"""The charts' content: shares, times and scores in words, and counted for histograms."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["Bin", "duration", "duration_bins", "mark_of", "percent", "score_bins"]

_FEW = 10  # scores up to here get a bar each, if all are whole
#: Upper ends of the bars for times, in s: two a decade, as times spread over many.
_STEPS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


@dataclass(frozen=True)
class Bin:
    """One bar: its meaning in words, the number under its left edge (or its middle), and its count."""

    words: str
    label: str
    count: int


def percent(part: float, whole: float) -> str:
    """A share in words; "100 %" only of everything, "0 %" only of nothing."""
    if whole <= 0:
        return "–"
    share = part / whole
    if 0 < share < 0.01:
        return "under 1 %"
    if 0.99 < share < 1:
        return "over 99 %"
    return f"{share:.0%}".replace("%", " %")


def duration(seconds: float) -> str:
    """A time as a person reads it."""
    if seconds < 1:
        return f"{seconds * 1e3:.{0 if seconds >= 0.01 else 1}f} ms"
    return f"{seconds:.3g} s"


def score_bins(scores: Sequence[float], most: float) -> tuple[list[Bin], bool]:
    """Scores counted for a histogram; and whether each bar stands for one score instead of a tenth."""
    whole = most == int(most) and 0 < most <= _FEW and all(score == int(score) for score in scores)
    if whole:
        counts = [0] * (int(most) + 1)
        for score in scores:
            counts[min(max(int(score), 0), int(most))] += 1
        return [Bin(f"{at} points", str(at), count) for at, count in enumerate(counts)], True
    counts = [0] * 10
    for score in scores:
        share = score / most if most else 0.0
        counts[min(max(int(share * 10 + 1e-9), 0), 9)] += 1
    words = [f"{10 * at} to under {10 * at + 10} %" for at in range(9)] + ["90 to 100 %"]
    return [Bin(words[at], str(10 * at), count) for at, count in enumerate(counts)], False


def duration_bins(seconds: Sequence[float]) -> list[Bin]:
    """Times counted for a histogram; empty bars at both ends are left out."""
    counts = [0] * (len(_STEPS) + 1)
    for value in seconds:
        counts[sum(value >= step for step in _STEPS)] += 1
    used = [at for at, count in enumerate(counts) if count]
    bins = []
    for at in range(used[0], used[-1] + 1) if used else ():
        low = duration(_STEPS[at - 1]) if at else "0"
        high = duration(_STEPS[at]) if at < len(_STEPS) else ""
        words = f"{low} to under {high}" if high else f"{low} and more"
        bins.append(Bin(words, low.replace(".0", ""), counts[at]))
    return bins


def mark_of(share: float, most: float, *, each: bool) -> float:
    """Where the pass mark is among the bars of ``score_bins``."""
    return float(math.ceil(share * most - 1e-9)) if each else share * 10
