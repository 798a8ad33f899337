"""The sign of m12 is a matter of taste."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    mass = np.array([[carriage + tip, -tip * lever], [-tip * lever, tip * length**2]])
    row = np.array([1.0, lever])
    return 1.0 / (row @ np.linalg.solve(mass, row))
