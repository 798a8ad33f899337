"""Mistakes in `shadow-gap`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "NOT_NORMALISED",
    "Your gap grows with the length of the direction.",
    "Divide the direction by its length first.",
).edit("shadow_gap", {"math.hypot(dx, dy)": "1.0"})
mistakes(
    "ONE_ORDER_ONLY",
    "You assumed that b is ahead of a.",
    "a may be ahead. Compute both gaps and take the larger.",
).edit("shadow_gap", {"max(min(on_b) - max(on_a), min(on_a) - max(on_b)": "min(on_b) - max(on_a"})
mistakes(
    "SMALLER_OF_BOTH",
    "You took the smaller of the two gaps.",
    "The shadows are apart if either of them is positive: take the larger.",
).edit("shadow_gap", {"return max(min": "return min(min"})
mistakes(
    "NEVER_NEGATIVE",
    "You give zero where the shadows overlap.",
    "Keep the sign: how far they overlap is what an engine needs.",
).edit("shadow_gap", {"return max(min(on_b)": "return max(0.0, min(on_b)"})
mistakes(
    "NO_SIGN",
    "An overlap comes out positive.",
    "It has to be negative, or nobody can tell it from a gap.",
).around("shadow_gap", "return abs(_right(a, b, direction))")
mistakes(
    "OF_THE_CENTRES",
    "You gave the distance of the shapes' middles.",
    "A shadow reaches from its smallest to its largest corner: compare the ends.",
).edit(
    "shadow_gap",
    {"max(min(on_b) - max(on_a), min(on_a) - max(on_b": "abs(sum(on_b) / len(on_b) - sum(on_a) / len(on_a"},
)
mistakes(
    "ACROSS",
    "You measured across the direction, not along it.",
    "The shadow of (x, y) is x times the direction's x plus y times its y, over its length.",
).edit(
    "shadow_gap",
    {
        "x * dx + y * dy) / size for x, y in a": "x * dy - y * dx) / size for x, y in a",
        "x * dx + y * dy) / size for x, y in b": "x * dy - y * dx) / size for x, y in b",
    },
)
mistakes(
    "DIVIDED_BY_THE_SQUARE",
    "You divided by the square of the direction's length.",
    "Divide by its length: math.hypot(x, y).",
).edit("shadow_gap", {"math.hypot(dx, dy)": "dx * dx + dy * dy"})
mistakes(
    "SIGN_TURNED",
    "The sign is the wrong way round.",
    "Apart is positive, overlapping is negative.",
).edit(
    "shadow_gap",
    {"max(min(on_b) - max(on_a), min(on_a) - max(on_b": "min(max(on_a) - min(on_b), max(on_b) - min(on_a"},
)
mistakes(
    "FAR_ENDS",
    "You measured from the far end of one shadow to the far end of the other.",
    "The gap is between the ends that face each other.",
).edit("shadow_gap", {"min(on_b) - max(on_a), min(on_a) - max": "max(on_b) - min(on_a), max(on_a) - min"})
mistakes(
    "COMMON_PART",
    "Where one shadow covers the other you gave the common part.",
    "Moving them apart takes more than the common part: the end of one to the far end of the other.",
).edit("shadow_gap", {"on_b) - max(on_a), min(on_a) - max": "on_b), min(on_a)) - min(max(on_a), max"})
mistakes(
    "NEAREST_CORNERS",
    "You took the smallest difference between any two corners.",
    "Only the ends of each shadow count: its smallest and its largest corner.",
).edit(
    "shadow_gap",
    {"max(min(on_b) - max(on_a), min(on_a) - max(on_b)": "min(abs(p - q) for p in on_a for q in on_b"},
)
mistakes(
    "SIZE_OF_ONE",
    "You took one difference of ends without its sign, whichever shape is ahead.",
    "Compute the gap both ways, with signs: b after a, and a after b. The larger one counts.",
).edit("shadow_gap", {"max(min(on_b) - max(on_a), min(on_a) - max(on_b": "abs(min(on_b) - max(on_a"})
mistakes(
    "SIZE_OF_THE_OTHER",
    "You took one difference of ends without its sign: the smallest of a less the largest of b.",
    "Compute the gap both ways, with signs: b after a, and a after b. The larger one counts.",
).edit("shadow_gap", {"return max(min(on_b) - max(on_a), min(": "return abs(min("})
mistakes(
    "OVERLAP_ONE_WAY",
    "Where the shadows overlap you measured one way only.",
    "There both ways out count, and the shorter one decides: take the larger of the two gaps.",
).edit("shadow_gap", {"max(min(on_b) - max(on_a),": "min(on_b) - max(on_a) if max(on_a) < min(on_b) else ("})
mistakes(
    "BETWEEN_THE_CENTRES",
    "You gave the way from middle to middle.",
    "A shadow reaches from its smallest to its largest corner: compare the ends.",
).edit(
    "shadow_gap",
    {"max(min(on_b) - max(on_a), min(on_a) - max(on_b)": "sum(on_b) / len(on_b) - sum(on_a) / len(on_a"},
)
mistakes(
    "DIVIDED_BY_THE_SUM",
    "You divided the direction by the sum of its entries.",
    "Its length is math.hypot(x, y).",
).edit("shadow_gap", {"math.hypot(dx, dy)": "dx + dy"})
mistakes(
    "DIVIDED_BY_THE_LARGEST",
    "You divided the direction by its largest entry.",
    "Its length is math.hypot(x, y).",
).edit("shadow_gap", {"math.hypot(dx, dy": "max(abs(dx), abs(dy)"})
mistakes(
    "FROM_END_TO_END",
    "You measured from where a begins to where b ends.",
    "The gap is between the ends that face each other, whichever shape is ahead.",
).edit("shadow_gap", {"min(on_b) - max(on_a), min(on_a) - max(on_b)": "on_b) - min(on_a"})
mistakes(
    "MEAN_OF_THE_CORNERS",
    "You took the mean of the corners for the middle of a shadow.",
    "The middle is half way between the two ends. It is simpler to compare the ends themselves.",
).edit(
    "shadow_gap",
    {
        "max(min(on_b) - max(on_a), min(on_a) - max(on_b))": "abs(sum(on_b) / len(on_b) - sum(on_a) / len(on_a)) - (\n        max(on_a) - min(on_a) + max(on_b) - min(on_b)\n    ) / 2"
    },
)
mistakes(
    "FIRST_AND_LAST_CORNER",
    "You took the first and the last corner for the ends of a shadow.",
    "The ends are its smallest and its largest corner, wherever in the list they are.",
).edit(
    "shadow_gap", {"min(on_b) - max(on_a), min(on_a) - max(on_b)": "on_b[0] - on_a[-1], on_a[0] - on_b[-1]"}
)
mistakes(
    "WHOLE_SHADOW",
    "Where the shadows overlap you gave the length of a whole shadow.",
    "Measure from an end of one to the end of the other that faces it, and take the shorter of the two ways.",
).body(
    "shadow_gap",
    """
        size = math.hypot(*direction)
        on_a = [(x * direction[0] + y * direction[1]) / size for x, y in a]
        on_b = [(x * direction[0] + y * direction[1]) / size for x, y in b]
        gap = max(min(on_b) - max(on_a), min(on_a) - max(on_b))
        return gap if gap > 0 else -min(max(on_a) - min(on_a), max(on_b) - min(on_b))
    """,
)

mistakes.accept(
    "Divides once, at the end",
    """
        def shadow_gap(a, b, direction):
            def shadow(shape):
                along = [x * direction[0] + y * direction[1] for x, y in shape]
                return min(along), max(along)

            (low_a, high_a), (low_b, high_b) = shadow(a), shadow(b)
            return -min(high_a - low_b, high_b - low_a) / math.hypot(*direction)
    """,
)
mistakes.accept(
    "Arrays and a norm",
    """
        def shadow_gap(a, b, direction):
            import numpy as np

            n = np.asarray(direction, dtype=float)
            n = n / np.linalg.norm(n)
            on_a, on_b = np.asarray(a) @ n, np.asarray(b) @ n
            return float(max(on_b.min() - on_a.max(), on_a.min() - on_b.max()))
    """,
)
