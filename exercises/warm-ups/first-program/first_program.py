"""A fall, a collision and a spring. This program has six faults: one stops it, five spoil its results.

Run it with `python first_program.py`. One small edit fixes each fault.
"""

import math

G = 9.81  # m/s^2
H = 0.01  # length of a step, s


def run(x, v, a, n):
    """A run of n steps with the constant acceleration ``a``: pairs (position, velocity).

    The first pair is the start, so there are n + 1 pairs.
    """
    states = []
    for _ in range(n):
        v += H * a
        x += H * v
        states.append((x, v))
    return states


def landing_time(heights):
    """The time of the first sample at or below the ground, s; None if there is none."""
    for k, _ in enumerate(heights):
        if k == len(heights) - 1:
            return k * H
    return None


def after_contact(v1, v2):
    """Velocities of two equal balls after an elastic collision head-on, m/s."""
    return v1, v2


def meeting(n):
    """Two balls of 1 m roll towards each other: the run of each, as pairs (position, velocity)."""
    x1, v1, x2, v2 = -5.0, 2.0, 5.0, -2.0
    first, second = [(x1, v1)], [(x2, v2)]
    for _ in range(n):
        if x2 - x1 <= 1.0 and v1 > v2:
            v1, v2 = after_contact(v1, v2)
        x1, x2 = x1 + H * v1, x2 + H * v2
        first.append((x1, v1))
        second.append((x2, v2))
    return first, second


def gap(first, second, k):
    """How far apart the centres of two balls are at sample ``k`` of their runs, m."""
    return abs(second[k][0][0] - first[k][0][0])


def euler_step(x, v, a, h):
    """One step of explicit Euler: position and velocity are both updated with their old rates."""
    v = v + h * a
    x = x + h * v
    return x, v


def semi_implicit_step(x, v, a, h):
    """One step of semi-implicit Euler: the velocity first, the position with the new velocity."""
    v = v + h * a
    x = x + h * v
    return x, v


def swing(step, omega, n):
    """Positions of a mass on a spring, released at 1 m, after 0, 1, ... n steps."""
    x, v, positions = 1.0, 0.0, [1.0]
    for _ in range(n):
        x, v = step(x, v, -(omega**2) * x, H)
        positions.append(x)
    return positions


def error_at_end(positions, omega):
    """How far the last of the positions is from cos(omega t) at its own time, m."""
    t = len(positions) * H
    return abs(positions[-1] - math.cos(omega * t))


def summary():
    """The program's results: pairs of a name and a value."""
    heights = [x for x, _ in run(10.0, 0.0, -G, 200)]
    first, second = meeting(500)
    euler, semi_implicit = swing(euler_step, 2.0, 500), swing(semi_implicit_step, 2.0, 500)
    return [
        ("fall from 10 m: first height", f"{heights[0]:.3f} m"),
        ("fall from 10 m: on the ground after", f"{landing_time(heights):.2f} s"),
        ("two balls: apart at the start", f"{gap(first, second, 0):.2f} m"),
        ("two balls: apart after 5 s", f"{gap(first, second, 500):.2f} m"),
        ("spring, 5 s: error of explicit Euler", f"{error_at_end(euler, 2.0):.4f} m"),
        ("spring, 5 s: error of semi-implicit Euler", f"{error_at_end(semi_implicit, 2.0):.4f} m"),
    ]


if __name__ == "__main__":
    for what, how_much in summary():
        print(f"{what:45}{how_much:>10}")
