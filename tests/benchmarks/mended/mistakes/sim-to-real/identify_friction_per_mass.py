# b and Fc are left divided by the mass.


def _parameters(theta, tau, late):
    """m, b, Fc, tau, latency and lag from the coefficients of a fit around (tau, late)."""
    m = 1 / theta[..., 0]
    tau, late = tau + theta[..., 3] * m, late + theta[..., 4] * m
    return np.stack([m, -theta[..., 1], -theta[..., 2], tau, late, tau + late], axis=-1)
