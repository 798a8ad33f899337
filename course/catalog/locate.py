"""Where the course's content lies: beside the code in a checkout, inside the package in a wheel.

The wheel is the student's: it has neither solutions nor hidden graders, and ``Content`` says so by holding
None for them. ``COURSE_CONTENT=DIR`` selects another course altogether, laid out as
``DIR/{exercises,lessons,quiz,scenes,solutions,graders}``.
"""

import contextlib
import functools
import json
import os
import sys
from dataclasses import dataclass
from pathlib import Path

from course.errors import InternalError, MissingCapabilityError, UsageError
from course.ids import WARM_UPS

ENVIRONMENT_VARIABLE = "COURSE_CONTENT"
#: The folders of a course in which each exercise has one of its own.
PLACES = ("exercises", "solutions", "graders")
#: A copy of a course says in this file where its folders were.
NAMES = "names.json"
_PACKAGE = Path(__file__).resolve().parent.parent


@dataclass(frozen=True, slots=True)
class Content:
    """The folders one course is made of.

    Attributes:
        root: the folder that paths in messages are best shown relative to.
        solutions, graders: None where this installation has none.
        scenes: of a course that ``COURSE_CONTENT`` names; None where it adds none to the program's own.
        names: of the folders where the files were written, if this is a copy: (folder, name) each.
    """

    root: Path
    exercises: Path
    lessons: Path
    quiz: Path
    solutions: Path | None = None
    graders: Path | None = None
    scenes: Path | None = None
    names: tuple[tuple[str, str], ...] = ()

    def shown(self, path: Path) -> str:
        """A path as its author knows it."""
        for place, name in self.names:
            folder = self.root / place
            if path.is_relative_to(folder):
                return f"{name}/{path.relative_to(folder).as_posix()}"
        return path.relative_to(self.root).as_posix() if path.is_relative_to(self.root) else str(path)

    def place(self, name: str) -> Path | None:
        """One of ``PLACES``."""
        folder: Path | None = getattr(self, name)
        return folder

    @property
    def is_checkout(self) -> bool:
        """True where the instructor's side is present, hidden graders above all."""
        return self.graders is not None

    def instructors(self) -> tuple[Path, Path]:
        """The folders of solutions and of hidden graders.

        Raises:
            MissingCapabilityError: this installation is a student's and lacks one of them.
        """
        if self.solutions is None or self.graders is None:
            raise MissingCapabilityError(
                "This installation is a student's: it has no hidden graders and no model solutions.",
                help="Use a checkout of the course, which has them in solutions/ and tests/graders/. "
                "Your instructor has one.",
                code="needs_checkout",
            )
        return self.solutions, self.graders

    @property
    def syllabus(self) -> Path:
        """The file that names the course and orders its lessons."""
        return self.lessons / "syllabus.toml"

    def place_of(self, exercise_id: str) -> Path:
        """Where an exercise lies in ``exercises``, ``solutions`` and ``graders``; warm-ups lie together."""
        inside = Path(WARM_UPS, exercise_id)
        return inside if (self.exercises / inside).is_dir() else Path(exercise_id)

    def exercise_folder(self, exercise_id: str) -> Path:
        """The files that a student gets of an exercise or a warm-up."""
        return self.exercises / self.place_of(exercise_id)

    def solution_folder(self, exercise_id: str) -> Path | None:
        """Its solutions; None where this installation has none."""
        return None if self.solutions is None else self.solutions / self.place_of(exercise_id)


def content() -> Content:
    """The content that this process is to use.

    Raises:
        UsageError: ``COURSE_CONTENT`` names something that is not a course.
        InternalError: the installation has lost its content.
    """
    named = os.environ.get(ENVIRONMENT_VARIABLE)
    if named:
        return chosen(Path(named))
    return _installed(_PACKAGE)


def chosen(folder: Path) -> Content:
    """The course under a named folder.

    Raises:
        UsageError: there is none.
    """
    with contextlib.suppress(RuntimeError):  # a home of nobody, a link to itself
        folder = folder.expanduser().resolve()
    if not (folder / "exercises").is_dir() or not (folder / "lessons").is_dir():
        problem = f"{ENVIRONMENT_VARIABLE} is {folder}, which holds no course."
        help_ = "Name a folder with exercises/ and lessons/ in it, or unset the variable."
        raise UsageError(problem, help=help_, code="no_such_content")
    return Content(
        root=folder,
        exercises=folder / "exercises",
        lessons=folder / "lessons",
        quiz=folder / "quiz",
        solutions=_if_there(folder / "solutions"),
        graders=_if_there(folder / "graders"),
        scenes=_if_there(folder / "scenes"),
        names=_names(folder / NAMES),
    )


def _names(file: Path) -> tuple[tuple[str, str], ...]:
    return tuple(json.loads(file.read_text("utf-8")).items()) if file.is_file() else ()


@functools.cache
def _installed(package: Path) -> Content:
    """The course that came with the package at ``package``.

    The wheel's folder is asked for first: it never exists in a checkout, while the folder beside an
    installed package is site-packages, where a stranger's ``exercises`` may well lie.
    """
    shipped = package / "content"
    if shipped.is_dir():
        return Content(
            root=package, exercises=shipped / "exercises", lessons=package / "lessons", quiz=shipped / "quiz"
        )
    root = package.parent
    if not (root / "pyproject.toml").is_file() or not (root / "exercises").is_dir():
        raise InternalError(
            f"The course's exercises are missing from {package}.",
            help="Install the course again; its files were moved or removed.",
            code="content_missing",
        )
    return Content(
        root=root,
        exercises=root / "exercises",
        lessons=package / "lessons",
        quiz=root / "quiz",
        solutions=_if_there(root / "solutions"),
        graders=_if_there(root / "tests" / "graders"),
    )


def cache_folder(name: str) -> Path:
    """Where this system keeps caches of the course; COURSE_CACHE names another folder."""
    if own := os.environ.get("COURSE_CACHE"):
        return Path(own) / name
    home = Path.home()
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local")
    elif sys.platform == "darwin":
        base = home / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return base / "physics-sim-course" / name


def _if_there(folder: Path) -> Path | None:
    return folder if folder.is_dir() else None
