"""What has to be installed for an engine, read from the course's own metadata.

The command lists the requirements themselves: nobody owns the course's name on an index.
"""

from __future__ import annotations

import importlib.metadata
import re
from dataclasses import dataclass
from pathlib import Path

__all__ = ["Requirement", "requirement_of"]

_DISTRIBUTION = "physics-sim-course"
_NAME = re.compile(r"[A-Za-z0-9._-]+")
_EXTRA = re.compile(r"""(?:\s*and\s*)?extra\s*==\s*['"][^'"]+['"]""")


@dataclass(frozen=True, slots=True)
class Requirement:
    """A package and the versions of it that serve.

    Attributes:
        text: as pip takes it, without the part after the semicolon.
        marker: where it is to be had at all; empty for everywhere.
    """

    text: str
    marker: str = ""

    @property
    def command(self) -> str:
        """What installs it."""
        return f"pip install '{self.text}'"

    @property
    def applies(self) -> bool:
        """False if the marker says that this Python or machine is not served."""
        if not self.marker:
            return True
        try:
            from packaging.markers import InvalidMarker, Marker
        except ImportError:
            return True
        try:
            return Marker(self.marker).evaluate()
        except InvalidMarker:
            return True


def requirement_of(package: str) -> Requirement:
    """The course's requirement of a package; the bare name where the course does not mention it."""
    for line in _lines():
        name = _NAME.match(line)
        if name and name[0].lower() == package.lower():
            text, _, marker = line.partition(";")
            return Requirement(text.strip(), _EXTRA.sub("", marker).strip().strip("()").strip())
    return Requirement(package)


def _lines() -> list[str]:
    """Every requirement, those of extras included; a checkout that was never installed has its own file."""
    try:
        found = importlib.metadata.requires(_DISTRIBUTION)
    except importlib.metadata.PackageNotFoundError:
        found = None
    return found or _from_checkout()


def _from_checkout() -> list[str]:
    import tomllib

    path = Path(__file__).parents[2] / "pyproject.toml"
    try:
        project = tomllib.loads(path.read_text(encoding="utf-8"))["project"]
    except (OSError, KeyError, tomllib.TOMLDecodeError):
        return []
    groups = project.get("optional-dependencies", {}).values()
    return [*project["dependencies"], *(line for group in groups for line in group)]
