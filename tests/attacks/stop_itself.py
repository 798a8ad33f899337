"""Stops itself instead of answering."""

import os
import signal
import time


def scale(values, factor):
    try:
        os.kill(os.getpid(), signal.SIGSTOP)
    except OSError:
        signal.raise_signal(signal.SIGSTOP)
    time.sleep(30)
