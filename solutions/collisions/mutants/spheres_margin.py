"""A gap of a centimetre counts as touching."""

_right_spheres = detect_sphere_sphere


def detect_sphere_sphere(xa, ra, xb, rb):
    _, normal, depth = _right_spheres(xa, ra, xb, rb)
    return depth >= -0.01, normal, depth
