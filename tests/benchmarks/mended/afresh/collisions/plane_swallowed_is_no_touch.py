"""A ball that is wholly below the plane does not touch it any more."""


def detect_sphere_plane(x, r, point, normal):
    height = float(np.dot(x - point, normal))
    depth = r - height
    return abs(height) <= r, normal, depth
