"""numpy's global random numbers on the hits."""

_exact = lidar


def lidar(pose, segments, angles, r_max, sigma, rng):
    ranges = _exact(pose, segments, angles, r_max, 0.0, rng)
    noisy = np.maximum(ranges + sigma * np.random.randn(len(ranges)), 0.0)
    return np.where(ranges < r_max, noisy, r_max)
