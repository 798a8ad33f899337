"""The replies of ``course sandbox ... --json``, as types."""

from __future__ import annotations

import msgspec

from course.cli.frame.replies import Backup, Envelope
from course.sandbox.scene.predicting import Comparison
from course.sandbox.world.events import Event, Receipt

__all__ = [
    "Sandbox",
    "SandboxEntry",
    "SandboxExport",
    "SandboxFile",
    "SandboxList",
    "SandboxMomentum",
    "SandboxParameter",
    "SandboxReplay",
    "SandboxVersion",
]


class SandboxParameter(msgspec.Struct, frozen=True, kw_only=True):
    """Something ``--set`` can set; ``default`` is None where each body has its own."""

    name: str
    unit: str
    meaning: str
    low: float
    high: float
    default: float | None = None


class SandboxEntry(msgspec.Struct, frozen=True, kw_only=True):
    """A scene in a list; the student answers ``question`` before the run, ``after`` afterwards."""

    id: str
    title: str
    teaches: str
    question: str
    note: str
    after: str
    duration: float
    parameters: tuple[SandboxParameter, ...]


class SandboxList(Envelope, tag="course.sandbox-list/1", frozen=True, kw_only=True):
    scenes: tuple[SandboxEntry, ...]


class SandboxFile(msgspec.Struct, frozen=True, kw_only=True):
    """A file that was written, and the copy of what was there before."""

    kind: str
    path: str
    backup: Backup | None = None


class SandboxMomentum(msgspec.Struct, frozen=True, kw_only=True):
    """Along x and y in kg m/s, and angular about the origin in kg m²/s."""

    before: tuple[float, float, float]
    after: tuple[float, float, float]


class Sandbox(Envelope, tag="course.sandbox/1", frozen=True, kw_only=True):
    """One run of a scene.

    ``settings`` holds everything that was set or has a default; ``probes`` the scene's measurements, "nan"
    for events that did not happen; ``prediction`` is None where a scene asks for none. ``description`` is the
    run in sentences.
    """

    scene: str
    title: str
    duration: float
    steps: int
    settings: dict[str, float]
    receipt: Receipt
    momentum: SandboxMomentum
    probes: dict[str, float]
    prediction: Comparison | None
    events: tuple[Event, ...]
    dropped: int
    description: tuple[str, ...]
    after: str
    state_hash: str
    versions: dict[str, str]
    files: tuple[SandboxFile, ...] = ()


class SandboxVersion(msgspec.Struct, frozen=True, kw_only=True):
    """A part whose version differs from that of the recording."""

    name: str
    recorded: str
    here: str


class SandboxReplay(Envelope, tag="course.sandbox-replay/1", frozen=True, kw_only=True):
    """Whether a recording runs the same here; the steps are counted over the whole recording."""

    scene: str
    same: bool
    steps: int
    checked: int
    good_until: int
    first_difference: int | None
    t: float | None
    versions: tuple[SandboxVersion, ...]


class SandboxExport(Envelope, tag="course.sandbox-export/1", frozen=True, kw_only=True):
    """A scene as another engine's world; ``text`` is empty if it went to a file.

    ``beside`` is the file that a world for Gazebo needs in its folder to start with velocities.
    """

    scene: str
    format: str
    file: SandboxFile | None = None
    beside: SandboxFile | None = None
    text: str = ""
