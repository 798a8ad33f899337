"""A sphere that touches the plane exactly does not touch it."""

_right_plane = detect_sphere_plane


def detect_sphere_plane(x, r, point, normal):
    _, normal, depth = _right_plane(x, r, point, normal)
    return depth > 0, normal, depth
