"""No reading is above r_max, with noise or without."""

_uncut = lidar


def lidar(pose, segments, angles, r_max, sigma, rng):
    return np.minimum(_uncut(pose, segments, angles, r_max, sigma, rng), r_max)
