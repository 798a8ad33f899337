"""A report of a crash: everything needed to look for the fault, in a file, for the person to send or not."""

from __future__ import annotations

import os
import platform
import sys
import tempfile
import traceback
from datetime import UTC, datetime

from course import __version__

__all__ = ["write_report"]


def write_report(error: BaseException) -> str:
    """Write the report and return its path; if even that fails, a phrase that says so."""
    lines = [
        f"course {__version__}, Python {platform.python_version()}, {platform.platform()}",
        f"when: {datetime.now(UTC).isoformat(timespec='seconds')}",
        f"command: {sys.argv!r}",
        "",
        *traceback.format_exception(error),
    ]
    try:
        handle, path = tempfile.mkstemp(prefix="course-crash-", suffix=".txt")
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as file:
            file.write("\n".join(lines))
    except OSError as problem:
        return f"no file, because none could be written ({problem.strerror or problem})"
    return path
