"""The two scenes of ``collisions`` in a real engine, pymunk, and how far that engine may be off.

pymunk (its core is Chipmunk) begins a step by moving every body; only then does it look for overlaps and
change velocities. Two things follow:

- A contact is noticed at the first sample at which the bodies overlap, up to one step late. Meanwhile they
  go on with their old velocity, so afterwards each is off by (old - new velocity) times the delay.
- In free fall the position moves with the velocity of the step before: it is g h t/2 too high, so a floor is
  reached about half a step late as well.

Its default settings also push overlapping bodies apart and leave a small overlap alone. Both are switched
off here, so that what is left is the error of the steps.
"""

from __future__ import annotations

import functools
import math

import numpy as np

#: Rounding of pymunk's positions over a few thousand steps stays below this, in m.
ROUNDING = 1e-9


@functools.cache
def head_on(scene, t_end, h):
    """pymunk's x of both balls, shape (n + 1, 2). scene: ``paths.HeadOn``."""
    import pymunk

    space = _space(pymunk, 0.0)
    balls = []
    # Restitutions of two shapes are multiplied: one of them carries the pair's.
    for mass, x, v, e in zip(scene.m, scene.x0, scene.v0, (1.0, scene.restitution), strict=True):
        ball = _ball(pymunk, space, mass, scene.radius, e)
        ball.position, ball.velocity = (x, 0.0), (v, 0.0)
        balls.append(ball)
    return _run(space, t_end, h, lambda: [ball.position.x for ball in balls])


@functools.cache
def drop(scene, t_end, h):
    """pymunk's height of the centre, shape (n + 1, 1). scene: ``paths.Drop``."""
    import pymunk

    space = _space(pymunk, -scene.g)
    ball = _ball(pymunk, space, 1.0, scene.radius, scene.restitution)
    ball.position, ball.velocity = (0.0, scene.z0), (0.0, scene.v0)
    floor = pymunk.Segment(space.static_body, (-10.0, 0.0), (10.0, 0.0), 0.0)
    floor.elasticity = 1.0
    space.add(floor)
    return _run(space, t_end, h, lambda: [ball.position.y])


def head_on_error(scene, after, h):
    """How far each ball may be off in pymunk, m: its change of velocity, one step late."""
    return [abs(new - old) * h + ROUNDING for old, new in zip(scene.v0, after, strict=True)]


def drop_error(scene, h):
    """How far the ball may be off in pymunk until its second contact, m.

    The change of velocity at the first contact, half a step late by the fall and one by the detection. The
    rebound is faster by what gravity adds in that time, which the factor two covers.
    """
    return 2 * (1 + scene.restitution) * scene.fastest * h


def _space(pymunk, gravity):
    space = pymunk.Space()
    space.gravity = (0.0, gravity)
    space.collision_bias, space.collision_slop = 1.0, 0.0
    return space


def _ball(pymunk, space, mass, radius, elasticity):
    ball = pymunk.Body(mass, math.inf)  # an infinite moment: it does not spin
    shape = pymunk.Circle(ball, radius)
    shape.elasticity = elasticity
    space.add(ball, shape)
    return ball


def _run(space, t_end, h, look):
    seen = [look()]
    for _ in range(round(t_end / h)):
        space.step(h)
        seen.append(look())
    return np.array(seen)
