"""The gap is returned instead of the depth."""


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = xb - xa
    distance = np.linalg.norm(apart)
    gap = distance - ra - rb
    return bool(gap <= 0), apart / distance if distance else np.eye(1, len(xa))[0], gap
