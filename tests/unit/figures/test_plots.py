"""Figures described as data: every kind of series is drawn, the same each time."""

from __future__ import annotations

import pytest

from course.figures.described import Panel, Plot, Series
from course.figures.plots import draw, render
from course.figures.style import house_style

X, Y = [0.0, 1.0, 2.0], [1.0, 3.0, 2.0]

EVERY_KIND = {
    "line": Series("a", X, Y),
    "quiet": Series("reference", X, Y, quiet=True),
    "steps": Series("a", X, Y, kind="steps"),
    "points": Series("a", X, Y, kind="points"),
    "band": Series("a", X, Y, kind="band", high=[2.0, 4.0, 3.0]),
    "interval": Series("a", ["m", "b", "tau"], Y, kind="interval", low=[0.5, 3.5, 1], high=[2, 4, 3]),
    "bars": Series("a", X, Y, kind="bars"),
    "named bars": Series("a", ["p", "q", "r"], Y, kind="bars"),
    "level": Series("limit", [], 2.0, kind="level"),
}


@pytest.mark.parametrize("kind", EVERY_KIND)
def test_each_kind_of_series_leaves_its_mark(kind: str) -> None:
    def ink(series: tuple[Series, ...]) -> bytes:
        return render(Plot("What is seen", (Panel("time / s", "x / m", series),)))

    assert ink((EVERY_KIND[kind],)) != ink(())


def test_the_same_description_gives_the_same_bytes() -> None:
    plot = Plot("Twice", (Panel("t", "x", tuple(EVERY_KIND[k] for k in ("line", "band", "level"))),))
    for kind in ("png", "svg", "pdf"):
        assert render(plot, kind) == render(plot, kind)


def test_scales_titles_and_legends_are_as_described() -> None:
    panel = Panel("h / s", "error / m", (Series("yours", X, Y), Series("theory", X, Y)), "Order", log="xy")
    with house_style():
        figure = draw(Plot("Slopes tell", (panel, panel, panel), columns=2))
    shown = [ax for ax in figure.axes if ax.get_visible()]
    assert len(shown) == 3
    assert (shown[0].get_xscale(), shown[0].get_yscale()) == ("log", "log")
    assert (shown[0].get_xlabel(), shown[0].get_title("left")) == ("h / s", "Order")
    assert [text.get_text() for text in shown[0].get_legend().get_texts()] == ["yours", "theory"]


def test_two_curves_never_differ_by_colour_alone() -> None:
    series = tuple(Series(str(i), X, Y) for i in range(7))
    with house_style():
        (ax,) = draw(Plot("Many", (Panel("t", "x", series),))).axes
    assert len({str(line.get_linestyle()) + str(line._dash_pattern) for line in ax.lines}) == 7
