"""Leaves notes for the next submission in every place two could share."""

import ctypes
import mmap
import os
import tempfile

libc = ctypes.CDLL(None)
places = [os.getcwd(), tempfile.gettempdir(), "/tmp", "/var/tmp", "/dev/shm", "/run", "/course-worker", "/packages"]
for place in places:
    path = os.path.join(place, "course_attack_note")
    if os.path.exists(path):
        print("FOUND-LEFTOVER", path)
    try:
        open(path, "w").write("note")
    except OSError:
        pass
for key in (0xC0, 0xC1):
    shm = libc.shmget(key, 4096, 0o1666)
    sem = libc.semget(key, 1, 0o1666)
    queue = libc.msgget(key, 0o1666)
    if max(shm, sem, queue) >= 0:
        print("FOUND-LEFTOVER ipc")
for make in (lambda: os.memfd_create("course_attack"), lambda: mmap.mmap(1, 4096)):
    try:
        print("FOUND-LEFTOVER" if make() == -1 else "")
    except (OSError, ValueError):
        pass
os.environ["FOUND_LEFTOVER"] = "1"
