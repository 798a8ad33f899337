"""The normal is the way from a to b."""


def detect_sphere_sphere(xa, ra, xb, rb):
    n = np.asarray(xb) - np.asarray(xa)
    d = float(np.sqrt(np.sum(n**2)))
    depth = ra + rb - d
    if d == 0:
        n = np.zeros(len(n))
        n[0] = 1.0
    return depth >= 0, n, depth
