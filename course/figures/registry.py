"""Which figures there are, and how one becomes a picture.

A figure is known here by its id, which lessons use: ``![…](figure:integrators-phase)``. The table names the
builder without importing it, so asking whether a figure exists costs no matplotlib.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, cast

from course.errors import NotFoundError, UsageError
from course.simulations.registry import SIMULATIONS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    Builder = Callable[[], Figure]

#: Figure id -> module under course.figures and the function in it that draws the figure.
FIGURES: dict[str, tuple[str, str]] = {
    "integrators-phase": ("integrators", "phase_portraits"),
    "integrators-energy": ("integrators", "energy_error"),
    "integrators-order": ("integrators", "error_against_step"),
    "integrators-stability": ("integrators", "stability"),
    **{f"sim-{name}": ("experiments", name.replace("-", "_")) for name in SIMULATIONS},
    "accuracy-chaos": ("sim_to_real", "chaos"),
    "accuracy-small-steps": ("sim_to_real", "small_steps"),
    "accuracy-substeps": ("sim_to_real", "substeps"),
    "arm-planned": ("robots", "planned"),
    "arm-torques": ("robots", "torques"),
    "arm-wall": ("robots", "wall"),
    "contact-cone": ("contact", "cone"),
    "contact-corners": ("contact", "corners"),
    "contact-pair": ("contact", "pair"),
    "contact-phases": ("contact", "phases"),
    "contact-rest": ("contact", "rest"),
    "contact-stacks": ("contact", "stacks"),
    "contact-tunnelling": ("contact", "tunnelling"),
    "how-an-engine-works-rotation": ("contact", "turning_over"),
    "why-simulate-standing": ("robots", "standing"),
    "engines-settings": ("engines", "settings"),
    "engines-speed": ("engines", "speed"),
    "twins-following": ("sim_to_real", "following"),
    "gap-settling": ("sim_to_real", "settling"),
    "summary-two-questions": ("robots", "two_questions"),
}


def figure_ids() -> tuple[str, ...]:
    return tuple(sorted(FIGURES))


def build(figure_id: str) -> Figure:
    """Draw a figure in the course's style.

    Raises:
        NotFoundError: no figure has this id.
    """
    if figure_id not in FIGURES:
        help_ = f"The figures are {', '.join(figure_ids())}."
        raise NotFoundError(f"There is no figure {figure_id!r}.", help=help_, code="figure_not_found")
    from course.figures.style import house_style

    module, function = FIGURES[figure_id]
    builder = cast("Builder", getattr(import_module(f"course.figures.{module}"), function))
    with house_style():
        return builder()


def png(figure_id: str) -> bytes:
    from course.figures.style import file_of

    return file_of(lambda: build(figure_id), "png")


def save(figure_id: str, folder: Path) -> Path:
    """Write a figure to ``folder/<id>.png``, making the folder; an older picture of that name is replaced."""
    picture = png(figure_id)
    path = folder / f"{figure_id}.png"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        path.write_bytes(picture)
    except OSError as error:
        problem = f"The figure cannot be written to {path}: {error.strerror or error}."
        help_ = "Name a folder you may write to: --figures DIR."
        raise UsageError(problem, help=help_, code="figures_not_writable") from error
    return path
