"""Figures of a comparison are drawn from its rows, whichever there are."""

from __future__ import annotations

import math

import msgspec
import pytest

from course.engines import reference
from course.engines.compare import LADDER, QUICK_LADDER
from course.figures import engines as module
from course.figures.style import house_style


def words(figure):
    return " ".join(text.get_text() for axes in figure.axes for text in axes.texts)


def test_the_steps_name_every_engine_and_only_mujoco_s_pendulum_is_of_order_four():
    with house_style():
        said = words(module._steps(reference.load().rows))
    for name in ("pymunk", "ODE", "Bullet 2.84", "Rapier", "PhysX", "Bullet 3", "DART"):
        assert name in said
    assert said.count("order 4.0") == 1
    assert "MuJoCo: order 4.0" in said


def test_the_speed_names_every_engine_once():
    with house_style():
        said = words(module.speed())
    for name in ("pymunk", "MuJoCo", "ODE", "Bullet 2.84", "Rapier", "PhysX", "Bullet 3", "DART"):
        assert said.count(name) == 1


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


def test_no_name_of_the_speed_or_the_settings_is_cut():
    from course.figures.engines import settings

    with house_style():
        assert inside(module.speed()) == []
        assert inside(settings()) == []


def test_where_a_smaller_step_gives_a_larger_error_no_order_is_claimed():
    with house_style():
        figure = module._steps(reference.load().rows)
    (pendulum,) = [axes for axes in figure.axes if "pendulum" in axes.get_title(loc="left")]
    words = [text.get_text() for text in pendulum.texts]
    assert "Rapier" in words


def test_the_same_rows_give_the_same_bytes():
    rows = reference.load().rows
    assert module.render(rows, "svg") == module.render(rows, "svg")


@pytest.mark.parametrize("scenario", ["free-fall", "pendulum"])
def test_one_test_alone_is_drawn_alone(scenario):
    rows = [row for row in reference.load().rows if row.scenario == scenario]
    assert list(module.render(rows, "png")) == ["steps"]


def test_rows_without_a_value_and_single_steps_draw_nothing():
    rows = reference.load().rows
    failed = [msgspec.structs.replace(row, status="crash", value=None) for row in rows]
    assert module.render(failed, "png") == {}
    single = [row for row in rows if row.scenario == "pendulum" and row.dt == 1 / 240]
    assert module.render(single, "png") == {}


def test_one_engine_alone_has_its_speed_drawn():
    rows = [
        row for row in reference.load().rows if row.engine == "dart" and row.scenario in ("boxes", "stack")
    ]
    assert list(module.render(rows, "png")) == ["speed"]
