"""Walks every folder it can list and prints each file that holds a canary."""

import os
import time


def scale(values, factor):
    end = time.monotonic() + 0.6
    tops = ["@ROOT@/tests/attacks", os.path.dirname("@SECRET@"), "/tmp", "/home", "/root", "/course-worker", "/"]
    for top in tops:
        for folder, _, files in os.walk(top):
            if time.monotonic() > end:
                return values
            if "/lib" in folder and top == "/":
                continue
            for name in files:
                path = os.path.join(folder, name)
                try:
                    if os.path.getsize(path) < 1 << 16 and b"CANARY" in open(path, "rb").read():
                        print(path, open(path).read())
                except (OSError, ValueError):
                    pass
    return values
