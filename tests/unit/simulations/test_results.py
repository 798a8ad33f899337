"""Every number that the simulations are known for; findings and figures that stay true whatever is set."""

import functools
import math

import numpy as np
import pytest

from course.errors import InternalError
from course.figures import experiments
from course.figures.style import METHODS, house_style
from course.simulations.base import Result, Row, run
from course.simulations.registry import SIMULATIONS, get

LONGEST_HEADLINE = 74


@functools.cache
def result(line):
    """Of a simulation and its settings, as they are typed."""
    name, *pairs = line.split()
    return run(get(name), pairs)


@pytest.mark.parametrize("name", SIMULATIONS)
def test_a_simulation_asks_runs_measures_and_finds(name):
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
def test_a_simulation_repeats_bit_for_bit(name):
    short = ["duration=1"] if get(name).parameter("duration") else []
    one, two = result(" ".join([name, *short])), run(get(name), short)
    assert repr(one.rows) == repr(two.rows)  # some are NaN, which equals nothing
    assert all(
        np.array_equal(a.values, b.values, equal_nan=True)
        for a, b in zip(one.columns, two.columns, strict=True)
    )


def test_a_row_without_theory_has_no_error_and_neither_has_what_did_not_happen():
    assert Row("x", 1.0, "m").error is None
    assert Row("x", math.nan, "m", 1.0).error is None
    assert Row("x", math.inf, "m", 1.0).error is None
    assert Row("x", 1.0, "m", math.nan).error is None
    assert Row("x", 1.5, "m", 1.0).error == 0.5


# -- numbers -----------------------------------------------------------------------------------------------

NEVER = pytest.approx(math.nan, nan_ok=True)
GOAL, HOP = "hand off its goal after the forward run", "hop out of the overlap, ERP"
KNOWN = {
    "free-fall": {"time to the ground": pytest.approx(1.4278431, abs=1e-7)},
    "free-fall duration=1": {"time to the ground": NEVER},
    "free-fall method=semi_implicit_euler": {"time to the ground": pytest.approx(1.4228, abs=2e-4)},
    "projectile duration=1": {"time of the highest point": NEVER},
    "projectile speed_z=-5": {"distance of landing": 0.0},
    "projectile speed_z=0": {"distance of landing": 0.0},
    "rotation": {
        "energy gained, explicit Euler": pytest.approx(0.278, abs=5e-4),
        "energy gained, Runge-Kutta 4": pytest.approx(0.0, abs=1e-8),
        "energy gained, split rotations": pytest.approx(0.0, abs=1e-8),
        "length of the quaternion, split rotations": pytest.approx(1.0, abs=1e-14),
        "angular momentum lost, split rotations": pytest.approx(0.0, abs=1e-12),
        "growth of the wobble": pytest.approx(5 / math.sqrt(3), rel=0.01),
        "times it turned over": 4,
    },
    "rotation inertia1=2 inertia2=3 inertia3=2.5": {"times it turned over": 0},
    "dynamics": {
        "inverse(forward(torque)) - torque, at most": pytest.approx(0.0, abs=1e-10),
        "kinematic: hand off the straight line, at most": pytest.approx(0.0, abs=1e-12),
        GOAL: pytest.approx(0.0, abs=1e-5),
    },
    "dynamics payload=0.01": {GOAL: pytest.approx(0.377, abs=0.005)},
    "solver-iterations": {
        "iterations to 1 %, 2 boxes": 7,
        "iterations to 1 %, 5 boxes": 45,
        "iterations to 1 %, 10 boxes": 178,
        "iterations to 1 %, 20 boxes": 713,
        "20-link chain, stretch after 16 iterations a frame": pytest.approx(0.0836, abs=1e-4),
    },
    "substeps": {
        "greatest stretch, 1 substep x 16 iterations": pytest.approx(0.0836, abs=1e-4),
        "greatest stretch, 16 substeps x 1 iteration": pytest.approx(0.0149, abs=1e-4),
    },
    "contact-models": {
        "lowest rebound, no correction": pytest.approx(0.223, abs=5e-4),
        "highest rebound, no correction": pytest.approx(0.255, abs=5e-4),
        "highest rebound, ERP in the velocity": pytest.approx(0.468, abs=5e-4),
        "energy kept at e = 1, split impulse": pytest.approx(1.0, abs=1e-3),
        f"{HOP} in the velocity": pytest.approx(0.0, abs=1e-4),
        f"{HOP} split impulse": 0.0,
    },
    "contact-models step=0.001": {
        f"{HOP} in the velocity": pytest.approx(0.7975, abs=1e-4),
        f"{HOP} split impulse": 0.0,
    },
    "contact-models erp=0.8": {
        f"{HOP} in the velocity": pytest.approx(0.1186, abs=1e-4),
        f"{HOP} split impulse": 0.0,
    },
    "contact-models stiffness=1e6 erp=0.8": {"depth at rest, penalty": NEVER},
    "environment": {"sliding further, friction 10 % lower": pytest.approx(1 / 9, rel=0.02)},
}


@pytest.mark.parametrize("line", KNOWN)
def test_numbers_are_the_known_ones(line):
    assert {quantity: result(line).row(quantity).simulated for quantity in KNOWN[line]} == KNOWN[line]


ALL = slice(None)


@pytest.mark.parametrize(
    ("line", "rows", "within"),
    [
        ("projectile", ALL, {"abs": 1e-9}),
        ("projectile speed_z=-3 height=20", ALL, {"abs": 1e-9}),
        ("projectile height=5 speed_z=0", ALL, {"abs": 1e-9}),
        ("projectile speed_x=0", ALL, {"abs": 1e-9}),
        ("integrators duration=50 step=0.02", slice(5, 7), {"rel": 1e-3}),
        ("dynamics", slice(2, 4), {"abs": 1e-12}),
        ("dynamics", slice(6, 7), {"abs": 1e-4}),
        ("solver-iterations", slice(4, 8), {"rel": 1e-3}),
        ("contact-models", slice(4), {"rel": 1e-6}),
        ("contact-models stiffness=1e6 erp=0.8", slice(1, 2), {"abs": 1e-9}),
        ("environment", slice(3, 6), {"rel": 1e-9}),
        ("collision restitution=0.5 mass1=3", ALL, {"abs": 1e-9}),
        ("collision speed2=1", ALL, {"abs": 1e-9}),
        ("collision restitution=0", ALL, {"abs": 1e-9}),
        ("collision speed1=-1", ALL, {"abs": 1e-9}),
        ("collision mass2=1000", ALL, {"abs": 1e-9}),
    ],
)
def test_what_is_measured_agrees_with_theory(line, rows, within):
    for row in result(line).rows[rows]:
        assert row.simulated == pytest.approx(row.theory, **within, nan_ok=True), row


def test_semi_implicit_euler_is_low_by_half_a_step_and_explicit_euler_as_much_too_high():
    out = result("free-fall")
    errors = [row.error for row in out.rows if "without ground" in row.quantity]
    assert errors == pytest.approx([0.0981, -0.0981, 0.0, 0.0], abs=1e-10)
    assert out.row("bias of semi-implicit Euler").theory == pytest.approx(-0.0981)


def test_the_throw_has_the_apex_and_the_landing_of_theory():
    values = [row.simulated for row in result("projectile").rows]
    assert values == pytest.approx([1.019368, 5.096840, 10.193680, 2.038736, 20.387360], abs=1e-6)


def test_air_is_missing_from_the_model_whatever_the_step():
    # Of order 4 with a force that depends on the speed; Verlet is not.
    lines = [f"projectile drag=0.02 method=rk4 step={h}" for h in (0.02, 0.004)]
    coarse, fine = (result(line).rows[4] for line in lines)
    assert coarse.simulated == pytest.approx(fine.simulated, rel=1e-4)
    assert fine.error < -4.0


def test_the_pair_touches_at_2_25_s_one_metre_apart_and_ends_at_six():
    values = [row.simulated for row in result("collision").rows]
    assert values == pytest.approx([2.25, 1, -2, 2, -6, 6, 0, 4], abs=1e-9)


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
def test_energy_errors_over_a_hundred_seconds_are_the_known_ones(step, expected):
    duration = round(100 / step) * step
    out = result(f"integrators duration={duration!r} step={step}")
    assert [row.simulated for row in out.rows[4:]] == pytest.approx(expected, rel=0.02)


def test_beyond_the_limit_every_energy_error_is_infinite():
    assert all(row.simulated == math.inf for row in result("integrators omega=1000").rows)


def test_a_billionth_of_a_radian_grows_past_one_in_ten_seconds():
    out = result("chaos")
    assert out.row("separation passes 1e-3 rad").simulated == pytest.approx(7.3, abs=0.05)
    for line in ("chaos", "chaos step=0.0025 duration=11"):
        assert result(line).row("separation passes 1 rad").simulated == pytest.approx(10.0, abs=0.1)


def test_a_pendulum_that_swings_low_is_not_called_chaotic():
    out = result("chaos angle1_deg=10 angle2_deg=10 duration=10")
    assert math.isnan(out.row("separation passes 1 rad").simulated)
    assert "still close" in out.headline


def test_averages_agree_where_paths_no_longer_do():
    means = [row.simulated for row in result("chaos").rows if row.quantity.startswith("mean energy")]
    assert means[0] == pytest.approx(means[1], rel=0.03)


@pytest.mark.parametrize("step", [0.01, 0.001])
def test_a_correction_in_the_velocity_gives_an_elastic_ball_the_energy_of_the_formula(step):
    # (1 + ERP u)² - 1 with u even from 0 to 1 is ERP + ERP²/3 on average, whatever the step.
    gained = result(f"contact-models step={step}").row("energy kept at e = 1, ERP in the velocity")
    assert gained.simulated - 1 == pytest.approx(0.2 + 0.04 / 3, rel=0.06)


@pytest.mark.parametrize("work", [2, 7, 16, 60])
def test_any_amount_of_work_is_split_into_at_most_six_ways(work):
    rows = result(f"substeps work={work} duration=0.5 frame=0.025").rows
    assert 2 <= len(rows) <= 6
    assert f"{work} substeps" in rows[-1].quantity


def test_the_same_work_in_smaller_steps_stretches_a_chain_less_and_less():
    stretches = [row.simulated for row in result("substeps").rows]
    assert stretches == sorted(stretches, reverse=True)


def test_a_sliding_block_stops_half_a_step_at_the_starting_speed_too_early():
    for row in result("environment").rows[:3]:
        assert row.error == pytest.approx(-2.0 * 0.01 / 2, rel=0.01)


# -- words -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("free-fall", "after 1.428 s"),
        ("free-fall", "0.0981 m"),
        ("free-fall duration=1", "still falling after 1 s; it would land after 1.428 s"),
        ("free-fall speed=100", "still rising after 2 s"),
        ("projectile duration=1", "still in the air"),
        ("projectile speed_z=0", "starts on the ground and does not leave it"),
        ("projectile speed_z=-1 height=2", "It lands after"),
        ("projectile speed_x=0 drag=0.1", "has no air. No smaller step"),
        ("collision", "2.5 s"),
        ("collision restitution=0", "none of the kinetic energy, which becomes heat."),
        ("collision restitution=0.99999", "nearly all of the kinetic energy; the rest"),
        ("environment speed=0.1", "Refine the step before"),
        ("substeps links=2", "for so few links"),
        ("solver-iterations iterations=1", "After 1 iteration from"),
        ("contact-models step=0.005", "m high, and with a smaller step higher."),
        ("contact-models", "does not hop, but would with a smaller step."),
        ("contact-models overlap=0", "starts 0 m inside the floor does not hop."),
        ("integrators", "0.0890 m"),
        ("integrators", "0.00553 m"),
        ("integrators step=1", "at the limit of 2"),
        ("integrators step=1.25", "beyond the limit of 2 for semi-implicit Euler and Verlet:"),
        ("integrators step=1.25", "below 1 s"),
        ("rotation nudge=10", "gains energy without limit"),
        ("rotation spin=0", "does not spin about axis 2"),
        ("rotation nudge=0", "nothing made the body wobble"),
        ("rotation inertia1=2 inertia2=3 inertia3=2.5", "a spin about it is stable. No torque"),
        ("rotation inertia2=3.5 nudge=5", "Such a large wobble still turned the body over."),
        ("rotation inertia1=2 nudge=1", "a wobble makes the spin drift"),
        ("rotation inertia1=3 inertia2=3 nudge=1", "a spin about it is stable. No torque"),
        ("rotation spin=100 step=0.1", "turns by 10 rad in one step"),
        ("rotation spin=100 step=0.1", "below 0.005 s"),
        ("dynamics duration=0.01 step=0.01", "errors of the steps grow"),
        ("chaos nudge=1 duration=5", "passes 0.001 rad at the start"),
    ],
)
def test_the_finding_says_what_these_settings_did(line, words):
    assert words in result(line).finding


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("free-fall duration=1", "Still falling"),
        ("collision speed1=-1 speed2=1", "do not touch"),
        ("rotation inertia1=2 inertia2=3 inertia3=2.5", "never flips over"),
        ("dynamics payload=0.01", "0.01 kg"),
        ("contact-models restitution=1", "as theory says"),
    ],
)
def test_the_headline_says_what_came_of_it(line, words):
    assert words in result(line).headline


@pytest.mark.parametrize("line", ["projectile method=explicit_euler", "projectile drag=0.1 speed_x=0"])
def test_a_headline_does_not_call_on_a_theory_that_does_not_bear_it_out(line):
    assert "as theory says" not in result(line).headline


# -- figures ---------------------------------------------------------------------------------------------


def figure(line):
    with house_style():
        return experiments.draw(result(line))


def labels(axes):
    legend = axes.get_legend()
    return [text.get_text() for text in legend.get_texts()] if legend else []


@pytest.mark.parametrize(
    "line",
    [
        "free-fall duration=1",
        "free-fall duration=0.01",
        "projectile speed_z=-5",
        "projectile duration=0.5",
        "collision radius=0 speed1=-1",
        "integrators step=1.25 duration=1000",
        "rotation spin=0 nudge=0.1",
        "rotation step=0.1 spin=100",
        "dynamics payload=0.1",
        "chaos angle1_deg=10 angle2_deg=5 duration=1",
        "solver-iterations boxes=3 iterations=5",
        "solver-iterations boxes=20 tolerance=0.5",
        "substeps work=60 duration=0.5 frame=0.025",
        "environment step=0.05",
        "contact-models restitution=0 step=0.05",
        "contact-models restitution=1 erp=1 height=100 step=0.02",
    ],
)
def test_extreme_settings_still_give_a_figure_with_a_title_that_fits(line):
    drawn = figure(line)
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
    assert figure("collision restitution=0.5").get_suptitle() == (
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
    lower = figure("chaos duration=12 step=0.01").axes[1]
    curve = np.asarray(lower.lines[0].get_ydata())
    t = np.asarray(lower.lines[0].get_xdata())
    marks = [line for line in lower.lines if line.get_marker() == "o"]
    assert len(marks) == 2
    for mark in marks:
        (when,), (level,) = mark.get_xdata(), mark.get_ydata()
        assert math.log(np.interp(when, t, curve) / level) == pytest.approx(0.0, abs=0.1)


def test_a_simulation_without_a_figure_is_our_fault():
    with pytest.raises(InternalError, match="has no figure"):
        experiments.draw(Result((), "", "", (), simulation="nothing"))
