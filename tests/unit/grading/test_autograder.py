"""The zip for Gradescope: complete, the same every time, and it grades as the class run does."""

from __future__ import annotations

import json
import os
import re
import stat
import subprocess
import sys
import tomllib
import zipfile
from typing import TYPE_CHECKING, Any

import pytest
from packaging.requirements import Requirement

from course.catalog.load import Catalog
from course.errors import MissingCapabilityError
from course.grading.exports.autograder import write_autograder
from course.grading.exports.container import grade, main
from tests.unit.grading.conftest import MINI

if TYPE_CHECKING:
    from pathlib import Path

WRONG = b"\ndef double(x):\n    print('I saw', x)\n    return x\n"
#: A hidden input of the miniature course, and what is expected of it.
HIDDEN = ("17.25", "34.5")


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
    assert not [name for name in names if "solutions" in name or name.startswith(("course/cli", "tests"))]
    assert not [name for name in names if name.startswith("/") or ".." in name or "__pycache__" in name]
    again = tmp_path / "again.zip"
    write_autograder(again, catalog, catalog.exercises(), seed=5, timeout=5.0, asked=False)
    assert again.read_bytes() == path.read_bytes()


def test_it_installs_the_versions_this_project_states(unpacked: Path) -> None:
    setup = (unpacked / "source" / "setup.sh").read_text("utf-8")
    stated = tomllib.loads((MINI.parents[2] / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
    installed = {Requirement(text) for text in re.findall(r"'([a-z][^']*)'", setup) if "=" in text}
    for name in ("msgspec", "numpy", "pytest"):
        assert next(found for found in map(Requirement, stated) if found.name == name) in installed


@pytest.mark.parametrize("script", ["setup.sh", "run_autograder"])
def test_its_scripts_are_shell(unpacked: Path, script: str) -> None:
    path = unpacked / "source" / script
    assert path.read_bytes().startswith(b"#!/usr/bin/env bash\n")
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
    assert "none of yours" in body["output"]


def test_a_students_installation_has_no_graders_to_pack(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("exercises", "lessons"):
        (tmp_path / "course" / name).mkdir(parents=True)
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "course"))
    with pytest.raises(MissingCapabilityError):
        write_autograder(tmp_path / "a.zip", Catalog(), (), seed=1, timeout=1.0, asked=False)
    assert not (tmp_path / "a.zip").exists()
