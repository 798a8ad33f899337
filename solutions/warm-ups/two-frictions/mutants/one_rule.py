"""Always multiplies."""


def pair_friction(mu1, mu2, rule):
    return mu1 * mu2
