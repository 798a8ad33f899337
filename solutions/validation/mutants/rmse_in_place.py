"""e *= e squares the errors and changes nothing else."""


def rmse(e):
    e *= e
    return float(np.sqrt(np.mean(e)))
