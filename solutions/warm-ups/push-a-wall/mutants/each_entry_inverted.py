"""An inverse inverts each entry."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    mass = np.array([[carriage + tip, tip * lever], [tip * lever, tip * length**2]])
    row = np.array([1.0, lever])
    return 1.0 / (row @ (1.0 / mass) @ row)
