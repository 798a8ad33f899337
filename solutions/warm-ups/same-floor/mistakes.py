"""Mistakes in `same-floor`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "KEPT_AS_THEY_ARE",
    "Both numbers are the old ones: the floor becomes another one with the step.",
    "Find the spring and the damper from the old step, then ERP and CFM from the new one.",
).body("same_floor", "return erp, cfm")
mistakes(
    "CFM_KEPT",
    "The CFM is the old one.",
    "The CFM is one over h k + c: it contains the step, too.",
).edit("same_floor", {"1 / whole": "cfm"})
mistakes(
    "ERP_SCALED",
    "The ERP is scaled like the step. But the step stands above and below the line of its fraction.",
    "Compute the spring and the damper, and from them the ERP at the new step.",
).edit("same_floor", {"new_h * spring / whole": "erp * new_h / h"})
mistakes(
    "DAMPER_TAKEN_WHOLE",
    "The damper was taken to be one over the CFM, which is h k + c.",
    "Subtract the spring's share: c is what is left of one over the CFM without h k.",
).edit("same_floor", {"damper = (1 - erp) / cfm": "damper = 1 / cfm"})
mistakes(
    "ERP_KEPT",
    "The ERP is the old one.",
    "The ERP is the share of h k in h k + c, so it changes with the step, too.",
).edit("same_floor", {"return new_h * spring / whole": "return erp"})
mistakes(
    "CFM_SCALED",
    "The CFM is scaled as if it went with one over the step.",
    "It is one over h k + c, and c does not change with the step.",
).edit("same_floor", {"1 / whole": "cfm * h / new_h"})
mistakes(
    "CFM_SCALED_WITH_THE_STEP",
    "The CFM is scaled like the step.",
    "It is one over h k + c: a longer step makes it smaller.",
).edit("same_floor", {"1 / whole": "cfm * new_h / h"})
mistakes(
    "ERP_SCALED_AGAINST_THE_STEP",
    "The ERP is scaled like one over the step.",
    "Compute the spring and the damper, and from them the ERP at the new step: a longer step makes it larger.",
).edit("same_floor", {"new_h * spring / whole": "erp * h / new_h"})
mistakes(
    "STEPS_EXCHANGED",
    "The two steps are exchanged.",
    "The old numbers belong to h, and the new ones to new_h.",
).around("same_floor", "return _right(erp, cfm, new_h, h)")
mistakes(
    "CFM_NOT_INVERTED",
    "Your second number is h k + c itself.",
    "The CFM is one over it.",
).edit("same_floor", {"1 / whole": "whole"})
mistakes(
    "SWAPPED",
    "The two numbers are exchanged.",
    "The ERP comes first, then the CFM.",
).edit("same_floor", {"new_h * spring / whole, 1 / whole": "1 / whole, new_h * spring / whole"})
mistakes(
    "ERP_AS_A_DECAY",
    "Your ERP is 1 - (1 - erp)**(new_h / h): the error decays as fast as before, but on another floor.",
    "Compute the spring and the damper, and from them the ERP at the new step.",
)
mistakes(
    "SPRING_WITHOUT_THE_STEP",
    "You took erp / cfm for the stiffness of the spring.",
    "erp / cfm is h k: divide it by the old step, too.",
).edit("same_floor", {"erp / (cfm * h)": "erp / cfm"})
mistakes(
    "CFM_OVER_THE_STEP",
    "You took the CFM as one over h (h k + c).",
    "In s/kg it is one over h k + c.",
).edit("same_floor", {"1 / whole": "h / (new_h * whole)"})
mistakes(
    "SPRING_TIMES_THE_STEP",
    "You multiply erp / cfm by the old step to get the stiffness of the spring.",
    "erp / cfm is h k: divide it by h. In Python that is erp / (cfm * h), with brackets.",
)
mistakes(
    "DAMPER_FOR_SPRING",
    "You took the spring's share of one over the CFM for the damper.",
    "The damper is what is left of it: (1 - erp) / cfm.",
)

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


def floor_of(erp=lambda e, r: r * e / (r * e + 1 - e), cfm=lambda e, r: 1 / (r * e + 1 - e)):
    def same_floor(e, old, h, new_h):
        r = new_h / h
        return erp(e, r), old * cfm(e, r)

    return same_floor


mistakes.terms(
    "same_floor",
    floor_of,
    {
        "erp": {
            "ERP_KEPT": lambda e, r: e,
            "ERP_AS_A_DECAY": lambda e, r: 1 - (1 - e) ** r,
            "ERP_SCALED": lambda e, r: e * r,
            "ERP_SCALED_AGAINST_THE_STEP": lambda e, r: e / r,
        },
        "cfm": {
            "CFM_KEPT": lambda e, r: 1.0,
            "CFM_SCALED": lambda e, r: 1 / r,
            "CFM_SCALED_WITH_THE_STEP": lambda e, r: r,
        },
    },
)


def floor_by(spring=lambda e, c, h: e / (c * h), damper=lambda e, c: (1 - e) / c, whole=lambda hk, c: hk + c):
    def same_floor(erp, cfm, h, new_h):
        new, c = new_h * spring(erp, cfm, h), damper(erp, cfm)
        return new / (new + c), 1 / whole(new, c)

    return same_floor


mistakes.terms(
    "same_floor",
    floor_by,
    {
        "spring": {
            "SPRING_WITHOUT_THE_STEP": lambda e, c, h: e / c,
            "SPRING_TIMES_THE_STEP": lambda e, c, h: e / c * h,
        },
        "damper": {"DAMPER_TAKEN_WHOLE": lambda e, c: 1 / c, "DAMPER_FOR_SPRING": lambda e, c: e / c},
        "whole": {"CFM_NOT_INVERTED": lambda hk, c: 1 / (hk + c)},
    },
)
