"""The zip for Gradescope: complete, the same every time, and it grades as the class run does."""

from __future__ import annotations

import contextlib
import json
import os
import re
import stat
import subprocess
import sys
import tomllib
import zipfile
from importlib import metadata
from typing import TYPE_CHECKING, Any

import pytest
from packaging.requirements import Requirement

from course.catalog.load import Catalog
from course.errors import MissingCapabilityError
from course.grading.exports.autograder import write_autograder
from course.grading.exports.container import grade, main
from course.scoring.judging.session import GradingSession
from tests.unit.grading.conftest import MINI

if TYPE_CHECKING:
    from pathlib import Path

    from course.scoring.judging.terms import Terms

WRONG = b"\ndef double(x):\n    print('I saw', x)\n    return x\n"
#: A hidden input of the miniature course, and what is expected of it.
HIDDEN = ("17.25", "34.5")
#: What ``setup.sh`` installs.
INSTALLED = ("msgspec", "numpy", "pymunk", "pytest")
#: Denies what an image that has run ``setup.sh`` lacks, though it is installed here.
DENY = """
import sys
class Absent:
    def find_spec(self, name, *_):
        if name.partition(".")[0] in ABSENT:
            raise ModuleNotFoundError(f"No module named {name!r} in the container", name=name)
sys.meta_path.insert(0, Absent())
"""


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory, catalog: Catalog) -> Path:
    """The autograder as Gradescope unpacks it into ``source``."""
    folder = tmp_path_factory.mktemp("autograder")
    path = folder / "autograder.zip"
    write_autograder(path, catalog, catalog.exercises(), seed=5, timeout=5.0, asked=False)
    with zipfile.ZipFile(path) as packed:
        assert packed.testzip() is None
        packed.extractall(folder / "source")
    return folder


def test_the_zip_has_what_gradescope_runs_and_only_what_grading_needs(
    unpacked: Path, tmp_path: Path, catalog: Catalog
) -> None:
    path = unpacked / "autograder.zip"
    with zipfile.ZipFile(path) as packed:
        modes = {info.filename: info.external_attr >> 16 for info in packed.infolist()}
    assert all(modes[name] & stat.S_IXUSR for name in ("setup.sh", "run_autograder"))
    names = set(modes)
    assert {
        "content/graders/doubling/checks.py",
        "content/exercises/halving/checks.py",
        "config.json",
    } <= names
    assert "content/solutions/doubling/doubling.py" in names
    assert not [name for name in names if "mutants" in name or name.startswith(("course/cli", "tests"))]
    assert not [name for name in names if name.startswith("/") or ".." in name or "__pycache__" in name]
    again = tmp_path / "again.zip"
    write_autograder(again, catalog, catalog.exercises(), seed=5, timeout=5.0, asked=False)
    assert again.read_bytes() == path.read_bytes()


def test_it_installs_the_versions_this_project_states(unpacked: Path) -> None:
    setup = (unpacked / "source" / "setup.sh").read_text("utf-8")
    stated = tomllib.loads((MINI.parents[2] / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
    installed = {Requirement(text) for text in re.findall(r"'([a-z][^']*)'", setup) if "=" in text}
    for name in INSTALLED:
        assert next(found for found in map(Requirement, stated) if found.name == name) in installed


@pytest.mark.parametrize("script", ["setup.sh", "run_autograder"])
def test_its_scripts_are_shell(unpacked: Path, script: str) -> None:
    path = unpacked / "source" / script
    assert path.read_bytes().startswith(b"#!/usr/bin/env bash\n")
    assert not re.search(rb"[^$]\{[a-z]+\}", path.read_bytes()), "a place that was not filled in"
    done = subprocess.run(["bash", "-n", path], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_it_grades_from_the_unpacked_zip_alone(unpacked: Path, solution: bytes) -> None:
    """As ``run_autograder`` does, with the paths of this machine in place of the container's."""
    submission = unpacked / "submission"
    submission.mkdir()
    (submission / "doubling.py").write_bytes(solution + WRONG)
    source, results = unpacked / "source", unpacked / "results" / "results.json"
    environment = {name: value for name, value in os.environ.items() if name not in {"PYTHONPATH"}}
    environment |= {"COURSE_CONTENT": str(source / "content"), "PYTHONPATH": str(source)}
    command = [sys.executable, "-P", "-m", "course.grading.exports.container"]
    done = subprocess.run(
        [*command, submission, results, source / "config.json"],
        env=environment, cwd="/", capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    body: dict[str, Any] = json.loads(results.read_bytes())
    assert body["score"] == 6
    assert {test["name"]: test["score"] for test in body["tests"]}["Twice three is six"] == 0
    (extra,) = body["extra_data"]["results"]
    assert extra["isolation"] in {"L1", "L2", "L3"}
    assert f"doubling: graded at {extra['isolation']}" in done.stdout
    assert not [value for value in HIDDEN if value in results.read_text("utf-8")]


def test_the_model_solution_of_every_exercise_has_full_marks_in_the_container(tmp_path: Path) -> None:
    """With the files of the zip and the packages of ``setup.sh``, and nothing else of this machine."""
    catalog = Catalog()
    path = tmp_path / "autograder.zip"
    write_autograder(path, catalog, catalog.exercises(), seed=7, timeout=10.0, asked=True)
    source, results = tmp_path / "source", tmp_path / "results.json"
    with zipfile.ZipFile(path) as packed:
        packed.extractall(source)
    assert catalog.content.solutions is not None
    for exercise in catalog.exercises():
        (tmp_path / "submission" / exercise.id).mkdir(parents=True)
        model = (catalog.content.solutions / exercise.id / exercise.module).read_bytes()
        (tmp_path / "submission" / exercise.id / exercise.module).write_bytes(model)
    (tmp_path / "deny").mkdir()
    (tmp_path / "deny" / "sitecustomize.py").write_text(f"ABSENT = {absent()!r}\n{DENY}", "utf-8")
    environment = {name: value for name, value in os.environ.items() if name not in {"PYTHONPATH"}}
    environment |= {"COURSE_CONTENT": str(source / "content"), "PYTHONPATH": f"{source}:{tmp_path / 'deny'}"}
    done = subprocess.run(
        [sys.executable, "-P", "-m", "course.grading.exports.container",
         tmp_path / "submission", results, source / "config.json"],
        env=environment, cwd="/", capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    body: dict[str, Any] = json.loads(results.read_bytes())
    lost = [(test["number"], test["output"]) for test in body["tests"] if test["status"] != "passed"]
    assert lost == []
    assert body["score"] == sum(exercise.max_points for exercise in catalog.exercises())


def absent() -> set[str]:
    """Top-level modules of what is installed here and not by ``setup.sh``."""
    wanted, present = list(INSTALLED), set()
    while wanted:
        name = wanted.pop().lower().replace("_", "-")
        if name not in present:
            present.add(name)
            with contextlib.suppress(metadata.PackageNotFoundError):
                needs = [Requirement(text) for text in metadata.requires(name) or ()]
                wanted += [need.name for need in needs if need.marker is None or need.marker.evaluate()]
    modules = metadata.packages_distributions()
    kept = {*present, "course", "course-physics-sim"}
    return {
        module
        for module, owners in modules.items()
        if module != "course" and not {owner.lower().replace("_", "-") for owner in owners} & kept
    }


def test_hidden_inputs_cannot_be_read_out_by_handing_in_again(
    tmp_path: Path, solution: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The total is shown at once; a comparison with a drawn number would tell one bit of it each time."""
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    (tmp_path / "submission").mkdir()
    seeds: list[int] = []
    plain = GradingSession.__init__

    def noted(self: GradingSession, *args: Any, terms: Terms, **more: Any) -> None:
        seeds.append(terms.seed)
        plain(self, *args, terms=terms, **more)

    monkeypatch.setattr(GradingSession, "__init__", noted)
    facts = json.loads(config(tmp_path).read_text())
    for what in (b"", b"# below 0.5?\n", b""):
        (tmp_path / "submission" / "doubling.py").write_bytes(solution + what)
        assert grade(tmp_path / "submission", facts)["score"] == 10
    assert seeds[0] == seeds[2] != seeds[1]
    assert all(0 <= seed < 2**63 for seed in seeds)


def config(tmp_path: Path, **changes: object) -> Path:
    path = tmp_path / "config.json"
    facts = {"exercises": ["doubling"], "required": True, "seed": 1, "timeout": 5.0, "at_least": "L1"}
    path.write_text(json.dumps(facts | changes), "utf-8")
    return path


def test_what_cannot_be_graded_is_explained_to_the_student(
    tmp_path: Path, catalog: Catalog, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    (tmp_path / "submission").mkdir()
    body = grade(tmp_path / "submission", json.loads(config(tmp_path).read_text()))
    assert body["score"] == 0
    assert "There is no doubling.py" in body["tests"][0]["output"]
    body = grade(tmp_path / "submission", json.loads(config(tmp_path, required=False).read_text()))
    assert (body["score"], body["tests"]) == (0, [])
    assert "doubling/doubling.py" in body["output"]


@pytest.mark.parametrize("changes", [{"exercises": ["none"]}, {"at_least": "L9"}])
def test_a_fault_of_ours_gives_no_score_and_always_a_results_file(
    tmp_path: Path, solution: bytes, monkeypatch: pytest.MonkeyPatch, changes: dict[str, object]
) -> None:
    monkeypatch.setenv("COURSE_CONTENT", str(MINI))
    (tmp_path / "submission").mkdir()
    (tmp_path / "submission" / "doubling.py").write_bytes(solution)
    results = tmp_path / "results.json"
    assert main([str(tmp_path / "submission"), str(results), str(config(tmp_path, **changes))]) == 0
    body = json.loads(results.read_bytes())
    assert "score" not in body
    assert "tests" not in body
    assert "not of yours" in body["output"]


def test_a_students_installation_has_no_graders_to_pack(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("exercises", "lessons"):
        (tmp_path / "course" / name).mkdir(parents=True)
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "course"))
    with pytest.raises(MissingCapabilityError):
        write_autograder(tmp_path / "a.zip", Catalog(), (), seed=1, timeout=1.0, asked=False)
    assert not (tmp_path / "a.zip").exists()
