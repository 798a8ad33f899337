"""Scales the ERP like the step."""


def same_floor(erp, cfm, h, new_h):
    spring = erp / (cfm * h)
    damper = (1 - erp) / cfm
    return erp * new_h / h, 1 / (new_h * spring + damper)
