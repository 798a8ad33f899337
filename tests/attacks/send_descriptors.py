"""Sends open files along with its answer."""

from frames import *
import os
import socket

read, write = os.pipe()


def scale(values, factor):
    for _ in range(20):
        try:
            socket.send_fds(sock, [wire.Codec().encode(wire.Kind.RESULT, True)], [read, write, 1, 2])
        except OSError:
            pass
    return values
