"""Stores measurements, so that a second request is quick.

A measurement is stored under everything it depends on: the engine's version, the measuring code, the machine,
the scenario and how it was run. Failures are not stored, because the next try may succeed.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from course.engines.results import Row

if TYPE_CHECKING:
    from collections.abc import Mapping

    from course.engines.machine import Machine

__all__ = ["Cache", "cache_folder", "code_digest"]


def cache_folder() -> Path:
    """Where this system keeps caches; COURSE_CACHE names another folder."""
    if own := os.environ.get("COURSE_CACHE"):
        return Path(own) / "engines"
    home = Path.home()
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = home / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return base / "physics-sim-course" / "engines"


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
        machine: part of every key.
    """

    def __init__(self, folder: Path, machine: Machine) -> None:
        self._folder = folder
        self._machine = machine

    def get(self, key: Mapping[str, Any]) -> Row | None:
        """The row stored under a key; None if there is none, or it cannot be read."""
        try:
            row = msgspec.json.decode(self._path(key).read_bytes(), type=Row)
        except (OSError, msgspec.DecodeError):
            return None
        return msgspec.structs.replace(row, origin="cached")

    def put(self, key: Mapping[str, Any], row: Row) -> None:
        """Store a row, if it has a value and the folder can be written."""
        if not row.ok:
            return
        path = self._path(key)
        with contextlib.suppress(OSError):
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile("wb", dir=path.parent, delete=False) as file:
                file.write(msgspec.json.encode(row))
            Path(file.name).replace(path)

    def _path(self, key: Mapping[str, Any]) -> Path:
        whole = {**key, "code": code_digest(), "machine": str(self._machine)}
        name = hashlib.sha256(json.dumps(whole, sort_keys=True).encode()).hexdigest()[:32]
        return self._folder / f"{name}.json"
