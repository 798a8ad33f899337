"""Axes of length 1 carry nothing."""


def nis(nu, S):
    nu = np.asarray(nu)
    return np.squeeze(nu[:, None, :] @ np.linalg.inv(S) @ nu[:, :, None])
