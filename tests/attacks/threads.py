"""Answers from a second thread while the first is busy."""

import threading

from course_worker.isolation.inside import wire


def scale(values, factor):
    def forge():
        print("FILE-CANARY" + "-7f3a: thread")

    try:
        threading.Thread(target=forge, daemon=True).start()
    except RuntimeError:
        pass
    return values
