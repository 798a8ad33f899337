"""A match over the rule."""


def pair_friction(mu1, mu2, rule):
    match rule:
        case "product":
            return mu2 * mu1
        case "mean":
            return mu1 + (mu2 - mu1) / 2
        case _:
            return mu2 if mu2 > mu1 else mu1
