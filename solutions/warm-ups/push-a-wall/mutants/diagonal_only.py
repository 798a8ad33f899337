"""M is nearly diagonal."""


def felt_mass(carriage, tip, length, angle):
    lever = -length * np.sin(angle)
    return 1.0 / (1.0 / (carriage + tip) + lever**2 / (tip * length**2))
