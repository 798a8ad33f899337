"""The exact band: bisection of the regularised incomplete gamma function, by its power series."""


def consistency_band(dof, runs, alpha):
    a = dof * runs / 2

    def below(x):  # the probability that a chi-square number is less than 2x
        if x <= 0:
            return 0.0
        term = total = 1 / a
        n = 0
        while term > 1e-13 * total:
            n += 1
            term *= x / (a + n)
            total += term
        return total * math.exp(a * math.log(x) - x - math.lgamma(a))

    def quantile(p):
        low, high = 0.0, 4 * a + 40
        while high - low > 1e-10 * high:
            middle = (low + high) / 2
            if below(middle) < p:
                low = middle
            else:
                high = middle
        return 2 * low

    return [quantile(alpha / 2) / runs, quantile(1 - alpha / 2) / runs]
