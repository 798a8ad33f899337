"""Functions of the program mended in a wrong way, or with a second fault."""

import math

H = 0.01


def with_half_a(x, v, a, h):
    return x + h * v + 0.5 * h * h * a, v + h * a


def velocity_kept(x, v, a, h):
    return x + h * v, v


def mean_velocity(x, v, a, h):
    return x + h * (v + 0.5 * h * a), v + h * a


def end_counted(positions, omega):
    return abs(positions[-1] - math.cos(omega * (len(positions) + 1) * H))


def second_to_last(positions, omega):
    return abs(positions[-1] - math.cos(omega * (len(positions) - 2) * H))


def index(heights):
    return next((k for k, height in enumerate(heights) if height <= 0.0), None)


def one_later(heights):
    return next(((k + 1) * H for k, height in enumerate(heights) if height <= 0.0), None)


def one_reversed(which):
    return lambda v1, v2: (-v1, v2) if which else (v1, -v2)


def with_sign(first, second, k):
    return second[k][0] - first[k][0]


def hypotheses():
    yield "euler_step", ("HALF_A_H_SQUARED",), with_half_a
    yield "euler_step", ("HALF_A_H_SQUARED",), mean_velocity
    yield "euler_step", ("VELOCITY_KEPT",), velocity_kept
    yield "error_at_end", ("TWO_STEPS_LATE",), end_counted
    yield "error_at_end", ("ONE_STEP_EARLY",), second_to_last
    yield "landing_time", ("SAMPLE_NOT_TIME",), index
    yield "landing_time", ("LANDING_ONE_LATE",), one_later
    yield "after_contact", ("ONE_REVERSED",), one_reversed(True)
    yield "after_contact", ("ONE_REVERSED",), one_reversed(False)
    yield "after_contact", ("EXCHANGED_AND_REVERSED",), lambda v1, v2: (-v2, -v1)
    yield "gap", ("SIGN_OF_THE_GAP",), with_sign
