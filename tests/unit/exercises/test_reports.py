"""What ``course report`` makes of an exercise: the words and rows follow the program, right or wrong."""

import functools
import re

import numpy as np
import pytest

from course.authoring.exercises.grading import LocalSubmission, mistakes_of, solution_path, source_of
from course.catalog.load import Catalog
from course.figures.plots import render
from course.scoring import kit
from course.simulations import bags

CATALOG = Catalog()
EXERCISES = [one.id for one in CATALOG.exercises() if one.readme_path.with_name("report.py").is_file()]
ONE_WRITTEN = "\ndel explicit_euler_step, semi_implicit_euler_step, velocity_verlet_step\n"


@functools.cache
def sections(exercise_id, program=""):
    """Of the model solution, of a known wrong program by its name, or of the solution with more lines."""
    exercise = CATALOG.exercise(exercise_id)
    wrong = [one for one in mistakes_of(CATALOG, exercise).wrong if one.name == program]
    if wrong:
        source = source_of(CATALOG, exercise, wrong[0]).decode()
    else:
        source = solution_path(CATALOG, exercise).read_text() + program
    return kit.companion(exercise_id, "report").report(LocalSubmission(source)).sections


@pytest.mark.parametrize("exercise_id", EXERCISES)
def test_every_part_of_a_right_program_s_report_has_rows_or_a_figure(exercise_id):
    for section in sections(exercise_id):
        assert section.rows or section.plot or section.title == "The plan", section.text


@pytest.mark.parametrize("exercise_id", EXERCISES)
def test_what_is_not_written_yet_is_said_to_be_so(exercise_id):
    stub = LocalSubmission(CATALOG.exercise(exercise_id).stub_path.read_text())
    assert "not written yet" in str(kit.companion(exercise_id, "report").report(stub).sections)


@pytest.mark.parametrize(
    ("exercise_id", "program", "place", "said"),
    [
        # From rest Verlet's energy swings by z^2/4, semi-implicit Euler's by z/(2 - z), at z = 0.5.
        ("integrators", "", 1, r"semi-implicit Euler 0\.333; velocity Verlet 0\.0625"),
        ("integrators", "", 2, r"explicit Euler 1\.0.*implicit Euler 1\.0.* Verlet 2\.0.* 4 (4\.0|3\.9)"),
        # Closed forms: none, 2, 2 and 2 sqrt(2); the steps tried are 0.02 apart.
        ("integrators", "", 3, r"the smallest tried; .* Euler 2\.0[012]; .* 2\.0[012]; .* 4 2\.8[234]"),
        ("integrators", "\nrk4_step = velocity_verlet_step\n", 2, r"Runge-Kutta 4 2\.0"),
        ("integrators", ONE_WRITTEN, 2, r"(\\n- .*){3}'rows': \(\('Runge-Kutta 4', [^)]*\),\)"),
        ("collisions", "", 0, r"'-3\.800000 m', '-3\.800000 m', .*'1\.440000 J', '1\.440000 J'"),
        ("collisions", "simulate_head_on.PASSES_THROUGH", 0, r"'5\.000000 m', '-3\.800000 m', '0 kg m/s'"),
        # It has predicted how far from pymunk it is.
        ("collisions", "", 2, r"'6\.00 ms', '28\.80 mm', '28\.80 mm'.*at most 0\.00 mm up to the contact"),
        ("collisions", "simulate_head_on.PASSES_THROUGH", 2, r"'28\.80 mm', '-12211\.20 mm'"),
        ("collisions", "simulate_drop.EULER_IN_FLIGHT", 3, r"8 ms: 33\.28 mm before the first contact"),
        ("validation", "", 0, r"good twin: .* your coverage finds 9\d\.\d% inside\. Below, a fifth"),
        # Of a filter with the right noise the mean NEES is 2; of one that believes another noise it is not.
        ("validation", "", 1, r"right, your NEES is (1\.[7-9]|2\.[0-2]).*half, .* is [4-9].*twice, .* is 1"),
        ("validation", "coverage.OUTSIDE_COUNTED", 0, r"good twin: .*finds \d\.\d% inside"),
        ("validation", "nees.DIVIDED_BY_D", 1, r"NEES is [01]\..* 0% above and at (9\d|100)% below"),
        ("validation", "block_bootstrap_ci.IID_BOOTSTRAP", 2, r"0 of them hold\. All are 9\.\d mm wide"),
        ("digital-twin", "", 4, r"about a bias that starts at 0\.05 rad/s"),
        ("digital-twin", "imu.BIAS0_IGNORED", 4, r"about a bias that starts at 0 rad/s"),
        ("digital-twin", "", 5, r"your motor at 2\.72 s, .* your delayed signal at 2\.86 s"),
        ("digital-twin", "delay_line.DELAY_ADVANCES", 5, r"your motor at 2\.72 s, .* signal at 2\.60 s"),
    ],
)
def test_the_words_and_rows_are_those_of_the_program(exercise_id, program, place, said):
    """The words are the figure for whoever does not see it: they follow the rows, not the right answer."""
    section = sections(exercise_id, program)[place]
    shown = {"text": section.text, "rows": section.rows, "seen": section.plot.description}
    assert re.search(said, repr(shown)), shown


@pytest.mark.parametrize("factor", [0, 1, np.nan, 1e200], ids=["vanishes", "still", "nan", "explodes"])
def test_any_step_is_drawn(factor):
    def step(accel, t, q, v, h):
        return q * factor, v * min(factor, 1)

    program = LocalSubmission("", replaced={"explicit_euler_step": step})
    for section in kit.companion("integrators", "report").report(program).sections:
        assert section.rows
        assert render(section.plot).startswith(b"\x89PNG")


def test_the_drive_makes_streams_that_a_bag_can_hold_and_each_scan_has_a_pose_of_its_own_time():
    solution = solution_path(CATALOG, CATALOG.exercise("digital-twin")).read_text()
    found = kit.companion("digital-twin", "drive").streams(LocalSubmission(solution))
    kinds = [type(stream).__name__ for stream in bags.streams_from(found)]
    assert kinds == ["ImuStream", "ScanStream", "OdometryStream", "TruthStream"]
    for kind in ("odometry", "truth"):
        assert set(found["scan"]["t"]) <= set(found[kind]["t"])
        x, y, t = found[kind]["x"], found[kind]["y"], found[kind]["t"]
        travelled = np.hypot(np.diff(x), np.diff(y)) / np.diff(t)
        # A chord is shorter than its arc, here by one part in 10,000; encoders are read in whole counts.
        assert np.allclose(travelled, found[kind]["speed"][1:], rtol=1e-3, atol=1e-9)
