"""Which engines exist, and which of them this machine has."""

import contextlib
import importlib.metadata
from dataclasses import dataclass
from importlib import import_module
from typing import cast

from course.engines.base import Adapter
from course.errors import NotFoundError
from course.extras import requirement_of
from course.printable import meant


@dataclass(frozen=True, slots=True)
class EngineInfo:
    """One engine.

    Attributes:
        id: for ``--engine``; the adapter is the module of this name in ``course.engines.adapters``.
        extra: the course's extra that brings it; empty for what the course needs anyway.
        licence: of the engine itself, an SPDX expression.
        about: the kind of engine, in half a line.
        single: it computes in single precision, so its errors stop shrinking at about 1e-6.
    """

    id: str
    name: str
    package: str
    extra: str
    licence: str
    about: str
    single: bool = False


ENGINES: dict[str, EngineInfo] = {
    one.id: one
    for one in (
        EngineInfo("pymunk", "pymunk (2-D)", "pymunk", "", "MIT", "Chipmunk: games in the plane"),
        EngineInfo(
            "mujoco", "MuJoCo", "mujoco", "engines", "Apache-2.0", "joint coordinates, soft contacts: control"
        ),
        EngineInfo(
            "ode",
            "ODE",
            "panda3d",
            "engines",
            "LGPL-2.1-or-later OR BSD-3-Clause",
            "joints as constraints: vehicles, creatures",
            single=True,
        ),
        EngineInfo(
            "bullet", "Bullet 2.84", "panda3d", "engines", "Zlib", "joints as constraints: games", single=True
        ),
        EngineInfo(
            "rapier",
            "Rapier",
            "rapier3d",
            "engines",
            "Apache-2.0",
            "joints as constraints, substeps: games",
            single=True,
        ),
        EngineInfo(
            "physx",
            "PhysX",
            "sapien",
            "physx",
            "BSD-3-Clause",
            "joint coordinates for robots: games, Isaac",
            single=True,
        ),
        EngineInfo(
            "pybullet", "Bullet 3", "pybullet", "bullet", "Zlib", "joint coordinates for robots: learning"
        ),
        EngineInfo(
            "dart", "DART", "dartpy", "dart", "BSD-2-Clause", "joint coordinates, exact contacts: Gazebo Sim"
        ),
    )
}


@dataclass(frozen=True, slots=True)
class Availability:
    """The state of one engine on this machine.

    Attributes:
        version: of the package; None if it is not installed.
        missing: why it is not installed; empty if it is.
        command: installs it; empty where none does, or nothing is missing.
    """

    version: str | None
    missing: str = ""
    command: str = ""

    @property
    def installed(self) -> bool:
        return self.version is not None


def availability(info: EngineInfo) -> Availability:
    """Whether an engine's package is installed, without importing it."""
    with contextlib.suppress(importlib.metadata.PackageNotFoundError):
        return Availability(importlib.metadata.version(info.package))
    wanted = requirement_of(info.package)
    if not wanted.applies:
        return Availability(None, wanted.unserved)
    return Availability(None, "not installed", wanted.command)


def get(engine_id: str) -> EngineInfo:
    if engine_id in ENGINES:
        return ENGINES[engine_id]
    problem = f"There is no engine {engine_id!r}."
    advice = meant(engine_id, ENGINES, f"The engines are {', '.join(ENGINES)}.")
    raise NotFoundError(problem, help=advice, code="engine_not_found")


def load(engine_id: str) -> Adapter:
    """Import an engine: only in a process that may crash.

    Raises:
        ImportError: it is not installed, or a library that it needs is not.
    """
    return cast("Adapter", import_module(f"course.engines.adapters.{get(engine_id).id}").EngineWorld)
