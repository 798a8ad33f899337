"""Sensors of ``digital-twin``, right and wrong: the right one with a term in another form.

Each family makes a function with the signature of its task. ``TERMS`` lists, for each task, families, what
they take for granted, and for each form of a term the code of the mistake.
"""

from __future__ import annotations

import math

import numpy as np

_TURN = 2 * math.pi

# -- encoder --------------------------------------------------------------------------------------------


def _encoder(
    quantise=np.floor, scale=1 / _TURN, angle=lambda theta: theta, gives=lambda counts, per_turn: counts
):
    """``scale``: of turns in an angle; ``gives``: what is made of the counts."""

    def encoder(theta, counts_per_rev):
        counts = quantise(angle(np.asarray(theta, dtype=float)) * counts_per_rev * scale)
        return gives(counts, counts_per_rev)

    return encoder


_ENCODER = {
    "quantise": (
        ("TRUNCATES_TOWARD_ZERO", np.trunc),
        ("ROUNDS_UP", np.ceil),
        ("ROUNDS_UP", lambda counts: np.floor(counts) + 1),
        ("NOT_QUANTISED", lambda counts: counts),
    ),
    "scale": (
        ("RADIANS_AS_TURNS", 1.0),
        ("RADIANS_AS_TURNS", _TURN),
        ("DEGREES_FOR_RADIANS", 1 / 360),
        ("DEGREES_FOR_RADIANS", 180 / math.pi / _TURN),
        *(("COUNTS_OFF_BY_FACTOR", factor / _TURN) for factor in (2.0, 4.0, 0.5, 0.25, math.pi / 3.14)),
    ),
    "angle": (
        ("TURNS_FORGOTTEN", lambda theta: theta % _TURN),
        ("TURNS_FORGOTTEN", lambda theta: np.fmod(theta, _TURN)),
        ("TURNS_FORGOTTEN", lambda theta: np.arctan2(np.sin(theta), np.cos(theta))),
        ("COUNTS_WITHOUT_SIGN", np.abs),
        ("COUNTS_NEGATED", np.negative),
        ("COUNTS_FROM_FIRST", lambda theta: theta - theta[0]),
    ),
    "gives": (
        ("TURNS_FORGOTTEN", lambda counts, per_turn: counts % per_turn),
        ("TURNS_FORGOTTEN", np.fmod),
        ("COUNTS_WITHOUT_SIGN", lambda counts, per_turn: np.abs(counts)),
        ("COUNTS_NEGATED", lambda counts, per_turn: -counts),
        ("RETURNS_ANGLE", lambda counts, per_turn: counts * _TURN / per_turn),
        ("RETURNS_TURNS", lambda counts, per_turn: counts / per_turn),
        ("RETURNS_TURNS", lambda counts, per_turn: np.floor(counts / per_turn)),
        ("COUNTS_ARE_STEPS", lambda counts, per_turn: np.diff(counts, prepend=0.0)),
        ("COUNTS_ARE_STEPS", lambda counts, per_turn: np.diff(counts, prepend=counts[0])),
    ),
}

# -- gyroscope ------------------------------------------------------------------------------------------


def _steps_first(rng, n):
    steps = rng.standard_normal(n - 1)
    return steps, rng.standard_normal(n)


def _white_first(rng, n):
    white = rng.standard_normal(n)
    return rng.standard_normal(n - 1), white


def _many_steps_first(rng, n):
    steps = rng.standard_normal(n)[: n - 1]
    return steps, rng.standard_normal(n)


def _white_then_many_steps(rng, n):
    white = rng.standard_normal(n)
    return rng.standard_normal(n)[: n - 1], white


def _in_turn(rng, n):
    """A loop over the samples: the noise of one, then the step to the next."""
    numbers = rng.standard_normal(2 * n - 1)
    return numbers[1::2], numbers[::2]


def _imu(
    draws=_steps_first,
    white=lambda density, dt: density / math.sqrt(dt),
    step=lambda walk, dt: walk * math.sqrt(dt),
    noise=lambda numbers: numbers,
    bias=lambda first, steps: first + np.concatenate(([0.0], np.cumsum(steps))),
    gives=lambda true, bias, noise: (true + bias + noise, bias),
):
    def imu(true, dt, noise_density, bias_random_walk, bias0, rng):
        steps, numbers = draws(rng, len(true))
        walked = bias(bias0, step(bias_random_walk, dt) * steps)
        return gives(np.asarray(true), walked, white(noise_density, dt) * noise(numbers))

    return imu


def _twice(draws):
    """The same numbers for the steps and for the noise."""

    def alike(rng, n):
        _, white = draws(rng, n)
        return white[: n - 1], white

    return (("SAME_DRAW_TWICE", alike),)


def _late(first, steps):
    return first + np.cumsum(np.append(steps, 0.0))


_IMU = {
    "white": (
        ("WHITE_NOISE_NOT_SCALED_BY_SQRT_DT", lambda density, dt: density),
        ("WHITE_NOISE_TIMES_SQRT_DT", lambda density, dt: density * math.sqrt(dt)),
        ("WHITE_NOISE_OVER_DT", lambda density, dt: density / dt),
        ("WHITE_NOISE_TIMES_DT", lambda density, dt: density * dt),
        ("WHITE_NOISE_MISSING", lambda density, dt: 0.0),
        ("WHITE_NOISE_FACTOR", lambda density, dt: density / math.sqrt(2 * dt)),
        ("WHITE_NOISE_FACTOR", lambda density, dt: density * math.sqrt(2 / dt)),
        ("WHITE_NOISE_FACTOR", lambda density, dt: density / 2 / math.sqrt(dt)),
        ("DENSITY_SQUARED", lambda density, dt: density**2 / math.sqrt(dt)),
        ("DENSITY_SQUARED", lambda density, dt: density**2 / dt),
    ),
    "step": (
        ("BIAS_NOT_SCALED_BY_SQRT_DT", lambda walk, dt: walk),
        ("BIAS_TIMES_DT", lambda walk, dt: walk * dt),
        ("BIAS_OVER_SQRT_DT", lambda walk, dt: walk / math.sqrt(dt)),
        ("BIAS_CONSTANT", lambda walk, dt: 0.0),
        ("BIAS_FACTOR", lambda walk, dt: walk * math.sqrt(dt / 3)),
        ("BIAS_FACTOR", lambda walk, dt: walk * math.sqrt(dt / 2)),
        ("BIAS_FACTOR", lambda walk, dt: walk * math.sqrt(2 * dt)),
        ("WALK_SQUARED", lambda walk, dt: walk**2 * math.sqrt(dt)),
        ("WALK_SQUARED", lambda walk, dt: walk**2 * dt),
    ),
    "noise": (
        ("WHITE_NOISE_ACCUMULATES", np.cumsum),
        ("WHITE_NOISE_SHARED", lambda numbers: np.full(len(numbers), numbers[0])),
        ("WHITE_NOISE_ONE_SIDED", np.abs),
    ),
    "bias": (
        ("BIAS_NOT_RANDOM_WALK", lambda first, steps: first + np.concatenate(([0.0], steps))),
        ("BIAS_STARTS_LATE", _late),
        ("BIAS0_IGNORED", lambda first, steps: np.concatenate(([0.0], np.cumsum(steps)))),
        ("BIAS_WALKS_TO_BIAS0", lambda first, steps: first + np.concatenate((np.cumsum(steps)[::-1], [0.0]))),
        ("BIAS0_ADDED_EACH_STEP", lambda first, steps: np.cumsum(np.concatenate(([first], first + steps)))),
    ),
    "gives": (
        ("BIAS_NOT_ADDED", lambda true, bias, noise: (true + noise, bias)),
        ("BIAS_SUBTRACTED", lambda true, bias, noise: (true - bias + noise, bias)),
        ("TRUE_RATE_MISSING", lambda true, bias, noise: (bias + noise, bias)),
        ("BIAS_OUT_OF_STEP", lambda true, bias, noise: (true + bias + noise, np.append(bias[0], bias[:-1]))),
        ("BIAS_OUT_OF_STEP", lambda true, bias, noise: (true + bias + noise, np.append(bias[1:], bias[-1]))),
        ("BIAS_HOLDS_WHITE_NOISE", lambda true, bias, noise: (true + bias + noise, bias + noise)),
        ("RETURNS_SWAPPED", lambda true, bias, noise: (bias, true + bias + noise)),
        ("NOISE_FOR_BIAS", lambda true, bias, noise: (true + bias + noise, noise)),
    ),
}
_ORDERS = (_steps_first, _white_first, _many_steps_first, _white_then_many_steps, _in_turn)

# -- lidar ----------------------------------------------------------------------------------------------


def _direct(angle, heading):
    return heading + angle


def _lidar(
    beam=_direct,
    vector=lambda c: (np.cos(c), np.sin(c)),
    start=lambda walls, place: walls[:, 0] - place,
    along_wall=lambda walls: walls[:, 1] - walls[:, 0],
    ahead=lambda along: along >= 0,
    between=lambda share: (share >= 0) & (share <= 1),
    pick=lambda along, hit: np.min(np.where(hit, along, np.inf), axis=1),
    distance=lambda nearest, angle: nearest,
    reads=lambda along, share, cross, length: along,
    reach=lambda r_max: r_max,
    none=lambda r_max: r_max,
    std=lambda sigma, nearest: sigma,
    numbers=lambda rng, n: rng.standard_normal(n),
    floor=lambda noisy, r_max: np.maximum(noisy, 0.0),
    on_none=False,
):
    """``reach``: how far a hit counts; ``none``: what is read without one; ``on_none``: with noise on it.

    ``reads``: what counts as the distance of a hit along its beam and at its share of the wall.
    """

    def lidar(pose, segments, angles, r_max, sigma, rng):
        walls = np.asarray(segments, dtype=float).reshape(-1, 2, 2)
        angles = np.asarray(angles, dtype=float)
        dx, dy = (part[:, None] for part in vector(beam(angles, pose[2])))
        ax, ay = start(walls, np.asarray(pose[:2])).T
        wx, wy = along_wall(walls).T
        with np.errstate(all="ignore"):
            cross = dx * wy - dy * wx
            along, share = (ax * wy - ay * wx) / cross, (ax * dy - ay * dx) / cross
        hit = (cross != 0) & ahead(along) & between(share) & np.isfinite(along)
        with np.errstate(all="ignore"):
            along = reads(along, share, cross, np.hypot(wx, wy))
        nearest = distance(pick(along, hit), angles)
        found = np.isfinite(nearest) & (nearest <= reach(r_max))
        draws = numbers(rng, len(angles))
        with np.errstate(all="ignore"):
            noisy = floor(nearest + std(sigma, nearest) * draws, r_max)
        empty = none(r_max) + (sigma * draws if on_none else 0.0)
        return np.where(found, noisy, empty)

    return lidar


def _farthest(along, hit):
    return np.where(hit.any(axis=1), np.max(np.where(hit, along, -1.0), axis=1), np.inf)


def _last(along, hit):
    index = hit.shape[1] - 1 - np.argmax(hit[:, ::-1], axis=1)
    return np.where(hit.any(axis=1), along[np.arange(len(along)), index], np.inf)


def _first(along, hit):
    return np.where(hit.any(axis=1), along[np.arange(len(along)), np.argmax(hit, axis=1)], np.inf)


_LIDAR = {
    "beam": (
        ("HEADING_IGNORED", lambda a, h: a),
        ("ANGLES_IGNORED", lambda a, h: h + 0.0 * a),
        ("HEADING_SUBTRACTED", lambda a, h: a - h),
        ("HEADING_SUBTRACTED", lambda a, h: h - a),
        *(
            ("BEAM_IN_DEGREES", beam)
            for f in (np.degrees, np.radians)
            for beam in (
                lambda a, h, f=f: f(a + h),
                lambda a, h, f=f: f(a) + h,
                lambda a, h, f=f: a + f(h),
            )
        ),
    ),
    "vector": (
        ("BEAM_SIN_COS_SWAPPED", lambda c: (np.sin(c), np.cos(c))),
        ("BEAM_REVERSED", lambda c: (-np.cos(c), -np.sin(c))),
    ),
    "start": (
        ("POSITION_IGNORED", lambda walls, place: walls[:, 0]),
        ("WALL_VECTOR_REVERSED", lambda walls, place: place - walls[:, 0]),
        ("POSITION_SIGN_FLIPPED", lambda walls, place: walls[:, 0] + place),
        ("WALL_ENDS_MIXED", lambda walls, place: walls[:, 1] - place),
    ),
    "along_wall": (("WALL_ENDS_MIXED", lambda walls: walls[:, 0] - walls[:, 1]),),
    "ahead": (("WALLS_BEHIND_SEEN", lambda along: True),),
    "between": (
        ("WALLS_ENDLESS", lambda share: True),
        ("WALLS_ENDLESS_ONE_WAY", lambda share: share >= 0),
        ("WALLS_ENDLESS_ONE_WAY", lambda share: share <= 1),
        ("NOTHING_IS_HIT", lambda share: share != share),  # noqa: PLR0124 - false for each
    ),
    "pick": (
        (
            "NOT_THE_NEAREST",
            lambda along, hit: np.where(hit.any(axis=1), np.max(np.where(hit, along, -1.0), axis=1), np.inf),
        ),
        ("NOT_THE_NEAREST", _last),
        ("NOT_THE_NEAREST", _first),
    ),
    "distance": (
        ("DISTANCE_SQUARED", lambda nearest, angle: nearest**2),
        ("DISTANCE_ALONG_HEADING", lambda nearest, angle: nearest * np.cos(angle)),
    ),
    "reads": (
        ("DISTANCE_ACROSS", lambda along, share, cross, length: along * np.abs(cross) / length),
        ("DISTANCE_ALONG_WALL", lambda along, share, cross, length: share),
        ("DISTANCE_ALONG_WALL", lambda along, share, cross, length: share * length),
    ),
    "reach": (("BEYOND_RANGE", lambda r_max: np.inf),),
    "none": (
        ("NO_HIT_NOT_MAX", lambda r_max: np.inf),
        ("NO_HIT_NOT_MAX", lambda r_max: np.nan),
        ("NO_HIT_NOT_MAX", lambda r_max: 0.0),
        ("NO_HIT_NOT_MAX", lambda r_max: -1.0),
    ),
    "std": (
        ("LIDAR_SIGMA_SQUARED", lambda sigma, nearest: sigma**2),
        ("LIDAR_SIGMA_ROOT", lambda sigma, nearest: math.sqrt(sigma)),
        ("LIDAR_NOISE_PROPORTIONAL", lambda sigma, nearest: sigma * nearest),
        ("LIDAR_NOISE_MISSING", lambda sigma, nearest: 0.0),
    ),
    "numbers": (
        ("LIDAR_NOISE_SHARED", lambda rng, n: rng.standard_normal()),
        ("LIDAR_NOISE_UNIFORM", lambda rng, n: rng.uniform(-1.0, 1.0, n)),
        ("LIDAR_NOISE_ONE_SIDED", lambda rng, n: np.abs(rng.standard_normal(n))),
    ),
    "floor": (
        ("NEGATIVE_RANGE", lambda noisy, r_max: noisy),
        ("RANGE_MADE_POSITIVE", lambda noisy, r_max: np.abs(noisy)),
        ("NOISE_CUT_AT_MAX", lambda noisy, r_max: np.clip(noisy, 0.0, r_max)),
    ),
    "on_none": (("LIDAR_NOISE_ON_MAX", True),),
}

TERMS = {
    "encoder": [(_encoder, {}, _ENCODER), (_encoder, {"quantise": np.rint}, _ENCODER)],
    "imu": [(_imu, {"draws": order}, _IMU | {"draws": _twice(order)}) for order in _ORDERS],
    "fit_noise": [],
    "lidar": [(_lidar, {}, _LIDAR)],
}
