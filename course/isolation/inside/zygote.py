"""Starts workers: a warm interpreter that forks a locked-down process per submission, or (L1) is a worker.

It holds trusted code and no secrets. The grader starts it once, inside bubblewrap at L3, with numpy loaded;
each request brings a socket and an output file and gets back a pidfd, so that the grader itself can end a
worker at any moment. Like all files that are copied next to a stranger's code, this one imports nothing of
the course.
"""

from __future__ import annotations

import contextlib
import ctypes
import errno
import gc
import importlib
import json
import os
import select
import socket
import sys
import threading
import time
from typing import Any, NamedTuple

# What submissions commonly import: loaded here once, it costs nothing in the workers.
_COMMON = (
    "abc", "bisect", "cmath", "collections", "collections.abc", "copy", "dataclasses", "enum", "functools",
    "heapq", "inspect", "itertools", "json", "math", "numbers", "operator", "random", "re", "statistics",
    "string", "time", "types", "typing", "warnings",
)  # fmt: skip
# numpy.ma: the first quantile or median imports it, which costs 13 ms. numpy.testing would add 36 ms to each
# start, and a submission has no use for it.
_NUMPY = (
    "numpy", "numpy.fft", "numpy.linalg", "numpy.ma", "numpy.polynomial", "numpy.random",
)  # fmt: skip

_SOCKET, _RULES = 3, 4  # descriptors of a forked worker
_LOOK_S = 0.5
_ended = ctypes.c_int()  # wire.ENDED
# Windows opens no library without a name, and nothing forks there: at L1 this process is the worker.
_libc: Any = None if sys.platform == "win32" else ctypes.CDLL(None, use_errno=True)


def main() -> None:
    """Entry point; ``argv[1]`` is the configuration as JSON (see ``course.isolation.spawn``)."""
    config: dict[str, Any] = json.loads(sys.argv[1])
    sys.argv[:] = [""]
    sys.path[:0] = config["path"]
    for name in (*_COMMON, *_NUMPY, *config["imports"]):
        importlib.import_module(name)
    from course_worker.isolation.inside import worker  # type: ignore[import-not-found]

    imports = frozenset(config["imports"])
    sock = _here(config) if config["level"] == "L1" else _become_worker(config, _fork_on_request(config))
    worker.run(sock, imports)


def _here(config: dict[str, Any]) -> socket.socket:
    """L1: this process is the worker. Its socket comes by number, or on Windows as shared bytes on stdin."""
    if config.get("share"):
        sock: socket.socket = socket.fromshare(sys.stdin.buffer.read(int(config["share"])))  # type: ignore[attr-defined]
    else:
        sock = socket.socket(fileno=config["control"])
    os.chdir(config["workdir"])
    if sys.platform == "linux":
        from course_worker.isolation.inside import lockdown

        lockdown.die_with_parent()
        lockdown.drop_bounding_set()
        lockdown.drop_capabilities()
    else:
        threading.Thread(target=_end_with_grader, args=(sock,), daemon=True).start()
    with contextlib.suppress(ImportError):  # Windows has no limits of this kind
        import resource

        kinds = [(resource.RLIMIT_FSIZE, "file_size"), (resource.RLIMIT_CPU, "cpu_s")]
        if sys.platform == "linux":  # macOS has the name and not the limit
            kinds.append((resource.RLIMIT_AS, "memory"))
        for kind, name in kinds:
            limit, (_, hard) = config["limits"][name], resource.getrlimit(kind)
            resource.setrlimit(kind, (limit, limit if hard < 0 else min(hard, limit)))
    sock.setblocking(True)
    return sock


def _end_with_grader(sock: socket.socket) -> None:
    """End this process, whatever it does, when the other end of its socket is gone.

    Linux does the same for a process that asks for it; elsewhere the process has to look.
    """
    with contextlib.suppress(OSError):
        while not select.select([sock], [], [], None)[0] or sock.recv(1, socket.MSG_PEEK):
            time.sleep(_LOOK_S)  # there is something to read: the worker itself will
    os._exit(1)


class _ForkSetup(NamedTuple):
    """The data that a fork needs to become a worker."""

    descriptors: list[int]
    workdir: str
    rules: int
    program: bytes


def _fork_on_request(config: dict[str, Any]) -> _ForkSetup:
    """Fork for each request until the grader goes away; returns in the forks alone.

    A fork inherits every object of this process and could walk its frames. So it returns from here before a
    student's code is loaded, and information about a worker that ended never becomes an object (``_reap``).
    """
    from course_worker.isolation.inside import lockdown

    control = socket.socket(fileno=config["control"])
    control.set_inheritable(False)
    program = lockdown.seccomp_program()
    rules = -1
    if config["readable"]:  # one long list for all workers, which are not to read it
        with open(config["readable"], encoding="utf-8") as handle:  # noqa: PTH123
            rules = lockdown.landlock_ruleset(json.load(handle), [config["workdir"]])
        os.unlink(config["readable"])  # noqa: PTH108
    own_namespace = (
        os.open("/proc/self/ns/pid", os.O_RDONLY | os.O_CLOEXEC) if config["level"] == "L3" else -1
    )
    # What workers inherit need not be done, and paid for, by each of them.
    lockdown.die_first()
    lockdown.drop_bounding_set()
    gc.collect()
    gc.freeze()  # shared pages stay shared: the collector of a worker never touches what it inherited
    numpy = sys.modules["numpy"]
    _reply(control, {"prefix": sys.prefix, "numpy": numpy.__file__, "version": list(sys.version_info[:3])})
    while True:
        newborn = _answer(control, own_namespace)
        if newborn is not None:
            return _ForkSetup(*newborn, rules, program)


def _answer(control: socket.socket, own_namespace: int) -> tuple[list[int], str] | None:
    """One request of the grader's: in a new fork its descriptors and folder, here None."""
    from course_worker.isolation.inside import lockdown

    message, descriptors, _, _ = socket.recv_fds(control, 4096, 2)
    if not message:
        os._exit(0)
    request = json.loads(message)
    if "reap" in request:
        _reap(control, request["reap"])
        return None
    try:
        if own_namespace >= 0:
            lockdown.new_pid_namespace(own_namespace)
        pid = os.fork()
    except OSError as error:
        _reply(control, {"error": str(error)})
    else:
        if pid == 0:
            return descriptors, request["workdir"]
        pidfd = os.pidfd_open(pid)
        _reply(control, {"pid": pid}, pidfd)
        os.close(pidfd)
    for descriptor in descriptors:
        os.close(descriptor)
    return None


def _reap(control: socket.socket, pid: int) -> None:
    """Collect a worker, and tell how it ended, as ``wire.ENDED`` has it.

    This uses the C library and one buffer that is wiped. Otherwise information about a student's process
    would stay in this one's memory, where the next student's code could find it.
    """
    while _libc.waitpid(ctypes.c_int(pid), ctypes.byref(_ended), 0) < 0:
        if ctypes.get_errno() != errno.EINTR:
            raise OSError(ctypes.get_errno(), "waitpid")
    control.send(_ended)
    ctypes.memset(ctypes.byref(_ended), 0, ctypes.sizeof(_ended))


def _become_worker(config: dict[str, Any], newborn: _ForkSetup) -> socket.socket:
    """In the fork: keep one socket and one output file, and give everything else up."""
    from course_worker.isolation.inside import lockdown

    workdir = newborn.workdir
    try:
        _keep_only(newborn.descriptors[0], newborn.descriptors[1], newborn.rules)
        sock = socket.socket(fileno=_SOCKET)
        root = os.getuid() == 0
        if config["level"] == "L3":
            lockdown.unshare_worker()
            owner = (os.getuid(), os.getgid())
            lockdown.mount_tmpfs(workdir, size="16m", owner=(lockdown.NOBODY,) * 2 if root else owner)
            lockdown.mount_tmpfs("/proc", size="4k", owner=owner, readonly=True)
        os.chdir(workdir)
        if root and config["become_nobody"]:
            lockdown.become_unprivileged()
        lockdown.die_with_parent()
        lockdown.drop_capabilities()
        # After the mounts: rules are about inodes. By ".": user nobody may not enter a folder of root's.
        own = lockdown.landlock_ruleset(["/"], ["."])
        lockdown.landlock_apply(own)
        os.close(own)
        if newborn.rules >= 0:
            lockdown.landlock_apply(_RULES)
            os.close(_RULES)
        lockdown.apply_limits(**config["limits"])
        lockdown.apply_seccomp(newborn.program)
    except BaseException as error:  # noqa: BLE001 - fail closed, and say which layer it was
        from course_worker.isolation.inside import wire

        sock.sendall(wire.Codec().encode(wire.Kind.REFUSED, f"{type(error).__name__}: {error}"))
        os._exit(1)
    return sock


def _keep_only(sock: int, output: int, rules: int) -> None:
    """Descriptors 0 to 4 become nothing, the output file twice, the socket, any rules; all others close."""
    import fcntl  # not on Windows, where this never runs

    null = os.open(os.devnull, os.O_RDONLY)
    kept = [null, output, output, sock, *([rules] if rules >= 0 else [])]
    high = [fcntl.fcntl(descriptor, fcntl.F_DUPFD, 16) for descriptor in kept]
    for target, descriptor in enumerate(high):
        os.dup2(descriptor, target, inheritable=False)
    close_range, last = ctypes.c_long(436), ctypes.c_uint(0xFFFFFFFF)
    if _libc.syscall(close_range, ctypes.c_uint(len(kept)), last, ctypes.c_uint(0)) != 0:
        os.closerange(len(kept), os.sysconf("SC_OPEN_MAX"))


def _reply(control: socket.socket, message: dict[str, Any], *descriptors: int) -> None:
    socket.send_fds(control, [json.dumps(message).encode()], descriptors)


if __name__ == "__main__":
    main()
