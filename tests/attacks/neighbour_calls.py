"""Makes every call by which two workers that run at once could tell each other something."""

import ctypes
import os
import struct

libc = ctypes.CDLL(None, use_errno=True)
shared = ctypes.cast(libc.getpid, ctypes.c_void_p).value & ~0xFFF  # a page of the C library, in all of them
blank = ctypes.create_string_buffer(4096)
library = os.open(os.__file__, os.O_RDONLY)
timeout = struct.pack("qq", 0, 1000)
parent = os.getppid() or 4242  # none where it is pid 1 of a namespace
waiter = struct.pack("QQII", 0, shared, 2, 0)
calls = {
    "futex wait": (202, shared, 0, ctypes.c_int.from_address(shared).value, timeout, None, 0),
    "futex wake": (202, shared, 1, 1, None, None, 0),
    "futex wait bitset": (202, shared, 9, ctypes.c_int.from_address(shared).value, None, None, -1),
    "futex waitv": (449, waiter, 1, 0, blank, 1),
    "set_robust_list": (273, blank, 24),
    "get_robust_list": (274, 1, blank, blank),
    "cpu clock of another": (228, (~(parent) << 3) | 2, blank),
    "cpu clock of a neighbour": (228, (~(os.getpid() + 1) << 3) | 2, blank),
    "sleep by another's clock": (230, (~(parent) << 3) | 2, 0, timeout, None),
    "sysinfo": (99, blank),
    "getsid": (124, parent),
    "getpgid": (121, parent),
    "getpriority": (140, 0, parent),
    "sched_getaffinity": (204, parent, 128, blank),
    "membarrier": (324, 1, 0, 0),
    "flock": (73, 0, 1),
    "lock": (72, 1, 6, blank),
    "open file lock": (72, 1, 37, blank),
    "lease": (72, 1, 1024, 0),
    "mincore": (27, shared, 4096, blank),
    "merge pages": (28, shared, 4096, 12),
    "page out": (28, shared, 4096, 21),
    "out of band": (44, 3, b"", 0, 1, None, 0),
    "with an address": (44, 3, b"", 0, 0, struct.pack("H", 1) + b"\0neighbour", 12),
    "peek": (45, 3, blank, 1, 0x42, None, None),
    "statfs": (137, b"/", blank),
    "epoll": (291, 0),
    "eventfd": (290, 0, 0),
    "drop from the page cache": (221, library, 0, 0, 4),
    "read ahead": (187, library, 0, 4096),
    "what is in the page cache": (451, library, blank, blank, 0),
    "read only what is in the page cache": (327, library, blank, 1, 0, 0, 8),
}


def scale(values, factor):
    for name, arguments in calls.items():
        ctypes.set_errno(0)
        result = libc.syscall(*[ctypes.c_long(a) if isinstance(a, int) else a for a in arguments])
        if result >= 0 or ctypes.get_errno() not in (1, 38):
            print("FOUND-LEFTOVER", name, result, ctypes.get_errno())
    return values
