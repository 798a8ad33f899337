"""Replaces the file its output goes to by a pipe that nobody writes to."""

import os

for name in os.listdir("."):
    try:
        os.unlink(name)
        os.mkfifo(name)
    except OSError:
        pass
try:
    os.mkfifo(".output")
except OSError:
    pass
