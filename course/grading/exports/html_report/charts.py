"""Charts as inline SVG: drawn for a phone's width, so that their words stay readable there.

Every chart says in words what it shows (its label), carries its numbers as text, and needs no colour.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from course.grading.exports.cells import number
from course.grading.exports.html_report.markup import Html, joined, shortened, tag

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = [
    "Bin", "bar_rows", "duration", "duration_bins", "histogram", "mark_of", "meter", "percent", "score_bins",
]  # fmt: skip

_WIDTH = 360.0
_HEIGHT = 190.0
_TOP = 34.0  # room for the mark's words and the highest bar's number
_BOTTOM = 34.0
_LEFT = 12.0
_ROW = 36.0
_LABEL = 46  # characters of a row's label that fit
_FEW = 10  # scores up to here get a bar each, if all are whole
#: Upper ends of the bars for times, in s: two a decade, as times spread over many.
_STEPS = (0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0)


@dataclass(frozen=True)
class Bin:
    """One bar: what it stands for in words, the number under its left edge (or its middle), and its count."""

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


def histogram(
    bins: Sequence[Bin],
    *,
    caption: str,
    axis: str,
    last: str = "",
    middle: bool = False,
    mark: tuple[float, str] | None = None,
) -> Html:
    """Bars over an axis, with the numbers as a table below them.

    Args:
        axis: what the horizontal axis is, with its unit.
        last: number under the right edge of the last bar.
        middle: labels stand under the bars instead of their left edges.
        mark: a vertical line: place in bars from the left, and its words.
    """
    step = (_WIDTH - 2 * _LEFT) / max(len(bins), 1)
    floor = _HEIGHT - _BOTTOM
    tallest = max((item.count for item in bins), default=0) or 1
    parts = []
    for at, item in enumerate(bins):
        left, height = _LEFT + at * step, (floor - _TOP) * item.count / tallest
        parts.append(_bar(left + 1.5, floor - height, step - 3, height))
        if item.count:
            parts.append(_words(left + step / 2, floor - height - 4, str(item.count)))
        parts.append(_words(left + step / 2 * middle, floor + 14, item.label, "soft"))
    if last:
        parts.append(_words(_LEFT + len(bins) * step, floor + 14, last, "soft"))
    parts.append(tag("line", x1=_LEFT, y1=floor, x2=_WIDTH - _LEFT, y2=floor, class_="axis"))
    parts.append(_words(_WIDTH / 2, _HEIGHT - 4, axis, "soft"))
    if mark is not None:
        x = _LEFT + mark[0] * step
        parts.append(tag("line", x1=x, y1=16.0, x2=x, y2=floor, class_="mark"))
        parts.append(_words(x, 11, mark[1], anchor="middle" if 90 < x < _WIDTH - 90 else _side(x)))
    label = "; ".join(f"{item.words}: {item.count}" for item in bins if item.count) or "nothing to count"
    drawing = _svg(_HEIGHT, f"{caption}. {label}", parts)
    rows = joined(
        tag("tr", tag("th", item.words, scope="row"), tag("td", str(item.count), class_="n")) for item in bins
    )
    heads = tag("tr", tag("th", axis, scope="col"), tag("th", "number", scope="col", class_="n"))
    numbers = tag("table", tag("thead", heads), tag("tbody", rows))
    return tag(
        "figure",
        tag("figcaption", caption),
        drawing,
        tag("details", tag("summary", "The numbers"), numbers),
    )


def bar_rows(rows: Sequence[tuple[str, float, float]], caption: str, *, code: bool = False) -> Html:
    """A bar per row on a track that stands for everything: label, points reached, points in all."""
    parts = []
    for at, (label, part, whole) in enumerate(rows):
        top = at * _ROW
        share = min(max(part / whole, 0.0), 1.0) if whole else 0.0
        kind = "code" if code else None
        parts.append(_words(0, top + 12, shortened(label, _LABEL), kind, anchor="start"))
        parts.append(_words(_WIDTH, top + 12, f"{number(part)} of {number(whole)}", anchor="end"))
        parts.append(_bar(0, top + 17, _WIDTH, 10, "track"))
        parts.append(_bar(0, top + 17, _WIDTH * share, 10))
    said = "; ".join(f"{label}: {number(part)} of {number(whole)}" for label, part, whole in rows)
    drawing = _svg(_ROW * len(rows), f"{caption}. {said}", parts)
    return tag("figure", tag("figcaption", caption), drawing)


def meter(part: float, whole: float) -> Html:
    """A small bar beside a share that stands in words next to it."""
    share = min(max(part / whole, 0.0), 1.0) if whole > 0 else 0.0
    track = tag("rect", width="100", height="10", class_="track")
    bar = tag("rect", width=100 * share, height="10", class_="bar")
    return tag(
        "svg",
        track,
        bar,
        viewBox="0 0 100 10",
        preserveAspectRatio="none",
        class_="meter",
        aria_hidden="true",
    )


def mark_of(share: float, most: float, *, each: bool) -> float:
    """Where the pass mark is among the bars of ``score_bins``."""
    return float(math.ceil(share * most - 1e-9)) if each else share * 10


def _svg(height: float, label: str, parts: Sequence[Html]) -> Html:
    view = f"0 0 {_WIDTH:g} {height:g}"
    return tag("svg", joined(parts), viewBox=view, role="img", aria_label=label)


def _bar(x: float, y: float, width: float, height: float, kind: str = "bar") -> Html:
    return tag("rect", x=x, y=y, width=width, height=height, class_=kind)


def _words(x: float, y: float, words: str, kind: str | None = None, anchor: str = "middle") -> Html:
    return tag("text", words, x=float(x), y=float(y), text_anchor=anchor, class_=kind)


def _side(x: float) -> str:
    return "start" if x <= 90 else "end"
