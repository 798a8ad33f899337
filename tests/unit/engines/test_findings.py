"""Sentences about a comparison hold only what its rows show."""

from __future__ import annotations

import pytest

from course.engines.findings import chaos, defaults, findings, fingerprints, phases, same_algorithm, slope
from course.engines.results import Row


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
