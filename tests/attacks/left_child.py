"""Starts a child in its own group and exits at once."""

import os
import time

try:
    if os.fork() == 0:
        time.sleep(5)
        os._exit(0)
except OSError:
    pass
os._exit(0)
