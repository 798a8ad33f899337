"""No numpy at all: lists of floats in loops, tuples and lists returned."""


def _dot(a, b):
    return sum(float(p) * float(q) for p, q in zip(a, b))


def _minus(a, b):
    return [float(p) - float(q) for p, q in zip(a, b)]


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = _minus(xb, xa)
    d = math.sqrt(_dot(apart, apart))
    normal = [c / d for c in apart] if d else [0.0] * (len(apart) - 1) + [-1.0]
    return [d <= ra + rb, normal, ra + rb - d]


def detect_sphere_plane(x, r, point, normal):
    height = _dot(_minus(x, point), normal)
    return [height <= r, list(normal), r - height]


def resolve(ma, mb, va, vb, normal, restitution):
    closing = _dot(_minus(va, vb), normal)
    if closing <= 0:
        return [list(va), list(vb)]
    j = (1 + restitution) * closing / (1 / ma + 1 / mb)
    return [[v - j / ma * n for v, n in zip(va, normal)], [v + j / mb * n for v, n in zip(vb, normal)]]


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    closing = _dot(_minus(va, vb), normal)
    if closing <= 0:
        return [list(va), list(vb)]
    give = 1 / ma + 1 / mb
    j = (1 + restitution) * closing / give
    slip = [w + closing * n for w, n in zip(_minus(vb, va), normal)]
    size = math.sqrt(_dot(slip, slip))
    share = min(mu * j, size / give) / size if size > 1e-300 else 0.0
    kick = [j * n - share * s for n, s in zip(normal, slip)]
    return [[v - k / ma for v, k in zip(va, kick)], [v + k / mb for v, k in zip(vb, kick)]]


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = _minus(xb, xa), _minus(vb, va)
    a, b, c = _dot(v, v), _dot(x, v), _dot(x, x) - (ra + rb) ** 2
    if b >= 0:
        return None
    if c <= 0:
        return 0.0
    d = b * b - a * c
    if d < 0:
        return None
    t = (-b - math.sqrt(d)) / a
    return t if t <= dt else None
