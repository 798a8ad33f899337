"""Both directions closed into a loop: the cart rolls on this side, and only here is its friction known."""

from __future__ import annotations

import math

import numpy as np

from course.grading import kit

bundles = kit.companion("digital-twin", "bundles")
scenes = kit.companion("digital-twin", "scenes")

#: Std of a position sensor better than the public one, m: what is judged is sync, not luck.
QUIET = 0.006


def friction_jump(rng):
    """Two frictions, 1/s, the second clearly another one."""
    first = rng.uniform(0.6, 0.8)
    return first, first * (rng.uniform(1.35, 1.6) if rng.uniform() < 0.5 else rng.uniform(0.62, 0.74))


def through_sync(submission, rng):
    """Five times five seconds: measurements folded through the student's sync, then a new drive from it.

    The drive comes from the mean friction of two seconds: one estimate is a noisy thing.

    Returns:
        The cart's mean speed over the last two seconds, the target, and the friction found and right.
    """
    before, after = friction_jump(rng)
    target = rng.uniform(0.7, 1.2)
    cart = scenes.Cart(((0.0, before), (6.0, after)), v=0.4 * target)
    guess = before * rng.uniform(0.75, 1.35)
    twin = scenes.new_twin(guess, guess * target, speed=cart.v, sigma=QUIET)
    speeds = []
    for i in range(5):
        ends = 5.0 * i + np.cumsum(rng.uniform(0.08, 0.12, 49))
        times = np.append(ends[ends < 5.0 * (i + 1) - 0.05], 5.0 * (i + 1))
        calls, truth = scenes.measured(cart, twin["drive"], times, rng, sigma=QUIET)
        folded = submission.fold("sync", twin, calls, keep=scenes.SEEN)
        rows = bundles.twins.path(folded)
        speeds += [v for t, _, v in truth if t > 23.0]
        with np.errstate(all="ignore"):
            friction = float(np.mean(rows[-20:, 3]))
        kit.expect_bounded(
            friction,
            low=0.05,
            high=10.0,
            source="the frictions are far inside",
            quantity="friction",
            units="1/s",
            input={"true friction": [before, after], "twin": twin},
            message="The twin's friction has left anything that a cart can have.",
            diagnose=lambda: bundles.twins.of_sync(submission, late=False),
        )
        twin = {**folded[-1], "drive": friction * target}
    return float(np.mean(speeds)), target, friction, after


def through_command(submission, rng):
    """Seven times three seconds: a twin of ours follows the cart, the student's command drives it.

    Our twin corrects by constant shares: all that ``command`` needs is a friction that is learned on the way.

    Returns:
        The cart's mean speed over the last three seconds, the target, and what was driven.
    """
    before, after = friction_jump(rng)
    target = rng.uniform(0.6, 1.2) * (1.0 if rng.uniform() < 0.5 else -1.0)
    cart = scenes.Cart(((0.0, before), (6.0, after)), v=0.4 * target)
    x, v, b = 0.0, cart.v, before
    drives, reached = [], []
    for i in range(7):
        twin = scenes.new_twin(b, drives[-1] if drives else 0.0, speed=v, position=x, t=3.0 * i)
        drive = kit.as_number(submission.call("command", twin, target), "the drive")
        drives.append(drive)
        if not abs(drive) < 100.0:  # nothing more is learned from a cart that is gone
            return math.inf, target, drives
        began = cart.x
        for k in range(30):
            a = drive - b * v
            x, v = x + 0.1 * v + 0.005 * a, v + 0.1 * a
            cart.roll(drive, 3.0 * i + 0.1 * (k + 1))
            surprise = cart.x + QUIET * rng.standard_normal() - x
            x, v = x + 0.3 * surprise, v + 0.5 * surprise
            b = max(b - 0.4 * surprise * math.copysign(1.0, v), 0.1)
        reached.append((cart.x - began) / 3.0)
    return reached[-1], target, drives
