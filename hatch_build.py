"""Notes in a wheel the Python and the NumPy of whoever builds it: they are those that grade.

A student's ``course check`` warns of what these cannot read (``course/scoring/versions.py`` says how).
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

#: Run by the Python that builds, outside of the environment that pip makes for a build: NumPy is there.
_COLLECT = """
import importlib, json, platform, sys
names = {}
modules = ("numpy", "numpy.linalg", "numpy.random", "numpy.fft", "math", "cmath", "itertools", "functools",
           "statistics", "random", "typing", "collections", "collections.abc", "contextlib", "dataclasses",
           "operator", "fractions", "enum", "warnings")
for module in modules:
    try:
        names[module] = sorted(dir(importlib.import_module(module)))
    except ImportError:
        pass
numpy = sys.modules["numpy"].__version__ if "numpy" in names else ""
print(json.dumps({"python": platform.python_version(), "numpy": numpy, "names": names,
                  "modules": sorted(sys.stdlib_module_names)}))
"""
_NAME = "graded_with.json"


class CustomBuildHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds ``course/graded_with.json``."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if version == "editable":
            return  # a checkout grades with itself
        told = subprocess.run([sys.executable, "-I", "-c", _COLLECT], capture_output=True, check=True).stdout
        self._folder = tempfile.TemporaryDirectory()
        path = Path(self._folder.name) / _NAME
        path.write_bytes(told)
        build_data["force_include"][str(path)] = f"course/{_NAME}"

    def finalize(self, version: str, _build_data: dict[str, Any], _artifact_path: str) -> None:
        if version != "editable":
            self._folder.cleanup()
