"""What of Jupyter this machine lacks, and the command that installs it.

Only running notebooks needs any of it: building, checking and grading them does not.
"""

from __future__ import annotations

from importlib.util import find_spec

from course.engines.extras import requirement_of
from course.errors import MissingCapabilityError

__all__ = ["EXTRA", "install_command", "require"]

#: The packages of the extra ``notebook``, as they are imported.
EXTRA = ("jupyterlab", "nbclient", "ipykernel", "anywidget")


def install_command() -> str:
    """What installs the whole extra; it names packages, since nobody owns the course's name on an index."""
    return "pip install " + " ".join(f"'{requirement_of(package).text}'" for package in EXTRA)


def require(what: str, *packages: str) -> None:
    """Make sure that packages are there.

    Args:
        what: what they are needed for, as the beginning of a sentence.

    Raises:
        MissingCapabilityError: one is not installed; the message says how to get it.
    """
    missing = [package for package in packages if find_spec(package) is None]
    if missing:
        verb = "are" if len(missing) > 1 else "is"
        raise MissingCapabilityError(
            f"{what} needs {' and '.join(missing)}, which {verb} not installed.",
            help=f"Install it with: {install_command()}",
            code="missing_extra",
        )
