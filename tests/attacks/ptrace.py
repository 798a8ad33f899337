"""Attaches to other processes and reads their memory."""

import ctypes
import os

libc = ctypes.CDLL(None)
buffer = ctypes.create_string_buffer(64)


class Vector(ctypes.Structure):
    _fields_ = [("base", ctypes.c_void_p), ("length", ctypes.c_size_t)]


for pid in (int("@PID@"), os.getppid(), 1, 2):
    if pid == os.getpid():
        continue
    here, there = Vector(ctypes.addressof(buffer), 64), Vector(id(buffer), 64)
    results = [libc.ptrace(16, pid, None, None), libc.ptrace(0x4206, pid, None, None)]
    results.append(libc.syscall(310, pid, ctypes.byref(here), 1, ctypes.byref(there), 1, 0))
    results.append(libc.syscall(311, pid, ctypes.byref(here), 1, ctypes.byref(there), 1, 0))
    results.append(libc.syscall(438, libc.syscall(434, pid, 0), 3, 0))
    results.append(libc.syscall(312, pid, os.getpid(), 0, 3, 3))
    if any(result >= 0 for result in results):
        print("FILE-CANARY" + "-7f3a: traced", pid, results)
