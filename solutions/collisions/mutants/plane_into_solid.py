"""The normal is returned pointing into the solid."""


def detect_sphere_plane(x, r, point, normal):
    depth = r - (x - point) @ normal
    return bool(depth >= 0), -normal, depth
