"""Figures described as data: every kind of series, and the student's curve over the right one."""

import numpy as np
import pytest

from course.authoring.exercises.grading import solution_path
from course.catalog.load import Catalog
from course.figures.described import Panel, Plot, Series, compared, marched, plot_of, read_curve, thinned
from course.figures.plots import draw, render
from course.figures.style import house_style
from course.physics.integrators import SemiImplicitEuler, State, trajectory
from course.physics.systems import Oscillator
from course.scoring.judging.session import GradingSession
from course.scoring.judging.submission import Submission, Terms

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
def test_each_kind_of_series_leaves_its_mark(kind):
    def ink(series):
        return render(Plot("What is seen", (Panel("time / s", "x / m", series),)))

    assert ink((EVERY_KIND[kind],)) != ink(())


def test_the_same_description_gives_the_same_bytes():
    plot = Plot("Twice", (Panel("t", "x", tuple(EVERY_KIND[k] for k in ("line", "band", "level"))),))
    for kind in ("png", "svg", "pdf"):
        assert render(plot, kind) == render(plot, kind)


def test_scales_titles_and_legends_are_as_described():
    panel = Panel("h / s", "error / m", (Series("yours", X, Y), Series("theory", X, Y)), "Order", log="xy")
    with house_style():
        figure = draw(Plot("Slopes tell", (panel, panel, panel), columns=2))
    shown = [ax for ax in figure.axes if ax.get_visible()]
    assert len(shown) == 3
    assert (shown[0].get_xscale(), shown[0].get_yscale()) == ("log", "log")
    assert (shown[0].get_xlabel(), shown[0].get_title("left")) == ("h / s", "Order")
    assert [text.get_text() for text in shown[0].get_legend().get_texts()] == ["yours", "theory"]


def test_two_curves_never_differ_by_colour_alone():
    series = tuple(Series(str(i), X, Y) for i in range(7))
    with house_style():
        (ax,) = draw(Plot("Many", (Panel("t", "x", series),))).axes
    assert len({str(line.get_linestyle()) + str(line._dash_pattern) for line in ax.lines}) == 7


CATALOG = Catalog()
T = np.linspace(0.0, 2.0, 41)
RIGHT = np.cos(2 * T)


def test_curves_that_are_one_on_paper_are_not_drawn():
    assert compared(T, RIGHT + 0.01, RIGHT, "x", "m") is None
    assert compared(T, RIGHT + 0.5 * T, RIGHT, "x", "m") is not None
    assert compared(T, T + 1, T, "t", "s") is None


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf, 1e300])
def test_whatever_a_curve_holds_it_can_be_drawn_and_said(wrong):
    for yours in (np.full(41, wrong), np.where(T > 1, wrong, RIGHT)):
        curve = compared(T, yours, RIGHT, "x", "m")
        plot = plot_of(curve)
        assert render(plot).startswith(b"\x89PNG")
        assert f"yours is at {wrong:.3g} m" in plot.description


def test_ends_that_read_the_same_are_told_once():
    curve = compared(T, np.where(T < 1.0, RIGHT + 1.0, RIGHT + 1e-9), RIGHT, "x", "m")
    assert "at 2 s, both are at -0.654 m." in curve.description


def test_where_curves_part_is_a_time_of_theirs():
    curve = compared(T, np.where(T > 0.99, RIGHT + 1.0, RIGHT), RIGHT, "x", "m")
    assert curve.parts_at == pytest.approx(1.0)
    assert "visibly apart from what it should be at 1 s" in curve.description


def test_of_a_long_swing_the_beginning_is_drawn_with_the_place_where_the_curves_part():
    t = np.linspace(0.0, 100.0, 4001)
    right = np.cos(2 * t)  # turns every pi / 2
    for parts, end in ((0.3, 10 * np.pi / 2), (50.0, 33 * np.pi / 2)):
        curve = compared(t, np.where(t > parts, 1.5 * right, right), right, "x", "m")
        drawn = plot_of(curve)
        assert np.asarray(drawn.panels[0].series[0].x)[-1] == pytest.approx(end, abs=0.1)
        assert "until" in drawn.title
        assert "at the end, at 100 s" in drawn.description


def test_a_curve_is_handed_on_in_few_points_with_both_ends():
    t = np.linspace(0.0, 9.0, 4001)
    long = compared(t, np.where(t > 5.0, np.nan, t), 2 * t, "x", "m")
    few = thinned(long)
    assert len(few.t) == 200
    assert (few.t[0], few.t[-1]) == (0.0, 9.0)
    assert thinned(few) is few
    told = {"t": few.t, "yours": ["nan" if np.isnan(one) else one for one in few.yours], "right": few.right}
    back = read_curve({**told, "quantity": "x", "units": "m", "right_is": "right"})
    assert np.array_equal(back.yours, few.yours, equal_nan=True)
    assert plot_of(back).description == few.description


def test_a_step_is_laid_over_the_method_that_it_is_named_for():
    q = RIGHT[:, None] * 1.2 ** T[:, None]
    march = "rk4_step", Oscillator(2.0), T, (q, -2 * np.sin(2 * T)[:, None])
    curve = marched(*march)
    assert curve.right_is == "RK4"
    assert np.allclose(curve.right, RIGHT * 1.0, atol=1e-3)
    assert marched("my_step", *march[1:]) is None
    assert marched(march[0], march[1], T, (RIGHT[:, None], march[3][1])) is None


@pytest.mark.parametrize(
    ("first", "told"), [(False, "semi-implicit Euler"), (True, "semi-implicit Euler, position first")]
)
def test_semi_implicit_euler_is_laid_over_its_own_order(first, told):
    spring, t = Oscillator(2.0), 0.5 * np.arange(41)
    right = trajectory(SemiImplicitEuler(position_first=first), spring, State.of([1.0], [3.0]), 0.5, 40)
    assert marched("semi_implicit_euler_step", spring, t, (right.q, right.v)) is None
    q = np.where(t[:, None] < 5, right.q, 0.0)
    curve = marched("semi_implicit_euler_step", spring, t, (q, right.v))
    assert (curve.right_is, curve.parts_at) == (told, 5.0)


@pytest.fixture(scope="module", params=["integrators", "collisions"])
def home(request):
    with GradingSession(CATALOG.exercise(request.param), CATALOG, terms=Terms(home=True)) as session:
        yield session


WRONG = {
    "integrators": (
        "def explicit_euler_step(accel, t, q, v, h):\n"
        "    v = v + h * accel(t, q, v)\n    return q + h * v, v\n",
        "explicit_euler_growth",
        "explicit Euler",
    ),
    "collisions": (
        "_right = simulate_drop\n\n\ndef simulate_drop(*args):\n    t, z, v = _right(*args)\n"
        "    return t, z[0] - 4.905 * np.asarray(t) ** 2, v\n",
        "drop_bounces",
        "right",
    ),
}


def test_a_failed_check_keeps_its_curve_and_a_passing_one_has_none(home):
    exercise = home.exercise
    solution = solution_path(CATALOG, exercise).read_bytes()
    more, check, named = WRONG[exercise.id]
    home.grade(Submission({exercise.module: solution + b"\n\n" + more.encode()}))
    assert home.curves[check].right_is == named
    home.grade(Submission({exercise.module: solution}))
    assert home.curves == {}


def test_a_grading_run_keeps_none():
    exercise = CATALOG.exercise("integrators")
    source = solution_path(CATALOG, exercise).read_bytes() + WRONG["integrators"][0].encode()
    with GradingSession(exercise, CATALOG) as session:
        verdict = session.grade(Submission({exercise.module: source}), only=["explicit_euler_growth"])
        assert [check.status.value for check in verdict.checks] == ["fail"]
        assert session.curves == {}
