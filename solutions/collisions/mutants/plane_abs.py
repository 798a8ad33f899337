"""The distance from the plane has no sign: below it, a body counts as outside."""


def detect_sphere_plane(x, r, point, normal):
    depth = r - abs((x - point) @ normal)
    return bool(depth >= 0), normal, depth
