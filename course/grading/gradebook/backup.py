"""Two copies beside a gradebook: of its newest state, and of the one before."""

from __future__ import annotations

import shutil
from typing import TYPE_CHECKING

from course.errors import MissingCapabilityError

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["back_up", "backups"]

_KEPT = 2


def back_up(path: Path) -> None:
    """Copy a closed gradebook; the previous copy becomes the older one.

    Raises:
        MissingCapabilityError: there is no room for it; the older copies are unchanged.
    """
    draft = _named(path, 0)
    try:
        shutil.copyfile(path, draft)
        for number in range(_KEPT, 1, -1):
            if _named(path, number - 1).exists():
                _named(path, number - 1).replace(_named(path, number))
        draft.replace(_named(path, 1))
    except OSError as error:
        draft.unlink(missing_ok=True)
        raise MissingCapabilityError(
            f"The backup of {path} cannot be written: {error.strerror}.",
            help="The gradebook is complete. Make room, and give the command again (a run with --resume).",
            code="no_backup",
        ) from None


def backups(path: Path) -> list[Path]:
    """The existing copies, newest first."""
    return [found for number in range(1, _KEPT + 1) if (found := _named(path, number)).is_file()]


def _named(path: Path, number: int) -> Path:
    return path.with_name(f"{path.stem}.backup-{number or 'new'}{path.suffix}")
