"""The position relative to the plane is computed in the caller's array."""


def detect_sphere_plane(x, r, point, normal):
    x -= point
    depth = r - float(x @ normal)
    return depth >= 0, normal, depth
