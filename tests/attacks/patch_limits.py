"""Lifts the limits of its own side of the wire and sends 100 MB."""

from course_worker.isolation.inside import wire

wire.MAX_ARRAY_BYTES = wire.MAX_VALUE_BYTES = 1 << 40


def scale(values, factor):
    return np.zeros(100 << 17)
