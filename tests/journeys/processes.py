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


def marked(marker: object) -> dict[int, str]:
    """Other processes with ``marker`` in their command line or in their environment: id -> command line."""
    found = {}
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            line, environment = (entry / "cmdline").read_bytes(), (entry / "environ").read_bytes()
            if str(marker).encode() in environment + line and int(entry.name) != os.getpid():
                found[int(entry.name)] = line.decode("utf-8", "replace")
    return found


def left_running(marker: object, patience_s: float = 30.0) -> list[str]:
    """Command lines of the processes with this marker that do not end by themselves within ``patience_s``."""
    deadline = time.monotonic() + patience_s
    while (left := marked(marker)) and time.monotonic() < deadline:
        time.sleep(0.2)
    return list(left.values())


def resident(pid: int) -> int:
    """Bytes of memory that a process has in use; none, once it has ended."""
    with contextlib.suppress(OSError, IndexError):
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return 0


def stored(folder: Path) -> int:
    """Bytes on disk of all files below a folder, while others write and delete there."""
    total = 0
    for path, _, names in os.walk(folder):
        for name in names:
            with contextlib.suppress(OSError):
                total += Path(path, name).lstat().st_blocks * 512
    return total
