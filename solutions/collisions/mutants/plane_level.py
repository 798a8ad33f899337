"""Every plane is a level floor."""


def detect_sphere_plane(x, r, point, normal):
    depth = r - (x[-1] - point[-1])
    return bool(depth >= 0), normal, depth
