"""An average varies as much as one of its terms."""


def consistency_band(dof, runs, alpha):
    def quantile(p, n):
        s = 2 / (9 * n)
        return n * (1 - s + NormalDist().inv_cdf(p) * math.sqrt(s)) ** 3

    return quantile(alpha / 2, dof), quantile(1 - alpha / 2, dof)
