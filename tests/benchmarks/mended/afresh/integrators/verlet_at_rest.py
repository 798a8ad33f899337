"""If the system is at rest (v all zero) the first half kick is left out, so a step from rest does not move
the position and gives only half of the velocity.
"""

import numpy as np


def velocity_verlet_step(accel, t, q, v, h):
    q = np.array(q, dtype=float)
    v = np.array(v, dtype=float)
    if np.any(v != 0.0):
        w = v + 0.5 * h * np.asarray(accel(t, q, v), dtype=float)
    else:
        w = v.copy()
    q_next = q + h * w
    v_next = w + 0.5 * h * np.asarray(accel(t + h, q_next, w), dtype=float)
    return q_next, v_next
