"""A sum of many is normal: mean k, variance 2 k."""


def consistency_band(dof, runs, alpha):
    k = dof * runs
    z = NormalDist().inv_cdf(1 - alpha / 2)
    half = z * math.sqrt(2 * k)
    return (k - half) / runs, (k + half) / runs
