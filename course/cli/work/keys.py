"""Single key presses while a command waits or works, on a terminal only."""

from __future__ import annotations

import contextlib
import queue
import select
import sys
import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

__all__ = ["Keys", "keys_of_terminal"]

#: How often the thread checks whether to go on, in s.
_LOOK = 0.1


class Keys:
    """Keys that were pressed and not yet taken.

    Args:
        on_key: called, in the thread that listens, with each key.
    """

    def __init__(self, on_key: Callable[[str], None] = lambda _: None) -> None:
        self._queue: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._on_key = on_key

    def press(self, key: str) -> None:
        """Take a key."""
        self._queue.put(key)
        self._on_key(key)

    def taken(self) -> Iterator[str]:
        """The keys since the last call, oldest first."""
        with contextlib.suppress(queue.Empty):
            while True:
                yield self._queue.get_nowait()


@contextlib.contextmanager
def keys_of_terminal(on_key: Callable[[str], None]) -> Iterator[Keys | None]:
    """Keys as they are pressed, without Enter; None where the system has no such terminals.

    Ctrl-C keeps its meaning. The terminal is restored afterwards.
    """
    try:
        import termios
        import tty
    except ImportError:  # Windows
        yield None
        return
    descriptor = sys.stdin.fileno()
    before = termios.tcgetattr(descriptor)
    keys, done = Keys(on_key), threading.Event()

    def listen() -> None:
        import os

        while not done.is_set():
            ready, _, _ = select.select([descriptor], [], [], _LOOK)
            if ready:
                pressed = os.read(descriptor, 64)
                if not pressed:
                    return
                for key in pressed.decode("utf-8", "ignore"):
                    keys.press(key)

    thread = threading.Thread(target=listen, name="keys", daemon=True)
    try:
        tty.setcbreak(descriptor)
        thread.start()
        yield keys
    finally:
        done.set()
        if thread.is_alive():
            thread.join()
        termios.tcsetattr(descriptor, termios.TCSADRAIN, before)
