"""What the tasks of ``collisions`` give, right and wrong, on one set of arguments.

Each function takes what the task takes. ``RIGHT`` has the formula that checks compare with. A wrong formula
is the right one with one of its terms in another form: ``TERMS`` lists, for each task, the terms, and for
each form of a term the code of the mistake; ``OTHERS`` are wrong in another way. Lengths in m, masses in kg.
"""

from __future__ import annotations

import math

import numpy as np


def _array(x):
    return np.asarray(x, dtype=float)


def _size(x):
    return float(np.sqrt(np.dot(x, x)))


# -- detection ------------------------------------------------------------------------------------------


def _spheres(
    depth=lambda r, d: r - d,
    normal=lambda w, d: w / d,
    touching=None,
    radii=lambda a, b: a + b,
    length=_size,
):
    """depth(sum of radii, distance), normal(vector, distance), touching(depth), length(vector)."""

    def detect(xa, ra, xb, rb):
        apart = _array(xb) - _array(xa)
        distance = length(apart)
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


# -- impacts --------------------------------------------------------------------------------------------


def each(code, *forms):
    """The same code for several forms of a term."""
    return tuple((code, form) for form in forms)


#: How the speed of parting is written into the impulse, rightly and wrongly.
FACTORS = (
    ("RESTITUTION_SQUARED", lambda e: 1 + e * e),
    ("RESTITUTION_DOUBLED", lambda e: 1 + 2 * e),
    ("IMPULSE_DOUBLED", lambda e: 2 * (1 + e)),
    ("RESTITUTION_HALVED", lambda e: 1 + e / 2),
    ("IMPULSE_HALVED", lambda e: (1 + e) / 2),
    ("RESTITUTION_AS_ENERGY", lambda e: 1 + math.sqrt(e)),
    *each("RESTITUTION_IGNORED", lambda e: 1.0, lambda e: 2.0),
    ("ONLY_THE_REBOUND", lambda e: e),
    ("RESTITUTION_SIGN_FLIPPED", lambda e: 1 - e),
)


def _give(ma, mb):
    """How much speed of parting one newton second makes, 1/kg."""
    return 1 / ma + 1 / mb


#: How the masses enter it, wrongly: what stands in the place of 1/ma + 1/mb.
GIVES = (
    *each("MASS_NOT_INVERSE", lambda ma, mb: ma + mb, lambda ma, mb: 1 / (ma + mb)),
    ("MASS_NOT_INVERSE", lambda ma, mb: 1 / _give(ma, mb)),
    ("IMPULSE_HALVED", lambda ma, mb: 2 * _give(ma, mb)),
    *each("MEAN_MASS", lambda ma, mb: 2 / (ma + mb), lambda ma, mb: 4 / (ma + mb)),
    *each("EQUAL_MASSES_ASSUMED", lambda ma, mb: 2 / ma, lambda ma, mb: 2 / mb),
    ("IMPULSE_DOUBLED", lambda ma, mb: _give(ma, mb) / 2),
    ("MASS_SUM_ROOTED", lambda ma, mb: 1 / math.sqrt(ma * mb)),
    *each("MASSES_SUBTRACTED", lambda ma, mb: 1 / ma - 1 / mb, lambda ma, mb: abs(1 / ma - 1 / mb)),
    *each("ONE_MASS_ONLY", lambda ma, mb: 1 / ma, lambda ma, mb: 1 / mb),
    *each("MASSES_IGNORED", lambda ma, mb: 1.0, lambda ma, mb: 2.0),
)


def _line(
    factor=lambda e: 1 + e,
    give=_give,
    acts=lambda c: c > 0,
    closing=lambda va, vb: va - vb,
    share=1.0,
    power=1,
    slow=None,
):
    """``share``: of the impulse returned; ``power``: of the speed; ``slow``: below it e is dropped."""

    def impulse(ma, mb, va, vb, e):
        speed = closing(va, vb)
        if slow is not None and speed < slow:
            e = 0.0
        return (
            share * factor(e) * math.copysign(abs(speed) ** power, speed) / give(ma, mb)
            if acts(speed)
            else 0.0
        )

    return impulse


def _no_friction(press, slip, speed, give, mu):
    return 0.0 * slip


def _coulomb(press, slip, speed, give, mu):
    """The impulse across the normal: what stops the slip, or mu times the impact if that is less."""
    return -min(mu * press, speed / give) / (speed or 1.0) * slip


def _impact(
    factor=lambda e: 1 + e,
    give=_give,
    acts=lambda c: c > 0,
    shares=(-1.0, 1.0),
    along=lambda n, u: n,
    slip_of=lambda va, vb, slip, n: slip,
    friction=_no_friction,
    friction_shares=None,
    kick=lambda j, m, other: j / m,
    closing_of=lambda va, vb, n: float((va - vb) @ n),
    slow=None,
    kept=lambda w, n: w,
    over=lambda ma, mb: (ma, mb),
    rubs_over=lambda ma, mb: (ma, mb),
):
    """An impact. ``shares``: of the impulse on a and b; ``along(n, u)``: its direction, u = vb - va;

    ``friction(press, slip, speed, give, mu)``: the impulse across, for a slip of b seen from a; ``over``,
    ``rubs_over``: the masses over which the impulse, and friction in it, changes the two velocities.
    """

    def resolve(ma, mb, va, vb, n, e, mu=0.0):
        va, vb, n = _array(va), _array(vb), _array(n)
        closing = closing_of(va, vb, n)
        if not acts(closing):
            return va, vb
        if slow is not None and closing < slow:
            e = 0.0
        press = factor(e) * closing / give(ma, mb)
        slip = slip_of(va, vb, vb - va + closing * n, n)
        across = friction(press, slip, _size(slip), give(ma, mb), mu)
        main = press * along(n, vb - va)
        rubs = zip(friction_shares or shares, (ma, mb), rubs_over(ma, mb), strict=True)
        across_a, across_b = (
            share * (own / other if own != other else 1.0) * across for share, own, other in rubs
        )
        a, b = (share * main + side for share, side in zip(shares, (across_a, across_b), strict=True))
        of_a, of_b = over(ma, mb)
        return kept(va, n) + kick(a, of_a, mb), kept(vb, n) + kick(b, of_b, ma)

    return resolve


def _only_along(ma, mb, va, vb, n, e):
    """What is across the normal is lost, also of bodies that do not approach."""
    return tuple((w @ n) * n for w in _impact()(ma, mb, va, vb, n, e))


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


def _exchanged(right):
    def resolve(ma, mb, *rest):
        return right(mb, ma, *rest)

    return resolve


def _reversed(right):
    """The normal is taken to point from b to a."""

    def resolve(ma, mb, va, vb, n, *rest):
        return right(ma, mb, va, vb, -_array(n), *rest)

    return resolve


def _exchange(ma, mb, va, vb, n, e, mu=0.0):
    """Along the normal the bodies exchange their velocities, as equal ones do for e = 1."""
    va, vb, n = _array(va), _array(vb), _array(n)
    closing = (va - vb) @ n
    return (va - closing * n, vb + closing * n) if closing > 0 else (va, vb)


def _stick(ma, mb, va, vb, n, e, mu=0.0):
    """Both go on with the velocity of their centre of mass."""
    va, vb, n = _array(va), _array(vb), _array(n)
    if (va - vb) @ n <= 0:
        return va, vb
    share = 1 / (1 + ma / mb) if math.isfinite(mb) else 1.0
    both = (1 - share) * va + share * vb
    return both, both


def _unit(u):
    return u / (_size(u) or 1.0)


def _per_axis(press, slip, speed, give, mu):
    return -np.clip(slip / give, -mu * press, mu * press)


def _sign(x):
    return 1.0 if x > 0 else -1.0


def _friction_without_rebound(ma, mb, va, vb, n, e, mu):
    """The limit of friction is taken from the impact that only stops the approach."""

    def friction(press, slip, speed, give, mu):
        return -min(mu * press / (1 + e), speed / give) / (speed or 1.0) * slip

    return _impact(friction=friction)(ma, mb, va, vb, n, e, mu)


def _each_rubs(cap):
    """Each body's own velocity across the normal is braked by mu J, or by ``cap(mass, give)`` of it."""

    def resolve(ma, mb, va, vb, n, e, mu):
        n, press = _array(n), _line()(ma, mb, float(va @ n), float(vb @ n), e)
        ends = _impact()(ma, mb, va, vb, n, e)
        if press == 0.0:
            return ends
        changes = []
        for m, v in ((ma, _array(va)), (mb, _array(vb))):
            across = v - (v @ n) * n
            size = _size(across)
            changes.append(min(mu * press / m, cap(m, _give(ma, mb)) * size) * _unit(across))
        return ends[0] - changes[0], ends[1] - changes[1]

    return resolve


def _scaled(friction=_no_friction, factor=lambda e: 2.0):
    """All of the velocities after an impact without loss, or with another factor, is multiplied by e."""
    right = _impact(factor=factor, friction=friction)

    def resolve(ma, mb, va, vb, n, e, *mu):
        va, vb, n = _array(va), _array(vb), _array(n)
        after = right(ma, mb, va, vb, n, e, *mu)
        return tuple(e * w for w in after) if (va - vb) @ n > 0 else after

    return resolve


def _held_by(masses):
    """What stops the slip is taken as slip times ``masses(ma, mb)``."""

    def resolve(ma, mb, *rest):
        def friction(press, slip, speed, give, mu):
            return -min(mu * press, speed * masses(ma, mb)) * _unit(slip)

        return _impact(friction=friction)(ma, mb, *rest)

    return resolve


def _rubs_by_speed(share):
    """Coulomb's limit is mu times the speed of approach, times ``share(e)``."""

    def resolve(ma, mb, va, vb, n, e, mu):
        def friction(press, slip, speed, give, mu):
            return -min(mu * share(e) * press * give / (1 + e), speed / give) * _unit(slip)

        return _impact(friction=friction)(ma, mb, va, vb, n, e, mu)

    return resolve


def _sticks_up_to(limit):
    """The slip is stopped where it is at most ``limit(mu, s, J)``, and mu J acts elsewhere."""

    def resolve(ma, mb, va, vb, n, e, mu):
        def friction(press, slip, speed, give, mu):
            sticks = speed <= limit(mu, press * give / (1 + e), press)
            return -(speed / give if sticks else mu * press) * _unit(slip)

        return _impact(friction=friction)(ma, mb, va, vb, n, e, mu)

    return resolve


def _rubs_while_sliding(press, slip, speed, give, mu):
    return -mu * press * _unit(slip) if mu * press < speed / give else 0.0 * slip


def _from_both_sides(right):
    """Acts only where a moves towards b and b towards a."""

    def resolve(ma, mb, va, vb, n, *rest):
        va, vb, n = _array(va), _array(vb), _array(n)
        return right(ma, mb, va, vb, n, *rest) if va @ n > 0 > vb @ n else (va, vb)

    return resolve


def _strikes_if(meets):
    """On a line: acts only where ``meets(va, vb)``, and they approach."""
    right = _line()
    return lambda ma, mb, va, vb, e: right(ma, mb, va, vb, e) if meets(va, vb) else 0.0


def _approach_by(meets):
    """On a line: whether they approach is decided by ``meets(va, vb)``, the impulse by their difference."""
    always = _line(acts=lambda c: True)
    return lambda ma, mb, va, vb, e: always(ma, mb, va, vb, e) if meets(va, vb) else 0.0


def _approach_in_space(meets, **terms):
    """The same in space, by ``meets`` of their parts along the normal."""
    always = _impact(acts=lambda c: True, **terms)

    def resolve(ma, mb, va, vb, n, *rest):
        va, vb, n = _array(va), _array(vb), _array(n)
        return always(ma, mb, va, vb, n, *rest) if meets(va @ n, vb @ n) else (va, vb)

    return resolve


_BY_ONE = (
    lambda va, vb: va > 0,
    lambda va, vb: vb < 0,
    lambda va, vb: va > 0 or vb < 0,
    lambda va, vb: abs(va) > abs(vb),
    lambda va, vb: va * vb < 0,
)


def _without_masses(share, **terms):
    """Each velocity changes by a part of (1 + e) s, whatever the masses are."""
    return _impact(give=lambda ma, mb: share, kick=lambda j, m, other: j, **terms)


def _without_parentheses(power):
    """(1 + e) s / (1 / ma) + 1 / mb, or with power -1 (1 + e) s / 1 / ma + 1 / mb."""
    return lambda ma, mb, va, vb, e: (1 + e) * (va - vb) * ma**power + 1 / mb if va > vb else 0.0


def _one_after_the_other(ma, mb, va, vb, n, e, mu=0.0):
    """The impulse on b is computed with a's new velocity."""
    va, vb, n = _array(va), _array(vb), _array(n)
    if (va - vb) @ n <= 0:
        return va, vb
    va = va - (1 + e) * ((va - vb) @ n) / _give(ma, mb) / ma * n
    return va, vb + (1 + e) * ((va - vb) @ n) / _give(ma, mb) / mb * n


def _speed_of(speed):
    """On a line: the impulse of ``speed(va, vb)``, where they approach."""
    return lambda ma, mb, va, vb, e: (1 + e) * speed(va, vb) / _give(ma, mb) if va > vb else 0.0


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
    roots=lambda room, speed2: math.sqrt(room / speed2),
    middle=lambda nearing, speed2: nearing / speed2,
    closing_of=lambda va, vb: va - vb,
    real=lambda room: room,
):
    """The first (root -1) or second (+1) time at which the centres are as far apart as the radii reach.

    ``none`` stands for a miss; ``middle`` and ``roots`` are the two terms of the root. ``square`` gives
    what stands for the square of the reach, ``overlap_square`` the same where they overlap.
    """
    overlap_square = overlap_square or square

    def time_of_impact(xa, va, ra, xb, vb, rb, dt):
        apart, closing = _array(xb) - _array(xa), closing_of(_array(va), _array(vb))
        reach, speed2 = radii(ra, rb), float(closing @ closing)
        nearing = float(apart @ closing)
        if apart @ apart <= overlap_square(reach) and overlap != "ignored":
            return 0.0 if nearing > 0 or overlap == "always" else none
        if speed2 == 0.0 or (nearing <= 0 and not past):
            return none
        nearest = nearing / speed2  # when the centres come closest; the rest is Pythagoras
        miss = apart - nearest * closing
        room = real(square(reach) - float(miss @ miss))
        if room < 0:
            return none
        t = middle(nearing, speed2) + root * roots(room, speed2)
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


def _mixed(twice, four, over, other=False):
    """Of two forms of the quadratic formula: b = ``twice`` x . v, b² - ``four`` a c, all over ``over`` a.

    With ``other``, ``over`` c is above and -b + sqrt(...) below.
    """

    def time_of_impact(xa, va, ra, xb, vb, rb, dt):
        x, v = _array(xb) - _array(xa), _array(vb) - _array(va)
        a, b, c = float(v @ v), twice * float(x @ v), float(x @ x) - (ra + rb) ** 2
        if b >= 0 or c <= 0:
            return 0.0 if b < 0 else None
        room = b * b - four * a * c
        root = math.sqrt(max(room, 0.0))
        t = over * c / (root - b) if other else (-b - root) / (over * a)
        return t if room >= 0 and 0 <= t <= dt else None

    return time_of_impact


def _without_root(share):
    """What stands under the square root is used as it is, times ``share``."""
    return _solved(lambda a, b, room: (-b - share * room) / a)


def _solved(root):
    """``root(a, b, room)`` of a t² + 2 b t + c = 0, whatever its sign is."""

    def time_of_impact(xa, va, ra, xb, vb, rb, dt):
        x, v = _array(xb) - _array(xa), _array(vb) - _array(va)
        a, b, c = float(v @ v), float(x @ v), float(x @ x) - (ra + rb) ** 2
        if b >= 0 or c <= 0:
            return 0.0 if b < 0 else None
        room = b * b - a * c
        t = root(a, b, room) if room >= 0 else math.inf
        return t if t <= dt else None

    return time_of_impact


def _miss_in_the_other_form(real):
    """c/(-b + sqrt(room)), where ``real(room)`` stands for what is under the root of a miss."""

    def time_of_impact(xa, va, ra, xb, vb, rb, dt):
        x, v = _array(xb) - _array(xa), _array(vb) - _array(va)
        a, b, c = float(v @ v), float(x @ v), float(x @ x) - (ra + rb) ** 2
        if b >= 0 or c <= 0:
            return 0.0 if b < 0 else None
        t = c / (-b + math.sqrt(real(b * b - a * c)))
        return t if t <= dt else None

    return time_of_impact


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


def whole_vectors(ma, mb, va, vb, n, e):
    """The textbook's formula for a line and e = 1, with vectors in the place of speeds."""
    return _impact(factor=lambda e: 2.0, along=lambda n, u: u / float(u @ n))(ma, mb, va, vb, n, e)


RIGHT = {
    "detect_sphere_sphere": _spheres(),
    "detect_sphere_plane": _plane(),
    "impulse_1d": _line(),
    "resolve": _impact(),
    "resolve_with_friction": _impact(friction=_coulomb),
    "time_of_impact": _moment(),
}

_TOUCHING = (
    ("TOUCHING_INVERTED", lambda deep: deep < 0),
    ("TOUCHING_NEEDS_OVERLAP", lambda deep: deep > 0),
    *each("CONTACT_MARGIN", lambda deep: deep >= -0.01, lambda deep: deep >= -0.001),
    *each("CONTACT_MARGIN", lambda deep: deep >= -0.1, lambda deep: deep >= 0.01),
    ("ALWAYS_TOUCHES", lambda deep: True),
    ("NEVER_TOUCHES", lambda deep: False),
)
_IMPACTS = {
    "acts": (
        ("IMPULSE_ON_SEPARATING", lambda c: True),
        ("APPROACH_REVERSED", lambda c: c < 0),
    ),
    "factor": FACTORS,
    "give": GIVES,
    "shares": (
        ("IMPULSE_REVERSED", (1.0, -1.0)),
        *each("THIRD_LAW_MISSING", (1.0, 1.0), (-1.0, -1.0), (-1.0, 0.0), (0.0, 1.0)),
        *each("THIRD_LAW_MISSING", (-1.0, 0.5), (-0.5, 1.0), (-1.0, 2.0), (-2.0, 1.0)),
        ("IMPULSE_HALVED", (-0.5, 0.5)),
        ("IMPULSE_DOUBLED", (-2.0, 2.0)),
    ),
    "kick": (
        ("MASS_NOT_INVERSE", lambda j, m, other: j * m),
        ("MASSES_IGNORED", lambda j, m, other: j),
        ("MASSES_SWAPPED", lambda j, m, other: j / other),
        *each("MASS_NOT_INVERSE", lambda j, m, other: j * other, lambda j, m, other: j / (m + other)),
        *each("MASS_NOT_INVERSE", lambda j, m, other: j / m**2, lambda j, m, other: j / math.sqrt(m)),
    ),
    "over": each("SAME_MASS_TWICE", lambda ma, mb: (ma, ma), lambda ma, mb: (mb, mb)),
    "along": (
        *each("BLOW_NOT_ALONG_NORMAL", lambda n, u: _unit(u), lambda n, u: -_unit(u)),
        *each("BLOW_NOT_ALONG_NORMAL", lambda n, u: u / float(u @ n), lambda n, u: np.ones(len(n))),
        *each("BLOW_PER_AXIS", lambda n, u: np.sign(n), lambda n, u: n * np.abs(n), lambda n, u: np.abs(n)),
    ),
    "closing_of": (
        ("SPEEDS_NOT_RELATIVE", lambda va, vb, n: float((va + vb) @ n)),
        ("SPEEDS_NOT_RELATIVE", lambda va, vb, n: float(abs(va @ n) + abs(vb @ n))),
        *each("SPEEDS_NOT_RELATIVE", lambda va, vb, n: float(va @ n), lambda va, vb, n: float(-vb @ n)),
        ("SPEED_NOT_ALONG_NORMAL", lambda va, vb, n: _size(va - vb) * _sign((va - vb) @ n)),
        ("SPEED_NOT_ALONG_NORMAL", lambda va, vb, n: _size(va) - _size(vb)),
        ("APPROACH_REVERSED", lambda va, vb, n: float((vb - va) @ n)),
        ("SPEED_UNSIGNED", lambda va, vb, n: abs(float((va - vb) @ n))),
        ("SPEED_SQUARED", lambda va, vb, n: float((va - vb) @ n) * abs(float((va - vb) @ n))),
    ),
    "slow": each("RESTITUTION_DROPPED_WHEN_SLOW", 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01),
    "kept": (
        ("ACROSS_NOT_KEPT", lambda w, n: (w @ n) * n),
        ("ALONG_NOT_KEPT", lambda w, n: w - (w @ n) * n),
    ),
}
_FRICTIONS = {
    "friction": (
        ("FRICTION_IGNORED", _no_friction),
        ("FRICTION_NOT_CLAMPED", lambda p, s, v, g, mu: -mu * p * _unit(s)),
        ("FRICTION_ALWAYS_STICKS", lambda p, s, v, g, mu: -s / g),
        ("FRICTION_ALWAYS_STICKS", lambda p, s, v, g, mu: -s / g if mu > 0 else 0.0 * s),
        ("FRICTION_DRIVES", lambda p, s, v, g, mu: -_coulomb(p, s, v, g, mu)),
        ("FRICTION_PER_AXIS", _per_axis),
        ("FRICTION_AXIS_SIGN_LOST", lambda p, s, v, g, mu: -min(mu * p, v / g) * np.abs(_unit(s))),
        ("FRICTION_AXIS_SIGN_LOST", lambda p, s, v, g, mu: min(mu * p, v / g) * np.abs(_unit(s))),
        ("STICKING_WITHOUT_MASS", lambda p, s, v, g, mu: -min(mu * p, v) * _unit(s)),
        ("STICKING_WITHOUT_MASS", lambda p, s, v, g, mu: -min(mu * p, v * g) * _unit(s)),
        ("FRICTION_TAKES_THE_LARGER", lambda p, s, v, g, mu: -max(mu * p, v / g) * _unit(s)),
        ("FRICTION_PROPORTIONAL", lambda p, s, v, g, mu: -mu * s / g),
        ("FRICTION_PROPORTIONAL", lambda p, s, v, g, mu: -min(mu, 1.0) * s / g),
        ("FRICTION_PROPORTIONAL", lambda p, s, v, g, mu: -mu * p * s),
        ("FRICTION_PROPORTIONAL", lambda p, s, v, g, mu: -min(mu * p * v, v / g) * _unit(s)),
        ("FRICTION_COEFFICIENT_CAPPED", lambda p, s, v, g, mu: _coulomb(p, s, v, g, min(mu, 1.0))),
        ("FRICTION_HALVED", lambda p, s, v, g, mu: _coulomb(p, s, v, g, mu / 2)),
        ("FRICTION_HALVED", lambda p, s, v, g, mu: _coulomb(p, s, v, g, mu) / 2),
        ("FRICTION_DOUBLED", lambda p, s, v, g, mu: _coulomb(p, s, v, g, 2 * mu)),
        ("FRICTION_COEFFICIENT_SQUARED", lambda p, s, v, g, mu: _coulomb(p, s, v, g, mu * mu)),
        ("FRICTION_WITHOUT_MU", lambda p, s, v, g, mu: _coulomb(p, s, v, g, 1.0)),
        ("FRICTION_STOPS_HALF_THE_SLIP", lambda p, s, v, g, mu: -min(mu * p, v / g / 2) * _unit(s)),
        ("FRICTION_STOPS_HALF_THE_SLIP", lambda p, s, v, g, mu: -min(mu * p, v / (2 * g)) * _unit(s)),
        ("FRICTION_SPINS", lambda p, s, v, g, mu: -min(mu * p, v / g * 2 / 7) * _unit(s)),
        ("FRICTION_SPINS", lambda p, s, v, g, mu: -min(mu * p, v / g / 3) * _unit(s)),
        ("FRICTION_STOPS_TWICE_THE_SLIP", lambda p, s, v, g, mu: -min(mu * p, 2 * v / g) * _unit(s)),
        ("FRICTION_ALL_OR_NOTHING", lambda p, s, v, g, mu: -s / g if mu * p >= v / g else 0.0 * s),
        ("FRICTION_NOT_UNIT", lambda p, s, v, g, mu: -min(mu * p, v / g) * s),
        ("FRICTION_WITHOUT_BLOW", lambda p, s, v, g, mu: -min(mu, v / g) * _unit(s)),
    ),
    "friction_shares": (
        *each("FRICTION_THIRD_LAW_MISSING", (-1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (-1.0, -1.0)),
        *each("FRICTION_THIRD_LAW_MISSING", (-1.0, 0.5), (-0.5, 1.0)),
    ),
    "rubs_over": (
        *each("FRICTION_OVER_OTHER_MASS", lambda ma, mb: (mb, ma), lambda ma, mb: (ma, ma)),
        ("FRICTION_OVER_OTHER_MASS", lambda ma, mb: (mb, mb)),
    ),
    "slip_of": (
        ("FRICTION_NOT_RELATIVE", lambda va, vb, s, n: -(va - (va @ n) * n)),
        ("FRICTION_NOT_RELATIVE", lambda va, vb, s, n: vb - (vb @ n) * n),
        ("FRICTION_NOT_RELATIVE", lambda va, vb, s, n: s + 2 * (va - (va @ n) * n)),
        ("FRICTION_NOT_ACROSS", lambda va, vb, s, n: vb - va),
        ("FRICTION_NOT_ACROSS", lambda va, vb, s, n: vb - va - (vb - va) @ n),
        ("FRICTION_NOT_ACROSS", lambda va, vb, s, n: s - 2 * ((vb - va) @ n) * n),
    ),
}

#: For each task its family, the values it takes for granted, and its terms.
TERMS = {
    "detect_sphere_sphere": (
        _spheres,
        {},
        {
            "normal": (
                ("NORMAL_REVERSED", lambda w, d: -w / d),
                *each("NORMAL_NOT_UNIT", lambda w, d: w, lambda w, d: w / d**2),
                *each("NORMAL_NOT_UNIT", lambda w, d: w / math.sqrt(d), lambda w, d: w / 2),
                *each("NORMAL_PER_AXIS", lambda w, d: np.sign(w), lambda w, d: np.abs(w) / d),
                *each("NORMAL_PER_AXIS", lambda w, d: w / np.abs(w).sum(), lambda w, d: w / np.abs(w).max()),
            ),
            "depth": (
                ("DEPTH_SIGN_FLIPPED", lambda r, d: d - r),
                ("DEPTH_CLAMPED", lambda r, d: max(r - d, 0.0)),
                ("DEPTH_UNSIGNED", lambda r, d: abs(r - d)),
                *each("DISTANCE_SQUARED", lambda r, d: r - d * d, lambda r, d: r * r - d * d),
                ("DISTANCE_SQUARED", lambda r, d: r - math.sqrt(d)),
                ("DEPTH_HALVED", lambda r, d: (r - d) / 2),
                *each("DEPTH_AS_SHARE", lambda r, d: (r - d) / r, lambda r, d: (r - d) / d),
                ("RADIUS_IGNORED", lambda r, d: -d),
                ("DISTANCE_IGNORED", lambda r, d: r),
            ),
            "touching": (*_TOUCHING, ("TOUCHING_INVERTED", lambda deep: deep <= 0)),
            "radii": (
                ("RADIUS_IGNORED", lambda a, b: 0.0),
                *each("ONE_RADIUS_ONLY", lambda a, b: a, lambda a, b: b, max, min, lambda a, b: 2 * a),
                ("ONE_RADIUS_ONLY", lambda a, b: 2 * b),
                *each("RADII_SUBTRACTED", lambda a, b: a - b, lambda a, b: abs(a - b)),
                ("RADII_HALVED", lambda a, b: (a + b) / 2),
                ("RADII_MULTIPLIED", lambda a, b: a * b),
                ("RADII_SQUARED_APART", math.hypot),
            ),
            "length": (
                *each("DISTANCE_BY_COORDINATES", lambda w: _size(w[:2]), lambda w: _size(w[-2:])),
                *each("DISTANCE_BY_COORDINATES", lambda w: _size(w[::2]), lambda w: abs(float(w[0]))),
                ("DISTANCE_BY_COORDINATES", lambda w: abs(float(w.sum()))),
                ("DISTANCE_BY_COORDINATES", lambda w: float(np.abs(w).sum())),
                ("DISTANCE_BY_COORDINATES", lambda w: float(np.abs(w).max())),
            ),
        },
    ),
    "detect_sphere_plane": (
        _plane,
        {},
        {
            "normal": (
                ("NORMAL_REVERSED", lambda n: -n),
                ("NORMAL_NOT_UNIT", lambda n: 2 * n),
                *each("NORMAL_PER_AXIS", np.abs, np.sign),
            ),
            "gap": (
                ("DISTANCE_UNSIGNED", lambda x, p, n: abs(float((x - p) @ n))),
                ("PLANE_POINT_IGNORED", lambda x, p, n: float(x @ n)),
                ("PLANE_POINT_IGNORED", lambda x, p, n: float(x @ n) + float(p @ n)),
                ("PLANE_ASSUMED_LEVEL", lambda x, p, n: float(x[-1] - p[-1])),
                ("PLANE_ASSUMED_LEVEL", lambda x, p, n: float(x[-1])),
                ("PLANE_ASSUMED_LEVEL", lambda x, p, n: float(x[min(1, len(x) - 1)] - p[min(1, len(x) - 1)])),
                ("DISTANCE_TO_POINT", lambda x, p, n: _size(x - p)),
                ("SOLID_ON_THE_WRONG_SIDE", lambda x, p, n: -float((x - p) @ n)),
                ("CENTRE_IGNORED", lambda x, p, n: float(p @ n)),
                ("DISTANCE_SQUARED", lambda x, p, n: float((x - p) @ n) ** 2),
                ("NORMAL_PER_AXIS", lambda x, p, n: float((x - p) @ np.abs(n))),
                ("NORMAL_PER_AXIS", lambda x, p, n: float(np.sum(x - p))),
            ),
            "depth": (
                ("DEPTH_SIGN_FLIPPED", lambda r, s: s - r),
                *each("DEPTH_CLAMPED", lambda r, s: max(r - s, 0.0), lambda r, s: min(r - s, r)),
                ("DEPTH_CLAMPED", lambda r, s: min(r - s, 2 * r)),
                ("DEPTH_UNSIGNED", lambda r, s: abs(r - s)),
                ("RADIUS_IGNORED", lambda r, s: -s),
                ("RADIUS_ADDED_TWICE", lambda r, s: 2 * r - s),
                ("RADII_HALVED", lambda r, s: r / 2 - s),
                ("RADIUS_SIGN_FLIPPED", lambda r, s: -r - s),
                ("DEPTH_HALVED", lambda r, s: (r - s) / 2),
                ("DEPTH_AS_SHARE", lambda r, s: (r - s) / r),
                ("DISTANCE_SQUARED", lambda r, s: r * r - s * s),
                ("DISTANCE_IGNORED", lambda r, s: r),
            ),
            "touching": (
                *_TOUCHING,
                ("TOUCHING_INVERTED", lambda deep: deep <= 0),
            ),
        },
    ),
    "impulse_1d": (
        _line,
        {},
        {
            "acts": (
                ("IMPULSE_ON_SEPARATING", lambda c: True),
                ("APPROACH_REVERSED", lambda c: c < 0),
                ("NO_RESPONSE", lambda c: False),
            ),
            "factor": FACTORS,
            "give": GIVES,
            "closing": (
                *each("SPEEDS_NOT_RELATIVE", lambda va, vb: va + vb, lambda va, vb: abs(va) + abs(vb)),
                *each("SPEEDS_NOT_RELATIVE", lambda va, vb: va, lambda va, vb: -vb),
                ("SPEEDS_NOT_RELATIVE", lambda va, vb: abs(va) - abs(vb)),
                ("APPROACH_REVERSED", lambda va, vb: vb - va),
                ("SPEED_UNSIGNED", lambda va, vb: abs(va - vb)),
            ),
            "share": (
                ("IMPULSE_REVERSED", -1.0),
                ("IMPULSE_HALVED", 0.5),
                ("IMPULSE_DOUBLED", 2.0),
            ),
            "power": (("SPEED_SQUARED", 2), ("SPEED_SQUARED", 0.5), ("SPEED_IGNORED", 0)),
            "slow": _IMPACTS["slow"],
        },
    ),
    "resolve": (_impact, {}, _IMPACTS),
    "resolve_with_friction": (_impact, {"friction": _coulomb}, _FRICTIONS | _IMPACTS),
    "time_of_impact": (
        _moment,
        {},
        {
            "root": (
                ("TIME_OF_IMPACT_LATE_ROOT", 1.0),
                ("CLOSEST_APPROACH", 0.0),
                ("ROOT_HALVED", -0.5),
                ("ROOT_DOUBLED", -2.0),
            ),
            "limit": (("IMPACT_BEYOND_STEP", False),),
            "past": (("IMPACT_IN_THE_PAST", True),),
            "overlap": (("OVERLAP_IGNORED", "ignored"), ("OVERLAP_ALWAYS_HITS", "always")),
            "radii": (
                ("RADIUS_IGNORED", lambda a, b: 0.0),
                *each("ONE_RADIUS_ONLY", lambda a, b: a, lambda a, b: b, max),
                ("RADII_SQUARED_APART", math.hypot),
                ("RADII_SUBTRACTED", lambda a, b: abs(a - b)),
                ("RADII_HALVED", lambda a, b: (a + b) / 2),
                ("RADIUS_ADDED_TWICE", lambda a, b: 2 * (a + b)),
            ),
            "square": (*each("RADII_NOT_SQUARED", lambda reach: reach, lambda reach: 2 * reach),),
            "overlap_square": (("OVERLAP_IGNORED", lambda reach: 0.0),),
            "unit": (
                ("RETURNS_SHARE_OF_STEP", lambda t, dt: t / dt),
                ("RETURNS_TIME_LEFT", lambda t, dt: dt - t),
                *each("RETURNS_THE_STEP", lambda t, dt: dt, lambda t, dt: 0.0),
                ("TIME_NEGATED", lambda t, dt: -t),
            ),
            "none": each("MISS_IS_A_NUMBER", -1.0, 0.0, -1, math.inf, math.nan, False),
            "roots": (
                ("ROOT_TERM_WRONG", lambda room, speed2: math.sqrt(room)),
                ("ROOT_TERM_WRONG", lambda room, speed2: math.sqrt(room * speed2)),
                ("ROOT_TERM_WRONG", lambda room, speed2: math.sqrt(room) / speed2),
                ("ROOT_TERM_WRONG", lambda room, speed2: room / speed2),
            ),
            "closing_of": (
                *each("MOTION_NOT_RELATIVE", lambda va, vb: -vb, lambda va, vb: va, lambda va, vb: va + vb),
                ("MOTION_NOT_RELATIVE", lambda va, vb: -va - vb),
                ("MOTION_REVERSED", lambda va, vb: vb - va),
            ),
            "real": (("MISS_NOT_SEEN", abs), ("MISS_NOT_SEEN", lambda room: max(room, 0.0))),
            "middle": (
                ("MIDDLE_TERM_WRONG", lambda nearing, speed2: nearing),
                ("MIDDLE_TERM_WRONG", lambda nearing, speed2: nearing / math.sqrt(speed2)),
                ("MIDDLE_TERM_WRONG", lambda nearing, speed2: 2 * nearing / speed2),
                ("MIDDLE_TERM_WRONG", lambda nearing, speed2: nearing / speed2 / 2),
            ),
        },
    ),
}

#: Wrong in another way than by one or two terms: per task, codes and formula.
OTHERS = {
    "detect_sphere_sphere": [
        (("DEPTH_SIGN_FLIPPED",), _spheres(depth=lambda r, d: d - r, touching=lambda deep: deep <= 0)),
        (
            ("DEPTH_SIGN_FLIPPED", "TOUCHING_NEEDS_OVERLAP"),
            _spheres(depth=lambda r, d: d - r, touching=lambda deep: deep < 0),
        ),
        (("DEPTH_CLAMPED",), _spheres(depth=lambda r, d: max(r - d, 0.0), touching=lambda deep: deep > 0)),
        (("DEPTH_UNSIGNED",), _spheres(depth=lambda r, d: abs(r - d), touching=lambda deep: True)),
    ],
    "detect_sphere_plane": [
        (("DEPTH_SIGN_FLIPPED",), _plane(depth=lambda r, s: s - r, touching=lambda deep: deep <= 0)),
        (
            ("DEPTH_SIGN_FLIPPED", "TOUCHING_NEEDS_OVERLAP"),
            _plane(depth=lambda r, s: s - r, touching=lambda deep: deep < 0),
        ),
        (("DEPTH_CLAMPED",), _plane(depth=lambda r, s: max(r - s, 0.0), touching=lambda deep: deep > 0)),
        (("NORMAL_REVERSED",), _plane(gap=lambda x, p, n: -float((x - p) @ n), normal=lambda n: -n)),
        (("LENGTH_OF_THE_POINT",), _plane(gap=lambda x, p, n: float(x @ n) - _size(p))),
    ],
    "impulse_1d": [
        (("ONLY_THE_REBOUND",), _line(factor=lambda e: 2 * e)),
        (("IMPULSE_AS_VELOCITY",), lambda ma, mb, *rest: _line()(ma, mb, *rest) / ma),
        (("IMPULSE_AS_VELOCITY",), lambda ma, mb, *rest: _line()(ma, mb, *rest) / mb),
        (("IMPULSE_AS_VELOCITY",), lambda ma, mb, *rest: _line()(ma, mb, *rest) * _give(ma, mb)),
        *((("PARENTHESES_MISSING",), _without_parentheses(first)) for first in (1, -1)),
        (("ONLY_HEAD_ON",), _strikes_if(lambda va, vb: va > 0 > vb)),
        (("ONLY_HEAD_ON",), _strikes_if(lambda va, vb: va * vb <= 0)),
        *((("APPROACH_BY_ONE_BODY",), _approach_by(meets)) for meets in _BY_ONE),
        *((("APPROACH_BY_ONE_BODY",), _strikes_if(meets)) for meets in (*_BY_ONE[:2], _BY_ONE[3])),
        *each(("SPEEDS_NOT_RELATIVE",), _speed_of(lambda va, vb: va), _speed_of(lambda va, vb: -vb)),
        (("SPEEDS_NOT_RELATIVE",), _speed_of(lambda va, vb: va + vb)),
        (("SPEEDS_NOT_RELATIVE",), _speed_of(lambda va, vb: abs(va) + abs(vb))),
    ],
    "resolve": [
        *((("MASSES_IGNORED",), _without_masses(share)) for share in (1.0, 2.0)),
        (("VELOCITIES_SCALED",), _scaled()),
        (("RESTITUTION_ON_TOP",), _scaled(factor=lambda e: 1 + e)),
        (("ONLY_HEAD_ON",), _from_both_sides(_impact())),
        *((("APPROACH_BY_ONE_BODY",), _approach_in_space(meets)) for meets in _BY_ONE),
        (("IMPULSE_COMPUTED_TWICE",), _one_after_the_other),
        (("APPROACH_REVERSED",), _reversed(_impact())),
        (("ACROSS_NOT_KEPT",), _only_along),
        (("EACH_BODY_ALONE",), _each_alone),
        (("RETURNS_SWAPPED",), _swapped(_impact())),
        (("MASSES_SWAPPED",), _exchanged(_impact())),
        (("ELASTIC_EXCHANGE",), _exchange),
        (("PERFECTLY_STICKY",), _stick),
    ],
    "resolve_with_friction": [
        (("ONLY_THE_REBOUND",), _impact(factor=lambda e: 2 * e, friction=_coulomb)),
        (("APPROACH_REVERSED",), _reversed(_impact(friction=_coulomb))),
        *((("MASSES_IGNORED",), _without_masses(share, friction=_coulomb)) for share in (1.0, 2.0)),
        (("ONLY_HEAD_ON",), _from_both_sides(_impact(friction=_coulomb))),
        *((("APPROACH_BY_ONE_BODY",), _approach_in_space(meets, friction=_coulomb)) for meets in _BY_ONE),
        (("FRICTION_WITHOUT_REBOUND",), _friction_without_rebound),
        (("FRICTION_EACH_ALONE",), _each_rubs(lambda m, give: 1.0)),
        (("FRICTION_EACH_ALONE",), _each_rubs(lambda m, give: 1 / (m * give))),
        (("VELOCITIES_SCALED",), _scaled(_coulomb)),
        (("RESTITUTION_ON_TOP",), _scaled(_coulomb, lambda e: 1 + e)),
        *each(("FRICTION_OF_A_SPEED",), _rubs_by_speed(lambda e: 1.0), _rubs_by_speed(lambda e: 1 + e)),
        (("FRICTION_OF_A_SPEED",), _rubs_by_speed(lambda e: e)),
        (("FRICTION_ONLY_WHILE_SLIDING",), _impact(friction=_rubs_while_sliding)),
        (("FRICTION_OTHER_COMPARISON",), _sticks_up_to(lambda mu, s, j: mu * s)),
        (("FRICTION_OTHER_COMPARISON",), _sticks_up_to(lambda mu, s, j: mu * j)),
        (("FRICTION_OTHER_COMPARISON",), _sticks_up_to(lambda mu, s, j: mu)),
        *each(("STICKING_WITHOUT_MASS",), _held_by(lambda ma, mb: ma + mb), _held_by(lambda ma, mb: ma)),
        (("STICKING_WITHOUT_MASS",), _held_by(lambda ma, mb: mb)),
        (("STICKING_WITHOUT_MASS",), _held_by(lambda ma, mb: (ma + mb) / 2)),
        (("EACH_BODY_ALONE",), _each_alone),
        (("RETURNS_SWAPPED",), _swapped(_impact(friction=_coulomb))),
        (("MASSES_SWAPPED",), _exchanged(_impact(friction=_coulomb))),
        (("ELASTIC_EXCHANGE",), _exchange),
        (("PERFECTLY_STICKY",), _stick),
    ],
    "time_of_impact": [
        *each(("TUNNELS",), _at_the_end_only(exact=False), _at_the_end_only(exact=True)),
        *(
            (("QUADRATIC_MIXED",), _mixed(*form, other))
            for form in ((1, 4, 2), (1, 1, 2), (1, 4, 1), (2, 1, 1), (2, 1, 2), (2, 4, 1))
            for other in (False, True)
        ),
        *((("ROOT_TERM_WRONG",), _without_root(share)) for share in (1.0, 2.0)),
        (("TIME_NEGATED",), _solved(lambda a, b, room: (b + math.sqrt(room)) / a)),
        (("MIDDLE_TERM_WRONG",), _solved(lambda a, b, room: (b - math.sqrt(room)) / a)),
        *each(("MISSES_COUNT_AS_HITS",), _head_on_always, _gap_over_speed),
        *((("MISS_NOT_SEEN",), _miss_in_the_other_form(real)) for real in (abs, lambda room: max(room, 0.0))),
        (("APPROACH_NOT_ASKED",), _moment(past=True, overlap="always")),
        (("IMPACT_IN_THE_PAST",), _moment(past=True, overlap="ignored")),
        (("RADII_NOT_SQUARED",), _moment(square=lambda reach: reach, overlap="ignored", past=True)),
        (
            ("RADII_NOT_SQUARED",),
            _moment(square=lambda reach: reach, overlap_square=lambda reach: reach**2),
        ),
        (("NEVER_FINDS_A_CONTACT",), lambda *_: None),
        (("MISS_IS_A_NUMBER",), _moment(none=-1.0, limit=True)),
    ],
}
