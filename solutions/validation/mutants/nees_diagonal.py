"""Only the variances matter; the rest of the matrix does not."""


def nees(err, P):
    return np.sum(err**2 / np.einsum("nii->ni", P), axis=1)
