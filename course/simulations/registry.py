"""The list of simulations; each is imported when it is needed."""

from __future__ import annotations

import difflib
from importlib import import_module
from typing import TYPE_CHECKING, cast

from course.errors import NotFoundError

if TYPE_CHECKING:
    from course.simulations.base import Simulation

__all__ = ["CHAPTER", "SIMULATIONS", "get"]

#: The four that an introduction begins with, in their order.
CHAPTER = ("free-fall", "projectile", "collision", "integrators")

#: Every simulation, in the order of a list; its module has the id's name and holds it as ``SIMULATION``.
SIMULATIONS = (
    *CHAPTER,
    "rotation",
    "dynamics",
    "chaos",
    "solver-iterations",
    "substeps",
    "environment",
    "contact-models",
)


def get(name: str) -> Simulation:
    """A simulation by its id.

    Raises:
        NotFoundError: there is none; its help names the closest ids.
    """
    if name not in SIMULATIONS:
        close = difflib.get_close_matches(name.lower().replace("_", "-"), SIMULATIONS, n=3, cutoff=0.5)
        meant = f"Did you mean {' or '.join(close)}? " if close else ""
        raise NotFoundError(
            f"There is no simulation {name!r}.",
            help=f"{meant}There are {', '.join(SIMULATIONS)}.",
            code="simulation_not_found",
        )
    module = import_module(f"course.simulations.experiments.{name.replace('-', '_')}")
    return cast("Simulation", module.SIMULATION)
