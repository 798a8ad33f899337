"""The angles are directions."""


def lidar(pose, segments, angles, r_max, sigma, rng):
    x, y, _ = pose
    out = np.full(len(angles), float(r_max))
    for i, a in enumerate(angles):
        c, s = math.cos(a), math.sin(a)
        best = math.inf
        for (x1, y1), (x2, y2) in segments:
            ex, ey = x2 - x1, y2 - y1
            det = c * ey - s * ex
            if abs(det) < 1e-12:
                continue
            r = ((x1 - x) * ey - (y1 - y) * ex) / det
            u = ((x1 - x) * s - (y1 - y) * c) / det
            if r >= 0 and 0 <= u <= 1:
                best = min(best, r)
        if best <= r_max:
            out[i] = max(0.0, best + sigma * rng.standard_normal())
    return out
