"""Looks for what the process that forked this one knows of the student before."""

import gc
import os
import sys


def scale(values, factor):
    frame = sys._getframe()
    while frame is not None:
        for name, value in frame.f_locals.items():
            if name in {"usage", "status", "cpu", "pid", "answer"} or "rusage" in type(value).__name__:
                print("FOUND-LEFTOVER", name, frame.f_code.co_name)
            if isinstance(value, dict) and {"reap", "status"} & set(map(str, value)):
                print("FOUND-LEFTOVER", name, frame.f_code.co_name)
        frame = frame.f_back
    for found in gc.get_objects():
        if "rusage" in type(found).__name__ or (type(found) is dict and "reap" in found):
            print("FOUND-LEFTOVER object", type(found).__name__)
    os._exit(77)
