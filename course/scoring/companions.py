"""Modules that the checks of an exercise share, loaded by path from the course in use."""

from __future__ import annotations

import functools
import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from course.catalog.locate import content

if TYPE_CHECKING:
    from types import ModuleType

__all__ = ["companion", "sibling"]


def companion(exercise_id: str, module: str) -> ModuleType:
    """A module that the public and hidden checks of an exercise share: ``exercises/<id>/<module>.py``.

    It is loaded by path from the course in use, once a process.

    Raises:
        FileNotFoundError: the exercise has no such file.
    """
    return _load(content().exercises / exercise_id / f"{module}.py", f"{exercise_id}_{module}")


def sibling(file: str, module: str) -> ModuleType:
    """A module beside a file of checks: ``sibling(__file__, "bundles")``.

    Raises:
        FileNotFoundError: there is no such file.
    """
    path = Path(file).resolve()
    return _load(path.with_name(f"{module}.py"), f"{path.parent.name}_{module}")


@functools.cache
def _load(path: Path, label: str) -> ModuleType:
    if not path.is_file():
        raise FileNotFoundError(path)
    # Two courses may be in use in one process (tests do that), so the name tells them apart.
    name = f"course_companion_{label}_{abs(hash(path)):x}".replace("-", "_")
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise FileNotFoundError(path)
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[name] = loaded  # dataclasses look their own module up
    spec.loader.exec_module(loaded)
    return loaded
