"""Lifts the limits of its own side of the wire and sends 100 MB."""

from course_worker.isolation.inside import encoding
from course_worker.isolation.inside import frames
from course_worker.isolation.inside import wire

for module in (frames, encoding, wire):
    module.MAX_ARRAY_BYTES = module.MAX_VALUE_BYTES = 1 << 40


def scale(values, factor):
    return np.zeros(100 << 17)
