"""Starts workers: a warm interpreter that forks a locked-down process per submission, or (L1) is one.

It holds trusted code and no secrets. The grader starts it once, inside bubblewrap at L3, with numpy loaded;
each request brings a socket and an output file and gets back a pidfd, so that the grader itself can end a
worker at any moment. Like all files that are copied next to a stranger's code, this one imports nothing of
the course.
"""

from __future__ import annotations

import array
import contextlib
import ctypes
import gc
import importlib
import json
import os
import select
import socket
import sys
import threading
import time
from typing import Any

# What submissions commonly import: loaded here once, it is in every worker for nothing.
_COMMON = (
    "abc", "bisect", "cmath", "collections", "collections.abc", "copy", "dataclasses", "enum", "functools",
    "heapq", "inspect", "itertools", "json", "math", "numbers", "operator", "random", "re", "statistics",
    "string", "time", "types", "typing", "warnings",
)  # fmt: skip
# numpy.ma: the first quantile or median imports it, which costs 13 ms.
_NUMPY = (
    "numpy", "numpy.fft", "numpy.linalg", "numpy.ma", "numpy.polynomial", "numpy.random", "numpy.testing",
)  # fmt: skip

_SOCKET, _RULES = 3, 4  # descriptors of a forked worker
_LOOK_S = 0.5
_libc = ctypes.CDLL(None)


def main() -> None:
    """Entry point; ``argv[1]`` is the configuration as JSON (see ``course.isolation.spawn``)."""
    config: dict[str, Any] = json.loads(sys.argv[1])
    sys.argv[:] = [""]
    sys.path[:0] = config["path"]
    for name in (*_COMMON, *_NUMPY, *config["imports"]):
        importlib.import_module(name)
    from course_worker.isolation import worker  # type: ignore[import-not-found]

    imports = frozenset(config["imports"])
    if config["level"] == "L1":
        _serve_here(config, imports, worker)
    else:
        _fork_on_request(config, imports, worker)


def _serve_here(config: dict[str, Any], imports: frozenset[str], worker: Any) -> None:
    """L1: this process is the worker. Its socket comes by number, or on Windows as shared bytes on stdin."""
    if config.get("share"):
        sock = socket.fromshare(sys.stdin.buffer.read(int(config["share"])))  # type: ignore[attr-defined]
    else:
        sock = socket.socket(fileno=config["control"])
    os.chdir(config["workdir"])
    if sys.platform == "linux":
        from course_worker.isolation import lockdown

        lockdown.die_with_parent()
        lockdown.drop_bounding_set()
        lockdown.drop_capabilities()
    else:
        threading.Thread(target=_end_with_grader, args=(sock,), daemon=True).start()
    if sys.platform != "win32":
        import resource

        for kind, name in ((resource.RLIMIT_FSIZE, "file_size"), (resource.RLIMIT_CPU, "cpu_s")):
            limit, (_, hard) = config["limits"][name], resource.getrlimit(kind)
            resource.setrlimit(kind, (limit, limit if hard < 0 else min(hard, limit)))
    sock.setblocking(True)
    worker.run(sock, imports)


def _end_with_grader(sock: socket.socket) -> None:
    """End this process, whatever it does, when the other end of its socket is gone.

    Linux does the same for a process that asks for it; elsewhere someone has to look.
    """
    with contextlib.suppress(OSError):
        while not select.select([sock], [], [], None)[0] or sock.recv(1, socket.MSG_PEEK):
            time.sleep(_LOOK_S)  # there is something to read: the worker itself will
    os._exit(1)


def _fork_on_request(config: dict[str, Any], imports: frozenset[str], worker: Any) -> None:
    from course_worker.isolation import lockdown

    control = socket.socket(fileno=config["control"])
    control.set_inheritable(False)
    program = lockdown.seccomp_program()
    rules = -1
    if config["readable"]:  # one long list for all workers
        with open(config["readable"], encoding="utf-8") as handle:  # noqa: PTH123
            rules = lockdown.landlock_ruleset(json.load(handle), [config["workdir"]])
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
        request, descriptors = _request(control)
        if request is None:
            os._exit(0)
        if "reap" in request:
            _, status, usage = os.wait4(request["reap"], 0)
            cpu = usage.ru_utime + usage.ru_stime
            _reply(control, {"status": status, "cpu_s": cpu, "peak_kb": usage.ru_maxrss})
            continue
        try:
            if own_namespace >= 0:
                lockdown.new_pid_namespace(own_namespace)
            pid = os.fork()
        except OSError as error:
            _reply(control, {"error": str(error)})
        else:
            if pid == 0:
                _become_worker(config, request, descriptors, program, rules, imports, worker)
            pidfd = os.pidfd_open(pid)
            _reply(control, {"pid": pid}, pidfd)
            os.close(pidfd)
        for descriptor in descriptors:
            os.close(descriptor)


def _become_worker(
    config: dict[str, Any],
    request: dict[str, Any],
    descriptors: list[int],
    program: bytes,
    rules: int,
    imports: frozenset[str],
    worker: Any,
) -> None:
    """In the fork: keep one socket and one output file, give everything else up, serve. Never returns."""
    from course_worker.isolation import lockdown

    try:
        _keep_only(descriptors[0], descriptors[1], rules)
        sock = socket.socket(fileno=_SOCKET)
        workdir = request["workdir"]
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
        own = lockdown.landlock_ruleset(["/"], [workdir])  # after the mounts: rules are about inodes
        lockdown.landlock_apply(own)
        os.close(own)
        if rules >= 0:
            lockdown.landlock_apply(_RULES)
            os.close(_RULES)
        lockdown.apply_limits(**config["limits"])
        lockdown.apply_seccomp(program)
    except BaseException as error:  # noqa: BLE001 - fail closed, and say which layer it was
        _refuse(sock, f"{type(error).__name__}: {error}")
        os._exit(1)
    worker.run(sock, imports)


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


def _refuse(sock: socket.socket, message: str) -> None:
    from course_worker.isolation import wire

    sock.sendall(wire.Codec().encode(wire.Kind.REFUSED, message))


def _request(control: socket.socket) -> tuple[dict[str, Any] | None, list[int]]:
    message, ancillary, _, _ = control.recvmsg(4096, socket.CMSG_LEN(16))
    descriptors = array.array("i")
    for level, kind, data in ancillary:
        if level == socket.SOL_SOCKET and kind == socket.SCM_RIGHTS:
            descriptors.frombytes(data[: len(data) - len(data) % descriptors.itemsize])
    return (json.loads(message) if message else None), list(descriptors)


def _reply(control: socket.socket, message: dict[str, Any], descriptor: int | None = None) -> None:
    held = array.array("i", [] if descriptor is None else [descriptor])
    rights = [(socket.SOL_SOCKET, socket.SCM_RIGHTS, held)] if held else []
    control.sendmsg([json.dumps(message).encode()], rights)


if __name__ == "__main__":
    main()
