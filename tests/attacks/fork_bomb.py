"""Forks as fast as it can."""

import os

for _ in range(64):
    try:
        if os.fork() == 0:
            os._exit(0)
        print("FILE-CANARY" + "-7f3a: forked")
    except OSError:
        pass
