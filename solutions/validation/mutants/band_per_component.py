"""The band should lie around one."""


def consistency_band(dof, runs, alpha):
    def quantile(p, n):
        s = 2 / (9 * n)
        return n * (1 - s + NormalDist().inv_cdf(p) * math.sqrt(s)) ** 3

    n = dof * runs
    return quantile(alpha / 2, n) / n, quantile(1 - alpha / 2, n) / n
