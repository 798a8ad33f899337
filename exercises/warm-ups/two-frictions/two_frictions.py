"""Two surfaces, one coefficient."""


def pair_friction(mu1, mu2, rule):
    """Coefficient of friction of two bodies, by an engine's rule.

    Args:
        mu1: coefficient of the first body.
        mu2: coefficient of the second.
        rule: "product", "mean" or "larger".

    Returns:
        float.
    """
    raise NotImplementedError
