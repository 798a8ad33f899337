"""Closes its only connection and goes on."""

from frames import *
import os
import time


def scale(values, factor):
    os.close(sock.fileno())
    time.sleep(30)
