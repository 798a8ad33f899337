"""The zip for Gradescope: complete, the same every time, and it grades as the class run does."""

import json
import re
import stat
import subprocess
import tomllib
import zipfile

import pytest
from packaging.requirements import Requirement

from course.catalog.locate import content
from course.grading import container
from course.grading.container import SNAPSHOT, main, write_autograder
from course.grading.running.snapshot import Snapshot
from tests.unit.grading.conftest import MINI
from tests.unit.grading.running.test_run import right

#: What ``setup.sh`` installs.
INSTALLED = ("msgspec", "numpy", "pymunk", "pytest")


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory, catalog):
    """The autograder as Gradescope unpacks it into ``source``."""
    folder = tmp_path_factory.mktemp("autograder")
    path = folder / "autograder.zip"
    write_autograder(path, catalog, catalog.exercises(), seed=5, timeout=5.0, asked=False)
    with zipfile.ZipFile(path) as packed:
        assert packed.testzip() is None
        packed.extractall(folder / "source")
    return folder


def test_the_zip_has_what_gradescope_runs_and_only_what_grading_needs(unpacked, tmp_path, catalog):
    path = unpacked / "autograder.zip"
    with zipfile.ZipFile(path) as packed:
        modes = {info.filename: info.external_attr >> 16 for info in packed.infolist()}
    assert all(modes[name] & stat.S_IXUSR for name in ("setup.sh", "run_autograder"))
    names = set(modes)
    assert {"graders.zip", "config.json", "course/grading/container.py"} <= names
    assert not [name for name in names if not name.startswith("course/") and "/" in name]
    with zipfile.ZipFile(unpacked / "source" / "graders.zip") as graders:
        inside = set(graders.namelist())
    assert {"content/graders/doubling/checks.py", "content/exercises/halving/checks.py"} <= inside
    assert "content/solutions/doubling/doubling.py" in inside
    assert not [name for name in inside if name.endswith(("/mistakes.py", "/record.json"))]
    assert not [name for name in inside if name.startswith(("course/cli", "tests"))]
    assert not [name for name in names if name.startswith("/") or ".." in name or "__pycache__" in name]
    again = tmp_path / "again.zip"
    write_autograder(again, catalog, catalog.exercises(), seed=5, timeout=5.0, asked=False)
    assert again.read_bytes() == path.read_bytes()


def test_it_installs_the_versions_this_project_states(unpacked):
    setup = (unpacked / "source" / "setup.sh").read_text("utf-8")
    stated = tomllib.loads((MINI.parents[2] / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
    installed = {Requirement(text) for text in re.findall(r"'([a-z][^']*)'", setup) if "=" in text}
    for name in INSTALLED:
        assert next(found for found in map(Requirement, stated) if found.name == name) in installed


@pytest.mark.parametrize("script", ["setup.sh", "run_autograder"])
def test_its_scripts_are_shell(unpacked, script):
    path = unpacked / "source" / script
    assert path.read_bytes().startswith(b"#!/usr/bin/env bash\n")
    assert not re.search(rb"[^$]\{[a-z]+\}", path.read_bytes()), "a place that was not filled in"
    done = subprocess.run(["bash", "-n", path], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def graded(tmp_path, source, **changes):
    """The body of the results for a submission with that file, or none; the exit code is always 0."""
    (tmp_path / "submission").mkdir(exist_ok=True)
    if source is not None:
        (tmp_path / "submission" / "doubling.py").write_bytes(source)
    snapshot = Snapshot.take(content())
    (tmp_path / SNAPSHOT).write_bytes(snapshot.packed)
    facts = {"exercises": ["doubling"], "required": True, "seed": 1, "timeout": 5.0, "at_least": "L1"}
    path, results = tmp_path / "config.json", tmp_path / "results.json"
    path.write_text(json.dumps(facts | {"graders": snapshot.sha256} | changes), "utf-8")
    assert main([str(tmp_path / "submission"), str(results), str(path)]) == 0
    return json.loads(results.read_bytes())


def test_hidden_inputs_cannot_be_read_out_by_handing_in_again(tmp_path, solution, monkeypatch):
    """The total is shown at once; a comparison with a drawn number would tell one bit of it each time."""
    seeds = []

    def noted(entries, terms):
        seeds.append(terms.seed)
        return right(entries, terms)

    monkeypatch.setattr(container, "grade_all", noted)
    for what in (b"", b"# below 0.5?\n", b""):
        assert graded(tmp_path, solution + what)["score"] == 10
    assert seeds[0] == seeds[2] != seeds[1]
    assert all(0 <= seed < 2**63 for seed in seeds)


def test_what_cannot_be_graded_is_explained_to_the_student(tmp_path):
    body = graded(tmp_path, None)
    assert body["score"] == 0
    assert "There is no doubling.py" in body["tests"][0]["output"]
    body = graded(tmp_path, None, required=False)
    assert (body["score"], body["tests"]) == (0, [])
    assert "doubling/doubling.py" in body["output"]


@pytest.mark.parametrize("changes", [{"exercises": ["none"]}, {"at_least": "L9"}, {"graders": "0" * 64}])
def test_a_fault_of_ours_gives_no_score_and_always_a_results_file(tmp_path, solution, changes):
    body = graded(tmp_path, solution, **changes)
    assert body.keys().isdisjoint({"score", "tests"})
    assert "not of yours" in body["output"]
