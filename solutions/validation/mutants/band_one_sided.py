"""alpha is the share outside each end."""


def consistency_band(dof, runs, alpha):
    def quantile(p, n):
        s = 2 / (9 * n)
        return n * (1 - s + NormalDist().inv_cdf(p) * math.sqrt(s)) ** 3

    return quantile(alpha, dof * runs) / runs, quantile(1 - alpha, dof * runs) / runs
