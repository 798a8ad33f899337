"""The point of the plane is not used."""


def detect_sphere_plane(x, r, point, normal):
    depth = r - x @ normal
    return bool(depth >= 0), normal, depth
