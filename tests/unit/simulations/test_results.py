"""Every number that the simulations are known for, and findings that stay true when something is set."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest

from course.simulations.base import Result, Row, run
from course.simulations.registry import SIMULATIONS, get

LONGEST_HEADLINE = 74


@functools.cache
def result(name: str, *pairs: str) -> Result:
    return run(get(name), pairs)


@pytest.mark.parametrize("name", SIMULATIONS)
def test_a_simulation_asks_runs_measures_and_finds(name: str) -> None:
    simulation, out = get(name), result(name)
    assert simulation.id == name
    assert simulation.question.endswith("?")
    assert out.rows
    assert len(out.headline) <= LONGEST_HEADLINE
    assert out.finding.endswith(".")
    assert len({column.values.size for column in out.columns}) == 1
    assert len({row.quantity for row in out.rows}) == len(out.rows)
    assert len({column.name for column in out.columns}) == len(out.columns)


@pytest.mark.parametrize("name", SIMULATIONS)
def test_a_simulation_repeats_bit_for_bit(name: str) -> None:
    short = ("duration=1",) if get(name).parameter("duration") else ()
    one, two = result(name, *short), run(get(name), short)
    assert repr(one.rows) == repr(two.rows)  # some are NaN, which equals nothing
    assert all(
        np.array_equal(a.values, b.values, equal_nan=True)
        for a, b in zip(one.columns, two.columns, strict=True)
    )


def test_a_row_without_theory_has_no_error_and_neither_has_what_did_not_happen() -> None:
    assert Row("x", 1.0, "m").error is None
    assert Row("x", math.nan, "m", 1.0).error is None
    assert Row("x", math.inf, "m", 1.0).error is None
    assert Row("x", 1.0, "m", math.nan).error is None
    assert Row("x", 1.5, "m", 1.0).error == 0.5


# -- the introduction --------------------------------------------------------------------------------------


def test_a_fall_from_ten_metres_takes_1_428_s() -> None:
    out = result("free-fall")
    assert out.row("time to the ground").simulated == pytest.approx(1.4278431, abs=1e-7)
    assert "after 1.428 s" in out.finding
    assert "0.0981 m" in out.finding


def test_semi_implicit_euler_is_low_by_half_a_step_and_explicit_euler_as_much_too_high() -> None:
    out = result("free-fall")
    errors = [row.error for row in out.rows if "without ground" in row.quantity]
    assert errors == pytest.approx([0.0981, -0.0981, 0.0, 0.0], abs=1e-10)
    assert out.row("bias of semi-implicit Euler").theory == pytest.approx(-0.0981)


def test_a_fall_that_does_not_end_says_when_it_would() -> None:
    out = result("free-fall", "duration=1")
    assert math.isnan(out.rows[0].simulated)
    assert "still falling after 1 s; it would land after 1.428 s" in out.finding
    assert out.headline.startswith("Still falling")


def test_a_naive_method_lands_at_its_own_time() -> None:
    assert result("free-fall", "method=semi_implicit_euler").rows[0].error == pytest.approx(-0.005, abs=2e-4)


def test_the_throw_has_the_apex_and_the_landing_of_theory() -> None:
    values = [row.simulated for row in result("projectile").rows]
    assert values == pytest.approx([1.019368, 5.096840, 10.193680, 2.038736, 20.387360], abs=1e-6)


def test_a_throw_that_does_not_come_down_says_so() -> None:
    out = result("projectile", "duration=1")
    assert "still in the air" in out.finding
    assert math.isnan(out.row("time of the highest point").simulated)


@pytest.mark.parametrize("pairs", [["speed_z=-3", "height=20"], ["height=5", "speed_z=0"], ["speed_x=0"]])
def test_throws_of_every_direction_agree_with_theory(pairs: list[str]) -> None:
    for row in result("projectile", *pairs).rows:
        assert row.simulated == pytest.approx(row.theory, abs=1e-9), row


@pytest.mark.parametrize("speed", [-5, 0])
def test_a_throw_into_the_ground_is_over_at_once(speed: int) -> None:
    out = result("projectile", f"speed_z={speed}")
    assert out.row("distance of landing").simulated == 0.0


@pytest.mark.parametrize(
    ("name", "pairs", "words"),
    [
        ("free-fall", ["speed=100"], "still rising after 2 s"),
        ("projectile", ["speed_z=0"], "starts on the ground and does not leave it"),
        ("projectile", ["speed_z=-1", "height=2"], "It lands after"),
        ("projectile", ["speed_x=0", "drag=0.1"], "has no air. No smaller step"),
        ("collision", ["restitution=0"], "none of the kinetic energy, which becomes heat."),
        ("collision", ["restitution=0.99999"], "nearly all of the kinetic energy; the rest"),
        ("environment", ["speed=0.1"], "Refine the step before"),
        ("substeps", ["links=2"], "for so few links"),
        ("solver-iterations", ["iterations=1"], "After 1 iteration from"),
        ("contact-models", [], "hops 0 m high, and higher with a smaller step."),
        ("contact-models", ["overlap=0"], "starts 0 m inside the floor hops 0 m high."),
        ("integrators", ["step=1"], "at the limit of 2"),
        ("rotation", ["nudge=10"], "gains energy without limit"),
        ("dynamics", ["duration=0.01", "step=0.01"], "errors of the steps grow"),
        ("chaos", ["nudge=1", "duration=5"], "passes 0.001 rad at the start"),
        ("rotation", ["spin=0"], "does not spin about axis 2"),
        ("rotation", ["nudge=0"], "nothing made the body wobble"),
    ],
)
def test_the_finding_says_what_these_settings_did(name: str, pairs: list[str], words: str) -> None:
    assert words in result(name, *pairs).finding


def test_a_headline_says_whether_theory_bears_it_out() -> None:
    assert "as theory says" in result("contact-models", "restitution=1").headline
    assert all(
        "as theory says" not in result("projectile", *pairs).headline
        for pairs in (["method=explicit_euler"], ["drag=0.1", "speed_x=0"])
    )


def test_air_is_missing_from_the_model_whatever_the_step() -> None:
    pairs = ["drag=0.02", "method=rk4"]  # of order 4 with a force that depends on the speed; Verlet is not
    coarse, fine = (result("projectile", *pairs, f"step={h}").rows[4] for h in (0.02, 0.004))
    assert coarse.simulated == pytest.approx(fine.simulated, rel=1e-4)
    assert fine.error is not None
    assert fine.error < -4.0


def test_the_pair_touches_at_2_25_s_one_metre_apart_and_ends_at_six() -> None:
    out = result("collision")
    assert [row.simulated for row in out.rows] == pytest.approx([2.25, 1, -2, 2, -6, 6, 0, 4], abs=1e-9)
    assert "2.5 s" in out.finding


@pytest.mark.parametrize(
    "pairs", [["restitution=0.5", "mass1=3"], ["speed2=1"], ["restitution=0"], ["speed1=-1"], ["mass2=1000"]]
)
def test_collisions_of_every_kind_agree_with_theory(pairs: list[str]) -> None:
    for row in result("collision", *pairs).rows:
        assert row.simulated == pytest.approx(row.theory, abs=1e-9, nan_ok=True), row


def test_balls_that_never_meet_are_said_to() -> None:
    assert "do not touch" in result("collision", "speed1=-1", "speed2=1").headline


def test_the_two_eulers_are_told_apart() -> None:
    out = result("integrators")
    assert abs(out.rows[0].error or 0) == pytest.approx(0.0890, abs=5e-5)
    assert abs(out.rows[1].error or 0) == pytest.approx(0.00553, abs=5e-6)
    assert "0.0890 m" in out.finding
    assert "0.00553 m" in out.finding


@pytest.mark.parametrize(
    ("step", "expected"),
    [
        (0.01, [53.6, 1.01e-2, 1.0e-4, 8.9e-9]),
        (0.05, [4.4e8, 5.26e-2, 2.5e-3, 2.8e-5]),
        (0.1, [1.08e17, 0.111, 1.0e-2, 8.8e-4]),
        (0.5, [1.6e60, 1.00, 0.188, 0.91]),
        (1.01, [7.7e69, 5.8e25, 5.1e23, 1.0]),
    ],
)
def test_energy_errors_over_a_hundred_seconds_are_the_known_ones(step: float, expected: list[float]) -> None:
    duration = round(100 / step) * step
    out = result("integrators", f"duration={duration!r}", f"step={step}")
    assert [row.simulated for row in out.rows[4:]] == pytest.approx(expected, rel=0.02)


def test_a_step_beyond_the_limit_is_called_one() -> None:
    out = result("integrators", "step=1.25")
    assert "beyond the limit of 2" in out.finding
    assert "below 1 s" in out.finding
    assert "2.83" not in out.finding
    assert all(row.simulated == math.inf for row in result("integrators", "omega=1000").rows)


def test_measured_energy_errors_stay_within_their_bounds() -> None:
    for row in result("integrators", "duration=50", "step=0.02").rows[5:7]:
        assert row.theory is not None
        assert row.simulated == pytest.approx(row.theory, rel=1e-3)


# -- beyond it ---------------------------------------------------------------------------------------------


def test_explicit_euler_gives_a_free_body_28_percent_of_energy() -> None:
    out = result("rotation")
    assert out.row("energy gained, explicit Euler").simulated == pytest.approx(0.278, abs=5e-4)
    assert abs(out.row("energy gained, Runge-Kutta 4").simulated) < 1e-8
    assert abs(out.row("energy gained, split rotations").simulated) < 1e-8
    assert out.row("length of the quaternion, split rotations").simulated == pytest.approx(1.0, abs=1e-14)
    assert out.row("angular momentum lost, split rotations").simulated < 1e-12
    assert out.row("growth of the wobble").simulated == pytest.approx(5 / math.sqrt(3), rel=0.01)
    assert out.row("times it turned over").simulated == 4


def test_a_spin_about_a_stable_axis_is_not_said_to_turn_over() -> None:
    out = result("rotation", "inertia1=2", "inertia2=3", "inertia3=2.5")
    assert out.row("times it turned over").simulated == 0
    assert "not the middle one" in out.finding
    assert "never flips over" in out.headline


def test_a_step_too_long_for_the_spin_is_called_one() -> None:
    out = result("rotation", "spin=100", "step=0.1")
    assert "turns by 10 rad in one step" in out.finding
    assert "below 0.005 s" in out.finding


def test_torques_of_the_right_model_carry_the_hand_to_its_goal() -> None:
    out = result("dynamics")
    assert abs(out.row("inverse(forward(torque)) - torque, at most").simulated) < 1e-10
    assert out.row("hand off its goal after the forward run").simulated < 1e-5
    assert out.row("kinematic: hand off the straight line, at most").simulated < 1e-12
    for row in out.rows[2:4]:
        assert row.simulated == pytest.approx(row.theory, abs=1e-12)
    assert out.row("forward: energy gained").error == pytest.approx(0.0, abs=1e-4)


def test_a_hundredth_of_a_kilogram_that_the_model_lacks_costs_a_third_of_a_metre() -> None:
    out = result("dynamics", "payload=0.01")
    assert out.row("hand off its goal after the forward run").simulated == pytest.approx(0.377, abs=0.005)
    assert "0.01 kg" in out.headline


def test_a_billionth_of_a_radian_grows_past_one_in_ten_seconds() -> None:
    out = result("chaos")
    assert out.row("separation passes 1e-3 rad").simulated == pytest.approx(7.3, abs=0.05)
    assert out.row("separation passes 1 rad").simulated == pytest.approx(10.0, abs=0.1)
    half = result("chaos", "step=0.0025", "duration=11")
    assert half.row("separation passes 1 rad").simulated == pytest.approx(10.0, abs=0.1)


def test_averages_agree_where_paths_no_longer_do() -> None:
    means = [row.simulated for row in result("chaos").rows if row.quantity.startswith("mean energy")]
    assert means[0] == pytest.approx(means[1], rel=0.03)


def test_a_pendulum_that_swings_low_is_not_called_chaotic() -> None:
    out = result("chaos", "angle1_deg=10", "angle2_deg=10", "duration=10")
    assert math.isnan(out.row("separation passes 1 rad").simulated)
    assert "still close" in out.headline


def test_stacks_need_the_known_numbers_of_iterations() -> None:
    out = result("solver-iterations")
    assert [row.simulated for row in out.rows[:4]] == [7, 45, 178, 713]
    for row in out.rows[4:8]:
        assert row.simulated == pytest.approx(row.theory, rel=1e-3)
    assert out.row("20-link chain, stretch after 16 iterations a frame").simulated == pytest.approx(
        0.084, abs=5e-4
    )


def test_the_same_work_in_small_steps_stretches_a_chain_five_times_less() -> None:
    out = result("substeps")
    stretches = [row.simulated for row in out.rows]
    assert (stretches[0], stretches[-1]) == pytest.approx((0.0836, 0.0149), abs=1e-4)
    assert stretches == sorted(stretches, reverse=True)


def test_floors_let_a_ball_sink_hop_and_gain_as_their_models_say() -> None:
    out = result("contact-models")
    for row in out.rows[:4]:
        assert row.simulated == pytest.approx(row.theory, rel=1e-6)
    assert out.row("lowest rebound, no correction").simulated == pytest.approx(0.223, abs=5e-4)
    assert out.row("highest rebound, no correction").simulated == pytest.approx(0.255, abs=5e-4)
    assert out.row("highest rebound, ERP in the velocity").simulated > 0.45
    # (1 + ERP u)² - 1 with u even from 0 to 1 is ERP + ERP²/3 on average, whatever the step.
    for step in (0.01, 0.001):
        gained = result("contact-models", f"step={step}").row("energy kept at e = 1, ERP in the velocity")
        assert gained.simulated - 1 == pytest.approx(0.2 + 0.04 / 3, rel=0.06)
    assert out.row("energy kept at e = 1, split impulse").simulated == pytest.approx(1.0, abs=1e-3)


def test_a_spring_too_stiff_for_the_step_is_said_to_throw_the_ball() -> None:
    out = result("contact-models", "stiffness=1e6", "erp=0.8")
    assert math.isnan(out.row("depth at rest, penalty").simulated)
    assert out.row("depth at rest, ERP and CFM of the spring").error == pytest.approx(0.0, abs=1e-9)
    for settings, hop in (([], 0.0), (["step=0.001"], 0.7975), (["erp=0.8"], 0.1186)):
        thrown, split = (row for row in result("contact-models", *settings).rows if "hop out" in row.quantity)
        assert (thrown.simulated, split.simulated) == (pytest.approx(hop, abs=1e-4), 0.0)


@pytest.mark.parametrize("work", [2, 7, 60])
def test_any_amount_of_work_is_split_into_at_most_six_ways(work: int) -> None:
    out = result("substeps", f"work={work}", "duration=0.5", "frame=0.025")
    assert 2 <= len(out.rows) <= 6
    assert f"{work} substeps" in out.rows[-1].quantity


def test_the_floor_decides_more_than_the_step() -> None:
    out = result("environment")
    for row in out.rows[:3]:
        assert row.error == pytest.approx(-2.0 * 0.01 / 2, rel=0.01)  # half a step at the starting speed
    for row in out.rows[3:6]:
        assert row.simulated == pytest.approx(row.theory, rel=1e-9)
    assert out.rows[6].simulated == pytest.approx(1 / 9, rel=0.02)
