"""A rotation as a matrix."""


def hand(a1, a2, l1, l2):
    import numpy as np

    def turned(a, vector):
        return np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]) @ vector

    elbow_to_hand = turned(a2, np.array([l2, 0.0]))
    return turned(a1, np.array([l1, 0.0]) + elbow_to_hand)
