"""Mistakes in `equal-work`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "LESS_WORK_LONGER_STEPS",
    "The quotient is upside down: the engine with fewer iterations gets longer steps, and then does even less work.",
    "An engine that makes fewer iterations in a step has to take more steps, so its step is shorter.",
).edit("fair_step", {"other / iterations": "iterations / other"})
mistakes(
    "SAME_STEP",
    "Both engines get the same step, whatever a step costs them.",
    "Make the iterations in a simulated second equal, not the steps.",
).edit("fair_step", {"h * other / iterations": "h"})
mistakes(
    "STEPS_IN_A_SECOND",
    "Your result is the number of steps per second.",
    "The length of one step is its inverse.",
).edit("fair_step", {"h * other / iterations": "iterations / (h * other)"})
mistakes(
    "ONE_ITERATION",
    "Your result is the time for which one iteration of A stands.",
    "B makes `other` iterations in a step: multiply by that.",
).edit("fair_step", {"h * other / iterations": "h / iterations"})
mistakes(
    "A_FORGOTTEN",
    "The iterations of A are not used.",
    "A makes iterations / h of them in a second. B should make as many.",
).edit("fair_step", {"h * other / iterations": "h / other"})
mistakes(
    "WHOLE_NUMBERS",
    "The quotient of the iterations is cut off to a whole number.",
    "Divide with one slash: /.",
).edit("fair_step", {"h * other / iterations": "h * (other // iterations)"})
mistakes(
    "WORK_OF_A",
    "Your result is the number of iterations that A makes in a second.",
    "B's step is `other` over that number.",
).edit("fair_step", {"h * other / iterations": "iterations / h"})
mistakes(
    "STEP_OF_A_NOT_USED",
    "The step of A is not used: your result is only a ratio.",
    "Multiply the ratio by h.",
).edit("fair_step", {"h * other / iterations": "other / iterations"})
mistakes(
    "NEVER_LONGER",
    "Your step of B is never longer than that of A.",
    "An engine that makes more iterations in a step may take longer ones.",
).edit("fair_step", {"h * other / iterations": "min(h, h * other / iterations)"})
mistakes(
    "ROUNDED_DOWN",
    "Your step is 0.",
    "It is a fraction of a second: divide with /, and leave out //, int and round.",
).edit("fair_step", {"other / iterations": "other // iterations"})
mistakes(
    "WORK_OF_BOTH",
    "You divide by the iterations of both engines together.",
    "A makes iterations / h of them in a second: divide by its iterations alone.",
).edit("fair_step", {"/ iterations": "/ (iterations + other)"})

mistakes.accept(
    "By the passes in a second",
    """
        def fair_step(h, iterations, other):
            passes = iterations / h
            return other / passes
    """,
)
mistakes.accept(
    "By the time that one pass stands for",
    """
        def fair_step(h, iterations, other):
            return h / iterations * other
    """,
)


@mistakes.more
def hypotheses():
    yield "fair_step", ("A_FORGOTTEN",), lambda h, iterations, other: h * other
    yield "fair_step", ("WHOLE_NUMBERS",), lambda h, iterations, other: h / (iterations // other)
