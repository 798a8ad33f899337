"""Wrong programs for the tasks of ``engine-comparison``, as functions: what a diagnosis is compared with.

Of ``characterise`` each is the model solution with one key measured in another way.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from course.scoring import kit

choosing = kit.sibling(__file__, "choosing")
model = kit.sibling(__file__, "engine_comparison")


def hypotheses():
    """Task, codes of what is wrong, and function of each, those with one mistake first."""
    for key, forms in _KEYS.items():
        for code, measure in forms:
            yield "characterise", (code,), _with(key, measure)
    for code, forms in choosing.METS.items():
        for met in forms:
            yield "choose_engine", (code,), _choosing(choosing.choose, met)
    for code, forms in choosing.CHOICES.items():
        for choice in forms:
            yield "choose_engine", (code,), _choosing(choice, choosing.meets)
    for (one, mets), (other, forms) in itertools.product(choosing.METS.items(), choosing.CHOICES.items()):
        for met, choice in itertools.product(mets[:1], forms[:1]):
            yield "choose_engine", (one, other), _choosing(choice, met)


def _choosing(choice, met):
    return lambda reports, requirements: choice(reports, requirements, met=met)


def _with(key, measure):
    """``characterise`` with one key measured by ``measure(engine, info)``."""

    def characterise(engine):
        info = engine.info()
        measures = _RIGHT | {key: measure}  # nothing is run for the key that is measured in another way
        return {each: of(engine, info) for each, of in measures.items()}

    return characterise


_RIGHT = {
    "order": lambda engine, info: model._order(engine, info["omega"]),
    "symplectic": lambda engine, info: _area()(engine, info),
    "linear_damping": lambda engine, info: model._linear_damping(engine, info["dt"]),
    "max_stable_step": lambda engine, info: model._max_stable_z(engine, info["omega"]) / info["omega"],
    "friction_anisotropy": model._anisotropy,
    "rest_penetration": lambda engine, info: max(0.0, info["radius"] - model._settled(engine, info)[2]),
    "restitution": lambda engine, info: model._slow_hit(engine, info)[0],
    "tunnelling_speed": model._tunnelling_speed,
    "deterministic": lambda engine, info: model._deterministic(engine, info["dt"]),
}


def _of(key, change):
    """The right value, changed: ``change(value, info)``."""
    return lambda engine, info: change(_RIGHT[key](engine, info), info)


# -- order ------------------------------------------------------------------------------------------------


def _order(ns=(16, 32, 64), start=(1.0, 0.7), span=1.3, log=math.log2, whole=round, gaps=None, turn=False):
    """``gaps``: which two numbers the ends y1, y2, y3 are made into."""
    gaps = gaps or (lambda y: (np.linalg.norm(y[0] - y[1]), np.linalg.norm(y[1] - y[2])))

    def measure(engine, info):
        omega = info["omega"]

        def end(n):
            q, v = engine.run("spring", [start[0]], [start[1] * omega], span / omega / n, n, [0.0])
            return np.array([q[-1][0], 0.0 if turn else v[-1][0] / omega])

        coarse, fine = gaps([end(n) for n in ns])
        return whole(log(coarse / fine))

    return measure


def _against_exact(start=(1.0, 0.7), span=1.3):
    turned = start[0] * math.cos(span) + start[1] * math.sin(span)
    moving = start[1] * math.cos(span) - start[0] * math.sin(span)
    exact = np.array([turned, moving])
    return _order(
        (32, 64, 64), start, span, gaps=lambda y: (np.linalg.norm(y[0] - exact), np.linalg.norm(y[1] - exact))
    )


def _same_step(engine, info):
    omega = info["omega"]

    def end(n):
        q, v = engine.run("spring", [1.0], [0.7 * omega], 0.05 / omega, n, [0.0])
        return np.array([q[-1][0], v[-1][0] / omega])

    y = [end(n) for n in (16, 32, 64)]
    return round(math.log2(np.linalg.norm(y[0] - y[1]) / np.linalg.norm(y[1] - y[2])))


def _to_the_coarsest(y):
    return np.linalg.norm(y[0] - y[1]), np.linalg.norm(y[0] - y[2])


def _to_the_finest(y):
    return np.linalg.norm(y[0] - y[2]), np.linalg.norm(y[1] - y[2])


def _squares(y):
    return np.sum((y[0] - y[1]) ** 2), np.sum((y[1] - y[2]) ** 2)


def _upside_down(y):
    return np.linalg.norm(y[1] - y[2]), np.linalg.norm(y[0] - y[1])


def _down(x):
    return int(x)


_ORDER = (
    ("ORDER_AGAINST_UNDAMPED", _against_exact()),
    ("ORDER_AGAINST_UNDAMPED", _against_exact((1.0, 0.0), 1.0)),
    ("ORDER_LOCAL", _of("order", lambda p, _: p + 1)),
    ("ORDER_SIGN", _order(gaps=_upside_down)),
    ("ORDER_WITHOUT_LOG", _order(log=lambda x: x)),
    ("ORDER_OTHER_LOG", _order(log=math.log)),
    ("ORDER_OTHER_LOG", _order(log=math.log10)),
    ("ORDER_STEPS_NOT_HALVED", _order((16, 64, 256))),
    ("ORDER_STEPS_NOT_HALVED", _order((10, 100, 1000))),
    ("ORDER_STEPS_NOT_HALVED", _order((16, 48, 144))),
    ("ORDER_STEPS_NOT_HALVED", _order(gaps=_squares)),
    ("ORDER_OF_OTHER_DIFFERENCES", _order(gaps=_to_the_coarsest)),
    ("ORDER_OF_OTHER_DIFFERENCES", _order(gaps=lambda y: _to_the_coarsest(y)[::-1])),
    *(
        ("ORDER_NOT_THREE", _of("order", lambda p, _, other=other: other if p == 3 else p))
        for other in (2, 4)
    ),
    ("ORDER_AGAINST_FINEST", _order(gaps=_to_the_finest)),
    ("ORDER_ROUNDED_DOWN", _order(whole=_down)),
    ("ORDER_ROUNDED_DOWN", _order((32, 64, 128), whole=_down)),
    ("ORDER_ROUNDED_DOWN", _order(whole=math.ceil)),
    ("ORDER_TIME_NOT_FIXED", _same_step),
    ("ORDER_AT_TURNING_POINT", _order(start=(1.0, 0.0), span=math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order(start=(1.0, 0.0), span=2 * math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order((64, 128, 256), (1.0, 0.0), math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order((64, 128, 256), (1.0, 0.0), 2 * math.pi, turn=True)),
    ("ORDER_AT_TURNING_POINT", _order(start=(1.0, 0.0), span=2 * math.pi)),
    ("ORDER_IN_ROUNDING", _order((4000, 8000, 16000))),
    ("ORDER_IN_ROUNDING", _order((2000, 4000, 8000))),
    ("ORDER_STEPS_TOO_LARGE", _order((2, 4, 8), span=5.3)),
    ("ORDER_STEPS_TOO_LARGE", _order((1, 2, 4), span=5.3)),
    ("ORDER_STEPS_TOO_LARGE", _order((1, 2, 4), span=2.0)),
    ("ORDER_ASSUMED", lambda engine, info: 1),
    ("ORDER_ASSUMED", lambda engine, info: 2),
)

# -- one spring step --------------------------------------------------------------------------------------


def _step(engine, info, z, back=True, scaled=True):
    """The matrix of a spring step of h omega = z; ``back``: velocities are divided by omega again."""
    omega = info["omega"]
    columns = []
    for q0, v0 in ((1.0, 0.0), (0.0, omega if scaled else 1.0)):
        q, v = engine.run("spring", [q0], [v0], z / omega, 1, [0.0])
        columns.append((q[1][0], v[1][0] / (omega if back else 1.0)))
    return np.transpose(columns)


def _area(z=0.5, least=1e-6, looks=lambda det, least: abs(det - 1) < least, **kinds):
    return lambda engine, info: bool(looks(np.linalg.det(_step(engine, info, z, **kinds)), least))


def _energy(steps, z, least, sided=False):
    def measure(engine, info):
        q, v = engine.run("spring", [1.0], [0.0], z / info["omega"], steps, [0.0])
        change = q[-1][0] ** 2 + (v[-1][0] / info["omega"]) ** 2 - 1
        return bool((change if sided else abs(change)) < least)

    return measure


_SYMPLECTIC = (
    ("SYMPLECTIC_INVERTED", _of("symplectic", lambda value, _: not value)),
    ("STABLE_TAKEN_FOR_SYMPLECTIC", _area(looks=lambda det, least: det - 1 < least)),
    ("STABLE_TAKEN_FOR_SYMPLECTIC", _area(looks=lambda det, least: abs(det) <= 1 + least)),
    ("SYMPLECTIC_TOLERANCE", _area(least=1e-2)),
    ("SYMPLECTIC_TOLERANCE", _area(least=0.1)),
    ("SYMPLECTIC_TOLERANCE", _area(least=1e-3)),
    ("SYMPLECTIC_STEP_TOO_SMALL", _area(z=1e-3)),
    ("SYMPLECTIC_STEP_TOO_SMALL", _area(z=0.01)),
    ("SYMPLECTIC_NEVER", _area(back=False)),
    ("SYMPLECTIC_NEVER", _area(scaled=False)),
    ("SYMPLECTIC_BY_ENERGY", _energy(100, 0.05, 0.1)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.05, 0.1)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.05, 0.01)),
    ("SYMPLECTIC_BY_ENERGY", _energy(100, 0.05, 0.01)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.01, 0.01)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1000, 0.01, 0.05)),
    ("SYMPLECTIC_BY_ENERGY", _energy(1, 0.5, 0.1)),
)

# -- damping ----------------------------------------------------------------------------------------------


def _damping(change):
    return _of("linear_damping", change)


def _at_dt(divisor, rate):
    def measure(engine, info):
        h = info["dt"] / divisor
        _, v = engine.run("free", [0.0], [1.0], h, 100, [0.0])
        return rate(v, h)

    return measure


def _envelope(engine, info):
    omega, h, n = info["omega"], info["dt"] / 50, 5000
    q, v = engine.run("spring", [1.0], [0.0], h, n, [0.0])
    return -math.log(math.hypot(q[-1][0], v[-1][0] / omega)) / (n * h)


_DAMPING = (
    ("DAMPING_ASSUMED", _damping(lambda c, _: 0.0)),
    ("DAMPING_SIGN", _damping(lambda c, _: -c)),
    ("DAMPING_OF_ENERGY", _damping(lambda c, _: 2 * c)),
    ("DAMPING_OF_ENVELOPE", _damping(lambda c, _: c / 2)),
    ("DAMPING_OF_ENVELOPE", _envelope),
    ("DAMPING_OTHER_LOG", _damping(lambda c, _: c / math.log(10))),
    ("DAMPING_OTHER_LOG", _damping(lambda c, _: c / math.log(2))),
    ("DAMPING_TIME_CONSTANT", _damping(lambda c, _: 1 / c if c > 1e-9 else 0.0)),
    ("DAMPING_TIME_CONSTANT", _damping(lambda c, _: 1 / c if c > 1e-9 else math.inf)),
    ("DAMPING_TIME_CONSTANT", _damping(lambda c, _: math.log(2) / c if c > 1e-9 else math.inf)),
    ("DAMPING_AS_FORCE", _damping(lambda c, info: c * info["mass"])),
    ("DAMPING_PER_STEP", _damping(lambda c, info: c * info["dt"])),
    ("DAMPING_PER_STEP", _damping(lambda c, info: c * info["dt"] / 1000)),
    ("DAMPING_AT_DT", _at_dt(1, lambda v, h: -math.log(v[-1][0]) / (100 * h))),
    ("DAMPING_AT_DT", _at_dt(1, lambda v, h: (1 - v[1][0]) / h)),
    ("DAMPING_AT_DT", _at_dt(2, lambda v, h: -math.log(v[-1][0]) / (100 * h))),
)

# -- the largest stable step ------------------------------------------------------------------------------


def _radius(m):
    return max(abs(np.linalg.eigvals(m)))


def _search(
    size=_radius, limit=1 + 1e-8, walk=0.5, last=10.0, endless=math.inf, unstable=0.0, fine=True, **kinds
):
    """``unstable``: what is returned where the first step fails, None for that step itself."""

    def measure(engine, info):
        omega = info["omega"]

        def stable(z):
            return bool(size(_step(engine, info, z, **kinds)) <= limit)

        low = 0.05
        if not stable(low):
            return unstable if unstable is not None else low / omega
        while stable(low + walk):
            low += walk
            if low >= last:
                return endless if endless is not None else last / omega
        return (model._bisect(stable, low, low + walk, 0.004 * low) if fine else low) / omega

    return measure


def _jumped(last):
    """One bisection over the whole range."""

    def measure(engine, info):
        def stable(z):
            return bool(_radius(_step(engine, info, z)) <= 1 + 1e-8)

        if not stable(0.05):
            return 0.0
        return math.inf if stable(last) else model._bisect(stable, 0.05, last, 0.001 * last) / info["omega"]

    return measure


def _from_above(engine, info):
    z = 10.0
    while z > 0.05 and not _radius(_step(engine, info, z)) <= 1 + 1e-8:
        z -= 0.01
    return math.inf if z >= 10 else z / info["omega"] if z > 0.05 else 0.0


def _by_eye(steps, most):
    def measure(engine, info):
        omega = info["omega"]

        def stable(z):
            q, _ = engine.run("spring", [1.0], [0.0], z / omega, steps, [0.0])
            return bool(np.all(np.isfinite(q)) and abs(q[-1][0]) < most)

        low = 0.05
        if not stable(low):
            return 0.0
        while stable(low + 0.5):
            low += 0.5
            if low >= 10:
                return math.inf
        return model._bisect(stable, low, low + 0.5, 0.004 * low) / omega

    return measure


_STABLE = (
    ("LIMIT_ASSUMED", lambda engine, info: 2 / info["omega"]),
    ("LIMIT_ASSUMED", lambda engine, info: math.sqrt(2) / info["omega"]),
    ("RETURNS_Z", _of("max_stable_step", lambda h, info: h * info["omega"])),
    ("STABLE_BY_DETERMINANT", _search(lambda m: abs(np.linalg.det(m)))),
    *(("STABLE_BY_TRACE", _search(lambda m: abs(np.trace(m)) / 2, walk=walk)) for walk in (0.5, 0.25, 0.05)),
    ("EIGENVALUES_WITHOUT_MODULUS", _search(lambda m: np.linalg.eigvals(m).real.max())),
    ("EIGENVALUES_WITHOUT_MODULUS", _search(lambda m: abs(np.linalg.eigvals(m).real).max())),
    ("SMALLEST_EIGENVALUE", _search(lambda m: min(abs(np.linalg.eigvals(m))))),
    ("STABLE_BY_NORM", _search(lambda m: np.linalg.norm(m, 2))),
    ("STABLE_BY_NORM", _search(lambda m: np.linalg.norm(m))),
    ("TOLERANCE_TOO_TIGHT", _search(limit=1 - 1e-12)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.01)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.001)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.05)),
    ("TOLERANCE_TOO_LOOSE", _search(limit=1.1)),
    ("LIMIT_FROM_ABOVE", _jumped(10.0)),
    ("LIMIT_FROM_ABOVE", _from_above),
    ("LIMIT_FROM_ABOVE", _search(walk=4.0)),
    ("LIMIT_NOT_SCALED", _search(scaled=False)),
    ("LIMIT_COARSE", _search(fine=False)),
    ("LIMIT_COARSE", _search(walk=0.25, fine=False)),
    ("NO_INFINITY", _search(endless=None)),
    ("NO_INFINITY", _search(endless=0.0)),
    ("NO_ZERO", _search(unstable=None)),
    ("NO_ZERO", _search(unstable=math.inf)),
    *(("NO_ZERO", _by_eye(steps, most)) for steps in (100, 300, 1000) for most in (2.0, 10.0, 1e3)),
)

# -- the floor --------------------------------------------------------------------------------------------

_ROOT = math.sqrt(0.5)


def _forces(diagonal=(_ROOT, _ROOT), straight=(1.0, 0.0), settled=True, slides=0.01, steps=1.0):
    """The least forces along two directions."""

    def of(engine, info):
        dt = info["dt"] / steps
        start = model._settled(engine, info) if settled else [0.0, 0.0, info["radius"]]
        n, most = round(0.5 / dt), 5 * info["mu"] * info["mass"] * info["g"]

        def least(direction):
            def sticks(force):
                push = [force * direction[0], force * direction[1], 0.0]
                _, v = engine.run("floor", start, [0.0] * 3, dt, n, push)
                return max(math.hypot(a, b) for a, b, _ in v) <= slides

            return model._bisect(sticks, 0.0, most, 0.001 * most)

        return least(diagonal), least(straight)

    return of


def _ratio(of=None, made=lambda diagonal, straight, info: diagonal / straight, **how):
    of = of or _forces(**how)
    return lambda engine, info: made(*of(engine, info), info)


_FRICTION = (
    ("ANISOTROPY_ASSUMED", lambda engine, info: 1.0),
    ("ANISOTROPY_ASSUMED", lambda engine, info: math.sqrt(2)),
    ("ANISOTROPY_INVERTED", _ratio(made=lambda d, s, _: s / d)),
    ("DIAGONAL_COMPONENT", _ratio(diagonal=(1.0, 1.0))),
    ("DIAGONAL_COMPONENT", _of("friction_anisotropy", lambda ratio, _: ratio * math.sqrt(2))),
    ("ANISOTROPY_IS_DIFFERENCE", _ratio(made=lambda d, s, _: d / s - 1)),
    ("ANISOTROPY_IS_DIFFERENCE", _ratio(made=lambda d, s, _: d - s)),
    ("ANISOTROPY_IS_COEFFICIENT", _ratio(made=lambda d, s, info: s / info["mass"] / info["g"])),
    ("ANISOTROPY_IS_COEFFICIENT", _ratio(made=lambda d, s, info: d / info["mass"] / info["g"])),
    ("ANISOTROPY_IS_COEFFICIENT", lambda engine, info: info["mu"]),
    ("ANISOTROPY_BY_FORMULA", _ratio(made=lambda d, s, info: d / info["mu"] / info["mass"] / info["g"])),
    ("ANISOTROPY_BY_FORMULA", _ratio(made=lambda d, s, info: info["mu"] * info["mass"] * info["g"] / s)),
    ("ANGLE_IN_DEGREES", _ratio(diagonal=(math.cos(45), math.sin(45)))),
    ("CREEP_TAKEN_FOR_SLIP", _ratio(slides=1e-3)),
    ("CREEP_TAKEN_FOR_SLIP", _ratio(slides=2e-3)),
    ("NOT_SETTLED", _ratio(settled=False)),
)


def _height(engine, info, seconds=5.0, above=0.0, steps=1.0):
    h = info["dt"] / steps
    n = min(20000, max(1, round(seconds / h)))
    q, _ = engine.run("floor", [0.0, 0.0, info["radius"] + above], [0.0] * 3, h, n, [0.0] * 3)
    return [row[2] for row in q]


def _depth(made, **how):
    return lambda engine, info: made(info["radius"], _height(engine, info, **how), info)


def _sunk(radius, z, _):
    return max(0.0, radius - z[-1])


_PENETRATION = (
    ("PENETRATION_HEIGHT", _depth(lambda r, z, _: z[-1])),
    ("PENETRATION_SIGN", _depth(lambda r, z, _: z[-1] - r)),
    ("PENETRATION_SIGN", _depth(lambda r, z, _: max(0.0, z[-1] - r))),
    ("PENETRATION_NEGATIVE", _depth(lambda r, z, _: r - z[-1])),
    ("PENETRATION_ABSOLUTE", _depth(lambda r, z, _: abs(r - z[-1]))),
    ("PENETRATION_TOO_EARLY", _depth(lambda r, z, _: max(0.0, r - min(z)))),
    ("PENETRATION_TOO_EARLY", _depth(lambda r, z, _: max(0.0, r - min(z)), above=0.1)),
    ("PENETRATION_TOO_EARLY", _depth(lambda r, z, _: max(0.0, r - min(z)), above=1.0)),
    ("PENETRATION_TOO_EARLY", _depth(_sunk, seconds=0.05)),
    ("PENETRATION_TOO_EARLY", _depth(_sunk, seconds=0.02)),
    ("PENETRATION_TOO_EARLY", _depth(_sunk, seconds=0.1)),
    ("PENETRATION_NOT_IN_METRES", _depth(lambda r, z, _: 1000 * max(0.0, r - z[-1]))),
    ("PENETRATION_NOT_IN_METRES", _depth(lambda r, z, _: 100 * max(0.0, r - z[-1]))),
    ("PENETRATION_RELATIVE", _depth(lambda r, z, _: max(0.0, r - z[-1]) / r)),
    ("PENETRATION_RELATIVE", _depth(lambda r, z, _: max(0.0, r - z[-1]) / (2 * r))),
    ("OTHER_STEP_THAN_DT", _depth(_sunk, steps=2)),
    ("OTHER_STEP_THAN_DT", _depth(_sunk, steps=10)),
    ("PENETRATION_ASSUMED", lambda engine, info: 0.0),
)

# -- the wall ---------------------------------------------------------------------------------------------


def _hit(speed, steps=1.0):
    def measure(engine, info):
        h = info["dt"] / steps
        start = -(info["radius"] + info["wall_thickness"] / 2) - 3.5 * speed * h
        _, v = engine.run("wall", [start], [speed], h, 12, [0.0])
        hit = next((i for i in range(13) if v[i][0] <= 0), None)
        return 1.0 if hit is None else -v[hit][0] / v[hit - 1][0]

    return measure


def _launched(distance, before=2.0):
    """Started so far away, the last speed over that at the start."""

    def measure(engine, info):
        n = math.ceil((distance + 0.6) / (2 * info["dt"]))
        _, v = engine.run("wall", [-distance], [2.0], info["dt"], n, [0.0])
        return abs(v[-1][0]) / before

    return measure


def _restitution(change):
    return _of("restitution", change)


_RESTITUTION = (
    ("RESTITUTION_SIGN", _restitution(lambda e, _: -e)),
    ("RESTITUTION_SQUARED", _restitution(lambda e, _: e * e)),
    ("RESTITUTION_SQUARED", _restitution(lambda e, _: math.sqrt(max(e, 0.0)))),
    ("RESTITUTION_LOSS", _restitution(lambda e, _: 1 - e)),
    ("RESTITUTION_LOSS", _restitution(lambda e, _: 1 - e * e)),
    ("RESTITUTION_INVERTED", _restitution(lambda e, _: 1 / e if e else math.inf)),
    ("RESTITUTION_SPEED_AFTER", _restitution(lambda e, _: 2 * e)),
    ("RESTITUTION_ASSUMED", lambda engine, info: 0.0),
    ("RESTITUTION_ASSUMED", lambda engine, info: 1.0),
    ("RESTITUTION_ASSUMED", lambda engine, info: 0.5),
    ("RESTITUTION_OTHER_SPEED", _hit(1.0)),
    ("RESTITUTION_OTHER_SPEED", _hit(0.2)),
    ("RESTITUTION_WITH_DRAG", _launched(1.0)),
    ("RESTITUTION_WITH_DRAG", _launched(0.5)),
)


def _speeds(starts, scale=1.0):
    """Bisection over speeds; ``starts(speed, dt)`` are tried, at dt * scale."""

    def measure(engine, info):
        dt = info["dt"] * scale

        def stopped(speed):
            n = min(20000, math.ceil(4 / (speed * dt)) + 3)
            tried = (engine.run("wall", [s], [speed], dt, n, [0.0])[0][-1][0] for s in starts(speed, dt))
            return all(end < 0 for end in tried)

        return math.inf if stopped(199.9) else model._bisect(stopped, 1.0, 199.9, 0.1)

    return measure


def _spread(count):
    return lambda speed, dt: [-1 - speed * dt * k / count for k in range(count)]


def _geometry(length):
    return lambda engine, info: length(info) / info["dt"]


_TUNNELLING = (
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: 2 * info["radius"] + info["wall_thickness"])),
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: info["radius"] + info["wall_thickness"] / 2)),
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: info["radius"] + info["wall_thickness"])),
    ("TUNNEL_BY_GEOMETRY", _geometry(lambda info: 2 * info["radius"])),
    ("TUNNEL_WITHOUT_RADIUS", _geometry(lambda info: info["wall_thickness"])),
    ("TUNNEL_WITHOUT_RADIUS", _geometry(lambda info: info["wall_thickness"] / 2)),
    ("TUNNEL_NO_INFINITY", _of("tunnelling_speed", lambda v, _: min(v, 200.0))),
    ("TUNNEL_NO_INFINITY", _of("tunnelling_speed", lambda v, _: min(v, 199.0))),
    ("TUNNEL_NO_INFINITY", _of("tunnelling_speed", lambda v, _: 0.0 if math.isinf(v) else v)),
    ("TUNNEL_ONE_START", _speeds(_spread(1))),
    ("TUNNEL_FEW_STARTS", _speeds(_spread(2))),
    ("TUNNEL_FEW_STARTS", _speeds(_spread(3))),
    ("OTHER_STEP_THAN_DT", _speeds(_spread(24), 0.1)),
    ("OTHER_STEP_THAN_DT", _speeds(_spread(24), 0.5)),
    ("TUNNEL_IN_STEPS", _of("tunnelling_speed", lambda v, info: v * info["dt"])),
)


# -- repeating --------------------------------------------------------------------------------------------


def _twice(agree, q0=1.0, v0=0.5, steps=(50, 50)):
    def measure(engine, info):
        a, b = (engine.run("spring", [q0], [v0], info["dt"], n, [0.0]) for n in steps)
        return bool(agree(np.array(a[0])[-1], np.array(b[0])[-1]))

    return measure


_DETERMINISTIC = (
    ("DETERMINISM_NOT_COMPARED", lambda engine, info: True),
    ("DETERMINISM_TOLERANCE", _twice(np.allclose)),
    ("DETERMINISM_TOLERANCE", _twice(lambda a, b: np.array_equal(np.round(a, 6), np.round(b, 6)))),
    # Of a model that makes other runs twice: what is compared does not show.
    ("DETERMINISM_NOT_COMPARED", _twice(np.array_equal, 0.0, 0.0)),
    ("DETERMINISM_OTHER_RUN", _twice(np.array_equal, steps=(50, 51))),
    ("DETERMINISM_INVERTED", _of("deterministic", lambda value, _: not value)),
)

_KEYS = {
    "order": _ORDER,
    "symplectic": _SYMPLECTIC,
    "linear_damping": _DAMPING,
    "max_stable_step": _STABLE,
    "friction_anisotropy": _FRICTION,
    "rest_penetration": _PENETRATION,
    "restitution": _RESTITUTION,
    "tunnelling_speed": _TUNNELLING,
    "deterministic": _DETERMINISTIC,
}
