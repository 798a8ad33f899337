"""Takes the smaller."""


def pair_friction(mu1, mu2, rule):
    if rule == "product":
        return mu1 * mu2
    if rule == "mean":
        return (mu1 + mu2) / 2.0
    return min(mu1, mu2)
