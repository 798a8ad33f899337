"""Converts the ERP alone."""


def same_floor(erp, cfm, h, new_h):
    spring = erp / (cfm * h)
    damper = (1 - erp) / cfm
    return new_h * spring / (new_h * spring + damper), cfm
