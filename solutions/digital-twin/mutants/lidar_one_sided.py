"""Walls whose cross product with the beam is not positive are left out, not only parallel ones."""


def lidar(pose, segments, angles, r_max, sigma, rng):
    x, y, heading = pose
    segments = np.asarray(segments, dtype=float).reshape(-1, 2, 2)
    beam = heading + np.asarray(angles, dtype=float)[:, None]
    dx, dy = np.cos(beam), np.sin(beam)
    ax, ay = (segments[:, 0] - (x, y)).T
    wx, wy = (segments[:, 1] - segments[:, 0]).T
    cross = dx * wy - dy * wx
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (ax * wy - ay * wx) / cross
        share = (ax * dy - ay * dx) / cross
    hit = (cross > 1e-12) & (along >= 0) & (share >= 0) & (share <= 1) & (along <= r_max)
    nearest = np.min(np.where(hit, along, np.inf), axis=1, initial=np.inf)
    noisy = np.maximum(nearest + sigma * rng.standard_normal(len(beam)), 0.0)
    return np.where(np.isfinite(nearest), noisy, r_max)
