"""The results of a comparison, as data: the same in memory, in the cache and in the shipped reference."""

import contextlib
import functools
import hashlib
import json
import os
import platform
import re
import subprocess
from pathlib import Path
from typing import Any, Literal

import msgspec

from course.errors import MissingCapabilityError
from course.printable import counted
from course.progress.workspace import write_atomically

# ---
# Which machine a measurement was made on, without personal data: no host, no path, no user.


class Machine(msgspec.Struct, frozen=True):
    """The machine and the versions that a measurement depends on."""

    cpu: str
    system: str
    cores: int
    python: str

    def __str__(self) -> str:
        return f"{self.cpu}, {counted(self.cores, 'core')}, {self.system}, Python {self.python}"


def this_machine() -> Machine:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    version = ".".join(platform.python_version_tuple()[:2])
    return Machine(_cpu(), f"{platform.system()} {platform.machine()}", cores, version)


def _cpu() -> str:
    with contextlib.suppress(OSError):
        told = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
        if found := re.search(r"^model name\s*:(.*)", told, re.MULTILINE):
            return found[1].strip()
    if platform.system() == "Darwin":
        asked = ["/usr/sbin/sysctl", "-n", "machdep.cpu.brand_string"]
        with contextlib.suppress(OSError, subprocess.SubprocessError):
            return subprocess.check_output(asked, stderr=subprocess.DEVNULL, text=True, timeout=5).strip()
    return platform.processor() or platform.machine() or "unknown processor"


Setting = Literal["default", "tuned"]
Status = Literal[
    "ok", "not_installed", "unavailable", "crash", "deadline", "diverged", "not_applicable", "failed"
]
DEFAULT: Setting = "default"
TUNED: Setting = "tuned"
OK: Status = "ok"


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One engine in one scenario.

    Attributes:
        setting: ``default`` is the engine as it comes, ``tuned`` with options set for the scenario.
        dt: step, s.
        status: ``ok``, or why there is no value.
        value: in the scenario's unit; None without one.
        message: the reason, where ``status`` is not ``ok``.
        origin: ``measured`` now, ``cached`` from an earlier run on this machine, or from the ``reference``.
        measured: the day, YYYY-MM-DD.
        version: of the engine's package.
        options, why: the settings, and a reason for each.
        samples: the values of which ``value`` is the mean or the median, one for each phase of the step or
            each start; empty for a single run.
        repeats: how often it was measured; ``spread`` is the largest value less the smallest.
    """

    engine: str
    scenario: str
    setting: Setting
    dt: float
    status: Status
    value: float | None = None
    message: str = ""
    origin: Literal["measured", "cached", "reference"] = "measured"
    measured: str = ""
    version: str = ""
    options: dict[str, Any] = {}
    why: tuple[str, ...] = ()
    samples: tuple[float, ...] = ()
    repeats: int = 1
    spread: float = 0.0
    details: dict[str, Any] = {}

    @property
    def ok(self) -> bool:
        return self.status == OK

    @property
    def place(self) -> tuple[str, str, Setting, float]:
        """Which row of a comparison it is."""
        return self.engine, self.scenario, self.setting, self.dt

    @property
    def lowest(self) -> float:
        """The least of the samples; the value where there are none."""
        return min(self.samples, default=self.value or 0.0)

    @property
    def highest(self) -> float:
        """The largest of the samples; the value where there are none."""
        return max(self.samples, default=self.value or 0.0)


class EngineState(msgspec.Struct, frozen=True, kw_only=True):
    """One engine on this machine, as ``--json`` has it too.

    ``usable`` is "installed and it starts"; ``command`` installs what is missing.
    """

    id: str
    name: str
    package: str
    extra: str
    licence: str
    about: str
    version: str | None
    usable: bool
    missing: str
    command: str


class Reference(msgspec.Struct, frozen=True, kw_only=True):
    """A measurement made once, for engines that are not installed."""

    format_version: int
    measured: str
    machine: Machine
    rows: tuple[Row, ...]

    @property
    def label(self) -> str:
        """Where and when, in a line."""
        return f"measured on {self.machine}, {self.measured}"


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """The results of one comparison.

    Attributes:
        machine: the one it ran on; ``reference`` is None unless rows of it are among ``rows``.
    """

    machine: Machine
    engines: tuple[EngineState, ...]
    rows: tuple[Row, ...]
    reference: Reference | None = None
    quick: bool = False

    @property
    def ran(self) -> bool:
        """True if at least one engine gave a value on this machine."""
        return any(row.ok and row.origin != "reference" for row in self.rows)


# ---
# Stores measurements, so that a second request is quick.
#
# A measurement is stored under everything it depends on: the engine's version, the measuring code, the
# machine, the scenario and how it was run. Failures are not stored, because the next try may succeed.


@functools.cache
def code_digest() -> str:
    """A digest of the code that builds and measures: when it changes, old numbers no longer count."""
    digest = hashlib.sha256()
    here = Path(__file__).parent
    for path in sorted((*here.rglob("*.py"), *here.rglob("*.toml"), here / "well_set.json")):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


class Cache:
    """Rows in files of their own, so that two runs at once cannot damage each other's.

    Args:
        folder: made when it is needed.
    """

    def __init__(self, folder: Path, machine: Machine) -> None:
        self._folder = folder
        self._machine = machine

    def get(self, key: tuple[Any, ...]) -> Row | None:
        """The row stored under a key; None if there is none, or it cannot be read."""
        try:
            row = msgspec.json.decode(self._path(key).read_bytes(), type=Row)
        except (OSError, msgspec.DecodeError):
            return None
        return msgspec.structs.replace(row, origin="cached")

    def put(self, key: tuple[Any, ...], row: Row) -> None:
        """Store a row, if it has a value and the folder can be written."""
        if not row.ok:
            return
        with contextlib.suppress(MissingCapabilityError):
            write_atomically(self._path(key), msgspec.json.encode(row))

    def _path(self, key: tuple[Any, ...]) -> Path:
        whole = json.dumps((*key, code_digest(), str(self._machine)))
        name = hashlib.sha256(whole.encode()).hexdigest()[:32]
        return self._folder / f"{name}.json"
