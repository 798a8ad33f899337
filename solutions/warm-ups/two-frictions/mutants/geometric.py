"""Takes the geometric mean."""


def pair_friction(mu1, mu2, rule):
    if rule == "product":
        return mu1 * mu2
    if rule == "mean":
        return (mu1 * mu2) ** 0.5
    return max(mu1, mu2)
