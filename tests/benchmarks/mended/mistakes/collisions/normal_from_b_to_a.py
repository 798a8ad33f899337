# The normal goes from b to a.


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = np.asarray(xa, dtype=float) - np.asarray(xb, dtype=float)
    distance = float(np.linalg.norm(apart))
    normal = apart / distance if distance > 0 else np.eye(1, len(apart))[0]
    depth = ra + rb - distance
    return depth >= 0, normal, depth
