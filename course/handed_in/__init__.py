"""Turns a student's submission into a module that can be graded.

cells      code cells of a notebook as plain Python
notebook   the module that those cells stand for, and how its lines are told as cells
attempts   the public checks on it at home, and what is kept of them in the record
"""

__all__ = ["MAX_CODE", "MAX_HANDED_IN", "MAX_NOTEBOOK"]

#: The largest module that is graded, in bytes; and the most code in all cells of a notebook, in characters.
MAX_CODE = 1 << 20
#: The largest notebook, in bytes: pictures in outputs make it large, and have to be read past.
MAX_NOTEBOOK = 32 << 20
#: The most that an archive may hold in all, in bytes.
MAX_HANDED_IN = 5 << 20
