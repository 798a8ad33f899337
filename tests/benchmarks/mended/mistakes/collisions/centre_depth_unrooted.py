# The distance is left squared.


def detect_sphere_sphere(xa, ra, xb, rb):
    apart = np.asarray(xb, dtype=float) - np.asarray(xa, dtype=float)
    distance = np.sum(apart**2)
    normal = apart / np.linalg.norm(apart) if distance > 0 else np.eye(1, len(apart))[0]
    depth = ra + rb - distance
    return depth >= 0, normal, depth
