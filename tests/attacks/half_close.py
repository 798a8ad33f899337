"""Closes one direction of its connection and waits."""

from frames import *
import socket
import time


def scale(values, factor):
    try:
        sock.shutdown(socket.SHUT_WR)
    except OSError:
        pass
    time.sleep(30)
