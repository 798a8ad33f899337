"""Replaces itself by another program."""

import os
import sys

for path in (sys.executable, "/bin/sh", "/usr/bin/env"):
    try:
        os.execv(path, [path, "-c", "while :; do :; done"])
    except OSError:
        pass
