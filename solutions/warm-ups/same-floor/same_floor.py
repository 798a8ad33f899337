"""Another step, the same floor: the model solution."""


def same_floor(erp, cfm, h, new_h):
    """ERP and CFM that keep a soft floor what it is when the step changes."""
    spring = erp / (cfm * h)
    damper = (1 - erp) / cfm
    whole = new_h * spring + damper
    return new_h * spring / whole, 1 / whole
