"""Two surfaces, one coefficient: the model solution."""


def pair_friction(mu1, mu2, rule):
    """Coefficient of friction of two bodies, by an engine's rule."""
    if rule == "product":
        return mu1 * mu2
    if rule == "mean":
        return (mu1 + mu2) / 2.0
    return max(mu1, mu2)
