"""Mistakes in `which-line-first`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "BOTH_OLD",
    "Both lines use the values from before the step, and every step adds energy.",
    "Let one of the two lines use the value that the other has just computed.",
).edit("swing", {"v += h * (-k / m * x)\n        x += h * v": "x, v = x + h * v, v + h * (-k / m * x)"})
mistakes(
    "BOTH_NEW",
    "Both lines use the values from after the step, and every step takes energy away.",
    "One old value and one new one balance: take the force at the old position, and move with the new velocity.",
).body(
    "swing",
    """
        w = h * h * k / m
        for _ in range(n):
            v = (v - h * k / m * x) / (1 + w)
            x = x + h * v
        return x, v
    """,
)
mistakes(
    "MASS_LOST",
    "The mass has got lost: you took the spring's force for the acceleration.",
    "Divide the force by m, as the file did.",
).edit("swing", {"v += h * (-k / m * x)": "v -= h * k * x"})
mistakes(
    "STEP_MISSING_IN_X",
    "The position changes by the velocity, not by the velocity times the step.",
    "In a step of h seconds a body moves by h v.",
)
mistakes(
    "STEP_MISSING_IN_V",
    "The velocity changes by the acceleration, not by the acceleration times the step.",
    "In a step of h seconds the velocity changes by h a.",
)
mistakes(
    "FORCE_AWAY",
    "The force pushes the mass away from the middle.",
    "A spring pulls back: the force is -k x.",
)
mistakes(
    "MEAN_VELOCITY",
    "The position moves with the mean of the old and the new velocity, and the swing still grows.",
    "Move it with the new velocity alone.",
).edit("swing", {"v += h": "before = v\n        v += h", "x += h * v": "x += h * (before + v) / 2"})
mistakes(
    "MEAN_POSITION",
    "The force is taken at the mean of the old and the new position, and the swing still grows.",
    "Take it at the new position alone.",
).edit(
    "swing",
    {
        "v += h * (-k / m * x)": "before = x",
        "x += h * v": "x += h * v\n        v += h * (-k / m * (before + x) / 2)",
    },
)
mistakes(
    "SECOND_ORDER",
    "This is the step of a method of second order (Heun's, or the midpoint method). The swing still grows, only slower.",
    "No new formula is needed: let one of the two lines of the file use the value that the other has just computed.",
).body(
    "swing",
    """
        for _ in range(n):
            a = -k / m * x
            x, v = x + h * v + 0.5 * h * h * a, v + h * a - 0.5 * h * h * k / m * v
        return x, v
    """,
)
mistakes(
    "SMALLER_STEPS",
    "You divide the step into smaller ones, and the swing still grows, only slower.",
    "Leave the step as it is: let one of the two lines use the value that the other has just computed.",
)
mistakes(
    "VELOCITY_FIRST",
    "The velocity comes first in your pair.",
    "The position comes first: return x, v.",
).edit("swing", {"return x, v": "return v, x"})
mistakes(
    "FORCE_TAKEN_ONCE",
    "The force is computed once, before the loop, and stays what it was at the start.",
    "Compute it in every step: it changes with the position.",
).edit("swing", {"for _": "a = -k / m * x\n    for _", "(-k / m * x)": "a"})

mistakes.accept(
    "Half a kick on either side of the move",
    """
        def swing(x, v, k, m, h, n):
            for _ in range(n):
                v += 0.5 * h * (-k / m * x)
                x += h * v
                v += 0.5 * h * (-k / m * x)
            return x, v
    """,
)
mistakes.accept(
    "The implicit middle of the step, solved for the spring",
    """
        def swing(x, v, k, m, h, n):
            w = 0.25 * h * h * k / m
            for _ in range(n):
                x_next = ((1 - w) * x + h * v) / (1 + w)
                v = v - 0.5 * h * k / m * (x + x_next)
                x = x_next
            return x, v
    """,
)
mistakes.accept(
    "Moves first, and takes the force at the new position",
    """
        def swing(x, v, k, m, h, n):
            for _ in range(n):
                x += h * v
                v += h * (-k / m * x)
            return x, v
    """,
)


def swing_of(old=False, of_x=lambda h: h, of_v=lambda h: h, sign=-1.0, mass=lambda m: m):
    def swing(x, v, k, m, h, n):
        for _ in range(n):
            before, v = v, v + of_v(h) * sign * k / mass(m) * x
            x += of_x(h) * (before if old else v)
        return x, v

    return swing


mistakes.terms(
    "swing",
    swing_of,
    {
        "old": {"BOTH_OLD": True},
        "of_x": {"STEP_MISSING_IN_X": lambda h: 1.0},
        "of_v": {"STEP_MISSING_IN_V": lambda h: 1.0},
        "sign": {"FORCE_AWAY": 1.0},
        "mass": {"MASS_LOST": lambda m: 1.0},
    },
)


def smaller(parts):
    def swing(x, v, k, m, h, n):
        for _ in range(parts * n):
            x, v = x + h / parts * v, v - h / parts * k / m * x
        return x, v

    return swing


def moves_first(mass=lambda m: m, sign=-1.0):
    def swing(x, v, k, m, h, n):
        for _ in range(n):
            x += h * v
            v += h * sign * k / mass(m) * x
        return x, v

    return swing


def pushed_alike(x, v, k, m, h, n):
    a = -k / m * x
    for _ in range(n):
        x += h * v
        v += h * a
    return x, v


@mistakes.more
def other_loops():
    yield "swing", ("SMALLER_STEPS",), smaller(2)
    yield "swing", ("SMALLER_STEPS",), smaller(10)
    yield "swing", ("MASS_LOST",), moves_first(mass=lambda m: 1.0)
    yield "swing", ("FORCE_AWAY",), moves_first(sign=1.0)
    yield "swing", ("VELOCITY_FIRST",), lambda *given: moves_first()(*given)[::-1]
    yield "swing", ("FORCE_TAKEN_ONCE",), pushed_alike
