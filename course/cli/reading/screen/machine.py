"""What the reader needs of the machine it runs on: something that shows files, and a folder to write to."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from course.errors import MissingCapabilityError

__all__ = ["can_open", "write_new"]


def can_open() -> bool:
    """Whether something here can show a page of the web or a picture in a window of its own."""
    if sys.platform in {"darwin", "win32"}:
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY") or os.environ.get("BROWSER"))


def write_new(name: str, text: str) -> Path:
    """Write a file into the current folder; one that is there already keeps its name and content.

    Raises:
        MissingCapabilityError: the folder cannot be written.
    """
    stem, _, ending = name.rpartition(".")
    number = 1
    while True:
        path = Path(name if number == 1 else f"{stem}-{number}.{ending}")
        try:
            with path.open("x", encoding="utf-8") as file:
                file.write(text)
        except FileExistsError:
            number += 1
        except OSError as error:
            raise MissingCapabilityError(
                f"{path} cannot be written ({error.strerror or error}).",
                help="Change to a folder that can be written.",
                code="not_writable",
            ) from error
        else:
            return path
