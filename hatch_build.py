"""What goes into the wheel and the source archive: files with a declared role, not whatever lies there.

A builder that takes whole folders takes what is in them: a `.env`, a list of students, a model solution,
notes. So each file needs a role: a module of a package, one of the data files below, one of an exercise's
files, a lesson that the syllabus names, a question, a scene. What else lies in these folders is left out and
named. Git is not asked, so an unpacked source archive gives the same wheel. An editable installation is not
built from this.

A wheel also notes the Python and the NumPy of whoever builds it: they are those that grade, and a student's
``course check`` warns of what these cannot read (``course/scoring/versions.py`` says how).
"""

from __future__ import annotations

import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

#: Data of the package, by their paths below `course`.
DATA = re.compile(
    r"""
    py\.typed
    | authoring/templates/([\w-]+/)?[\w.-]+\.tmpl
    | engines/(reference|well_set)\.json | engines/options/\w+\.toml
    | grading/similar\.(css|html\.j2) | grading/exports/html_report/templates/\w+\.(css|js|html\.j2)
    | lessons/syllabus\.toml | lessons/worked/\w+/(\w+\.py|README\.md|exercise\.toml)
    | notebooks/static/\w+\.js
    | sandbox/scenes/[\w-]+\.toml | sandbox/views/web/static/\w+\.(css|html|js|svg)
    | scoring/checks/checks\.ini
    """,
    re.VERBOSE,
)
#: Files of an exercise, beside the stub, which its `exercise.toml` names.
OF_AN_EXERCISE = re.compile(
    r"""
    README\.md | (exercise|rubric)\.toml | diagnoses\.json
    | (checks|questions|report|boxes)\.py | checking/\w+\.py
    """,
    re.VERBOSE,
)
#: What tools leave behind: left out without a word.
_UNSAID = re.compile(r"__pycache__|.*\.pyc|\..*_cache|\.hypothesis|\.ipynb_checkpoints")
_SAID = 20


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


class Roles(BuildHookInterface):  # type: ignore[type-arg]
    """The files of a distribution, for hatchling."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add every file with a role, and name the others."""
        if version == "editable":
            return  # a checkout grades with itself
        if self.target_name == "wheel":
            told = subprocess.run(
                [sys.executable, "-I", "-c", _COLLECT], capture_output=True, check=True
            ).stdout
            self._folder = tempfile.TemporaryDirectory()
            path = Path(self._folder.name) / _NAME
            path.write_bytes(told)
            build_data["force_include"][str(path)] = f"course/{_NAME}"
        root = Path(self.root)
        moved = {"exercises": "course/content/exercises", "quiz": "course/content/quiz"}
        for top in ("course", "exercises", "quiz"):
            chosen = set(declared(root / top))
            target = moved.get(top, top) if self.target_name == "wheel" else top
            for path in sorted(chosen):
                name = f"{target}/{path.relative_to(root / top).as_posix()}"
                build_data["force_include"][str(path)] = name
            left = list(left_out(root / top, chosen))
            for path in left[:_SAID]:
                self.app.display_warning(f"Left out, without a role: {path.relative_to(root).as_posix()!r}")
            if len(left) > _SAID:
                self.app.display_warning(f"Left out, without a role: {len(left) - _SAID} more in {top}")

    def finalize(self, version: str, _build_data: dict[str, Any], _artifact_path: str) -> None:
        """Let go of what was noted."""
        if version != "editable" and self.target_name == "wheel":
            self._folder.cleanup()


def declared(folder: Path) -> Iterator[Path]:
    """The files with a role below one of the three folders; a link has none, for it leads out of them."""
    found = {"course": _of_the_package, "exercises": _of_exercises, "quiz": _questions}[folder.name](folder)
    return (path for path in found if path.is_file() and not path.is_symlink())


def _of_the_package(folder: Path) -> Iterator[Path]:
    lessons = tomllib.loads((folder / "lessons" / "syllabus.toml").read_text("utf-8"))["lessons"]
    yield from (folder / "lessons" / f"{name}.md" for name in lessons)
    for path in _below(folder):
        module = path.suffix == ".py" and path.stem.isidentifier()
        within = path.relative_to(folder)
        packages = [folder / above / "__init__.py" for above in within.parents]
        if (module and all(map(Path.is_file, packages))) or DATA.fullmatch(within.as_posix()):
            yield path


def _of_exercises(folder: Path) -> Iterator[Path]:
    yield from (folder / "times.json", folder / "warm-ups" / "diagnoses.json")
    for head in [*folder.glob("*/exercise.toml"), *folder.glob("warm-ups/*/exercise.toml")]:
        yield head.parent / Path(tomllib.loads(head.read_text("utf-8"))["module"]).name
        for path in _below(head.parent):
            if OF_AN_EXERCISE.fullmatch(path.relative_to(head.parent).as_posix()):
                yield path


def _questions(folder: Path) -> Iterator[Path]:
    return (path for path in folder.glob("*.toml") if re.fullmatch(r"[a-z0-9-]+", path.stem))


def _below(folder: Path) -> Iterator[Path]:
    """Every file; what lies behind a link to a folder is not below."""
    for path in sorted(folder.iterdir()):
        if path.is_dir() and not path.is_symlink():
            if not _UNSAID.fullmatch(path.name):
                yield from _below(path)
        else:
            yield path


def left_out(folder: Path, chosen: set[Path]) -> Iterator[Path]:
    """What has no role: files, and folders in which nothing has one."""
    for path in sorted(folder.iterdir()):
        if path in chosen or _UNSAID.fullmatch(path.name):
            continue
        if any(one.is_relative_to(path) for one in chosen):
            yield from left_out(path, chosen)
        else:
            yield path
