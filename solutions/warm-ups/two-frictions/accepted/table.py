"""A table of rules."""


def pair_friction(mu1, mu2, rule):
    return {"product": mu1 * mu2, "mean": 0.5 * (mu1 + mu2), "larger": max(mu1, mu2)}[rule]
