"""The course as Jupyter notebooks: generated from the one source of content, and back as submissions.

``%load_ext course.notebooks`` in a notebook gives ``%course_check``. Building and grading notebooks needs no
Jupyter; only what runs inside one imports IPython.
"""

from __future__ import annotations

from typing import Any

__all__ = ["load_ipython_extension"]


def load_ipython_extension(shell: Any) -> None:
    """What ``%load_ext course.notebooks`` calls."""
    from course.notebooks.magic import register

    register(shell)
