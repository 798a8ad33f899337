"""Ways to type a command: a student's, from the built wheel, and an instructor's, from the checkout.

In an ordinary run the wheel is unpacked, and what it needs comes from this environment; an instructor's
commands run in the tests' own process; the parts of a journey that come in turn are those of the day. With
``COURSE_JOURNEYS=all``, as CI has it, the wheel is installed into an environment of its own, every command is
a process, and every part is tried.
"""

import json
import os
import subprocess
import sys
import time
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import pytest

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.notebooks.build import exercise_cells
from course.notebooks.cells import document
from tests.command_line import in_process

T = TypeVar("T")
ROOT = Path(__file__).resolve().parents[2]
#: Whether this run tries everything.
ALL = os.environ.get("COURSE_JOURNEYS") == "all"
#: What a command may need of this machine, and nothing that says which course is meant.
_KEPT = ("PATH", "LANG", "TMPDIR", "SSL_CERT_FILE", "COURSE_REQUIRE_LEVEL")


def model(exercise: Exercise) -> str:
    """The model solution of an exercise."""
    return (ROOT / "solutions" / exercise.place / exercise.module).read_text("utf-8")


def notebook(exercise: Exercise) -> bytes:
    """The exercise's notebook, with the solution in its cells."""
    cells = exercise_cells(exercise, model(exercise))
    return document(cells, kind="exercise", id=exercise.id, version=Catalog().version)


def results(out: Path) -> dict[tuple[str, str], dict[str, Any]]:
    """What a grading run found, by student and exercise."""
    lines = map(json.loads, (out / "results.jsonl").read_text("utf-8").splitlines())
    return {(line["student"], line["exercise"]): line for line in lines}


def in_turn(cases: Sequence[T], each: int = 1) -> list[T]:
    """The cases of this run: all of them, or of the day as many as are tried each time."""
    if ALL:
        return list(cases)
    first = time.gmtime().tm_yday * each
    return [cases[(first + number) % len(cases)] for number in range(min(each, len(cases)))]


@dataclass
class Way:
    """Types commands, and fails with the whole line where one does not end as it should.

    Attributes:
        here: whether a command runs in this process, where it has nothing to read.
    """

    command: list[str]
    home: Path
    environment: dict[str, str] = field(default_factory=dict)
    here: bool = False

    def __call__(
        self, *words: object, cwd: Path | None = None, code: int | None = 0, stdin: str = "", **more: str
    ) -> subprocess.CompletedProcess[str]:
        line, environment = [*self.command, *map(str, words)], {**self.environment, **more}
        if self.here and not stdin:
            ran = in_process(*words, cwd=cwd or self.home, env=environment)
            ran.stdout = ran.stdout.replace("\r\n", "\n")  # as of a process
        else:
            ran = subprocess.run(
                line, cwd=cwd or self.home, env=environment, input=stdin, timeout=600,
                capture_output=True, text=True, encoding="utf-8", check=False,
            )  # fmt: skip
        shown = f"$ course {' '.join(map(str, words))}\n{ran.stdout}{ran.stderr}exit {ran.returncode}"
        assert code is None or ran.returncode == code, shown
        assert "Traceback (most recent call last)" not in ran.stderr, shown
        return ran


def _environment(home: Path) -> dict[str, str]:
    kept = {name: os.environ[name] for name in _KEPT if name in os.environ}
    return {**kept, "HOME": str(home), "LC_ALL": "C.UTF-8", "PYTHONDONTWRITEBYTECODE": "1"}


@pytest.fixture(scope="session")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel that an instructor hands out, built from this checkout."""
    folder = tmp_path_factory.mktemp("wheel")
    build = "import hatchling.build, sys; print(hatchling.build.build_wheel(sys.argv[1]))"
    subprocess.run([sys.executable, "-c", build, folder], cwd=ROOT, capture_output=True, check=True)
    (made,) = folder.glob("*.whl")
    return made


@pytest.fixture(scope="session")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[list[str], dict[str, str]]:
    """How a student runs what was built: the command, and what the environment has to say."""
    folder = tmp_path_factory.mktemp("student")
    if ALL:
        subprocess.run([sys.executable, "-m", "venv", folder / "venv"], check=True)
        pip = [folder / "venv" / "bin" / "python", "-m", "pip", "install", "--quiet", str(wheel)]
        subprocess.run(pip, check=True)
        return [str(folder / "venv" / "bin" / "course")], {}
    with zipfile.ZipFile(wheel) as packed:
        packed.extractall(folder)
    return [sys.executable, "-P", "-m", "course"], {"PYTHONPATH": str(folder)}


@pytest.fixture
def student(installed: tuple[list[str], dict[str, str]], tmp_path: Path) -> Way:
    """Commands of a student, who has the wheel."""
    command, says = installed
    return Way(command, tmp_path, {**_environment(tmp_path), **says})


@pytest.fixture
def workspace(student: Way, tmp_path: Path) -> Path:
    student("init", "work")
    return tmp_path / "work"


@pytest.fixture
def instructor(tmp_path: Path) -> Way:
    """Commands of an instructor, in a checkout."""
    command = [sys.executable, "-P", "-m", "course"]
    return Way(command, tmp_path, {**_environment(tmp_path), "PYTHONPATH": str(ROOT)}, here=not ALL)
