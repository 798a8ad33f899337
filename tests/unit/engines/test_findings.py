"""What is said and drawn of a comparison holds only what its rows show."""

import math

import msgspec
import pytest

from course.engines import reference
from course.engines.compare import LADDER, QUICK_LADDER
from course.engines.findings import chaos, defaults, findings, fingerprints, phases, same_algorithm, slope
from course.engines.results import Row
from course.figures import engines as module
from course.figures.style import house_style


def row(engine, scenario, value, setting="tuned", samples=(), **details):
    return Row(
        samples=samples,
        engine=engine,
        scenario=scenario,
        setting=setting,
        dt=1 / 240,
        status="ok",
        value=value,
        details=details,
    )


def swings(engine, *ends, setting="tuned"):
    return row(engine, "double-pendulum", 1.0, setting, at_the_end_percent=list(ends))


def test_the_free_fall_names_the_velocity_that_moves_a_body():
    said = fingerprints(
        [
            row("mujoco", "free-fall", 0.5, steps=200),
            row("pymunk", "free-fall", -0.5, steps=200),
            row("rapier", "free-fall", 0.125, steps=200),
            row("dart", "free-fall", 0.5, steps=200),
            row("pybullet", "free-fall", -4.7, steps=200),
        ]
    )
    assert "The new one: MuJoCo and DART" in said
    assert "the old one: pymunk (2-D)" in said
    assert "the new one in each of 4 substeps: Rapier" in said
    assert "Bullet 3" not in said


def test_engines_agree_only_if_every_start_does():
    same = [swings("mujoco", 4.4, 9.2), swings("dart", 4.4, 9.2), swings("physx", 4.5, 9.2)]
    assert same_algorithm(same).endswith("in MuJoCo and DART.")
    assert same_algorithm([swings("mujoco", 4.4, 9.2), swings("dart", 4.4, 9.3)]) == ""
    assert same_algorithm([swings("mujoco"), swings("dart")]) == ""


def test_an_engine_as_it_comes_may_agree_with_another_one_well_set():
    said = same_algorithm([swings("mujoco", 4.4, setting="default"), swings("pybullet", 4.4)])
    assert said.endswith("in MuJoCo and Bullet 3.")


def test_defaults_count_where_options_moved_one_engine_beyond_all():
    rows = [
        row("mujoco", "bounce", 0.0, "default"),
        row("mujoco", "bounce", 0.25),
        row("ode", "bounce", 0.247, "default"),
        row("ode", "bounce", 0.247),
        row("mujoco", "slide", 0.0, "default"),
        row("mujoco", "slide", 0.0),
        row("ode", "slide", 1.0, "default"),
        row("ode", "slide", 1.0),
    ]
    assert "in 1 of 2 scenarios (bounce)" in defaults(rows)
    assert defaults(rows[4:]) == ""
    assert defaults(rows[:2]) == ""


def test_a_move_within_the_range_of_the_phases_is_not_called_an_option_s():
    still = [row(e, "bounce", 0.25, s) for e in ("ode", "dart") for s in ("default", "tuned")]
    moved = [
        row("mujoco", "bounce", 0.1, "default", samples=(0.05, 0.24)),
        row("mujoco", "bounce", 0.25, samples=(0.23, 0.27)),
    ]
    assert defaults([*still, *moved]) == ""
    apart = [row("mujoco", "bounce", 0.1, "default", samples=(0.05, 0.18)), moved[1]]
    assert "in 1 of 1 scenarios (bounce)" in defaults([*still, *apart])
    # Well-set engines lie as far apart as their phases reach.
    wide = [row("bullet", "bounce", 0.25, s, samples=(0.1, 0.4)) for s in ("default", "tuned")]
    assert defaults([*still, *apart, *wide]) == ""


def test_the_widest_impact_is_named_with_its_range_and_narrow_ones_are_not():
    rows = [
        row("bullet", "bounce", 0.25, samples=(0.14, 0.41)),
        row("ode", "bounce", 0.25, samples=(0.24, 0.26)),
        row("ode", "small-drop", 5.0, samples=(4.0, 6.0)),
    ]
    assert "Bullet 2.84 gives between 0.1400 and 0.4100 m in bounce" in phases(rows)
    assert "ODE gives between 4.00 and 6.00 mm in small-drop" in phases(rows[1:])
    assert phases([row("ode", "bounce", 0.25, samples=(0.249, 0.251))]) == ""
    assert phases([row("ode", "bounce", 0.25)]) == ""


def test_chaos_quotes_the_widest_engine_and_keeps_quiet_about_small_ones():
    assert "DART" in chaos([swings("dart", -9.6, 9.2), swings("mujoco", -1.0, 1.0)])
    assert "between -9.6 and +9.2 %" in chaos([swings("dart", -9.6, 9.2)])
    assert chaos([swings("mujoco", 0.0, 1e-5)]) == ""


def test_rows_without_a_value_say_nothing():
    failed = Row(engine="ode", scenario="free-fall", setting="tuned", dt=1 / 240, status="crash")
    assert findings([failed]) == ()


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_slope_is_the_order(order):
    points = [(dt, 3e6 * dt**order * 1e-3) for dt in (1 / 60, 1 / 120, 1 / 240, 1 / 480)]
    assert slope(points, single=False) == pytest.approx(order)


def test_round_off_has_no_slope():
    points = [(0.1, 1e-7), (0.05, 1e-7), (0.025, 1e-7)]
    assert slope(points, single=True) is None
    assert slope(points, single=False) == pytest.approx(0.0)


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
