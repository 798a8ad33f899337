"""The depth is cut off at zero."""

_right = detect_sphere_sphere


def detect_sphere_sphere(xa, ra, xb, rb):
    touching, normal, depth = _right(xa, ra, xb, rb)
    return touching, normal, max(depth, 0.0)
