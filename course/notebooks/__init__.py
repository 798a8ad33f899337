"""The course as Jupyter notebooks: generated from the one source of content, and back as submissions.

``%load_ext course.notebooks`` in a notebook gives ``%course_check``; ``check`` does the same in scripts.
Building and grading notebooks needs no Jupyter; only what runs inside one imports IPython.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from course.notebooks.checking import CheckTable

    Source = str | Path | Iterable[str | Callable[..., Any] | type]

__all__ = ["check", "load_ipython_extension"]


def check(exercise: str, task: str | None = None, *, source: Source | None = None) -> CheckTable:
    """Run the public checks of an exercise on code from anywhere; in a workspace, record the attempt.

    Args:
        task: show the checks of this function only.
        source: what to check: the text of a module; a path, or its text, that ends in .py or .ipynb; or
            functions, classes and texts in the order of a module, to which the exercise's own imports are
            added. If left out, the cells that IPython ran.

    Raises:
        NotFoundError: there is no such exercise, function or file.
        UsageError: the source of something cannot be found.
        UngradableError: there is nothing to check.
    """
    from course.notebooks.checking import check as run

    return run(exercise, task, source)


def load_ipython_extension(shell: Any) -> None:
    """Called by ``%load_ext course.notebooks``."""
    from course.notebooks.magic import register

    register(shell)
