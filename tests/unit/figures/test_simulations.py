"""The figures of the simulations show what was run, whatever was set, and say what it came to."""

import functools
import math

import numpy as np
import pytest

from course.errors import InternalError
from course.figures import experiments as simulations
from course.figures.style import METHODS, house_style
from course.simulations.base import Result, run
from course.simulations.registry import get


@functools.cache
def result(name, *pairs):
    return run(get(name), pairs)


def figure(name, *pairs):
    with house_style():
        return simulations.draw(result(name, *pairs))


def labels(axes):
    legend = axes.get_legend()
    return [text.get_text() for text in legend.get_texts()] if legend else []


@pytest.mark.parametrize(
    ("name", "pairs"),
    [
        ("free-fall", ["duration=1"]),
        ("free-fall", ["duration=0.01"]),
        ("projectile", ["speed_z=-5"]),
        ("projectile", ["duration=0.5"]),
        ("collision", ["radius=0", "speed1=-1"]),
        ("integrators", ["step=1.25", "duration=1000"]),
        ("rotation", ["spin=0", "nudge=0.1"]),
        ("rotation", ["step=0.1", "spin=100"]),
        ("dynamics", ["payload=0.1"]),
        ("chaos", ["angle1_deg=10", "angle2_deg=5", "duration=1"]),
        ("solver-iterations", ["boxes=3", "iterations=5"]),
        ("solver-iterations", ["boxes=20", "tolerance=0.5"]),
        ("substeps", ["work=60", "duration=0.5", "frame=0.025"]),
        ("environment", ["step=0.05"]),
        ("contact-models", ["restitution=0", "step=0.05"]),
        ("contact-models", ["restitution=1", "erp=1", "height=100", "step=0.02"]),
    ],
)
def test_extreme_settings_still_give_a_figure_with_a_title_that_fits(name, pairs):
    drawn = figure(name, *pairs)
    with house_style():
        drawn.canvas.draw()
    title = next(text for text in drawn.texts if text.get_text() == drawn.get_suptitle())
    assert title.get_window_extent().x1 <= drawn.bbox.x1


@pytest.mark.parametrize(
    "name",
    ["projectile", "collision", "integrators", "rotation", "solver-iterations", "substeps", "contact-models"],
)
def test_a_legend_beside_the_axes_stays_on_the_page(name):
    drawn = figure(name)
    drawn.canvas.draw()
    boxes = [axes.get_legend().get_window_extent() for axes in drawn.axes if axes.get_legend()]
    assert boxes
    assert all(box.x1 <= drawn.bbox.x1 for box in boxes)


def test_the_title_is_the_finding_of_the_run_that_is_drawn():
    assert figure("collision", "restitution=0.5").get_suptitle() == (
        "Contact at 2.25 s conserves momentum and 25 % of the kinetic energy"
    )


def test_balls_are_drawn_in_their_width_and_bounce_where_they_touch():
    (axes,) = figure("collision").axes
    left = next(line for line in axes.lines if line.get_label() == "left ball and its width")
    assert np.max(np.asarray(left.get_ydata())) == pytest.approx(-0.5, abs=0.02)
    assert "contact at 2.25 s" in labels(axes)


def test_errors_of_the_two_eulers_are_drawn_one_each_way():
    right = figure("free-fall").axes[1]
    ends = {line.get_color(): float(np.asarray(line.get_ydata())[-1]) for line in right.lines}
    assert ends[METHODS["explicit_euler"].color] == pytest.approx(0.0981)
    assert ends[METHODS["semi_implicit_euler"].color] == pytest.approx(-0.0981)


def test_stacks_are_labelled_with_the_iterations_they_need():
    (axes,) = figure("solver-iterations").axes
    assert labels(axes) == ["2 boxes: 7", "5 boxes: 45", "10 boxes: 178", "20 boxes: 713"]


def test_the_times_at_which_two_pendulums_part_are_marked_on_the_curve():
    lower = figure("chaos", "duration=12", "step=0.01").axes[1]
    curve = np.asarray(lower.lines[0].get_ydata())
    t = np.asarray(lower.lines[0].get_xdata())
    marks = [line for line in lower.lines if line.get_marker() == "o"]
    assert len(marks) == 2
    for mark in marks:
        (when,), (level,) = mark.get_xdata(), mark.get_ydata()
        assert math.log(np.interp(when, t, curve) / level) == pytest.approx(0.0, abs=0.1)


def test_a_simulation_without_a_figure_is_our_fault():
    with pytest.raises(InternalError, match="has no figure"):
        simulations.draw(Result((), "", "", (), simulation="nothing"))
