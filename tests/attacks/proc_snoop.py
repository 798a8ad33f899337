"""Reads memory, environment, descriptors and links of other processes."""

import os

pids = [*range(1, 8), os.getpid(), os.getppid(), int("@PID@"), "self", "thread-self"]
for pid in pids:
    for name in ("mem", "environ", "cmdline", "maps", "fd/0", "fd/3", "root", "cwd", "exe", "ns/pid", "oom_score_adj"):
        path = f"/proc/{pid}/{name}"
        for read in (lambda: open(path, "rb").read(64), lambda: os.readlink(path), lambda: os.listdir(path)):
            try:
                print("FILE-CANARY" + "-7f3a: read", path, read())
            except OSError:
                pass
