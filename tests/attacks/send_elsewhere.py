"""Sends datagrams to other addresses over the one socket it has."""

import socket

for number in range(3, 8):
    try:
        socket.socket(fileno=number).sendto(b"stolen", ("127.0.0.1", int("@PORT@")))
    except (OSError, TypeError):
        pass
