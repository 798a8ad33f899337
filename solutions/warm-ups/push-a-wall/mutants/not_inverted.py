"""M is used as it is."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    mass = np.array([[carriage + tip, tip * lever], [tip * lever, tip * length**2]])
    row = np.array([1.0, lever])
    return row @ mass @ row
