"""Takes one over the CFM for the damper."""


def same_floor(erp, cfm, h, new_h):
    spring = erp / (cfm * h)
    damper = 1 / cfm
    whole = new_h * spring + damper
    return new_h * spring / whole, 1 / whole
