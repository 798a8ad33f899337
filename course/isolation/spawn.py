"""Starts worker processes for one grading session, at the protection level it is told to use.

    L3  bubblewrap around a zygote; a worker forked from it gets namespaces, Landlock and seccomp
    L2  the zygote without bubblewrap: Landlock, seccomp and limits
    L1  one plain process per worker: the wire protocol and deadlines, nothing else

The rest of the program talks to a ``Handle``: a channel, a way to kill, and how it ended. What that must be
is written in ``course.isolation.levels``; ``spawner`` is where another kind of worker is entered, and nothing
above this package has to know of it.
"""

from __future__ import annotations

import contextlib
import json
import os
import select
import shutil
import signal
import socket
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from course.isolation import launch
from course.isolation.failures import IsolationError
from course.isolation.inside.wire import ENDED, LOOK
from course.isolation.launch import View, view_for
from course.isolation.levels import (
    LIMITS,
    MAX_OUTPUT,
    START_TIMEOUT,
    Exit,
    Handle,
    Level,
    ProcessClock,
    Spawner,
    ticking,
)

# ---
# Linux, L3 and L2: workers forked from a warm zygote, each ended by a pidfd.


_INSIDE = "/course-worker"  # where the worker's files appear inside bubblewrap
_PACKAGES = "/packages"


class ZygoteSpawner:
    """Linux: forks workers from a warm zygote and holds a pidfd of each."""

    def __init__(self, level: Level, view: View, imports: tuple[str, ...]) -> None:
        self.level = level
        self._view = view
        self._imports = imports
        self._process: subprocess.Popen[bytes] | None = None
        self._left: list[Iterator[None]] = []  # removals of folders of workers that ended
        self._start()

    def _start(self) -> None:
        self._folder = launch.private_folder()
        self._control, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        try:
            with theirs:
                launch.copy_worker_files(self._folder)
                self._process = self._run(self._command(theirs.fileno()), theirs.fileno())
            self._control.settimeout(START_TIMEOUT)
            self._check_start()
        except BaseException:
            self.close()
            raise

    def _command(self, control: int) -> list[str]:
        root = os.getuid() == 0
        config: dict[str, Any] = {
            "control": control,
            "level": self.level.value,
            "imports": list(self._imports),
            "limits": vars(LIMITS),
            "become_nobody": root and (self.level is Level.L3 or _open_to_others(self._view)),
        }
        if self.level is Level.L3:
            # No list of readable files is needed: the root contains only these.
            self._scratch = "/tmp"
            config |= {"path": [_INSIDE, _PACKAGES], "readable": None, "workdir": self._scratch}
            inside = launch.command(self._view, _INSIDE, config)
            return [*_bubblewrap(self._view, self._folder, root), *inside]
        scratch = self._folder / "scratch"
        scratch.mkdir(mode=0o711)
        self._scratch = str(scratch)
        readable = self._folder / "readable.json"  # may well be longer than an argument can be
        readable.write_text(
            json.dumps([str(path) for path in (*self._view.expanded(), self._folder)]), "utf-8"
        )
        path = [str(self._folder), *sorted({str(entry.parent) for entry in self._view.packages})]
        config |= {"path": path, "readable": str(readable), "workdir": self._scratch}
        if config["become_nobody"]:
            self._folder.chmod(0o711)
        return launch.command(self._view, str(self._folder), config)

    def _run(self, command: list[str], control: int) -> subprocess.Popen[bytes]:
        with (self._folder / "stderr").open("wb") as errors:
            try:
                return subprocess.Popen(
                    command,
                    pass_fds=(control,),
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=errors,
                    env=launch.environment(),
                    cwd="/",
                )
            except OSError as error:
                raise IsolationError(f"the zygote could not be started: {error}") from None

    def _check_start(self) -> None:
        """An interpreter may silently load a library other than its own: compare what the zygote reports."""
        try:
            hello, _ = self._receive()
        except (OSError, ValueError) as error:
            raise IsolationError(f"the zygote did not start: {self._stderr() or error}") from None
        expected = list(sys.version_info[:3])
        view, prefix = self._view, hello["prefix"]
        if Path(prefix) != view.prefix or hello["version"] != expected:
            raise IsolationError(f"the zygote runs another Python: {prefix}, expected {view.prefix}")
        roots = [Path(_PACKAGES), *view.packages]
        if not any(Path(hello["numpy"]).is_relative_to(root) for root in roots):
            raise IsolationError(f"the zygote found another numpy: {hello['numpy']}")

    def _stderr(self) -> str:
        text = (self._folder / "stderr").read_text("utf-8", "replace").strip()
        return text.splitlines()[-1] if text else ""

    def _send(self, message: dict[str, Any], descriptors: tuple[int, ...] = ()) -> None:
        socket.send_fds(self._control, [json.dumps(message).encode()], descriptors)

    def _receive(self) -> tuple[dict[str, Any], int | None]:
        message, received, _, _ = socket.recv_fds(self._control, 4096, 1)
        if not message:
            raise OSError("the zygote ended")
        return json.loads(message), received[0] if received else None

    def spawn(self) -> Handle:
        try:
            return self._fork()
        except OSError as error:
            # The zygote is gone: the system may end any process when memory runs out. Start another, once.
            cause = self._stderr() or str(error)
        self.close()
        self._start()
        try:
            return self._fork()
        except OSError:
            raise IsolationError(f"the zygote does not answer: {cause}") from None

    def _fork(self) -> Handle:
        ours, theirs = socket.socketpair()
        output = os.memfd_create("output", os.MFD_CLOEXEC)
        workdir = self._scratch
        try:
            if self.level is Level.L2:
                workdir = tempfile.mkdtemp(dir=self._scratch)
                # The worker may run as user nobody; only the owner can list the folder around it.
                Path(workdir).chmod(0o777)
            with theirs:
                self._send({"workdir": workdir}, (theirs.fileno(), output))
                answer, pidfd = self._receive()
            if pidfd is None:
                raise IsolationError(f"the zygote could not fork: {answer.get('error')}")
        except BaseException:
            ours.close()
            os.close(output)
            raise
        return _ForkedHandle(ours, answer["pid"], pidfd, output, workdir, self)

    def reap(self, pid: int) -> Exit:
        """Collect a worker that has ended."""
        try:
            self._send({"reap": pid})
            (status,) = ENDED.unpack(self._control.recv(4096))
        except (OSError, struct.error) as error:
            raise IsolationError(f"the zygote does not answer: {self._stderr() or error}") from None
        return Exit(os.WEXITSTATUS(status) if os.WIFEXITED(status) else 0, status & 0x7F)

    def leave(self, workdir: Path) -> None:
        """Remember the folder of a worker that ended, for ``tidy``."""
        self._left.append(launch.removing(workdir))

    def tidy(self) -> None:
        launch.tidy(self._left)

    def close(self) -> None:
        self._control.close()  # the zygote ends at end of file, and all it started with it
        if self._process is not None:
            try:
                self._process.wait(2)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            self._process = None
        launch.sweep(self._folder)


def _bubblewrap(view: View, folder: Path, root: bool) -> list[str]:
    """The command that builds a root with only the view in it, and starts a process there."""
    binary = shutil.which("bwrap")
    if binary is None:
        raise IsolationError("bubblewrap is not installed")
    command = [binary, *(f"--unshare-{name}" for name in ("pid", "net", "ipc", "uts", "cgroup-try"))]
    command += ["--hostname", "course", "--die-with-parent", "--new-session"]
    if not root:
        # Not "--dev": it would nest a second user namespace, in which these capabilities are void.
        command += ["--unshare-user", "--cap-add", "CAP_SYS_ADMIN", "--cap-add", "CAP_SETPCAP"]
    for above in _folders_above(view.readable):
        # Made by name: those that a bind makes on its way are closed to everyone but their owner.
        command += ["--perms", "0755", "--dir", str(above)]
    for path in view.readable:
        if path.is_symlink():
            command += ["--symlink", os.readlink(path), str(path)]  # noqa: PTH115 - the text of the link
        else:
            bind = "--dev-bind" if path.is_relative_to("/dev") else "--ro-bind"
            command += [bind, str(path), str(path)]
    for path in view.masked:
        command += ["--perms", "0755", "--tmpfs", str(path)]
    command += ["--perms", "0755", "--dir", _PACKAGES]
    for path in view.packages:
        command += ["--ro-bind", str(path), f"{_PACKAGES}/{path.name}"]
    for path in view.masked:
        command += ["--remount-ro", str(path)]
    command += ["--ro-bind", str(folder), _INSIDE, "--proc", "/proc", "--tmpfs", "/tmp"]
    return [*command, "--remount-ro", "/tmp", "--remount-ro", "/", "--chdir", "/", "--"]


def _folders_above(paths: tuple[Path, ...]) -> list[Path]:
    """Folders that lead to these paths and are not inside one of them, outermost first."""
    above = {parent for path in paths for parent in path.parents}
    inside = {folder for folder in above if any(folder.is_relative_to(path) for path in paths)}
    return sorted(above - inside - {Path("/")})


def _open_to_others(view: View) -> bool:
    """Whether an unprivileged user can reach the interpreter (it may lie below root's own home)."""
    folders = {folder for path in (view.interpreter, *view.packages) for folder in path.parents}
    return all(folder.stat().st_mode & 0o001 for folder in folders)


def _number_here(pidfd: int) -> int:
    """The pid of a process as this process sees it; the zygote may live in a namespace of its own."""
    lines = Path(f"/proc/self/fdinfo/{pidfd}").read_text("ascii").splitlines()
    return next(int(line.partition(":")[2]) for line in lines if line.startswith("Pid:"))


@dataclass(eq=False)
class _ForkedHandle:
    """A worker forked by the zygote, ended by its pidfd."""

    channel: socket.socket
    _pid: int
    _pidfd: int
    _output: int
    _workdir: str
    _owner: ZygoteSpawner
    _exit: Exit | None = None

    def __post_init__(self) -> None:
        ticking(self.channel)
        clock = ProcessClock(_number_here(self._pidfd))
        self.cpu_s, self.asleep = clock.cpu_s, clock.asleep

    def output(self) -> str:
        return os.pread(self._output, MAX_OUTPUT, 0).decode("utf-8", "replace")

    def look(self) -> None:
        if LOOK is not None and self._exit is None:
            with contextlib.suppress(ProcessLookupError):
                signal.pidfd_send_signal(self._pidfd, LOOK)

    def finish(self) -> Exit:
        if self._exit is None:
            ended, _, _ = select.select([self._pidfd], [], [], 0)
            if not ended:
                with contextlib.suppress(ProcessLookupError):
                    signal.pidfd_send_signal(self._pidfd, signal.SIGKILL)
                ended, _, _ = select.select([self._pidfd], [], [], START_TIMEOUT)
                if not ended:
                    raise IsolationError("a worker does not end after SIGKILL")
            try:
                self._exit = self._owner.reap(self._pid)
            finally:
                self.channel.close()
                os.close(self._pidfd)
                os.close(self._output)
                if self._owner.level is Level.L2:
                    self._owner.leave(Path(self._workdir))
        return self._exit


# ---
# L1, on any system: a plain process per worker.


class ProcessSpawner:
    """Any system: a plain process per worker, the next one started ahead so that a restart costs no wait."""

    def __init__(self, view: View, imports: tuple[str, ...]) -> None:
        self.level = Level.L1
        self._folder = launch.private_folder()
        launch.copy_worker_files(self._folder)
        self._view = view
        self._imports = imports
        self._standby: _ProcessHandle | None = None
        self._left: list[Iterator[None]] = []  # removals of folders of workers that ended

    def _start(self) -> _ProcessHandle:
        workdir = Path(tempfile.mkdtemp(dir=self._folder))
        packages = sorted({str(entry.parent) for entry in self._view.packages})
        config: dict[str, Any] = {
            "level": "L1",
            "imports": list(self._imports),
            "limits": vars(LIMITS),
            "path": [str(self._folder), *packages],
            "workdir": str(workdir),
        }
        ours, theirs = socket.socketpair()
        # Opened twice and at once: later the student's code may have put anything under that name.
        with theirs, (workdir / ".output").open("wb") as output:
            printed = (workdir / ".output").open("rb")
            streams: dict[str, Any] = {"stdout": output, "stderr": output, "env": launch.environment()}
            if sys.platform == "win32":
                process = self._start_windows(theirs, config, streams)
            else:
                process = subprocess.Popen(
                    launch.command(self._view, str(self._folder), {**config, "control": theirs.fileno()}),
                    pass_fds=(theirs.fileno(),),
                    start_new_session=True,
                    stdin=subprocess.DEVNULL,
                    **streams,
                )
        return _ProcessHandle(ours, process, printed, workdir, self._left)

    def _start_windows(
        self, theirs: socket.socket, config: dict[str, Any], streams: dict[str, Any]
    ) -> subprocess.Popen[bytes]:
        # A socket cannot be inherited there; it is shared with the child by its process id, over stdin.
        shared_size = len(theirs.share(os.getpid()))  # type: ignore[attr-defined]
        command = launch.command(self._view, str(self._folder), {**config, "share": shared_size})
        process = subprocess.Popen(command, stdin=subprocess.PIPE, **streams)
        assert process.stdin is not None
        process.stdin.write(theirs.share(process.pid))  # type: ignore[attr-defined]
        process.stdin.close()
        return process

    def spawn(self) -> Handle:
        handle, self._standby = self._standby, None
        if handle is not None and not handle.alive():
            # It ended with the thread that started it, because Linux takes that thread for its parent.
            handle.finish()
            handle = None
        handle = handle or self._start()
        try:
            self._standby = self._start()
        except OSError as error:
            handle.finish()
            raise IsolationError(f"a worker process could not be started: {error}") from None
        return handle

    def tidy(self) -> None:
        launch.tidy(self._left)

    def close(self) -> None:
        if self._standby is not None:
            self._standby.finish()
            self._standby = None
        launch.sweep(self._folder)


@dataclass(eq=False)
class _ProcessHandle:
    """A worker that is a plain child process."""

    channel: socket.socket
    _process: subprocess.Popen[bytes]
    _output: IO[bytes]
    _workdir: Path
    _left: list[Iterator[None]]

    def __post_init__(self) -> None:
        ticking(self.channel)
        clock = ProcessClock(self._process.pid)
        self.cpu_s, self.asleep = clock.cpu_s, clock.asleep

    def alive(self) -> bool:
        return self._process.poll() is None

    def output(self) -> str:
        if self._output.closed:
            return ""
        self._output.seek(0)
        return self._output.read(MAX_OUTPUT).decode("utf-8", "replace")

    def look(self) -> None:
        if LOOK is not None:
            self._process.send_signal(LOOK)

    def finish(self) -> Exit:
        if hasattr(os, "killpg"):  # not on Windows
            # What it started goes with it, also if it ended by itself; until it is waited for, its number
            # cannot have become another's.
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(self._process.pid, signal.SIGKILL)
        self._process.kill()
        code = self._process.wait()
        self.channel.close()
        self._output.close()
        self._left.append(launch.removing(self._workdir))
        return Exit(max(code, 0), max(-code, 0))


def spawner(level: Level, imports: tuple[str, ...]) -> Spawner:
    """A spawner for submissions that may import ``imports``."""
    view = view_for(imports)
    if level is Level.L1:
        return ProcessSpawner(view, imports)
    return ZygoteSpawner(level, view, imports)
