"""Q(alpha) and Q(1 - alpha)."""


def consistency_band(dof, runs, alpha):
    k = dof * runs

    def quantile(p):
        z = NormalDist().inv_cdf(p)
        return k * (1 - 2 / (9 * k) + z * math.sqrt(2 / (9 * k))) ** 3

    return quantile(alpha) / runs, quantile(1 - alpha) / runs
