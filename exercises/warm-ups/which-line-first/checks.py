"""Checks of `which-line-first`."""

import math

import pytest

from course.scoring import kit


@pytest.mark.task("swing")
@pytest.mark.points(1)
def test_energy_stays(submission):
    """The energy of a long swing"""
    k, m = 4.0, 1.0
    h = 0.1 * math.sqrt(m / k)
    for n in (20, 200, 2000, 20000):
        x, v = kit.as_vector(submission.call("swing", 1.0, 0.5, k, m, h, n), 2, "position and velocity")
        energy = (0.5 * m * v**2 + 0.5 * k * x**2) / (0.5 * m * 0.5**2 + 0.5 * k)
        kit.expect_bounded(
            energy,
            low=0.9,
            high=1.1,
            source="with a step of a tenth of sqrt(m/k) the right loop stays within 8 % of where it began",
            quantity="the energy over the energy at the start",
            input={"k": k, "m": m, "h": h, "n": n},
            message="The energy of the swing does not stay where it began.",
            help=(
                "Do one step on paper. One line needs old values alone, the other the value that the"
                " first has just computed, and no mean of the two."
            ),
        )


@pytest.mark.task("swing")
@pytest.mark.points(1)
@pytest.mark.requires("energy_stays")
def test_quarter(submission):
    """One short step, and a quarter of the period"""
    k, m = 9.0, 2.0
    omega = math.sqrt(k / m)
    x, v, h = 0.3, 0.4 * omega, 0.01 / omega
    found = kit.as_vector(submission.call("swing", x, v, k, m, h, 1), 2, "position and velocity")
    kit.expect_array(
        [found[0], found[1] / omega],
        [0.3 * math.cos(0.01) + 0.4 * math.sin(0.01), 0.4 * math.cos(0.01) - 0.3 * math.sin(0.01)],
        abs=0.0002,
        source="a loop of first order is off by 0.00005 at most after this step, no step at all by 0.003",
        quantity="the position, and the velocity over omega",
        units="m",
        input={"x": x, "v": v, "k": k, "m": m, "h": h, "n": 1},
        message="After one short step the mass is not where a mass on a spring would be.",
        help="How often does the loop run with n = 1? Each time it takes one step of h.",
    )
    n = 1000
    h = 0.5 * math.pi / omega / n
    x, v = kit.as_vector(submission.call("swing", 0.3, 0.0, k, m, h, n), 2, "position and velocity")
    kit.expect_array(
        [x, v / omega],
        [0.0, -0.3],
        abs=0.001,
        source="0.3 cos(omega t); a loop of first order is off by 0.3 h omega / 2, about 0.0003",
        quantity="the position, and the velocity over omega",
        units="m",
        input={"k": k, "m": m, "h": h, "n": n},
        message="After a quarter of a period the mass is not where a mass on a spring would be.",
        help="Keep the force -k x and the two sums; change only the order.",
    )


#: Calls that tell wrong programs apart.
QUESTIONS = {
    "swing": [(1.0, 0.5, 4.0, 1.0, 0.05, 1), (1.0, 0.5, 4.0, 1.0, 0.05, 2), (0.3, -0.2, 9.0, 2.0, 0.1, 5)]
}
