"""Never reads what the grader sends, while it keeps asking."""

from frames import *
import time


def sample(f, points):
    frame = wire.Codec().encode(wire.Kind.CALLBACK, [0, None, 1.0])
    for _ in range(100_000):
        sock.sendall(frame)
    time.sleep(30)
