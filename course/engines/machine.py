"""Which machine a measurement was made on, without personal data: no host, no path, no user."""

from __future__ import annotations

import os
import platform
import subprocess

import msgspec

__all__ = ["Machine", "this_machine"]


class Machine(msgspec.Struct, frozen=True):
    """The machine and the versions that a measurement depends on.

    Attributes:
        cpu: the processor's model.
        system: operating system and architecture.
        cores: how many processors this process may use.
        python: its version.
    """

    cpu: str
    system: str
    cores: int
    python: str

    def __str__(self) -> str:
        cores = f"{self.cores} core{'s' if self.cores != 1 else ''}"
        return f"{self.cpu}, {cores}, {self.system}, Python {self.python}"


def this_machine() -> Machine:
    """The machine that this runs on."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    version = ".".join(platform.python_version_tuple()[:2])
    return Machine(_cpu(), f"{platform.system()} {platform.machine()}", cores, version)


def _cpu() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:  # noqa: PTH123 - no file, a kernel's answer
            for line in file:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    if platform.system() == "Darwin":
        try:
            asked = subprocess.run(
                ["/usr/sbin/sysctl", "-n", "machdep.cpu.brand_string"],
                capture_output=True,
                text=True,
                timeout=5,
                check=True,
            )
        except (OSError, subprocess.SubprocessError):
            pass
        else:
            return asked.stdout.strip()
    return platform.processor() or platform.machine() or "unknown processor"
