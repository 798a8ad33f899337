"""The list of simulations; each is imported when it is needed."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, cast

from course.errors import NotFoundError
from course.printable import meant

if TYPE_CHECKING:
    from course.simulations.base import Simulation

#: The four that an introduction begins with, in their order.
CHAPTER = ("free-fall", "projectile", "collision", "integrators")

#: Every simulation, in the order of a list, and the module below ``experiments`` that holds it under its name
#: in capitals.
SIMULATIONS = {
    "free-fall": "motion",
    "projectile": "motion",
    "collision": "contact",
    "integrators": "dynamics",
    "rotation": "motion",
    "dynamics": "dynamics",
    "chaos": "dynamics",
    "solver-iterations": "contact",
    "substeps": "contact",
    "environment": "dynamics",
    "contact-models": "contact",
}


def get(name: str) -> Simulation:
    """A simulation by its id.

    Raises:
        NotFoundError: there is none; its help names the closest ids.
    """
    if name not in SIMULATIONS:
        raise NotFoundError(
            f"There is no simulation {name!r}.",
            help=f"{meant(name, SIMULATIONS)} Known: {', '.join(SIMULATIONS)}.".lstrip(),
            code="simulation_not_found",
        )
    module = import_module(f"course.simulations.experiments.{SIMULATIONS[name]}")
    return cast("Simulation", getattr(module, name.replace("-", "_").upper()))
