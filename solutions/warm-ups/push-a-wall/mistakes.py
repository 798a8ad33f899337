"""Mistakes in `push-a-wall`: words beside the programs that they are true of."""

from course.authoring.mistakes import Mistakes

mistakes = Mistakes()

mistakes(
    "ONE_OVER_FORGOTTEN",
    "You give J M⁻¹ Jᵀ itself.",
    "It is an acceleration for each newton. The mass is one over it.",
).edit("felt_mass", {"1.0 / (row @ np.linalg.solve(mass, row)": "row @ np.linalg.solve(mass, row"})
mistakes(
    "M_NOT_INVERTED",
    "You computed J M Jᵀ: M is not inverted.",
    "Between a force and an acceleration stands M⁻¹.",
).edit("felt_mass", {"1.0 / (row @ np.linalg.solve(mass, row))": "row @ mass @ row"})
mistakes(
    "ONE_OVER_M_NOT_INVERTED",
    "You computed 1 / (J M Jᵀ): M is not inverted.",
    "Between a force and an acceleration stands M⁻¹.",
).edit("felt_mass", {"np.linalg.solve(mass, row)": "mass @ row"})
mistakes(
    "EVERYTHING",
    "Your result is the whole mass, in every pose.",
    "A bent rod gives way, and the wall feels less.",
).body("felt_mass", "return carriage + tip + 0.0 * length * angle")
mistakes(
    "TIP_ALONE",
    "Your result is the mass of the tip, in every pose.",
    "A rod along the rail pushes with the carriage behind it.",
).body("felt_mass", "return tip + 0.0 * length * angle")
mistakes(
    "DIAGONAL_ONLY",
    "You left out the entries of M beside its diagonal.",
    "m12 and m21 couple the carriage and the rod.",
).edit("felt_mass", {"tip * lever], [tip * lever,": "0.0], [0.0,"})
mistakes(
    "COUPLING_SIGN",
    "A sign beside the diagonal is wrong, in M or in its inverse, or that of J's second entry.",
    "m12 = -tip length sin(angle), and J's second entry is -length sin(angle). If you invert by hand, the entry beside the diagonal is -m12 / det.",
).edit("felt_mass", {"tip * lever], [": "-tip * lever], [-"})
mistakes(
    "EACH_ENTRY_INVERTED",
    "You inverted each entry of M on its own.",
    "1 / M and M ** -1 work on the entries. numpy.linalg.inv(M) is the inverse matrix.",
).edit("felt_mass", {"np.linalg.solve(mass, row)": "(1.0 / mass) @ row"})
mistakes(
    "COSINE",
    "You used the cosine of the angle where the sine belongs.",
    "Turning a rod that lies along the rail does not move its tip towards the wall.",
).edit("felt_mass", {"np.sin(angle": "np.cos(angle"})
mistakes(
    "FIRST_ENTRY_ONLY",
    "You gave one over the first entry of M⁻¹, as if only the carriage moved the tip.",
    "J has two entries, and both count: J @ M⁻¹ @ J.",
).edit("felt_mass", {"(row @ np.linalg.solve(mass, row))": "np.linalg.inv(mass)[0, 0]"})
mistakes(
    "LENGTH_NOT_SQUARED",
    "In m22 the length is not squared.",
    "An inertia is a mass times a length squared.",
).edit("felt_mass", {"length**2]": "length]"})
mistakes(
    "INTO_RADIANS",
    "You converted the angle to radians.",
    "It is in radians already.",
).edit("felt_mass", {"sin(angle)": "sin(np.radians(angle))"})
mistakes(
    "INTO_DEGREES",
    "You converted the angle to degrees.",
    "numpy.sin expects radians, and the angle is in radians.",
).edit("felt_mass", {"sin(angle)": "sin(np.degrees(angle))"})
mistakes(
    "TIP_NOT_CARRIED",
    "m11 lacks the tip.",
    "The carriage carries the tip along: m11 = carriage + tip.",
).edit("felt_mass", {"carriage + tip,": "carriage,"})
mistakes(
    "LEFT_J_FORGOTTEN",
    "You added up M⁻¹ Jᵀ, which holds accelerations of two different things.",
    "Multiply with J from the left: it says how much of each arrives at the tip.",
).edit("felt_mass", {"/ (row @ np.": "/ np.sum(np."})
mistakes(
    "J_WITHOUT_LENGTH",
    "The length is missing in J.",
    "J's second entry is -length sin(angle).",
).edit("felt_mass", {"[1.0, lever]": "[1.0, lever / length]"})
mistakes(
    "COSINE_SQUARED",
    "You count the carriage with the cosine squared. That is right with the rod along the rail or upright, but not in between.",
    "The rod gives way as it turns: work out x from M x = Jᵀ, then J x, then one over it.",
).body("felt_mass", "return tip + carriage * np.cos(angle) ** 2 + 0.0 * length")

mistakes.accept(
    "The matrix is inverted by hand",
    """
        def felt_mass(carriage, tip, length, angle):
            import math

            c, s = math.cos(angle), math.sin(angle)
            return tip * (carriage + tip * c * c) / (tip * c * c + carriage * s * s)
    """,
)
mistakes.accept(
    "Inverts the matrix, and keeps J a row",
    """
        def felt_mass(carriage, tip, length, angle):
            m12 = -tip * length * np.sin(angle)
            m = np.array([[carriage + tip, m12], [m12, tip * length**2]])
            j = np.array([[1.0, -length * np.sin(angle)]])
            return float(1 / (j @ np.linalg.inv(m) @ j.T)[0, 0])
    """,
)
