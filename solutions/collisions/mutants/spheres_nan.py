"""The vector between the centres is divided by its length, whatever that is."""


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = xb - xa
    distance = np.linalg.norm(apart)
    return bool(distance <= ra + rb), apart / distance, ra + rb - distance
