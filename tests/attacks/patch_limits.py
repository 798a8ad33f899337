"""Lifts the limits of its own side of the wire and sends 100 MB."""

import encoding
import frames
import wire

for module in (frames, encoding, wire):
    module.MAX_ARRAY_BYTES = module.MAX_VALUE_BYTES = 1 << 40


def scale(values, factor):
    return np.zeros(100 << 17)
