"""Starts worker processes for one grading session, at the protection level it is told to use.

    L3  bubblewrap around a zygote; a worker forked from it gets namespaces, Landlock and seccomp
    L2  the zygote without bubblewrap: Landlock, seccomp and limits
    L1  one plain process per worker: the wire protocol and deadlines, nothing else

The rest of the program talks to a ``Handle``: a socket, a way to kill, and how it ended.
"""

from __future__ import annotations

import array
import contextlib
import json
import os
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any, Protocol

from course.isolation.failures import IsolationError
from course.isolation.view import View, view_for

__all__ = ["LIMITS", "Exit", "Handle", "Level", "Limits", "Spawner", "spawner"]

_FLAT_FILES = ("isolation/wire.py", "isolation/worker.py", "isolation/lockdown.py", "isolation/zygote.py")
_RHS_FILE = "physics/systems.py"
_INSIDE = "/course-worker"  # where the flat files appear inside bubblewrap
_START_TIMEOUT = 30.0  # s; starting takes about 0.2, a laptop that wakes up may take far longer


class Level(StrEnum):
    """How strongly a stranger's code is kept apart; a greater letter is not weaker."""

    L1 = "L1"
    L2 = "L2"
    L3 = "L3"


@dataclass(frozen=True)
class Limits:
    """What one worker may use.

    Attributes:
        cpu_s: seconds of CPU; the wall deadline ends a check long before.
        memory: bytes of address space.
        file_size: bytes per file, the captured output included.
        descriptors: open files.
    """

    cpu_s: int = 90
    memory: int = 2 << 30
    file_size: int = 1 << 20
    descriptors: int = 32


LIMITS = Limits()


@dataclass(frozen=True)
class Exit:
    """How a worker ended. ``signal`` is 0 if it exited by itself."""

    code: int
    signal: int
    cpu_s: float = 0.0


class Handle(Protocol):
    """A running worker."""

    sock: socket.socket

    def output(self) -> str:
        """What it printed so far."""

    def finish(self) -> Exit:
        """Kill it if it lives, wait for its end, clean up after it."""


class Spawner(Protocol):
    """Starts workers, one at a time."""

    level: Level

    def spawn(self) -> Handle:
        """A new worker.

        Raises:
            IsolationError: it could not be started.
        """

    def close(self) -> None:
        """End everything that was started; safe to call twice."""


def spawner(level: Level, imports: tuple[str, ...], *, limits: Limits = LIMITS) -> Spawner:
    """A spawner for submissions that may import ``imports``.

    Raises:
        IsolationError: this machine cannot provide that level.
    """
    view = view_for(imports)
    if level is Level.L1:
        return _ProcessSpawner(view, imports, limits)
    return _ZygoteSpawner(level, view, imports, limits)


def _copy_flat_files(target: Path) -> None:
    package = Path(__file__).resolve().parents[1]
    for name in (*_FLAT_FILES, _RHS_FILE):
        shutil.copy(package / name, target)


def _command(view: View, folder: str, config: dict[str, Any]) -> list[str]:
    # -S and -s: no site-packages, so nothing but the declared packages on the path; -P: no current folder.
    flags = ["-S", "-s", "-P", "-B"]
    return [str(view.interpreter), *flags, f"{folder}/zygote.py", json.dumps(config)]


def _environment() -> dict[str, str]:
    kept = {
        name: os.environ[name]
        for name in ("SYSTEMROOT", "PATH")
        if name in os.environ and sys.platform == "win32"
    }
    threads = {f"{name}_NUM_THREADS": "1" for name in ("OPENBLAS", "OMP", "MKL", "VECLIB_MAXIMUM")}
    return {**kept, **threads, "LANG": "C.UTF-8", "HOME": "/nonexistent", "PYTHONHASHSEED": "0"}


class _ZygoteSpawner:
    """Linux: forks workers from a warm zygote and holds a pidfd of each."""

    def __init__(self, level: Level, view: View, imports: tuple[str, ...], limits: Limits) -> None:
        self.level = level
        self._folder = Path(tempfile.mkdtemp(prefix="course-zygote-"))
        self._process: subprocess.Popen[bytes] | None = None
        try:
            _copy_flat_files(self._folder)
            self._start(view, imports, limits)
        except BaseException:
            self.close()
            raise

    def _start(self, view: View, imports: tuple[str, ...], limits: Limits) -> None:
        root = os.getuid() == 0
        scratch = self._folder / "scratch"
        scratch.mkdir(mode=0o711)
        self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        config: dict[str, Any] = {
            "control": theirs.fileno(),
            "level": self.level.value,
            "imports": list(imports),
            "limits": vars(limits),
            "become_nobody": root and (self.level is Level.L3 or _open_to_others(view)),
        }
        if self.level is Level.L3:
            self._scratch = "/tmp"
            config |= {"path": [_INSIDE, "/packages"], "readable": ["/"], "workdir": "/tmp"}
            command = self._bubblewrap(view, root) + _command(view, _INSIDE, config)
        else:
            self._scratch = str(scratch)
            readable = [str(path) for path in (*view.expanded(), self._folder)]
            path = [str(self._folder), *sorted({str(entry.parent) for entry in view.packages})]
            config |= {"path": path, "readable": readable, "workdir": self._scratch}
            if config["become_nobody"]:
                self._folder.chmod(0o711)
            command = _command(view, str(self._folder), config)
        with theirs, (self._folder / "stderr").open("wb") as errors:
            self._process = subprocess.Popen(
                command,
                pass_fds=(theirs.fileno(),),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=errors,
                env=_environment(),
                cwd="/",
            )
        self._control.settimeout(_START_TIMEOUT)
        self._check_start(view)

    def _bubblewrap(self, view: View, root: bool) -> list[str]:
        binary = shutil.which("bwrap")
        if binary is None:
            raise IsolationError("bubblewrap is not installed")
        command = [
            binary,
            "--unshare-pid",
            "--unshare-net",
            "--unshare-ipc",
            "--unshare-uts",
            "--die-with-parent",
        ]
        command += ["--unshare-cgroup-try", "--new-session"]
        if not root:
            # Not "--dev": it would nest a second user namespace, in which these capabilities are void.
            command += ["--unshare-user", "--cap-add", "CAP_SYS_ADMIN", "--cap-add", "CAP_SETPCAP"]
        for path in view.readable:
            if path.is_symlink():
                command += ["--symlink", os.readlink(path), str(path)]  # noqa: PTH115 - the text of the link
            else:
                command += [
                    "--dev-bind" if str(path).startswith("/dev/") else "--ro-bind",
                    str(path),
                    str(path),
                ]
        for path in view.masked:
            command += ["--tmpfs", str(path)]
        for path in view.packages:
            command += ["--ro-bind", str(path), f"/packages/{path.name}"]
        command += ["--ro-bind", str(self._folder), _INSIDE, "--proc", "/proc", "--tmpfs", "/tmp"]
        return [*command, "--remount-ro", "/tmp", "--remount-ro", "/", "--chdir", "/", "--"]

    def _check_start(self, view: View) -> None:
        """An interpreter may silently load another library than its own: compare what the zygote reports."""
        try:
            hello, _ = self._receive()
        except (OSError, ValueError) as error:
            raise IsolationError(f"the zygote did not start: {self._stderr() or error}") from None
        expected = list(sys.version_info[:3])
        if Path(hello["prefix"]) != view.prefix or hello["version"] != expected:
            raise IsolationError(f"the zygote runs another Python: {hello['prefix']}, expected {view.prefix}")
        roots = [Path("/packages"), *view.packages]
        if not any(Path(hello["numpy"]).is_relative_to(root) for root in roots):
            raise IsolationError(f"the zygote found another numpy: {hello['numpy']}")

    def _stderr(self) -> str:
        text = (self._folder / "stderr").read_text("utf-8", "replace").strip()
        return text.splitlines()[-1] if text else ""

    def _send(self, message: dict[str, Any], descriptors: tuple[int, ...] = ()) -> None:
        rights = (
            [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array.array("i", descriptors))] if descriptors else []
        )
        self._control.sendmsg([json.dumps(message).encode()], rights)

    def _receive(self) -> tuple[dict[str, Any], int | None]:
        message, ancillary, _, _ = self._control.recvmsg(4096, socket.CMSG_LEN(4))
        if not message:
            raise OSError("the zygote ended")
        received = array.array("i")
        for _, _, data in ancillary:
            received.frombytes(data[: len(data) - len(data) % received.itemsize])
        return json.loads(message), received[0] if received else None

    def spawn(self) -> Handle:
        ours, theirs = socket.socketpair()
        output = os.memfd_create("output", os.MFD_CLOEXEC)
        workdir = self._scratch
        if self.level is Level.L2:
            workdir = tempfile.mkdtemp(dir=self._scratch)
            Path(workdir).chmod(0o777)  # inside a folder only its owner can list; the worker may be nobody
        try:
            with theirs:
                self._send({"workdir": workdir}, (theirs.fileno(), output))
                answer, pidfd = self._receive()
            if pidfd is None:
                raise IsolationError(f"the zygote could not fork: {answer.get('error')}")
        except OSError as error:
            ours.close()
            os.close(output)
            raise IsolationError(f"the zygote does not answer: {self._stderr() or error}") from None
        return _ForkedHandle(ours, answer["pid"], pidfd, output, workdir, self)

    def reap(self, pid: int) -> Exit:
        """Collect a worker that has ended."""
        self._send({"reap": pid})
        answer, _ = self._receive()
        status = answer["status"]
        return Exit(os.WEXITSTATUS(status) if os.WIFEXITED(status) else 0, status & 0x7F, answer["cpu_s"])

    def close(self) -> None:
        if self._process is not None:
            with contextlib.suppress(OSError):
                self._control.close()  # the zygote ends at end of file, and all it started with it
            try:
                self._process.wait(2)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            self._process = None
        shutil.rmtree(self._folder, ignore_errors=True)


def _open_to_others(view: View) -> bool:
    """Whether an unprivileged user can reach the interpreter (it may lie below root's own home)."""
    for path in (view.interpreter, *view.packages):
        for folder in path.parents:
            if not folder.stat().st_mode & 0o001:
                return False
    return True


class _ForkedHandle:
    """A worker forked by the zygote, ended by its pidfd."""

    def __init__(
        self, sock: socket.socket, pid: int, pidfd: int, output: int, workdir: str, owner: _ZygoteSpawner
    ) -> None:
        self.sock = sock
        self._pid = pid
        self._pidfd = pidfd
        self._output = output
        self._workdir = workdir
        self._owner = owner
        self._exit: Exit | None = None

    def output(self) -> str:
        size = min(os.fstat(self._output).st_size, LIMITS.file_size)
        return os.pread(self._output, size, 0).decode("utf-8", "replace")

    def finish(self) -> Exit:
        if self._exit is None:
            ended, _, _ = select.select([self._pidfd], [], [], 0)
            if not ended:
                with contextlib.suppress(ProcessLookupError):
                    signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)
                ended, _, _ = select.select([self._pidfd], [], [], _START_TIMEOUT)
                if not ended:
                    raise IsolationError("a worker does not end after SIGKILL")
            self._exit = self._owner.reap(self._pid)
            self.sock.close()
            os.close(self._pidfd)
            os.close(self._output)
            if self._owner.level is Level.L2:
                shutil.rmtree(self._workdir, ignore_errors=True)
        return self._exit


class _ProcessSpawner:
    """Any system: a plain process per worker, the next one started ahead so that a restart costs no wait."""

    def __init__(self, view: View, imports: tuple[str, ...], limits: Limits) -> None:
        self.level = Level.L1
        self._folder = Path(tempfile.mkdtemp(prefix="course-worker-"))
        _copy_flat_files(self._folder)
        self._view = view
        self._imports = imports
        self._limits = limits
        self._standby: _ProcessHandle | None = None

    def _start(self) -> _ProcessHandle:
        workdir = Path(tempfile.mkdtemp(dir=self._folder))
        packages = sorted({str(entry.parent) for entry in self._view.packages})
        config: dict[str, Any] = {
            "level": "L1",
            "imports": list(self._imports),
            "limits": vars(self._limits),
            "path": [str(self._folder), *packages],
            "workdir": str(workdir),
        }
        ours, theirs = socket.socketpair()
        with theirs:
            return _ProcessHandle(ours, theirs, self._view, str(self._folder), config, workdir)

    def spawn(self) -> Handle:
        handle = self._standby or self._start()
        self._standby = None
        try:
            self._standby = self._start()
        except OSError as error:
            handle.finish()
            raise IsolationError(f"a worker process could not be started: {error}") from None
        return handle

    def close(self) -> None:
        if self._standby is not None:
            self._standby.finish()
            self._standby = None
        shutil.rmtree(self._folder, ignore_errors=True)


class _ProcessHandle:
    """A worker that is a plain child process."""

    def __init__(
        self,
        ours: socket.socket,
        theirs: socket.socket,
        view: View,
        folder: str,
        config: dict[str, Any],
        workdir: Path,
    ) -> None:
        self.sock = ours
        self._workdir = workdir
        self._path = workdir / ".output"
        with self._path.open("wb") as output:
            streams: dict[str, Any] = {"stdout": output, "stderr": output, "env": _environment()}
            if sys.platform == "win32":
                self._process = self._start_windows(theirs, view, folder, config, streams)
            else:
                self._process = subprocess.Popen(
                    _command(view, folder, {**config, "control": theirs.fileno()}),
                    pass_fds=(theirs.fileno(),),
                    start_new_session=True,
                    stdin=subprocess.DEVNULL,
                    **streams,
                )

    @staticmethod
    def _start_windows(
        theirs: socket.socket, view: View, folder: str, config: dict[str, Any], streams: dict[str, Any]
    ) -> subprocess.Popen[bytes]:
        # A socket cannot be inherited there; it is shared with the child by its process id, over stdin.
        shared_size = len(theirs.share(os.getpid()))  # type: ignore[attr-defined]
        command = _command(view, folder, {**config, "share": shared_size})
        process = subprocess.Popen(command, stdin=subprocess.PIPE, **streams)
        assert process.stdin is not None
        process.stdin.write(theirs.share(process.pid))  # type: ignore[attr-defined]
        process.stdin.close()
        return process

    def output(self) -> str:
        with self._path.open("rb") as handle:
            return handle.read(LIMITS.file_size).decode("utf-8", "replace")

    def finish(self) -> Exit:
        if self._process.poll() is None:
            if sys.platform == "win32":
                self._process.kill()
            else:
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.killpg(self._process.pid, signal.SIGKILL)  # what it started goes with it
                self._process.kill()
        code = self._process.wait()
        self.sock.close()
        shutil.rmtree(self._workdir, ignore_errors=True)
        return Exit(max(code, 0), max(-code, 0))
