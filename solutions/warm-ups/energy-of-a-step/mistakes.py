"""Mistakes in `energy-of-a-step`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "WIDTH_NOT_ENERGY",
    "This is the factor for the width of the swing. The energy grows with its square.",
    "Energy goes with the square of the swing's width: leave the root out.",
).edit("growth", {"1.0 + h * h * k / m": "(1.0 + h * h * k / m) ** 0.5"})
mistakes(
    "FREQUENCY_UPSIDE_DOWN",
    "Mass and stiffness are swapped.",
    "A stiffer spring swings faster: omega squared is k / m.",
).edit("growth", {"h * k / m": "h * m / k"})
mistakes(
    "FIRST_POWER",
    "The growth is proportional to h here; it should go with the square of h.",
    "The mixed terms of first order cancel, which leaves h squared times k / m.",
).edit("growth", {"h * k / m": "(k / m) ** 0.5"})
mistakes(
    "SHRINKS",
    "The energy shrinks here, but an explicit Euler step adds energy.",
    "Both squares are added: the sign is plus.",
).edit("growth", {"1.0 + h *": "1.0 - h *"})
mistakes(
    "ONLY_THE_GAIN",
    "Your result is only the share that is added.",
    "A factor contains what was there before: add 1.",
).edit("growth", {"1.0 + h": "h"})
mistakes(
    "HALF_KEPT",
    "What is added is half of what it should be.",
    "The energy before has the factor 1/2, too: it drops out of the quotient.",
).edit("growth", {"k / m": "k / m / 2"})
mistakes(
    "SQUARED",
    "You squared the factor once more.",
    "1 + h^2 k / m is the factor of the energy already.",
).edit("growth", {"1.0 + h * h * k / m": "(1.0 + h * h * k / m) ** 2"})
mistakes(
    "MIXED_TERM_KEPT",
    "You squared 1 + h omega. Its mixed term is not there in the energy.",
    "The mixed terms of position and velocity have opposite signs and cancel.",
).edit("growth", {"1.0 + h * h * k / m": "(1.0 + h * (k / m) ** 0.5) ** 2"})
mistakes(
    "MASS_FORGOTTEN",
    "The mass is not used.",
    "The acceleration is -k x / m.",
)
mistakes(
    "FOURTH_POWER",
    "You squared k / m, too.",
    "k / m is already the square of the angular frequency.",
)
mistakes(
    "ROOT_OF_THE_FREQUENCY",
    "You took the root of k / m where k / m itself belongs.",
    "The angular frequency is squared here, and its square is k / m.",
)
mistakes(
    "EXPONENTIAL",
    "Your result is the exponential of h^2 k / m.",
    "One step adds up two squares, and no more: the factor has two terms.",
).edit("growth", {"1.0 + h * h * k / m": "2.718281828459045 ** (h * h * k / m)"})
mistakes(
    "NEW_VELOCITY",
    "You moved the position with the new velocity, from x = 1 and v = 0.",
    "In an explicit Euler step the position moves with the old one.",
).edit("growth", {"1.0 + h * h * k / m": "(1.0 - h * h * k / m) ** 2 + h * h * k / m"})

mistakes.accept(
    "By way of the angular frequency",
    """
        def growth(k, m, h):
            omega = (k / m) ** 0.5
            return 1.0 + (h * omega) ** 2
    """,
)
mistakes.accept(
    "Takes the step and divides the energies",
    """
        def growth(k, m, h):
            x, v = 0.3, -0.7
            before = k * x * x + m * v * v
            x, v = x + h * v, v - h * k / m * x
            return (k * x * x + m * v * v) / before
    """,
)


def growth_of(omega2=lambda k, m: k / m, step=lambda h: h * h, sign=1.0, half=1.0, root=1.0):
    return lambda k, m, h: (1 + half * sign * step(h) * omega2(k, m)) ** root


mistakes.terms(
    "growth",
    growth_of,
    {
        "omega2": {
            "FREQUENCY_UPSIDE_DOWN": lambda k, m: m / k,
            "MASS_FORGOTTEN": lambda k, m: k,
            "FOURTH_POWER": lambda k, m: (k / m) ** 2,
            "ROOT_OF_THE_FREQUENCY": lambda k, m: (k / m) ** 0.5,
        },
        "step": {"FIRST_POWER": lambda h: h},
        "sign": {"SHRINKS": -1.0},
        "half": {"HALF_KEPT": 0.5},
        "root": {"WIDTH_NOT_ENERGY": 0.5},
    },
)
