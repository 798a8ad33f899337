# The band of a single run: the runs do not narrow it.


def consistency_band(dof, runs, alpha):
    n = dof

    def quantile(p):  # Wilson and Hilferty, 1931: the cube root of a chi-square is nearly normal
        s = 2 / (9 * n)
        return n * (1 - s + NormalDist().inv_cdf(p) * math.sqrt(s)) ** 3

    return quantile(alpha / 2), quantile(1 - alpha / 2)
