"""Forks twice to outlive its grading and writes a note later."""

import os
import time

try:
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            time.sleep(5)
        os._exit(0)
    print("FILE-CANARY" + "-7f3a: forked")
except OSError:
    pass
