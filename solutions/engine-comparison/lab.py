"""The hidden boxes: eight engines drawn from the seed of a grading run.

They are made of the parts a student can read in ``boxes.py`` and of some that are not there: other ways to
step, an engine whose substeps differ in length, one that never explodes, one that is never stable for long.
Each is drawn so that every key of the report takes values that a guess or a slip gets wrong.
"""

from __future__ import annotations

import functools
import math

import numpy as np

from course.scoring import kit

bench = kit.companion("engine-comparison", "bench")
boxes = kit.companion("engine-comparison", "boxes")
questions = kit.companion("engine-comparison", "questions")
instrument = kit.sibling(__file__, "instrument")


def explicit_euler(a, x, v, h):
    return x + h * v, v + h * a(x, v)


def position_first_euler(a, x, v, h):
    x = x + h * v
    return x, v + h * a(x, v)


def midpoint(a, x, v, h):
    half_x, half_v = x + h / 2 * v, v + h / 2 * a(x, v)
    return x + h * half_v, v + h * a(half_x, half_v)


def implicit_euler(a, x, v, h):
    """a(x, v) is linear, so the equation v' = v + h a(x + h v', v') is solved by dividing."""
    still, moving = a(x, 0.0), a(x + h, 1.0)
    v = (v + h * still) / (1 - h * (moving - still))
    return x + h * v, v


def substeps(step, count):
    """``count`` equal steps in one: the order is the same, and larger steps are stable."""

    def taken(a, x, v, h):
        for _ in range(count):
            x, v = step(a, x, v, h / count)
        return x, v

    taken.__name__ = step.__name__
    return taken


def uneven_euler(share):
    """As below, of first order: the range that explodes is narrower, and lies elsewhere."""

    def step(a, x, v, h):
        x, v = position_first_euler(a, x, v, share * h)
        return position_first_euler(a, x, v, (1 - share) * h)

    step.__name__ = "uneven_euler"
    return step


def uneven_verlet(share):
    """Two Verlet substeps, one of ``share`` of the step: stability is lost, found again, and lost again."""

    def step(a, x, v, h):
        x, v = boxes.velocity_verlet(a, x, v, share * h)
        return boxes.velocity_verlet(a, x, v, (1 - share) * h)

    step.__name__ = "uneven_verlet"
    return step


_G = 9.81


@functools.lru_cache(maxsize=256)
def drawn(seed: int):
    """The parameters of the boxes of one grading run, in a fixed order."""
    rng = np.random.default_rng([seed, 0x656E67])
    made = {make: _scene(rng, **make(rng)) for make in _MAKERS}
    for make, other in _SHOWN_ALIKE.items():
        made[make] |= {name: made[other][name] for name in SHOWN}
    return tuple(made.values())


@functools.lru_cache(maxsize=256)
def truths(seed: int):
    """The right report of each of them; jitter is too small to matter and left out."""
    reports = []
    for parameters in drawn(seed):
        quiet = boxes.Box(**{**parameters, "jitter": 0.0})
        report = instrument.truth(quiet)
        report["deterministic"] = not parameters.get("jitter")
        reports.append(report)
    return tuple(reports)


def population(seed: int):
    """The boxes themselves, new for each submission: their noise starts over, so a regrade repeats."""
    return tuple(
        boxes.Box(**parameters, noise=np.random.default_rng([seed, number]))
        for number, parameters in enumerate(drawn(seed))
    )


def cases(submission):
    """The eight, each handed to the submission once for all checks."""
    made = zip(population(submission.seed), truths(submission.seed), strict=True)
    return bench.cases(
        submission,
        "drawn",
        lambda: [
            bench.Case(f"unknown engine {n}", box, truth) for n, (box, truth) in enumerate(made, start=1)
        ],
    )


def three(submission):
    """Of the eight those that are made like the three at home."""
    found = cases(submission)
    return [found[_MAKERS.index(maker)] for maker in (_verlet, _game, _accurate)]


def _scene(rng, dt, **engine):
    """The numbers that ``info`` shows; how fast a body may tunnel follows from them."""
    return {
        "dt": dt,
        "omega": _between(rng, 1.5, 5.0),
        "mass": _between(rng, 0.4, 3.0),
        "g": _G,
        "mu": _between(rng, 0.4, 0.9),
        "radius": _between(rng, 0.06, 0.15),
        "wall_thickness": _between(rng, 0.02, 0.08),
        **engine,
    }


def _between(rng, low, high):
    return float(rng.uniform(low, high))


def _off_whole_millimetres(softness, dt):
    """About as soft, but a body lies at least 0.2 mm from a whole number of them deep: rounded to one, no
    depth is near enough.

    At rest what the damper takes from a step's fall, h g, is missing from the spring: the depth is s - 2 c
    sqrt(s) with c = h sqrt(g) / 4.
    """
    c = dt * math.sqrt(_G) / 4
    part, whole = math.modf(1e3 * (softness - 2 * c * math.sqrt(softness)))
    depth = 1e-3 * (whole + 0.2 + 0.6 * part)
    return (c + math.sqrt(c * c + depth)) ** 2


# -- the eight: what each is there for ------------------------------------------------------------------


def _game(rng):
    """First order, slows everything down, fast impacts most, creeps, grips the diagonal, keeps a margin,
    tunnels."""
    return {
        "dt": 1 / 60,
        "step": boxes.semi_implicit_euler,
        "damping": _between(rng, 1.3, 1.7),
        "cone": boxes.square_pyramid,
        "grip": _between(rng, 0.5, 0.9),
        "creep": _between(rng, 0.003, 0.005),
        "margin": _between(rng, 2e-4, 8e-4),
        "restitution": _between(rng, 0.35, 0.6),
        "bounce_most": _between(rng, 1.4, 1.6),
        "contact": "sided",
    }


def _soft(rng):
    """Contact that gives way: a body sinks in, creeps, is weak on the diagonal, stops dead at a wall. Of a
    slow spring, of third order, and stable for longer than other explicit ones."""
    return {
        "dt": 1 / 120,
        "omega": _between(rng, 0.3, 0.45),
        "step": substeps(questions.kutta, int(rng.integers(3, 6))),
        "cone": boxes.diamond_pyramid,
        "creep": _between(rng, 0.003, 0.006),
        "softness": _between(rng, 0.003, 0.008),
        "restitution": 0.0,
    }


def _verlet(rng):
    """Second order, keeps energy, misses nothing at the wall, where slow impacts do not bounce."""
    return {
        "dt": 1 / 120,
        "step": boxes.velocity_verlet,
        "restitution": _between(rng, 0.5, 0.9),
        "bounce_threshold": _between(rng, 1.3, 1.7),
        "contact": "swept",
    }


def _accurate(rng):
    """Fourth order, a wall that can be jumped over, and never twice the same."""
    return {
        "dt": 1 / 240,
        "step": boxes.rk4,
        "cone": boxes.square_pyramid,
        "softness": _off_whole_millimetres(_between(rng, 0.001, 0.003), 1 / 240),
        "restitution": _between(rng, 0.6, 0.9),
        "jitter": 10 ** _between(rng, -12.0, -11.0),
    }


def _parallel(rng):
    """Never twice the same; slow impacts do not bounce, and only fast bodies get through. Two substeps of
    different length, too."""
    return {
        "dt": 1 / 600,
        "radius": _between(rng, 0.09, 0.12),
        "wall_thickness": _between(rng, 0.03, 0.05),
        "step": uneven_euler(_between(rng, 0.64, 0.67)),
        "margin": _between(rng, 2e-4, 8e-4),
        "restitution": _between(rng, 0.4, 0.8),
        "bounce_threshold": _between(rng, 1.3, 1.7),
        "contact": "sided",
        "jitter": 10 ** _between(rng, -12.0, -11.0),
    }


def _unbreakable(rng):
    """Implicit: first order, never unstable, fades on the spring more than its damping says."""
    return {
        "dt": 1 / 60,
        "step": implicit_euler,
        "damping": _between(rng, 1.8, 2.2),
        "cone": boxes.diamond_pyramid,
        "grip": _between(rng, 0.8, 1.3),
        "restitution": _between(rng, 0.3, 0.55),
        "contact": "swept",
    }


def _restless(rng):
    """Midpoint without damping: of second order, and at no step quite stable."""
    return {
        "dt": 1 / 240,
        "step": midpoint,
        "softness": _between(rng, 0.002, 0.006),
        "cone": boxes.diamond_pyramid,
        "restitution": _between(rng, 0.5, 0.9),
        "bounce_threshold": _between(rng, 1.3, 1.7),
        "contact": "swept",
        "jitter": 10 ** _between(rng, -12.0, -11.0),
    }


def _substepped(rng):
    """Two substeps of different length, twice: a range of steps that explode, and stable ones beyond it. It
    lies at 5.2/omega to 6.2/omega or somewhat more, where ``_parallel`` is past the one at 2.4/omega."""
    return {
        "dt": 1 / 120,
        "step": substeps(uneven_verlet(_between(rng, 0.38, 0.41)), 2),
        "cone": boxes.square_pyramid,
        "creep": _between(rng, 0.003, 0.006),
        "restitution": _between(rng, 0.3, 0.9),
        "contact": "sided",
    }


_MAKERS = (_game, _soft, _verlet, _accurate, _parallel, _unbreakable, _restless, _substepped)

#: What ``info`` shows.
SHOWN = ("dt", "omega", "mass", "g", "mu", "radius", "wall_thickness")
#: Engines that show the same numbers as an earlier one and are different inside: what was kept of the one
#: under its numbers is wrong for the other.
_SHOWN_ALIKE = {_unbreakable: _game, _restless: _accurate, _substepped: _soft}
