"""What is inside the wheel and the source archive, and that the course works from each way to install it.

The archives are built offline from a copy of the repository in which traps are laid: files that git ignores,
and files in the folders that must never reach a student.
"""

import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import numpy as np
import pytest
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]

#: Files that are there and must not be in any archive.
TRAPS = (
    "solutions/integrators/trap.py",
    "solutions/trap.toml",
    "tests/graders/integrators/trap.py",
    "tests/trap.py",
    "docs/trap.md",
    ".ci/trap",
    "exercises/integrators/__pycache__/trap.cpython-311.pyc",
    "course/physics/__pycache__/trap.cpython-311.pyc",
    "course/catalog/.mypy_cache/trap.json",
    "exercises/.venv/trap.py",
    "quiz/.hypothesis/trap",
    "course/build/trap.py",
    "trap.py",
)
#: Files that lie where those of a role lie, and have none: each is left out, and named.
PLANTED = (
    "course/trap.env",
    "course/lessons/trap-notes.md",
    "course/physics/trap students.csv",
    "course/scoring/checks/trap.ini",
    "course/sandbox/scenes/trap",
    "course/trap-module.py",
    "exercises/.env-trap",
    "exercises/trap.csv",
    "exercises/integrators/.env.trap",
    "exercises/integrators/trap_solution.py",
    "exercises/integrators/trap.md",
    "exercises/integrators/checking/trap.xlsx",
    "exercises/integrators/solutions-trap/integrators.py",
    "exercises/warm-ups/fall-time/trap-fall_time.py",
    "quiz/trap.toml.bak",
    "quiz/trap students.toml",
)

FORBIDDEN = {
    "solutions", "tests", "graders", "docs", ".ci", "accepted", "record.json", "__pycache__",
}  # fmt: skip


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """A copy of the repository with the traps laid: the build must choose from all of it by itself."""
    ignore = shutil.ignore_patterns(".git", ".venv", "__pycache__", ".*_cache", ".hypothesis")
    folder = shutil.copytree(ROOT, tmp_path_factory.mktemp("source") / "repo", ignore=ignore)
    for trap in (*TRAPS, *PLANTED):
        (folder / trap).parent.mkdir(parents=True, exist_ok=True)
        (folder / trap).write_text("trap = 1\n")
    (folder / "secret").write_text("trap = 1\n")
    (folder / "exercises" / "integrators" / "rubric.toml").symlink_to("../../secret")  # a role's name
    return folder


def _build(source, out, kind):
    """Build offline with the backend that is installed; the archive, and what the builder said.

    Args:
        kind: "wheel", "sdist" or "editable".
    """
    code = f"import hatchling.build as b, sys; print(b.build_{kind}(sys.argv[1]))"
    done = subprocess.run(
        [sys.executable, "-c", code, str(out)], cwd=source, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return out / done.stdout.split()[-1], done.stdout + done.stderr


@pytest.fixture(scope="module")
def built(source, tmp_path_factory):
    """By kind, what is handed out and what the builder said."""
    return {kind: _build(source, tmp_path_factory.mktemp(kind), kind) for kind in ("wheel", "sdist")}


@pytest.fixture(scope="module")
def wheel(built):
    return built["wheel"][0]


def _names(archive):
    """Files of an archive, without the folder an sdist wraps around them."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as wheel:
            return wheel.namelist()
    with tarfile.open(archive) as tar:
        return [member.name.partition("/")[2] for member in tar.getmembers() if member.isfile()]


def _student_files(folder):
    """What a student must get of a folder: everything that git would keep."""
    return {
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and not path.name.endswith(".pyc")
    }


@pytest.mark.parametrize("kind", ["wheel", "sdist"])
def test_only_what_has_a_role_for_students_is_inside_and_what_has_none_is_named(built, kind):
    archive, said = built[kind]
    names = _names(archive)
    assert [name for name in names if FORBIDDEN & set(name.split("/"))] == []
    assert [name for name in names if "trap" in name or name.endswith("integrators/rubric.toml")] == []
    named = {line.rpartition(" role: ")[2].strip("'\"") for line in said.splitlines() if " role: " in line}
    folders = {"exercises/integrators/solutions-trap/integrators.py": "exercises/integrators/solutions-trap"}
    assert {folders.get(trap, trap) for trap in PLANTED} <= named
    assert "exercises/integrators/rubric.toml" in named
    assert not {name for name in named if "__pycache__" in name or "_cache" in name}


def test_a_checkout_has_no_file_without_a_role(tmp_path):
    assert " role: " not in _build(ROOT, tmp_path, "wheel")[1]


def test_git_has_no_say_in_what_is_inside(source, wheel, tmp_path):
    copy = tmp_path / "repository"
    shutil.copytree(source, copy, symlinks=True)
    git = ["git", "-c", "user.name=n", "-c", "user.email=n@example.org"]
    subprocess.run([*git, "init", "-q"], cwd=copy, check=True)
    subprocess.run(
        [*git, "add", "-f", "exercises/integrators/trap.md", "course/trap.env"], cwd=copy, check=True
    )
    (copy / ".gitignore").write_text("*.toml\n*.py\n")
    assert sorted(_names(_build(copy, tmp_path, "wheel")[0])) == sorted(_names(wheel))


def test_no_line_of_a_solution_or_grader_is_inside_the_wheel(wheel):
    """Moved or renamed, a hidden file would still be found by what it says."""
    hidden = [*ROOT.glob("tests/graders/*/*.py")]
    for folder in ("*", "warm-ups/*", "warm-ups/*/accepted"):
        hidden += ROOT.glob(f"solutions/{folder}/*.py")
    assert hidden
    # What a stub gives is in the solution as well, and no secret.
    given = {line for path in ROOT.glob("exercises/**/*.py") for line in path.read_text().splitlines()}
    marks = {
        path: max(set(path.read_text(encoding="utf-8").splitlines()) - given, key=len) for path in hidden
    }
    with zipfile.ZipFile(wheel) as archive:
        inside = "\n".join(
            archive.read(name).decode("utf-8") for name in archive.namelist() if name.endswith(".py")
        )
    assert [str(path) for path, line in marks.items() if line in inside] == []


def test_the_wheel_has_everything_a_student_needs(wheel):
    names = set(_names(wheel))
    assert {f"course/content/{name}" for name in _student_files("exercises")} <= names
    assert {f"course/content/{name}" for name in _student_files("quiz")} <= names
    assert _student_files("course") <= names
    for needed in ("exercise.toml", "README.md", "checks.py", "diagnoses.json", "integrators.py"):
        assert f"course/content/exercises/integrators/{needed}" in names
    assert "course/content/exercises/warm-ups/diagnoses.json" in names
    for needed in ("exercise.toml", "README.md", "checks.py", "fall_time.py"):
        assert f"course/content/exercises/warm-ups/fall-time/{needed}" in names
    assert "course/lessons/syllabus.toml" in names


def test_the_wheel_notes_the_python_and_the_numpy_that_grade(wheel):
    with zipfile.ZipFile(wheel) as archive:
        told = json.loads(archive.read("course/graded_with.json"))
    assert (told["python"], told["numpy"]) == (platform.python_version(), np.__version__)
    assert {"sqrt", "fsum"} <= set(told["names"]["math"])
    assert "trapezoid" in told["names"]["numpy"]


def test_the_wheel_installs_one_package_and_nothing_beside_it(wheel):
    tops = {name.split("/")[0] for name in _names(wheel)}
    (metadata,) = tops - {"course"}
    assert metadata.endswith(".dist-info")


def test_the_source_archive_builds_the_same_wheel(built, wheel, tmp_path):
    with tarfile.open(built["sdist"][0]) as tar:
        tar.extraction_filter = getattr(tarfile, "data_filter", None)  # from 3.11.4 on
        tar.extractall(tmp_path)
    (folder,) = tmp_path.iterdir()
    again, _ = _build(folder, tmp_path, "wheel")
    assert sorted(_names(again)) == sorted(_names(wheel))


_ASK = """
import json
from course.catalog.load import Catalog
from course.catalog.locate import content
found, catalog = content(), Catalog()
print(json.dumps({
    "checkout": found.is_checkout, "root": str(found.root), "lessons": len(catalog.lessons()),
    "exercises": [e.id for e in catalog.exercises()],
    "stubs": [e.stub_path.is_file() for e in catalog.exercises()],
}))
"""


#: What the folder adds comes before what is installed here, which may well be this very checkout.
_FIRST = """
import site, sys
before = list(sys.path)
site.addsitedir({site!r})
sys.path[:] = [entry for entry in sys.path if entry not in before] + before
"""


def _ask(folder, code, **environment):
    """What a fresh interpreter says that finds the package only as given."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("COURSE_", "PYTHON"))}
    done = subprocess.run(
        [sys.executable, "-P", "-c", code],
        cwd=folder,
        env={**kept, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_an_unpacked_wheel_finds_its_content_and_is_a_students(wheel, tmp_path):
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path / "site")
    said = json.loads(_ask(tmp_path, _ASK, PYTHONPATH=str(tmp_path / "site")))
    assert said["checkout"] is False
    assert "integrators" in said["exercises"]
    assert all(said["stubs"])
    assert said["lessons"] >= 1


def test_an_editable_installation_reads_the_checkout(source, tmp_path):
    site = tmp_path / "site"
    with zipfile.ZipFile(_build(source, tmp_path, "editable")[0]) as archive:
        archive.extractall(site)
    assert list(site.glob("*.pth")), "an editable wheel points at the checkout"
    said = json.loads(_ask(tmp_path, _FIRST.format(site=str(site)) + _ASK))
    assert said["checkout"] is True
    assert said["root"] == str(source)
    assert "integrators" in said["exercises"]


def _pinned():
    """What CI installs: names and versions; each line has one digest and no address."""
    lines = [line for line in (ROOT / ".ci" / "pinned.txt").read_text("utf-8").splitlines() if line[0] != "#"]
    found = [re.fullmatch(r"([a-z0-9-]+)==(\S+) --hash=sha256:[0-9a-f]{64}", line) for line in lines]
    assert all(found), "a line is no name, version and digest"
    return {match[1]: match[2] for match in found if match}


def test_what_ci_installs_is_pinned_and_is_what_the_course_asks_for():
    pinned = _pinned()
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    project = pyproject["project"]
    (extras,) = re.findall(r"-e '\.\[([a-z,]+)\]'", (ROOT / ".ci" / "run").read_text("utf-8"))
    assert f"[{extras}]" in (ROOT / ".ci" / "pin").read_text("utf-8")
    wanted = [*project["dependencies"], *pyproject["build-system"]["requires"]]
    for extra in extras.split(","):
        wanted += project["optional-dependencies"][extra]
    here = {"python_version": "3.11", "sys_platform": "linux", "platform_machine": "x86_64"}
    for requirement in map(Requirement, wanted):
        if requirement.marker is None or requirement.marker.evaluate(here):
            name = re.sub(r"[-_.]+", "-", requirement.name).lower()
            assert pinned[name] in requirement.specifier, f"{requirement}: run .ci/pin again"


def test_actions_are_fetched_by_commit():
    used = [
        line for path in (ROOT / ".github" / "workflows").glob("*.yml")
        for line in path.read_text("utf-8").splitlines() if "uses:" in line
    ]  # fmt: skip
    assert used
    assert [line for line in used if not re.search(r"@[0-9a-f]{40} # v[\d.]+$", line)] == []
