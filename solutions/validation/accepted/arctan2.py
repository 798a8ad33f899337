"""The angle from its cosine and sine; half a turn comes out positive."""


def wrap_angle(e):
    return np.arctan2(np.sin(e), np.cos(e))


def nees(err, P):
    return np.array([x @ np.linalg.inv(covariance) @ x for x, covariance in zip(err, P)])
