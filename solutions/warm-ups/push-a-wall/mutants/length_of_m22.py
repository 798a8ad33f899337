"""m22 is a mass times a length."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    mass = np.array([[carriage + tip, tip * lever], [tip * lever, tip * length]])
    row = np.array([1.0, lever])
    return 1.0 / (row @ np.linalg.solve(mass, row))
