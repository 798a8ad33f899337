"""Frames on the pipes between our own processes: a 4-byte little-endian length, then msgpack.

Also the life of such a process, which ends with the one that started it, and its limits where it reads
untrusted files.
"""

import _thread
import os
import queue
import signal
import struct
import threading
import time
from time import process_time
from typing import IO, Any

import msgspec

try:
    import resource
except ImportError:  # Windows has none of these limits
    resource = None  # type: ignore[assignment]
from collections.abc import Iterator

_LENGTH = struct.Struct("<I")
#: Wall seconds that a process has to clean up after the one it worked for is gone.
_LAST_S = 3.0


def read_frame(source: IO[bytes], most: int | None = None) -> bytes | None:
    """The next frame's content; None at the end of the stream, or if it is longer than ``most`` bytes."""
    header = source.read(_LENGTH.size)
    if len(header) < _LENGTH.size:
        return None
    size = _LENGTH.unpack(header)[0]
    if most is not None and size > most:
        return None
    body = source.read(size)
    return body if len(body) == size else None


def write_frame(sink: IO[bytes], message: Any) -> None:
    """Write one message and flush it."""
    body = msgspec.msgpack.encode(message)
    sink.write(_LENGTH.pack(len(body)) + body)
    sink.flush()


def served(source: IO[bytes]) -> Iterator[bytes]:
    """The frames of a pipe, one after the other, as long as the process at its other end lives.

    A thread reads them. Whoever started this process may be killed while a frame is worked on, which can take
    minutes: then the work is interrupted (``KeyboardInterrupt`` in the main thread), and a little later this
    process ends in any case.
    """
    waiting: queue.Queue[bytes | None] = queue.Queue()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # also where it was started with that ignored

    def read() -> None:
        while (frame := read_frame(source)) is not None:
            waiting.put(frame)
        at_work = waiting.unfinished_tasks
        waiting.put(None)
        if at_work:
            _interrupt_main()
            time.sleep(_LAST_S)
            os._exit(1)

    threading.Thread(target=read, daemon=True).start()
    while (frame := waiting.get()) is not None:
        yield frame
        waiting.task_done()


def _interrupt_main() -> None:
    if hasattr(signal, "pthread_kill"):  # which also ends a wait for a worker's answer
        signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)
    else:
        _thread.interrupt_main()


def limit_memory(size: int) -> None:
    """Limit this process's memory from now on, in bytes; it leaves no core file either."""
    if resource is not None:
        resource.setrlimit(resource.RLIMIT_AS, (size, size))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def limit_cpu(seconds: int) -> None:
    """End this process once it has used so much more CPU time than by now; a later call begins anew."""
    if resource is not None:
        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        resource.setrlimit(resource.RLIMIT_CPU, (int(process_time()) + seconds + 1, hard))
