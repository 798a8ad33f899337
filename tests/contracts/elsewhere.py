"""Makes a Python of this machine lack what Windows lacks, then goes on as the program or as a worker.

    python elsewhere.py course ARGUMENT...    the command line
    python elsewhere.py worker FILE CONFIG    what runs beside a submission, as ``launch.command`` starts it

Taken away: the modules fcntl, resource, termios, tty, pwd and grp, os.fork and what belongs to it, signals,
AF_UNIX. The platform is called something that no branch of the course knows, so that neither Linux's own ways
nor those of Windows, which need a Windows, are taken. What the standard library itself does there by other
means (a socket pair over TCP, ending a process) is put back by those means.
"""

import asyncio  # noqa: F401 - looks at the platform when it is imported, as a part of Windows would
import os
import runpy
import signal
import socket
import subprocess
import sys
import sysconfig

GONE = ("fcntl", "resource", "termios", "tty", "pty", "pwd", "grp")
OF_OS = (
    "fork", "forkpty", "getuid", "geteuid", "getgid", "getegid", "getpgid", "killpg", "setsid",
    "memfd_create", "pidfd_open", "sched_getaffinity", "sched_setaffinity", "wait4", "pread",
    "getloadavg", "mkfifo",
)  # fmt: skip


def take_away():
    sysconfig.get_config_vars()  # of the interpreter that this is, kept for later
    killed = signal.SIGKILL
    for name in GONE:
        sys.modules[name] = None  # importing it raises ImportError
    for name in OF_OS:
        delattr(os, name)
    for name in ("SIGKILL", "SIGHUP", "SIGALRM", "SIGCHLD", "pthread_sigmask", "pidfd_send_signal"):
        delattr(signal, name)
    for name in ("AF_UNIX", "send_fds", "recv_fds"):
        delattr(socket, name)
    socket.socketpair = pair_over_tcp
    subprocess.Popen.kill = lambda self: self.send_signal(int(killed))
    sys.platform = "elsewhere"


def pair_over_tcp(*_):
    """As the standard library does it on Windows."""
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        listener.listen(1)
        one = socket.create_connection(listener.getsockname())
        other, _ = listener.accept()
    return one, other


def main():
    what, *rest = sys.argv[1:]
    if what == "worker":
        file, config = rest
        sys.argv[:] = [file, config]
        import select  # noqa: F401 - the standard library loads it before the names go

        take_away()
        runpy.run_path(file, run_name="__main__")
        return
    import shutil  # noqa: F401 - these look for what is about to go, and find it missing elsewhere
    import tempfile  # noqa: F401

    take_away()
    from course.isolation import launch

    plain = launch.command

    def command(view, folder, config):
        interpreter, *flags, file, text = plain(view, folder, config)
        return [interpreter, *flags, __file__, "worker", file, text]

    launch.command = command
    from course.cli.frame.app import run

    sys.exit(run(rest))


if __name__ == "__main__":
    main()
