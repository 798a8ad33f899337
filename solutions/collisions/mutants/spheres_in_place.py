"""The vector between the centres is computed in the caller's array."""


def detect_sphere_sphere(xa, ra, xb, rb):
    xb -= xa
    distance = float(np.linalg.norm(xb))
    normal = xb / distance if distance > 0 else np.eye(1, len(xb))[0]
    depth = ra + rb - distance
    return depth >= 0, normal, depth
