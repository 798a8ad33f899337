# The height above the plane is taken without its sign.


def detect_sphere_plane(x, r, point, normal):
    height = abs(float((np.asarray(x) - np.asarray(point)) @ np.asarray(normal)))
    depth = r - height
    return depth >= 0, normal, depth
