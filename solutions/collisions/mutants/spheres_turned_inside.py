"""Where one centre lies in the other sphere, the normal is turned round."""

_right = detect_sphere_sphere


def detect_sphere_sphere(xa, ra, xb, rb):
    touching, normal, depth = _right(xa, ra, xb, rb)
    return touching, -normal if depth > min(ra, rb) else normal, depth
