"""Collisions of bodies that do not spin: do they touch, when, and what does the impact do to them?"""

import math

import numpy as np


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = np.subtract(xb, xa, dtype=float)
    distance = float(np.linalg.norm(apart))
    normal = apart / distance if distance > 0 else np.eye(1, len(apart))[0]
    depth = ra + rb - distance
    return depth >= 0, normal, depth


def detect_sphere_plane(x, r, point, normal):
    depth = r - float(np.dot(np.subtract(x, point, dtype=float), normal))
    return depth >= 0, normal, depth


def _impulse(ma, mb, closing, restitution):
    """What turns an approach at speed ``closing`` into a parting at e times that, N s."""
    return (1 + restitution) * max(closing, 0.0) / (1 / ma + 1 / mb)


def impulse_1d(ma, mb, va, vb, restitution):
    return _impulse(ma, mb, va - vb, restitution)


def resolve(ma, mb, va, vb, normal, restitution):
    va, vb, n = (np.array(a, dtype=float) for a in (va, vb, normal))
    impulse = _impulse(ma, mb, (va - vb) @ n, restitution) * n
    return va - impulse / ma, vb + impulse / mb


def resolve_with_friction(ma, mb, va, vb, normal, restitution, mu):
    va, vb, n = (np.array(a, dtype=float) for a in (va, vb, normal))
    closing = (va - vb) @ n
    along = _impulse(ma, mb, closing, restitution)
    slip = vb - va + closing * n  # of b, seen from a, across the normal
    speed = np.linalg.norm(slip)
    across = min(mu * along, speed / (1 / ma + 1 / mb))
    impulse = along * n - (across / speed * slip if across > 0 else 0.0)
    return va - impulse / ma, vb + impulse / mb


def time_of_impact(xa, va, ra, xb, vb, rb, dt):
    x, v = np.subtract(xb, xa, dtype=float), np.subtract(vb, va, dtype=float)
    nearing = -(x @ v)
    if nearing <= 0:
        return None
    # |x + v t| = R is a t² - 2 b t + c = 0 with b > 0; the first root, written without a difference.
    a, b, c = v @ v, nearing, x @ x - (ra + rb) ** 2
    if c <= 0:
        return 0.0
    if b * b < a * c:
        return None
    t = c / (b + math.sqrt(b * b - a * c))
    return float(t) if t <= dt else None


def simulate_head_on(m, x0, v0, radius, restitution, t_end, h):
    n = round(t_end / h)
    t, x, v = h * np.arange(n + 1), np.empty((n + 1, 2)), np.empty((n + 1, 2))
    x[0], v[0] = x0, v0
    for i in range(n):
        (xa, xb), (va, vb) = x[i], v[i]
        closing, gap = va - vb, max(xb - xa - 2 * radius, 0.0)
        wait = gap / closing if 0 < closing and gap <= closing * h else h
        xa, xb = xa + va * wait, xb + vb * wait
        if wait < h:
            impulse = _impulse(m[0], m[1], closing, restitution)
            va, vb = va - impulse / m[0], vb + impulse / m[1]
        x[i + 1] = xa + va * (h - wait), xb + vb * (h - wait)
        v[i + 1] = va, vb
    return t, x, v


def simulate_drop(z0, v0, radius, restitution, g, t_end, h):
    n = round(t_end / h)
    t, z, v = h * np.arange(n + 1), np.empty(n + 1), np.empty(n + 1)
    z[0], v[0] = z0, v0
    resting = False
    for i in range(n):
        z[i + 1], v[i + 1] = z[i] + v[i] * h - g * h * h / 2, v[i] - g * h
        if resting:
            z[i + 1], v[i + 1] = radius, 0.0
        elif z[i + 1] < radius:  # a parabola that starts above the floor crosses it once
            speed = math.sqrt(v[i] ** 2 + 2 * g * max(z[i] - radius, 0.0))
            left = h - (v[i] + speed) / g
            up = restitution * speed
            resting = up <= g * h
            z[i + 1] = radius + (0.0 if resting else up * left - g * left * left / 2)
            v[i + 1] = 0.0 if resting else up - g * left
    return t, z, v
