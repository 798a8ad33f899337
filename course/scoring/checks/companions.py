"""Shared by the checks of an exercise, from the course in use: modules, known answers, words."""

from __future__ import annotations

import functools
import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from course.catalog.locate import content
from course.errors import ContentError
from course.scoring.explain.table import FILE as TABLE
from course.scoring.explain.table import read_table
from course.scoring.explain.words import FILE as WORDS
from course.scoring.explain.words import Words, read_words
from course.scoring.failures import place_of, reason_of

if TYPE_CHECKING:
    from types import ModuleType

__all__ = ["companion", "companion_path", "known_answers", "not_importable", "reference", "sibling", "words"]


def companion(exercise_id: str, module: str) -> ModuleType:
    """A module that public and hidden checks of an exercise share: ``exercises/<id>/checking/<module>.py``.

    What the course itself asks for, ``questions`` and ``report``, lies beside the checks. It is loaded by
    path from the course in use, once per process.

    Raises:
        FileNotFoundError: the exercise has no such file.
    """
    return _load(companion_path(exercise_id, module), f"{exercise_id}_{module}")


def companion_path(exercise_id: str, module: str) -> Path:
    """The file of a companion, whether or not it is there."""
    folder = content().exercise_folder(exercise_id)
    inside = folder / "checking" / f"{module}.py"
    return inside if inside.is_file() else folder / inside.name


def reference(exercise_id: str, module: str) -> ModuleType | None:
    """A module that answers for the student, ``solutions/<id>/<module>.py``; None at home, which has none."""
    folder = content().solution_folder(exercise_id)
    if folder is None:
        return None
    return _load(folder / f"{module}.py", f"{exercise_id}_{module}_right")


def known_answers(exercise_id: str, check: str) -> list[Any]:
    """The answers that a public check with fixed inputs expects where there is no reference, in its order."""
    table = read_table(content().exercise_folder(exercise_id) / TABLE)
    return [_known(value) for value in table.answers[check]]


def _known(value: Any) -> Any:
    """A known answer as a reference gives it: arrays and tuples are marked as such, infinities are text."""
    if isinstance(value, dict):
        items = {key: _known(item) for key, item in value.items()}
        if items.keys() == {"array"}:
            return np.array(items["array"])
        return tuple(items["tuple"]) if items.keys() == {"tuple"} else items
    if isinstance(value, list):
        return [_known(item) for item in value]
    return float(value) if value in ("inf", "-inf") else value


def words(exercise_id: str) -> Words:
    """The diagnoses of an exercise by their codes, from its ``diagnoses.toml``."""
    return read_words(content().exercise_folder(exercise_id) / WORDS)


def sibling(file: str, module: str) -> ModuleType:
    """A module beside a file of checks: ``sibling(__file__, "bundles")``.

    Raises:
        FileNotFoundError: there is no such file.
    """
    path = Path(file).resolve()
    return _load(path.with_name(f"{module}.py"), f"{path.parent.name}_{module}")


def not_importable(error: BaseException, file: Path) -> ContentError:
    """The fault of a course's file that raises while a check file is imported.

    Args:
        file: the one to name where the error itself names none of the course's.
    """
    while isinstance(error, pytest.Collector.CollectError) and error.__cause__ is not None:
        error = error.__cause__
    if isinstance(error, ContentError):
        return error
    line: int | None = None
    if isinstance(error, SyntaxError) and error.filename:
        file, line = Path(error.filename), error.lineno
    else:
        place = place_of(error)
        if place is not None:
            name, line = place
            file = content().root / name
    return ContentError(file, line, f"it cannot be imported ({reason_of(error)}).", help=_CORRECT)


_CORRECT = "Correct that line, or what it needs."


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
