"""Mistakes in `same-floor`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "KEPT_AS_THEY_ARE",
    "Both numbers are the old ones: the floor becomes another one with the step.",
    "Find the spring and the damper from the old step, then ERP and CFM from the new one.",
).body(
    "same_floor",
    """
        return erp, cfm
    """,
)
mistakes(
    "CFM_KEPT",
    "The ERP follows the step, but the CFM is the old one.",
    "The CFM is one over h k + c: it contains the step, too.",
).body(
    "same_floor",
    """
        spring = erp / (cfm * h)
        damper = (1 - erp) / cfm
        return new_h * spring / (new_h * spring + damper), cfm
    """,
)
mistakes(
    "ERP_SCALED",
    "The ERP is scaled like the step. But the step stands above and below the line of its fraction.",
    "Compute the spring and the damper, and from them the ERP at the new step.",
).body(
    "same_floor",
    """
        spring = erp / (cfm * h)
        damper = (1 - erp) / cfm
        return erp * new_h / h, 1 / (new_h * spring + damper)
    """,
)
mistakes(
    "DAMPER_TAKEN_WHOLE",
    "The damper was taken to be one over the CFM, which is h k + c.",
    "Subtract the spring's share: c is what is left of one over the CFM without h k.",
).edit("same_floor", {"damper = (1 - erp) / cfm": "damper = 1 / cfm"})

mistakes.accept(
    "Solves two equations for the spring and the damper",
    """
        import numpy as np


        def same_floor(erp, cfm, h, new_h):
            k, c = np.linalg.solve([[h, 1.0], [h * (1 - erp), -erp]], [1 / cfm, 0.0])
            return np.array([new_h * k, 1.0]) / (new_h * k + c)
    """,
)
mistakes.accept(
    "By the ratio of the two steps",
    """
        def same_floor(erp, cfm, h, new_h):
            r = new_h / h
            share = r * erp + 1 - erp
            return [r * erp / share, cfm / share]
    """,
)
