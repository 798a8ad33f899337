"""Optional parts of the course: what each is for, its packages, and the one message where these are missing.

The core imports none of these parts: a caller gets one by its name here, after a look whether what it needs
is installed. A command that installs something lists the requirements themselves, read from the course's own
metadata: the course is on no package index.
"""

import importlib
import importlib.util
import platform
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from course.errors import MissingCapabilityError

_DISTRIBUTION = "physics-sim-course"
_EXTRA = re.compile(r"""extra\s*==\s*['"]([^'"]+)['"]""")


@dataclass(frozen=True, slots=True)
class Part:
    """A part that the base install does without; the extra of its name brings what it needs.

    Attributes:
        what: it does, as the subject of a sentence.
        packages: that it imports; where a distribution has another name, "module=distribution".
        module: its door, for ``load``; empty where a registry of its own has several.
    """

    what: str
    packages: tuple[str, ...]
    module: str = ""


PARTS: dict[str, Part] = {
    "engines": Part("Running the engines of the lessons", ("mujoco", "panda3d", "rapier3d")),
    "physx": Part("Running PhysX", ("sapien",)),
    "bullet": Part("Running PyBullet", ("pybullet",)),
    "dart": Part("Running DART", ("dartpy",)),
    "notebook": Part("Running a notebook", ("jupyterlab", "nbclient", "ipykernel", "anywidget")),
    "cluster": Part(
        "Grading on a cluster", ("distributed", "cryptography"), "course.grading.cluster.connect"
    ),
    "gradescope": Part("Reading a Gradescope download", ("yaml=pyyaml",), "yaml"),
    "ros": Part("A ROS 2 bag", ("rosbags",), "rosbags.rosbag2"),
    "web": Part(
        "The view in a browser", ("starlette", "uvicorn", "websockets"), "course.sandbox.views.web.view"
    ),
}


#: The packages of the base install that grading needs; Gradescope's container has these, and no extra.
CONTAINER = Part(
    "Grading in Gradescope's container",
    ("msgspec", "numpy", "pymunk", "pytest"),
    "course.grading.container",
)


@dataclass(frozen=True, slots=True)
class Requirement:
    """A package and the versions of it that serve.

    Attributes:
        name: of the distribution.
        versions: in pip's form, such as ">=8.4,<10"; empty for any.
        group: the extra that brings it; empty for the base install.
        applies: False if this Python or machine is not served.
        served: the marker that says which are, as the metadata has it; empty for all.
    """

    name: str
    versions: str = ""
    group: str = ""
    applies: bool = True
    served: str = field(default="", compare=False)

    @property
    def unserved(self) -> str:
        """Why this machine cannot have it, as a sentence without its end; empty if it can."""
        if self.applies:
            return ""
        here = f"Python {platform.python_version()} on {platform.system()} {platform.machine()}"
        return f"{self.name} has no wheel for {here}; there are some where {self.served}"

    @property
    def text(self) -> str:
        """As pip takes it."""
        return self.name + self.versions

    @property
    def command(self) -> str:
        """The command that installs it."""
        return f"pip install '{self.text}'"


def available(part: str) -> bool:
    """Whether everything that a part needs is installed."""
    return not _missing(PARTS[part].packages)


def load(part: str) -> Any:
    """The module of a part.

    Raises:
        MissingCapabilityError: something that it needs is not installed.
    """
    require(part)
    return importlib.import_module(PARTS[part].module)


def require(part: str, *packages: str, what: str = "") -> None:
    """Make sure that a part's packages are installed.

    Args:
        packages: of the part, those that are needed now; all if none is named.
        what: they are needed for, as the subject of a sentence; the part's own words if empty.

    Raises:
        MissingCapabilityError: one is not installed; the message says how to get the whole part.
    """
    known = PARTS[part]
    missing = _missing(packages or known.packages)
    if missing:
        names = " and ".join(filter(None, (", ".join(missing[:-1]), missing[-1])))
        verb = "are" if len(missing) > 1 else "is"
        texts = (requirement_of(package.rpartition("=")[2]).text for package in known.packages)
        raise MissingCapabilityError(
            f"{what or known.what} needs {names}, which {verb} not installed.",
            help="Install what it needs: pip install " + " ".join(f"'{text}'" for text in texts),
            code="missing_extra",
        )


def requirement_of(package: str) -> Requirement:
    """The course's requirement of a distribution; its bare name where the course does not mention it."""
    found = (one for one in requirements() if one.name.lower() == package.lower())
    return next(found, Requirement(package))


def requirements() -> list[Requirement]:
    """Every requirement of the course, those of its extras included."""
    from packaging.requirements import Requirement as Parsed

    found = []
    for line in _lines():
        parsed = Parsed(line)
        extra = _EXTRA.search(str(parsed.marker or ""))
        group = extra[1] if extra else ""
        # In the order in which the project states them, where packaging sorts.
        versions = line.partition(";")[0].strip().removeprefix(parsed.name).strip().strip("()")
        applies = parsed.marker is None or parsed.marker.evaluate({"extra": group})
        found.append(Requirement(parsed.name, versions, group, applies, _where(str(parsed.marker or ""))))
    return found


def _where(marker: str) -> str:
    """A marker without the extra, which says nothing about the machine."""
    kept = _EXTRA.sub("", marker)
    return re.sub(r"^[\s()]*(?:and\s)?|\s+and[\s()]*$|[()]", "", kept).strip().replace('"', "'")


def _missing(packages: tuple[str, ...]) -> list[str]:
    """The distributions of those that cannot be imported."""
    named = [package.partition("=") for package in packages]
    return [name or module for module, _, name in named if importlib.util.find_spec(module) is None]


def _lines() -> list[str]:
    """As the metadata has them; a checkout that was never installed has its project file."""
    import importlib.metadata  # takes long, and hardly any command needs it

    try:
        found = importlib.metadata.requires(_DISTRIBUTION)
    except importlib.metadata.PackageNotFoundError:
        found = None
    return found or _from_checkout()


def _from_checkout() -> list[str]:
    import tomllib

    path = Path(__file__).parents[1] / "pyproject.toml"
    try:
        project = tomllib.loads(path.read_text(encoding="utf-8"))["project"]
    except (OSError, KeyError, tomllib.TOMLDecodeError):
        return []
    groups = project.get("optional-dependencies", {}).items()
    optional = [_with_extra(line, name) for name, lines in groups for line in lines]
    return [*project["dependencies"], *optional]


def _with_extra(line: str, name: str) -> str:
    """A line of an extra as installed metadata has it."""
    text, _, marker = line.partition(";")
    also = f"({marker.strip()}) and " if marker.strip() else ""
    return f"{text.strip()}; {also}extra == '{name}'"
