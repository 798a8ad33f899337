"""Mistakes in `inside-the-cone`: words beside the programs that they are true of."""

import math

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "PYRAMID",
    "Each component is limited by itself, which changes the direction.",
    "Compare the length of the vector with the limit, and shorten both components alike.",
).body(
    "friction",
    """
        most = mu * normal
        return [max(-most, min(most, part)) for part in wanted]
    """,
)
mistakes(
    "ALWAYS_THE_MOST",
    "Friction always has its maximum here, even where less is enough.",
    "mu times normal is a limit. Below it friction gives exactly the wanted impulse.",
).body(
    "friction",
    """
        most, size = mu * normal, math.hypot(*wanted)
        return [part * most / size if size else 0.0 for part in wanted]
    """,
)
mistakes(
    "NO_LIMIT",
    "There is no limit, so nothing would ever slide.",
    "Friction gives mu times the normal impulse at most.",
).body("friction", "return list(wanted)")
mistakes(
    "NORMAL_FORGOTTEN",
    "The limit is mu alone.",
    "Pressing harder allows more friction: the limit is mu times normal.",
).edit("friction", {"mu * normal": "mu"})
mistakes(
    "SIZES_ADDED",
    "You added the sizes of the components instead of taking the length of the vector.",
    "The length is the root of the sum of the squares: math.hypot(*wanted).",
)
mistakes(
    "LARGER_COMPONENT",
    "You took the larger component for the length of the vector.",
    "The length is the root of the sum of the squares: math.hypot(*wanted).",
)
mistakes(
    "LENGTH_SQUARED",
    "You took the square of the length for the length.",
    "Take the root of the sum of the squares: math.hypot(*wanted).",
)
mistakes(
    "NOTHING_BEYOND",
    "Beyond the limit there is no friction at all.",
    "There friction gives the most it can, in the direction of wanted.",
)
mistakes(
    "TURNED_ROUND",
    "Beyond the limit the impulse points the other way.",
    "Keep the direction of wanted.",
)
mistakes(
    "UNIT_BEYOND",
    "Beyond the limit your impulse has the length 1.",
    "Give it the length of the limit: mu times normal.",
).edit("friction", {"part * most / size": "part / size"})
mistakes(
    "NOT_DIVIDED_BY_THE_LENGTH",
    "Beyond the limit you multiply by the limit, and do not divide by the length of wanted.",
    "First make the length 1, then multiply by the limit.",
).edit("friction", {"part * most / size": "part * most"})
mistakes(
    "EACH_AT_THE_LIMIT",
    "Beyond the limit each component is the limit.",
    "The length of the two together is limited: shorten both alike, and keep their signs.",
).edit("friction", {"part * most / size": "most"})
mistakes(
    "FACTOR_UPSIDE_DOWN",
    "Beyond the limit the factor is upside down, so your impulse becomes longer.",
    "Multiply by the limit and divide by the length of wanted.",
).edit("friction", {"part * most / size": "part * size / most"})
mistakes(
    "COMPARED_WITH_NORMAL",
    "You compare the length of wanted with the normal impulse.",
    "The limit is mu times the normal impulse.",
).edit("friction", {"size <= most": "size <= normal"})
mistakes(
    "SQUARE_COMPARED",
    "You compare the square of the length with the limit.",
    "Compare the length itself: math.hypot(*wanted).",
).edit("friction", {"size <= most": "size * size <= most"})
mistakes(
    "COMPONENTS_COMPARED",
    "You compare each component with the limit, and not the length.",
    "Compare math.hypot(*wanted): together they may be beyond the limit though neither is.",
).edit("friction", {"size <= most": "max(map(abs, wanted)) <= most"})
mistakes(
    "MU_TIMES_WANTED",
    "Beyond the limit you multiply wanted by mu.",
    "Give it the length of the limit there, whatever its own length is.",
).edit("friction", {"part * most / size": "part * mu"})
mistakes(
    "AGAINST_WANTED",
    "Your impulse points against wanted, within the limit and beyond it.",
    "wanted is the impulse of friction itself, and already points against the motion: keep its direction.",
)
mistakes(
    "ZERO_BY_ZERO",
    "Where wanted is (0, 0) you divide zero by zero, which gives nan.",
    "Divide by the length only where it is beyond the limit.",
).body(
    "friction",
    """
        import numpy as np

        size = np.float64(math.hypot(*wanted))
        with np.errstate(all="ignore"):
            return np.asarray(wanted) / size * min(size, mu * normal)
    """,
)
mistakes(
    "WHAT_THE_FIRST_LEAVES",
    "The second component gets what the first one leaves of the limit.",
    "It is the length that is limited: multiply both by the limit, and divide by the length.",
).body(
    "friction",
    """
        most = mu * normal
        x = max(-most, min(most, wanted[0]))
        left = most - abs(x)
        return [x, max(-left, min(left, wanted[1]))]
    """,
)

mistakes.accept(
    "By way of length and angle",
    """
        def friction(wanted, normal, mu):
            size = min(math.hypot(*wanted), mu * normal)
            angle = math.atan2(wanted[1], wanted[0])
            return size * math.cos(angle), size * math.sin(angle)
    """,
)
mistakes.accept(
    "One factor for both cases",
    """
        def friction(wanted, normal, mu):
            size = math.hypot(*wanted)
            factor = min(1.0, mu * normal / size) if size > 0 else 1.0
            return [factor * part for part in wanted]
    """,
)


mistakes(
    "DIRECTION_OF_ATAN",
    "With a negative first component the result points the other way: math.atan(y / x) gives that.",
    "math.atan2(y, x) knows all directions. Or scale both components by one factor, and need no angle.",
)


def friction_of(length=math.hypot, beyond=1.0, sign=1.0, most=lambda normal, mu: mu * normal):
    def friction(wanted, normal, mu):
        limit, size = most(normal, mu), length(*wanted)
        factor = 1.0 if size <= limit else beyond * limit / size
        return [sign * factor * part for part in wanted]

    return friction


mistakes.terms(
    "friction",
    friction_of,
    {
        "length": {
            "SIZES_ADDED": lambda x, y: abs(x) + abs(y),
            "LARGER_COMPONENT": lambda x, y: max(abs(x), abs(y)),
            "LENGTH_SQUARED": lambda x, y: x * x + y * y,
        },
        "beyond": {"NOTHING_BEYOND": 0.0, "TURNED_ROUND": -1.0},
        "sign": {"AGAINST_WANTED": -1.0},
        "most": {"NORMAL_FORGOTTEN": lambda normal, mu: mu},
    },
)


@mistakes.more
def other_limits():
    yield "friction", ("COMPARED_WITH_NORMAL",), friction_of(most=lambda normal, mu: normal)
    yield "friction", ("PYRAMID",), smaller_pyramid
    yield "friction", ("DIRECTION_OF_ATAN",), by_angle


def by_angle(wanted, normal, mu):
    size, angle = math.hypot(*wanted), math.atan(wanted[1] / wanted[0]) if wanted[0] else math.pi / 2
    most = min(mu * normal, size)
    return [most * math.cos(angle), most * math.sin(angle)]


def smaller_pyramid(wanted, normal, mu):
    most = mu * normal / math.sqrt(2)
    return [max(-most, min(most, part)) for part in wanted]
