"""Two levels are in the table."""


def consistency_band(dof, runs, alpha):
    n, z = dof * runs, 1.96 if alpha <= 0.05 else 1.645
    ends = [n * (1 - 2 / (9 * n) + sign * z * math.sqrt(2 / (9 * n))) ** 3 for sign in (-1, 1)]
    return ends[0] / runs, ends[1] / runs
