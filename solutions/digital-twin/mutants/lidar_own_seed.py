"""It makes a generator of its own with a fixed seed, so that scans repeat."""

_with = lidar


def lidar(pose, segments, angles, r_max, sigma, rng):
    return _with(pose, segments, angles, r_max, sigma, np.random.default_rng(0))
