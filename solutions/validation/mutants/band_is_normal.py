"""With twenty degrees of freedom anything is normal."""


def consistency_band(dof, runs, alpha):
    half = NormalDist().inv_cdf(1 - alpha / 2) * math.sqrt(2 * dof / runs)
    return dof - half, dof + half
