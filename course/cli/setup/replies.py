"""The replies of the commands around the work."""

from __future__ import annotations

import msgspec

from course.catalog.models import CourseRef
from course.cli.frame.replies import Envelope, NextStep, WrittenFile
from course.cli.work.replies import Check


class Demo(Envelope, tag="course.demo/2", frozen=True, kw_only=True):
    """A worked example with a mistake, and without it.

    ``change`` is the corrected line as a diff. ``energy`` is the energy of each motion in units of its energy
    at the start: the least and the most over ``steps`` steps of ``step_size`` seconds.
    """

    before: Check
    after: Check
    change: tuple[str, ...]
    steps: int
    step_size: float
    energy_before: tuple[float, float]
    energy_after: tuple[float, float]


class Init(Envelope, tag="course.init/1", frozen=True, kw_only=True):
    """``created`` is False where the folder was a workspace already; nothing was changed then."""

    workspace: str
    created: bool
    course: CourseRef
    next: NextStep
    files: tuple[WrittenFile, ...] = ()


class Bug(Envelope, tag="course.bug/1", frozen=True, kw_only=True):
    """A report for a developer who looks for a fault; ``traceback`` is False where no crash was found."""

    file: WrittenFile
    traceback: bool


class Package(msgspec.Struct, frozen=True):
    """A requirement and what is installed for it; ``group`` is "" or the name of the extra."""

    name: str
    requirement: str
    installed: str | None
    ok: bool
    group: str = ""


class Fix(msgspec.Struct, frozen=True):
    """A missing part and the command that installs it."""

    problem: str
    command: str


class Doctor(Envelope, tag="course.doctor/1", frozen=True, kw_only=True):
    course: CourseRef
    python: str
    platform: str
    installation: str
    packages: tuple[Package, ...]
    protection: str
    protection_causes: tuple[str, ...]
    protection_advice: tuple[str, ...]
    terminal: dict[str, str]
    workspace: str | None
    repaired: str | None
    fixes: tuple[Fix, ...]
    unserved: tuple[str, ...] = ()
