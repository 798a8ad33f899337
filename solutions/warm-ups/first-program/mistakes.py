"""Mistakes in `first-program`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ONE_INDEX_TOO_MANY",
    "It takes an index of a position, and here a position is a number.",
    "first[k] is a pair, and first[k][0] is its position. Take no further index.",
).edit("gap", {"] - first[k]": "][0] - first[k][0]"})
mistakes(
    "VELOCITIES_COMPARED",
    "The velocities are compared, not the positions.",
    "The position comes first in each pair.",
).edit("gap", {"0] - first[k][0": "1] - first[k][1"})
mistakes(
    "START_LOST",
    "The first sample is the state after one step: the start is lost, and every later sample is one step early.",
    "Begin the list with the start: states = [(x, v)].",
).edit("run", {"states = [(x, v)]": "states = []"})
mistakes(
    "END_LOST",
    "The start is there, but the state after the last step is not.",
    "Begin the list with the start, and append after each step as before: n + 1 pairs.",
).around("run", "return _right(x, v, a, n)[:-1]")
mistakes(
    "END_OF_THE_RUN",
    "Your result is the time of the last sample, wherever the ball is by then.",
    "Look at the height: find the first sample that is 0 or less.",
).body("landing_time", "return (len(heights) - 1) * H if len(heights) else None")
mistakes(
    "GROUND_NOT_INCLUDED",
    "A ball exactly on the ground is not counted as landed.",
    "At or below: use <=.",
).edit("landing_time", {"if height <= 0.0:": "if height < 0.0:"})
mistakes(
    "PASS_THROUGH",
    "Both balls keep their velocities: they pass through each other.",
    "Equal balls exchange their velocities: give v2, v1.",
).edit("after_contact", {"return v2, v1": "return v1, v2"})
mistakes(
    "BOTH_REVERSED",
    "Each ball turns round. That is right if both are equally fast; otherwise it makes momentum out of nothing.",
    "Equal balls exchange their velocities: try 3 and 1, where the sum must stay 4.",
).edit("after_contact", {"return v2, v1": "return -v1, -v2"})
mistakes(
    "SEMI_IMPLICIT_TWICE",
    "This is semi-implicit Euler, like the function below it: the position moves with the new velocity.",
    "Move the position first, while the velocity is still the old one.",
).body("euler_step", "return semi_implicit_step(x, v, a, h)")
mistakes(
    "STEP_MISSING",
    "One of the rates is not multiplied by the step.",
    "Both x and v advance by h times their rate.",
).body("euler_step", "return x + h * v, v + a")
mistakes(
    "ONE_STEP_LATE",
    "The last position is compared with the exact one of a step later.",
    "The first position belongs to t = 0, so the last belongs to (len(positions) - 1) * H.",
).edit("error_at_end", {"(len(positions) - 1": "len(positions"})
mistakes(
    "SIGN_OF_THE_ERROR",
    "The error can be negative.",
    "Keep the abs().",
).body("error_at_end", "return math.cos(omega * (len(positions) - 1) * H) - positions[-1]")
mistakes(
    "HALF_A_H_SQUARED",
    "The position moves by h v and half of a h squared. That is exact for a constant acceleration, and not Euler's step.",
    "Explicit Euler uses the old velocity alone: x + h * v.",
)
mistakes(
    "VELOCITY_KEPT",
    "The velocity does not change.",
    "Both are updated: the velocity advances by h * a.",
)
mistakes(
    "TWO_STEPS_LATE",
    "The last position is compared with the exact one of two steps later.",
    "The first position belongs to t = 0, so the last belongs to (len(positions) - 1) * H.",
)
mistakes(
    "ONE_STEP_EARLY",
    "The last position is compared with the exact one of a step earlier.",
    "The first position belongs to t = 0, so the last belongs to (len(positions) - 1) * H.",
)
mistakes(
    "SAMPLE_NOT_TIME",
    "Your result is the number of the sample, not its time.",
    "Multiply it by H.",
)
mistakes(
    "LANDING_ONE_LATE",
    "Your result is the time of the sample after the landing.",
    "The first sample has k = 0 and the time 0: give k * H.",
)
mistakes(
    "ONE_REVERSED",
    "One ball turns round and the other goes on.",
    "Equal balls exchange their velocities: give v2, v1.",
)
mistakes(
    "EXCHANGED_AND_REVERSED",
    "The velocities are exchanged, and turned round as well.",
    "Exchange them and leave their signs: give v2, v1.",
)
mistakes(
    "SIGN_OF_THE_GAP",
    "The distance can be negative.",
    "Keep the abs().",
)
mistakes(
    "LAST_BELOW",
    "Your result is the time of the last sample at or below the ground.",
    "The first one counts: return as soon as you have found it.",
).body(
    "landing_time", "return max((k * H for k, height in enumerate(heights) if height <= 0.0), default=None)"
)
mistakes(
    "STUCK_TOGETHER",
    "Both balls go on with the mean of their velocities, as if they stuck together.",
    "Elastic balls keep their energy, too: equal ones exchange their velocities.",
).body("after_contact", "return (v1 + v2) / 2, (v1 + v2) / 2")
mistakes(
    "ASSIGNED_IN_TURN",
    "Both balls have the same velocity afterwards: one of them is overwritten before it is used.",
    "Exchange both at once: return v2, v1.",
).body(
    "after_contact",
    """
        v1 = v2
        v2 = v1
        return v1, v2
    """,
)
mistakes(
    "START_TWICE",
    "The start is in the list twice, and the state after the last step is not.",
    "Put the start into the list before the loop, and append after each step.",
).around(
    "run",
    """
        states = _right(x, v, a, n)
        return states[:1] + states[:-1]
    """,
)
mistakes(
    "ONE_STEP_MORE",
    "There is one step too many.",
    "The loop takes n steps, and the start makes n + 1 pairs.",
).edit("run", {"range(n)": "range(n + 1)"})
mistakes(
    "NEAREST_TO_THE_GROUND",
    "Your result is the time of the sample nearest to the ground, also where that is above it.",
    "Return as soon as a height is 0 or less.",
).body("landing_time", "return min(range(len(heights)), key=lambda k: abs(heights[k])) * H")
mistakes(
    "SIZES_OF_THE_POSITIONS",
    "You subtract the sizes of the two positions, so balls on either side of the origin come out too close.",
    "Subtract the positions with their signs, and take the size of the difference.",
).edit("gap", {"abs(second[k][0] - first[k][0])": "abs(abs(second[k][0]) - abs(first[k][0]))"})
mistakes(
    "LAST_ABOVE",
    "Your result is the time of the last sample above the ground.",
    "The first one at or below it counts, which is the next.",
).body(
    "landing_time",
    "return next((k * H for k in range(len(heights) - 1) if heights[k] > 0.0 >= heights[k + 1]), None)",
)

mistakes.accept(
    "Arrays instead of lists",
    """
        import numpy as np


        def run(x, v, a, n):
            states = np.empty((n + 1, 2))
            states[0] = x, v
            for k in range(n):
                velocity = states[k, 1] + H * a
                states[k + 1] = states[k, 0] + H * velocity, velocity
            return states


        def landing_time(heights):
            below = np.flatnonzero(np.asarray(heights) <= 0)
            return float(H * below[0]) if below.size else None


        def gap(first, second, k):
            return float(abs(np.asarray(first)[k, 0] - np.asarray(second)[k, 0]))


        def euler_step(x, v, a, h):
            return np.array([x, v]) + h * np.array([v, a])
    """,
)
mistakes.accept(
    "The same edits, written otherwise",
    """
        def run(x, v, a, n):
            states = []
            for k in range(n + 1):
                states.append((x, v))
                v += H * a
                x += H * v
            return states


        def landing_time(heights):
            return next((k * H for k, height in enumerate(heights) if height <= 0), None)


        def after_contact(v1, v2):
            total = v1 + v2
            return total - v1, total - v2


        def gap(first, second, k):
            (x1, _), (x2, _) = first[k], second[k]
            return abs(x1 - x2)


        def euler_step(x, v, a, h):
            return x + h * v, v + h * a


        def error_at_end(positions, omega):
            return abs(positions[-1] - math.cos(omega * H * len(positions[1:])))
    """,
)


H = 0.01


def euler(moved=lambda v, a, h: h * v, faster=lambda a, h: h * a):
    return lambda x, v, a, h: (x + moved(v, a, h), v + faster(a, h))


def landing(time=lambda k: k * H, landed=lambda height: height <= 0.0):
    return lambda heights: next((time(k) for k, height in enumerate(heights) if landed(height)), None)


def error_at(last=lambda n: n - 1, size=abs):
    return lambda positions, omega: size(positions[-1] - math.cos(omega * last(len(positions)) * H))


mistakes.terms(
    "euler_step",
    euler,
    {
        "moved": {"HALF_A_H_SQUARED": lambda v, a, h: h * v + 0.5 * h * h * a},
        "faster": {"VELOCITY_KEPT": lambda a, h: 0.0, "STEP_MISSING": lambda a, h: a},
    },
)
mistakes.terms(
    "landing_time",
    landing,
    {
        "time": {"SAMPLE_NOT_TIME": lambda k: k, "LANDING_ONE_LATE": lambda k: (k + 1) * H},
        "landed": {"GROUND_NOT_INCLUDED": lambda height: height < 0.0},
    },
)
mistakes.terms(
    "error_at_end",
    error_at,
    {
        "last": {
            "ONE_STEP_LATE": lambda n: n,
            "TWO_STEPS_LATE": lambda n: n + 1,
            "ONE_STEP_EARLY": lambda n: n - 2,
        },
        "size": {"SIGN_OF_THE_ERROR": float},
    },
)


def nearest(heights):
    k = min(range(len(heights)), key=lambda k: abs(heights[k]))
    return k * H if min(heights) <= 0.0 else None


@mistakes.more
def hypotheses():
    yield "after_contact", ("ONE_REVERSED",), lambda v1, v2: (-v1, v2)
    yield "after_contact", ("ONE_REVERSED",), lambda v1, v2: (v1, -v2)
    yield "after_contact", ("EXCHANGED_AND_REVERSED",), lambda v1, v2: (-v2, -v1)
    yield "after_contact", ("ASSIGNED_IN_TURN",), lambda v1, v2: (v1, v1)
    yield "euler_step", ("STEP_MISSING",), euler(moved=lambda v, a, h: v)
    yield "gap", ("SIGN_OF_THE_GAP",), lambda first, second, k: second[k][0] - first[k][0]
    yield "landing_time", ("NEAREST_TO_THE_GROUND",), nearest
