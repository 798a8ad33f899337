"""Who is running: the process table of Linux, for tests of what a run starts, loses and leaves behind."""

import contextlib
import os
import time
from pathlib import Path


def below(pid: int) -> dict[int, tuple[int, str]]:
    """The processes that a process started, and theirs: id -> parent, command line."""
    known = {}
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
            line = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace")
            known[int(entry.name)] = (int(fields[1]), line)
    found: dict[int, tuple[int, str]] = {}
    waiting = [pid]
    while waiting:
        parent = waiting.pop()
        for child, (its, line) in known.items():
            if its == parent and child not in found:
                found[child] = (its, line)
                waiting.append(child)
    return found


def left_running(marker: object, patience_s: float = 30.0) -> list[str]:
    """Command lines of other processes with ``marker`` in theirs or in their environment.

    They are given ``patience_s`` wall seconds to end by themselves; those that do not are what is returned.
    """
    deadline = time.monotonic() + patience_s
    while True:
        left = []
        for entry in Path("/proc").glob("[0-9]*"):
            with contextlib.suppress(OSError):
                known = (entry / "environ").read_bytes() + (entry / "cmdline").read_bytes()
                if str(marker).encode() in known and int(entry.name) != os.getpid():
                    left.append((entry / "cmdline").read_text("utf-8", "replace"))
        if not left or time.monotonic() > deadline:
            return left
        time.sleep(0.2)


def stored(folder: Path) -> int:
    """Bytes on disk of all files below a folder, while others write and delete there."""
    total = 0
    for path, _, names in os.walk(folder):
        for name in names:
            with contextlib.suppress(OSError):
                total += Path(path, name).lstat().st_blocks * 512
    return total
