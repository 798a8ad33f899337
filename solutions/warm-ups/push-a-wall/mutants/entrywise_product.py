"""* multiplies matrices."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    mass = np.array([[carriage + tip, tip * lever], [tip * lever, tip * length**2]])
    return 1.0 / np.linalg.inv(mass)[0, 0]
