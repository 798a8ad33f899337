"""Reports an exception whose parts are arrays, numbers and functions."""

from frames import *


turn = [0]


def scale(values, factor):
    turn[0] += 1
    odd = [
        {"type": "E", "message": "m", "frames": np.zeros(3), "bases": np.zeros(2), "line": 1.5},
        {"type": np.zeros(2), "message": 7, "frames": 5, "bases": 5, "line": True},
        {"type": "E", "frames": [[["x"], 1, "f"], [np.zeros(2), 1, "f"], [1], 7, [{}, {}, {}]], "bases": [[1], {}]},
        [1, 2], None, 5.0, np.zeros((2, 2)), {"frames": "text", "bases": "text", "line": -1},
    ]
    sock.sendall(wire.Codec().encode(wire.Kind.RAISED, odd[(turn[0] - 1) % len(odd)]))
    return scale


advance = sample = compose = draw = scale
