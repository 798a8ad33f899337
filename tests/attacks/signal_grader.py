"""Signals the grader, the zygote and everyone else."""

import ctypes
import fcntl
import os
import signal

libc = ctypes.CDLL(None)
pid = int("@PID@")
for number in (pid, os.getppid(), -os.getpgrp(), 2):
    for name in (0, signal.SIGUSR1) if number == pid else (0,):
        try:
            os.kill(number, name)
            if number not in (0, os.getpid()):
                print("FILE-CANARY" + "-7f3a: signalled", number)
        except OSError:
            pass
libc.syscall(200, pid, 10)  # tkill
libc.syscall(234, pid, pid, 10)  # tgkill
libc.syscall(129, pid, 10, ctypes.create_string_buffer(128))  # rt_sigqueueinfo
descriptor = libc.syscall(434, pid, 0)  # pidfd_open
libc.syscall(424, descriptor, 10, None, 0)  # pidfd_send_signal
libc.prctl(1, 10)
for fd in range(0, 6):
    for command, value in ((8, pid), (10, 10), (4, os.O_ASYNC | os.O_NONBLOCK * 0), (15, 0), (1026, 0xFF)):
        try:
            fcntl.fcntl(fd, command, value)
        except OSError:
            pass
    try:
        fcntl.ioctl(fd, 0x8901, pid.to_bytes(4, "little"))
    except OSError:
        pass
