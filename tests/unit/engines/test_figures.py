"""Figures of a comparison are drawn from its rows, whichever there are."""

from __future__ import annotations

import msgspec
import pytest

from course.engines import reference
from course.figures import engine_comparison as module
from course.figures.style import house_style


def words(figure):
    return " ".join(text.get_text() for axes in figure.axes for text in axes.texts)


def test_the_steps_name_every_engine_and_only_mujoco_s_pendulum_is_of_order_four():
    with house_style():
        said = words(module.steps())
    for name in ("pymunk", "ODE", "Bullet 2.84", "Rapier", "PhysX", "Bullet 3", "DART"):
        assert name in said
    assert said.count("order 4.0") == 1
    assert "MuJoCo: order 4.0" in said


def test_the_speed_names_every_engine_once():
    with house_style():
        said = words(module.speed())
    for name in ("pymunk", "MuJoCo", "ODE", "Bullet 2.84", "Rapier", "PhysX", "Bullet 3", "DART"):
        assert said.count(name) == 1


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
