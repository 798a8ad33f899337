"""What the tasks of ``collisions`` give, right and wrong, on one set of arguments.

Each function takes what the task takes. ``WRONG`` lists, per task, a code and a formula that makes the
mistake of that name; ``RIGHT`` has the formula that checks compare with. Lengths in m, masses in kg.
"""

from __future__ import annotations

import math

import numpy as np


def _array(x):
    return np.asarray(x, dtype=float)


def _size(x):
    return float(np.sqrt(np.dot(x, x)))


# -- detection ------------------------------------------------------------------------------------------


def _spheres(depth=lambda r, d: r - d, normal=lambda w, d: w / d, touching=None, radii=lambda a, b: a + b):
    """depth(sum of radii, distance), normal(vector from a to b, distance), touching(depth)."""

    def detect(xa, ra, xb, rb):
        apart = _array(xb) - _array(xa)
        distance = _size(apart)
        n = normal(apart, distance) if distance else np.eye(1, len(apart))[0]
        deep = depth(radii(ra, rb), distance)
        return (deep >= 0.0 if touching is None else touching(deep)), n, deep

    return detect


def _plane(gap=None, depth=lambda r, s: r - s, normal=lambda n: n, touching=lambda deep: deep >= 0.0):
    """gap(x, point, normal) is the height of the centre, depth(radius, height) what is inside."""
    gap = gap or (lambda x, p, n: float((x - p) @ n))

    def detect(x, r, point, n):
        x, point, n = _array(x), _array(point), _array(n)
        deep = depth(r, gap(x, point, n))
        return touching(deep), normal(n), deep

    return detect


# -- blows ----------------------------------------------------------------------------------------------

#: How the speed of parting is written into the impulse, rightly and wrongly.
FACTORS = (
    ("RESTITUTION_SQUARED", lambda e: 1 + e * e),
    ("RESTITUTION_AS_ENERGY", lambda e: 1 + math.sqrt(e)),
    ("RESTITUTION_IGNORED", lambda e: 2.0),
    ("RESTITUTION_IGNORED", lambda e: 1.0),
    ("ONLY_THE_REBOUND", lambda e: e),
    ("RESTITUTION_SIGN_FLIPPED", lambda e: 1 - e),
)


def _give(ma, mb):
    """How much speed of parting one newton second makes, 1/kg."""
    return 1 / ma + 1 / mb


#: How the masses enter it, wrongly: what stands in the place of 1/ma + 1/mb.
GIVES = (
    ("MASS_NOT_INVERSE", lambda ma, mb: ma + mb),
    ("MASS_NOT_INVERSE", lambda ma, mb: 1 / (ma + mb)),
    ("MEAN_MASS", lambda ma, mb: 2 * _give(ma, mb)),
    ("MEAN_MASS", lambda ma, mb: 2 / (ma + mb)),
    ("MEAN_MASS", lambda ma, mb: 4 / (ma + mb)),
    ("EQUAL_MASSES_ASSUMED", lambda ma, mb: 2 / ma),
    ("EQUAL_MASSES_ASSUMED", lambda ma, mb: 2 / mb),
    ("ONE_MASS_ONLY", lambda ma, mb: 1 / ma),
    ("ONE_MASS_ONLY", lambda ma, mb: 1 / mb),
    ("MASSES_IGNORED", lambda ma, mb: 1.0),
    ("MASSES_IGNORED", lambda ma, mb: 2.0),
)


def _line(factor=lambda e: 1 + e, give=_give, acts=lambda c: c > 0, closing=lambda va, vb: va - vb, sign=1.0):
    def impulse(ma, mb, va, vb, e):
        speed = closing(va, vb)
        return sign * factor(e) * speed / give(ma, mb) if acts(speed) else 0.0

    return impulse


def _no_rub(press, slip, speed, give, mu):
    return 0.0 * slip


def _coulomb(press, slip, speed, give, mu):
    """The impulse across the normal: what stops the slip, or mu times the blow if that is less."""
    return -min(mu * press, speed / give) / (speed or 1.0) * slip


def _blow(
    factor=lambda e: 1 + e,
    give=_give,
    acts=lambda c: c > 0,
    shares=(-1.0, 1.0),
    along=lambda n, u: n,
    slip_of=lambda va, vb, slip, n: slip,
    rub=_no_rub,
    rub_shares=None,
    kick=lambda j, m: j / m,
    closing_of=lambda va, vb, n: float((va - vb) @ n),
):
    """A blow. ``shares``: signs of the impulse on a and b; ``along(n, u)``: its direction, u = vb - va;

    ``rub(press, slip, speed, give, mu)``: the impulse across, for a slip of b seen from a.
    """

    def resolve(ma, mb, va, vb, n, e, mu=0.0):
        va, vb, n = _array(va), _array(vb), _array(n)
        closing = closing_of(va, vb, n)
        if not acts(closing):
            return va, vb
        press = factor(e) * closing / give(ma, mb)
        slip = slip_of(va, vb, vb - va + closing * n, n)
        across = rub(press, slip, _size(slip), give(ma, mb), mu)
        main = press * along(n, vb - va)
        across_a, across_b = (s * across for s in (rub_shares or shares))
        a, b = (share * main + side for share, side in zip(shares, (across_a, across_b), strict=True))
        return va + kick(a, ma), vb + kick(b, mb)

    return resolve


def _each_alone(ma, mb, va, vb, n, e, mu=0.0):
    """Each body is thrown back as if from a wall, by its own velocity."""
    va, vb, n = _array(va), _array(vb), _array(n)
    if (va - vb) @ n <= 0:
        return va, vb
    return va - (1 + e) * (va @ n) * n, vb - (1 + e) * (vb @ n) * n


def _swapped(right):
    def resolve(*args):
        return right(*args)[::-1]

    return resolve


def _unit(u):
    return u / (_size(u) or 1.0)


def _per_axis(press, slip, speed, give, mu):
    return -np.clip(slip / give, -mu * press, mu * press)


_BLOWS = (
    ("IMPULSE_ON_SEPARATING", {"acts": lambda c: True}),
    ("NORMAL_REVERSED", {"acts": lambda c: c < 0}),
    *((code, {"factor": factor}) for code, factor in FACTORS),
    *((code, {"give": give}) for code, give in GIVES),
    ("IMPULSE_REVERSED", {"shares": (1.0, -1.0)}),
    ("THIRD_LAW_MISSING", {"shares": (1.0, 1.0)}),
    ("THIRD_LAW_MISSING", {"shares": (-1.0, -1.0)}),
    ("THIRD_LAW_MISSING", {"shares": (-1.0, 0.0)}),
    ("THIRD_LAW_MISSING", {"shares": (0.0, 1.0)}),
    ("MASS_NOT_INVERSE", {"kick": lambda j, m: j * m}),
    ("MASSES_IGNORED", {"kick": lambda j, m: j}),
    ("BLOW_NOT_ALONG_NORMAL", {"along": lambda n, u: _unit(u)}),
    ("BLOW_NOT_ALONG_NORMAL", {"along": lambda n, u: -_unit(u)}),
    ("SPEEDS_NOT_RELATIVE", {"closing_of": lambda va, vb, n: float((va + vb) @ n)}),
    ("SPEEDS_NOT_RELATIVE", {"closing_of": lambda va, vb, n: float(abs(va @ n) + abs(vb @ n))}),
    ("SPEED_NOT_ALONG_NORMAL", {"closing_of": lambda va, vb, n: _size(va - vb) * _sign((va - vb) @ n)}),
)


def _sign(x):
    return 1.0 if x > 0 else -1.0


_RUBS = (
    ("FRICTION_IGNORED", _no_rub, {}),
    ("FRICTION_NOT_CLAMPED", lambda p, s, v, g, mu: -mu * p * _unit(s), {}),
    ("FRICTION_ALWAYS_STICKS", lambda p, s, v, g, mu: -s / g, {}),
    ("FRICTION_ALWAYS_STICKS", lambda p, s, v, g, mu: -s / g if mu > 0 else 0.0 * s, {}),
    ("FRICTION_DRIVES", lambda p, s, v, g, mu: -_coulomb(p, s, v, g, mu), {}),
    ("FRICTION_PER_AXIS", _per_axis, {}),
    ("STICKING_WITHOUT_MASS", lambda p, s, v, g, mu: -min(mu * p, v) * _unit(s), {}),
    ("FRICTION_TAKES_THE_LARGER", lambda p, s, v, g, mu: -max(mu * p, v / g) * _unit(s), {}),
    ("FRICTION_PROPORTIONAL", lambda p, s, v, g, mu: -mu * s / g, {}),
    ("FRICTION_PROPORTIONAL", lambda p, s, v, g, mu: -min(mu, 1.0) * s / g, {}),
    ("FRICTION_THIRD_LAW_MISSING", _coulomb, {"rub_shares": (-1.0, 0.0)}),
    ("FRICTION_THIRD_LAW_MISSING", _coulomb, {"rub_shares": (0.0, 1.0)}),
    ("FRICTION_THIRD_LAW_MISSING", _coulomb, {"rub_shares": (1.0, 1.0)}),
    ("FRICTION_THIRD_LAW_MISSING", _coulomb, {"rub_shares": (-1.0, -1.0)}),
    ("FRICTION_NOT_RELATIVE", _coulomb, {"slip_of": lambda va, vb, s, n: -(va - (va @ n) * n)}),
    ("FRICTION_NOT_RELATIVE", _coulomb, {"slip_of": lambda va, vb, s, n: vb - (vb @ n) * n}),
    ("FRICTION_NOT_ACROSS", _coulomb, {"slip_of": lambda va, vb, s, n: vb - va}),
)


def _friction_without_rebound(ma, mb, va, vb, n, e, mu):
    """The limit of friction is taken from the blow that only stops the approach."""

    def rub(press, slip, speed, give, mu):
        return -min(mu * press / (1 + e), speed / give) / (speed or 1.0) * slip

    return _blow(rub=rub)(ma, mb, va, vb, n, e, mu)


# -- the moment of contact ------------------------------------------------------------------------------


def _moment(
    root=-1.0,
    limit=True,
    past=False,
    overlap="approaching",
    radii=lambda a, b: a + b,
    unit=lambda t, dt: t,
    none=None,
    square=lambda reach: reach * reach,
    overlap_square=None,
):
    """The first (root -1) or second (+1) time at which the centres are as far apart as the radii reach.

    ``square`` gives what stands for the square of the reach, ``overlap_square`` the same where they overlap.
    """
    overlap_square = overlap_square or square

    def time_of_impact(xa, va, ra, xb, vb, rb, dt):
        apart, closing = _array(xb) - _array(xa), _array(va) - _array(vb)
        reach, speed2 = radii(ra, rb), float(closing @ closing)
        nearing = float(apart @ closing)
        if apart @ apart <= overlap_square(reach) and overlap != "ignored":
            return 0.0 if nearing > 0 or overlap == "always" else none
        if speed2 == 0.0 or (nearing <= 0 and not past):
            return none
        nearest = nearing / speed2  # when the centres come closest; the rest is Pythagoras
        miss = apart - nearest * closing
        room = square(reach) - float(miss @ miss)
        if room < 0:
            return none
        t = nearest + root * math.sqrt(room / speed2)
        if (limit and t > dt) or (t < 0 and not past):
            return none
        return unit(t, dt)

    return time_of_impact


def _head_on_always(xa, va, ra, xb, vb, rb, dt):
    """Gap over speed of approach along the line of centres, as if nothing could pass by."""
    apart = _array(xb) - _array(xa)
    distance = _size(apart)
    closing = float((_array(va) - _array(vb)) @ apart) / (distance or 1.0)
    gap = distance - ra - rb
    if closing <= 0:
        return None
    return max(gap, 0.0) / closing if gap <= closing * dt else None


def _gap_over_speed(xa, va, ra, xb, vb, rb, dt):
    """Gap over the whole relative speed, whatever its direction."""
    apart, u = _array(xb) - _array(xa), _array(va) - _array(vb)
    gap, speed = _size(apart) - ra - rb, _size(u)
    if apart @ u <= 0 or speed == 0:
        return None
    return max(gap, 0.0) / speed if gap <= speed * dt else None


def _at_the_end_only(exact):
    """Looks at both ends of the step and nowhere between."""
    true = _moment()

    def time_of_impact(xa, va, ra, xb, vb, rb, dt):
        now, then = (_array(xb) - _array(xa) + t * (_array(vb) - _array(va)) for t in (0.0, dt))
        if _size(now) <= ra + rb:
            return true(xa, va, ra, xb, vb, rb, dt)
        if _size(then) > ra + rb:
            return None
        return true(xa, va, ra, xb, vb, rb, dt) if exact else dt

    return time_of_impact


RIGHT = {
    "detect_sphere_sphere": _spheres(),
    "detect_sphere_plane": _plane(),
    "impulse_1d": _line(),
    "resolve": _blow(),
    "resolve_with_friction": _blow(rub=_coulomb),
    "time_of_impact": _moment(),
}

WRONG = {
    "detect_sphere_sphere": [
        ("NORMAL_REVERSED", _spheres(normal=lambda w, d: -w / d)),
        ("NORMAL_NOT_UNIT", _spheres(normal=lambda w, d: w)),
        ("DEPTH_SIGN_FLIPPED", _spheres(depth=lambda r, d: d - r, touching=lambda deep: deep <= 0)),
        ("DEPTH_SIGN_FLIPPED", _spheres(depth=lambda r, d: d - r)),
        ("DEPTH_CLAMPED", _spheres(depth=lambda r, d: max(r - d, 0.0), touching=lambda deep: deep > 0)),
        ("DEPTH_CLAMPED", _spheres(depth=lambda r, d: max(r - d, 0.0))),
        ("DEPTH_UNSIGNED", _spheres(depth=lambda r, d: abs(r - d))),
        ("TOUCHING_INVERTED", _spheres(touching=lambda deep: deep < 0)),
        ("DISTANCE_SQUARED", _spheres(depth=lambda r, d: r - d * d)),
        ("DISTANCE_SQUARED", _spheres(depth=lambda r, d: r * r - d * d)),
        ("RADIUS_IGNORED", _spheres(radii=lambda a, b: 0.0)),
        ("ONE_RADIUS_ONLY", _spheres(radii=lambda a, b: a)),
        ("ONE_RADIUS_ONLY", _spheres(radii=lambda a, b: b)),
        ("ONE_RADIUS_ONLY", _spheres(radii=max)),
    ],
    "detect_sphere_plane": [
        ("NORMAL_REVERSED", _plane(normal=lambda n: -n)),
        ("DISTANCE_UNSIGNED", _plane(gap=lambda x, p, n: abs(float((x - p) @ n)))),
        ("DEPTH_SIGN_FLIPPED", _plane(depth=lambda r, s: s - r, touching=lambda deep: deep <= 0)),
        ("DEPTH_SIGN_FLIPPED", _plane(depth=lambda r, s: s - r)),
        ("DEPTH_CLAMPED", _plane(depth=lambda r, s: max(r - s, 0.0))),
        ("DEPTH_CLAMPED", _plane(depth=lambda r, s: max(r - s, 0.0), touching=lambda deep: deep > 0)),
        ("TOUCHING_INVERTED", _plane(touching=lambda deep: deep < 0)),
        ("RADIUS_IGNORED", _plane(depth=lambda r, s: -s)),
        ("RADIUS_ADDED_TWICE", _plane(depth=lambda r, s: 2 * r - s)),
        ("PLANE_POINT_IGNORED", _plane(gap=lambda x, p, n: float(x @ n))),
        ("PLANE_ASSUMED_LEVEL", _plane(gap=lambda x, p, n: float(x[-1] - p[-1]))),
        ("DISTANCE_TO_POINT", _plane(gap=lambda x, p, n: _size(x - p))),
        ("SOLID_ON_THE_WRONG_SIDE", _plane(gap=lambda x, p, n: -float((x - p) @ n))),
    ],
    "impulse_1d": [
        ("IMPULSE_ON_SEPARATING", _line(acts=lambda c: True)),
        ("NORMAL_REVERSED", _line(acts=lambda c: c < 0)),
        *((code, _line(factor=factor)) for code, factor in FACTORS),
        *((code, _line(give=give)) for code, give in GIVES),
        ("IMPULSE_REVERSED", _line(sign=-1.0)),
        ("SPEEDS_NOT_RELATIVE", _line(closing=lambda va, vb: va + vb)),
        ("SPEEDS_NOT_RELATIVE", _line(closing=lambda va, vb: abs(va) + abs(vb))),
        ("SPEEDS_NOT_RELATIVE", _line(closing=lambda va, vb: va)),
    ],
    "resolve": [
        *((code, _blow(**slip)) for code, slip in _BLOWS),
        ("EACH_BODY_ALONE", _each_alone),
        ("RETURNS_SWAPPED", _swapped(_blow())),
    ],
    "resolve_with_friction": [
        *((code, _blow(rub=rub, **slip)) for code, rub, slip in _RUBS),
        ("FRICTION_WITHOUT_REBOUND", _friction_without_rebound),
        *((code, _blow(**{"rub": _coulomb} | slip)) for code, slip in _BLOWS),
        ("EACH_BODY_ALONE", _each_alone),
        ("RETURNS_SWAPPED", _swapped(_blow(rub=_coulomb))),
    ],
    "time_of_impact": [
        ("TUNNELS", _at_the_end_only(exact=False)),
        ("TUNNELS", _at_the_end_only(exact=True)),
        ("TIME_OF_IMPACT_LATE_ROOT", _moment(root=1.0)),
        ("IMPACT_BEYOND_STEP", _moment(limit=False)),
        ("IMPACT_IN_THE_PAST", _moment(past=True)),
        ("IMPACT_IN_THE_PAST", _moment(past=True, overlap="ignored")),
        ("OVERLAP_IGNORED", _moment(overlap="ignored")),
        ("OVERLAP_ALWAYS_HITS", _moment(overlap="always")),
        ("MISSES_COUNT_AS_HITS", _head_on_always),
        ("MISSES_COUNT_AS_HITS", _gap_over_speed),
        ("RADIUS_IGNORED", _moment(radii=lambda a, b: 0.0)),
        ("ONE_RADIUS_ONLY", _moment(radii=lambda a, b: a)),
        ("ONE_RADIUS_ONLY", _moment(radii=lambda a, b: b)),
        ("RADII_NOT_SQUARED", _moment(square=lambda reach: reach)),
        ("RADII_NOT_SQUARED", _moment(square=lambda reach: reach, overlap="ignored")),
        ("RADII_NOT_SQUARED", _moment(square=lambda reach: reach, overlap="ignored", past=True)),
        ("RADII_NOT_SQUARED", _moment(square=lambda reach: reach, overlap_square=lambda reach: reach**2)),
        ("RADII_SQUARED_APART", _moment(radii=math.hypot)),
        ("RADII_SQUARED_APART", _moment(radii=math.hypot, overlap="ignored")),
        ("RETURNS_SHARE_OF_STEP", _moment(unit=lambda t, dt: t / dt)),
        ("RETURNS_TIME_LEFT", _moment(unit=lambda t, dt: dt - t)),
    ],
}

#: The later root, whether or not it lies within the step.
later_root = _moment(root=1.0, limit=False)
