"""The sandbox's style in a cell's output: the web view's own, adapted to a place inside a page."""

from __future__ import annotations

from pathlib import Path

import course.sandbox.views.web

__all__ = ["STATIC", "style"]

#: The web view's files.
STATIC = Path(course.sandbox.views.web.__file__).parent / "static"

#: Where the web view asks for its window's width, a cell has to ask for its own: two notebooks side by side
#: leave half a window. Below this width the picture would be narrower than the panel beside it.
_WINDOW, _CELL = "@media (max-width: 860px)", "@container (max-width: 720px)"
#: A cell's output is not a page: the cells above and below it should stay in sight. JupyterLab has its own
#: layout for lists of terms.
_HERE = f"""
.sandbox {{ height: min(75vh, 44rem); }}
.sandbox :is(dt, dd) {{ float: none; width: auto; margin: 0; padding: 0; }}
.sandbox dt {{ font-weight: inherit; }}
{_CELL} {{
  .sandbox {{ height: auto; min-height: 0; }}
  .sandbox .events ol {{ max-height: 8rem; }}
}}
"""


def style() -> str:
    """The style sheet of a world in a cell. The element around it must be a container of inline size."""
    return (STATIC / "style.css").read_text("utf-8").replace(_WINDOW, _CELL) + _HERE
