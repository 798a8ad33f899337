"""The same edits, written otherwise."""


def run(x, v, a, n):
    states = []
    for k in range(n + 1):
        states.append((x, v))
        v += H * a
        x += H * v
    return states


def landing_time(heights):
    return next((k * H for k, height in enumerate(heights) if height <= 0), None)


def after_contact(v1, v2):
    total = v1 + v2
    return total - v1, total - v2


def gap(first, second, k):
    (x1, _), (x2, _) = first[k], second[k]
    return abs(x1 - x2)


def euler_step(x, v, a, h):
    return x + h * v, v + h * a


def error_at_end(positions, omega):
    return abs(positions[-1] - math.cos(omega * H * len(positions[1:])))
