"""Calls that tell wrong programs of `first-program` apart. What they should give is not here."""

_FIRST, _SECOND = [[0.0, 1.0], [1.5, 1.25]], [[5.0, -2.0], [3.0, -2.5]]

QUESTIONS = {
    "gap": [(_FIRST, _SECOND, 0), (_FIRST, _SECOND, 1), (_SECOND, _FIRST, 1)],
    "run": [(10.0, 2.0, -9.81, 3), (0.5, -1.0, 4.0, 1), (0.5, -1.0, 4.0, 0)],
    "landing_time": [([0.5, 0.2, -0.2, -0.7, -1.3],), ([1.0, 0.6, 0.0, -0.9],), ([2.0, 1.5],)],
    "after_contact": [(2.0, -2.0), (3.0, 1.0), (0.5, -1.5)],
    "euler_step": [(1.0, 0.5, -4.0, 0.1), (0.3, -2.0, 1.0, 0.5)],
    "error_at_end": [([1.0, 0.9, 0.7], 2.0), ([1.0, 0.5], 3.0), ([1.0, 1.2, 1.0, 1.1, 1.5], 20.0)],
}
