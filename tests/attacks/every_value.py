"""Functions that return every kind of plain value in turn; START and STRIDE are filled in by the test."""

import numpy as np

_deep = 0.0
for _ in range(28):
    _deep = [_deep]

_odd = [
    None, True, 0, -1, 2**62, 0.5, float("nan"), float("inf"), -float("inf"), 1e308, "", "text", "9" * 5000,
    [], [[]], [None], [1.0, "x"], [[1.0], [1.0, 2.0]], _deep, {}, {"a": 1}, {"q": [], "v": None},
    np.zeros(0), np.zeros((0, 3)), np.zeros((2, 0)), np.array(1.0), np.array(np.nan), np.ones(1), np.ones(2), np.ones(3),
    np.ones((2, 2)), np.ones((3, 2)), np.ones((1,) * 8), np.full(2, np.nan), np.full((2, 2), np.inf), np.full(3, 1e308),
    np.array([True, False]), np.array([1j, 2]), np.arange(3), np.full(2, 2**62), np.zeros(5000), (np.ones(1), np.ones(1)),
    (np.ones(2), np.ones(2)), [np.ones(2), None], [np.ones(1), "x"], (np.full(1, np.nan), np.full(1, np.inf)),
    (np.ones(3), np.ones((3, 1)), np.ones((3, 1))), ([0.0], [[1.0]], [[1.0]]), lambda *a: None, [len, len], np.float32(1),
]
_turn = [START]


def _answer(*args, **kwargs):
    _turn[0] += STRIDE
    return _odd[_turn[0] % len(_odd)]


class _Anything:
    def __init__(self, *args, **kwargs):
        pass

    def __getattr__(self, name):
        return _answer
