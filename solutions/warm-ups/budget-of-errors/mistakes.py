"""Mistakes in `budget-of-errors`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "PLAIN_SUM",
    "The errors are added as if all of them pushed the same way.",
    "Independent errors partly cancel: add their squares and take the root.",
).edit("total_error", {"math.sqrt(sum(error * error for error in errors)": "sum(errors"})
mistakes(
    "LARGEST_ALONE",
    "Only the largest error counts.",
    "It counts most, but the others count too: add the squares.",
).edit("total_error", {"math.sqrt(sum(error * error for error in errors)": "max(errors"})
mistakes(
    "MEAN_NOT_SUM",
    "The squares are averaged, not added.",
    "Add the squares without dividing.",
).edit("total_error", {"in errors))": "in errors) / len(errors))"})
mistakes(
    "ROOT_MISSING",
    "Your result is a square: the root is missing.",
    "Take the root at the end.",
).edit("total_error", {"math.sqrt(": "("})
mistakes(
    "MEAN_OF_THE_ERRORS",
    "Your result is the mean of the errors.",
    "Another error makes the total larger: add the squares and take the root.",
).edit("total_error", {"math.sqrt(sum(error * error for error in errors))": "sum(errors) / len(errors)"})
mistakes(
    "NOT_SQUARED",
    "You took the root of the sum, but the errors are not squared.",
    "Square each, add, then take the root.",
).edit("total_error", {"error * error for error in errors": "errors"})
mistakes(
    "SUM_OVER_ROOT_OF_NUMBER",
    "You divided the sum by the root of the number of errors.",
    "Add the squares of the errors, and take the root of this sum.",
).body("total_error", "return sum(errors) / math.sqrt(len(errors))")
mistakes(
    "HALF_NOT_ROOT",
    "You halved the sum of the squares instead of taking its root.",
    "Write **0.5, or math.sqrt. Python reads x**1/2 as half of x.",
).body("total_error", "return sum(error * error for error in errors) / 2")
mistakes(
    "FIRST_TWO_ONLY",
    "Only the first two errors count.",
    "The list may be longer: go through all of it.",
).edit("total_error", {"for error in errors": "for error in errors[:2]"})
mistakes(
    "EQUAL_ONES_ONCE",
    "Errors of the same size count only once.",
    "A set keeps one of several equal numbers: go through the list itself.",
).edit("total_error", {"for error in errors": "for error in set(errors)"})
mistakes(
    "THREE_ONLY",
    "Your function takes exactly three errors.",
    "The list may be of any length: go through all of it.",
).body(
    "total_error",
    """
        step, model, sensor = errors
        return math.sqrt(step**2 + model**2 + sensor**2)
    """,
)
mistakes(
    "SMALL_ONES_LEFT_OUT",
    "Small errors are left out.",
    "Add the squares of all of them: a small one counts little, but it counts.",
).edit("total_error", {"for error in errors": "for error in errors if error > 0.1 * max(errors)"})
mistakes(
    "FIRST_TWICE",
    "The first error counts twice.",
    "Start the sum at 0, or the loop at the second error.",
).edit("total_error", {"math.sqrt(": "math.sqrt(errors[0] ** 2 + "})
mistakes(
    "ENDS_ALONE",
    "Only the first and the last error count.",
    "There may be more between them, or a single one: go through the whole list.",
).body("total_error", "return math.hypot(errors[0], errors[-1])")
mistakes(
    "ONE_LEFT_OUT",
    "The first or the last error does not count.",
    "The first has the index 0, the last len(errors) - 1. `for error in errors` finds all.",
).edit("total_error", {"for error in errors": "for error in errors[1:]"})

mistakes.accept(
    "With hypot",
    """
        def total_error(errors):
            return math.hypot(*errors)
    """,
)
mistakes.accept(
    "Adds one error after the other",
    """
        def total_error(errors):
            total = 0.0
            for error in errors:
                total = (total**2 + error**2) ** 0.5
            return total
    """,
)


def total_of(part=lambda errors: errors, number=lambda errors: 1, root=0.5):
    return lambda errors: (sum(error * error for error in part(errors)) / number(errors)) ** root


mistakes.terms(
    "total_error",
    total_of,
    {
        "part": {
            "ONE_LEFT_OUT": lambda errors: errors[:-1],
            "FIRST_TWO_ONLY": lambda errors: errors[:2],
            "FIRST_TWICE": lambda errors: [*errors, errors[0]],
        },
        "number": {"MEAN_NOT_SUM": len},
        "root": {"ROOT_MISSING": 1.0},
    },
)
