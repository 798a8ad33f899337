"""No process noise: the filter stops learning."""

_WANDER = np.zeros((3, 3))
