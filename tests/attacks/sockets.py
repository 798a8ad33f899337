"""Connects, sends and listens by every family of sockets."""

import ctypes
import socket

libc = ctypes.CDLL(None)


def tries():
    tcp = socket.socket()
    tcp.settimeout(0.2)
    tcp.connect(("127.0.0.1", int("@PORT@")))
    yield tcp


def udp():
    socket.socket(type=socket.SOCK_DGRAM).sendto(b"stolen", ("127.0.0.1", int("@PORT@")))


def abstract():
    socket.socket(socket.AF_UNIX).connect("\0course_attack_@PORT@")


attempts = [
    lambda: next(tries()), udp, abstract, lambda: socket.socketpair(),
    lambda: socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, 0), lambda: socket.socket(socket.AF_PACKET, socket.SOCK_RAW),
    lambda: socket.socket(socket.AF_INET, socket.SOCK_RAW, 1), lambda: socket.socket(socket.AF_INET6),
    lambda: socket.getaddrinfo("localhost", 80), lambda: libc.socket(2, 1, 0) + 1 or 1 / 0,
    lambda: socket.create_server(("127.0.0.1", 0)), lambda: socket.socket(40, 1),
    lambda: socket.socket(socket.AF_UNIX).bind("course_attack_socket"), lambda: socket.socket(38, 5, 0),
]
for k, attempt in enumerate(attempts):
    try:
        attempt()
        if k != 8:
            print("FILE-CANARY" + "-7f3a: network", k)
    except (OSError, ZeroDivisionError):
        pass
