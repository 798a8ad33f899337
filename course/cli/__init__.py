"""The terminal: every command, what it prints, and the one place where an error becomes an exit code.

``frame`` is the program around the commands; each other room is one group of them, with its replies (what
``--json`` prints) and its screens. A room is imported when one of its commands is run.
"""

import signal
from typing import NoReturn


def main() -> NoReturn:
    """Load the program and run it. Ctrl-C while it is still being loaded ends it without a word."""
    hears = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if hears:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from course.cli.frame import app

    if hears:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    app.main()
