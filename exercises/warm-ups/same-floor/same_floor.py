"""Another step, the same floor."""


def same_floor(erp, cfm, h, new_h):
    """ERP and CFM that keep a soft floor what it is when the step changes.

    Args:
        erp: error reduction at the step h, no unit; greater than zero.
        cfm: constraint force mixing at the step h, s/kg; greater than zero.
        h: the step so far, s.
        new_h: the new step, s.

    Returns:
        two floats: the ERP, no unit, and the CFM, s/kg, at the new step.
    """
    raise NotImplementedError
