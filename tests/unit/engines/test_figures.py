"""Figures of a comparison are drawn from its rows, whichever there are."""

from __future__ import annotations

import math

import msgspec
import pytest

from course.engines import reference
from course.engines.compare import LADDER, QUICK_LADDER
from course.figures import engines as module
from course.figures.style import house_style


def test_the_steps_name_every_engine_and_only_mujoco_s_pendulum_is_of_order_four():
    with house_style():
        figure = module._steps(reference.load().rows)
    said = [text.get_text() for axes in figure.axes for text in axes.texts]
    for name in ("pymunk", "ODE", "Bullet 2.84", "Rapier", "PhysX", "Bullet 3", "DART"):
        assert any(name in words for words in said)
    assert [words for words in said if "order 4.0" in words] == ["MuJoCo: order 4.0"]
    # Of its pendulum a smaller step gives a larger error: no order is claimed.
    assert "Rapier" in said


def inside(figure):
    """The texts of a figure that stick out of it, or out of it and into the next panel."""
    figure.canvas.draw()
    size = figure.bbox
    out = []
    for axes in figure.axes:
        for text in axes.texts:
            box = text.get_window_extent()
            next_panel = min((o.bbox.x0 for o in figure.axes if o.bbox.x0 > axes.bbox.x0), default=size.x1)
            if box.x0 < 0 or box.x1 > next_panel or box.y0 < axes.bbox.y0 or box.y1 > size.y1:
                out.append(text.get_text())
    return out


@pytest.mark.parametrize("ladder", [LADDER, QUICK_LADDER])
@pytest.mark.parametrize("tests", [("free-fall",), ("pendulum",), ("free-fall", "pendulum")])
def test_no_name_of_the_steps_is_cut(ladder, tests):
    rows = [
        row
        for row in reference.load().rows
        if row.scenario in tests and any(math.isclose(row.dt, dt) for dt in ladder)
    ]
    with house_style():
        assert inside(module._steps(rows)) == []


def test_of_the_figures_those_are_drawn_for_which_the_rows_suffice():
    rows = reference.load().rows
    pendulum = [row for row in rows if row.scenario == "pendulum"]
    one_engine = [row for row in rows if row.engine == "dart" and row.scenario in ("boxes", "stack")]
    failed = [msgspec.structs.replace(row, status="crash", value=None) for row in rows]
    single = [row for row in pendulum if row.dt == 1 / 240]
    drawn = [list(module.render(given, "png")) for given in (pendulum, one_engine, failed, single)]
    assert drawn == [["steps"], ["speed"], [], []]
