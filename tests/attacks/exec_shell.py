"""Starts other programs by every way there is."""

import ctypes
import os
import subprocess
import sys

libc = ctypes.CDLL(None, use_errno=True)
tries = {
    "subprocess": lambda: subprocess.run(["/bin/sh", "-c", "true"]).returncode,
    "python": lambda: subprocess.run([sys.executable, "-c", "1"]).returncode,
    "posix_spawn": lambda: os.posix_spawn("/bin/true", ["true"], {}),
    "system": lambda: 0 if libc.system(b"true") == 0 else 1 / 0,
    "vfork": lambda: libc.syscall(58) + 1 or 1 / 0,
    "fork": os.fork,
    "forkpty": os.forkpty,
}
for name, attempt in tries.items():
    try:
        attempt()
        print("FILE-CANARY" + "-7f3a: started by", name)
    except (OSError, ZeroDivisionError, subprocess.SubprocessError):
        pass
