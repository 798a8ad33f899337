"""How far the centre is from the plane is how far it is from its point."""


def detect_sphere_plane(x, r, point, normal):
    distance = np.linalg.norm(np.asarray(x) - np.asarray(point))
    depth = r - distance
    return bool(depth >= 0), np.array(normal), float(depth)
