"""The carriage moves itself only."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    mass = np.array([[carriage, tip * lever], [tip * lever, tip * length**2]])
    row = np.array([1.0, lever])
    return 1.0 / (row @ np.linalg.solve(mass, row))
