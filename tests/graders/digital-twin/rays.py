"""Distances to walls, found another way than most: each wall is turned into the frame of the beam."""

from __future__ import annotations

import numpy as np


def distances(pose, segments, angles, r_max):
    """Distance along each beam to its nearest wall or r_max, and which beams are no close call.

    In a beam's frame (the beam along +x) a wall is hit if its ends lie on both sides of the axis, where it
    crosses the axis.

    Returns:
        (ranges, clear), both of shape (B,). A beam is not clear if it passes an end of a wall, or a wall
        at the end of its reach, so closely that rounding decides.
    """
    x, y, heading = pose
    ends = np.asarray(segments, dtype=float) - (x, y)
    c, s = (f(heading + np.asarray(angles))[:, None, None] for f in (np.cos, np.sin))
    along = ends[..., 0] * c + ends[..., 1] * s  # (B, M, 2)
    beside = ends[..., 1] * c - ends[..., 0] * s
    crosses = beside[..., 0] * beside[..., 1] < 0
    width = np.where(crosses, beside[..., 0] - beside[..., 1], 1.0)
    hits = along[..., 0] + (along[..., 1] - along[..., 0]) * beside[..., 0] / width
    grazes = (along.max(axis=2) > 0) & (np.abs(beside).min(axis=2) < 1e-6)
    close = crosses & ((np.abs(hits - r_max) < 1e-6) | (np.abs(hits) < 1e-6))
    ranges = np.where(crosses & (hits > 0), hits, np.inf).min(axis=1)
    return np.minimum(ranges, r_max), ~(grazes | close).any(axis=1)


def hall(rng):
    """A crooked hall of four walls with a gap, and six walls standing about in it; shape (11, 2, 2)."""
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) * rng.uniform(2.5, 4.0, (4, 2))
    walls = [np.stack((corners[i], corners[(i + 1) % 4])) for i in range(3)]
    start, stop = corners[3], corners[0]
    walls += [np.stack((start, start + 0.3 * (stop - start))), np.stack((start + 0.6 * (stop - start), stop))]
    for _ in range(6):
        middle, angle, half = rng.uniform(-2, 2, 2), rng.uniform(0, np.pi), rng.uniform(0.2, 0.6)
        reach = half * np.array([np.cos(angle), np.sin(angle)])
        walls.append(np.stack((middle - reach, middle + reach)))
    return rng.permutation(np.array(walls))  # the nearest is neither the first nor the last


def long_before_short(pose, rng):
    """A long wall and, behind it, a short one with nearer middle and ends; shape (2, 2, 2), in this order."""
    near, reach, half = rng.uniform(0.8, 1.2), rng.uniform(2.0, 2.4), rng.uniform(0.3, 0.6)
    walls = np.array([[[near, -8.0], [near, reach]], [[near + 0.3, -half], [near + 0.3, half]]])
    angle = rng.uniform(0, 2 * np.pi)
    c, s = np.cos(angle), np.sin(angle)
    return walls @ np.array([[c, s], [-s, c]]) + np.asarray(pose)[:2]
