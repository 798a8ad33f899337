"""The terminal: every command, what it prints, and the one place where an error becomes an exit code.

``frame`` is the program around the commands; each other room is one group of them, with its replies (what
``--json`` prints) and its screens. A room is imported when one of its commands is run.
"""

from course.cli.frame.app import main

__all__ = ["main"]
