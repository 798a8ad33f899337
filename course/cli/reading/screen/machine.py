"""Writing a file to the current folder."""

from __future__ import annotations

from pathlib import Path

from course.errors import MissingCapabilityError


def write_new(name: str, text: str) -> Path:
    """Write a file into the current folder; an existing one keeps its name and content.

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
