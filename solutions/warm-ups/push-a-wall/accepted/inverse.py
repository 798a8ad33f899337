"""Inverts the matrix, and keeps J a row."""


def felt_mass(carriage, tip, length, angle):
    m12 = -tip * length * np.sin(angle)
    m = np.array([[carriage + tip, m12], [m12, tip * length**2]])
    j = np.array([[1.0, -length * np.sin(angle)]])
    return float(1 / (j @ np.linalg.inv(m) @ j.T)[0, 0])
