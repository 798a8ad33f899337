"""Our run, nbgrader and otter side by side: the same checks on the same submissions, CPU per submission.

    python tests/benchmarks/peers/compare.py [EXERCISE] [--submissions 8] [--class 96] [--only nbgrader]
                                             [--venvs DIR]

Each peer gets a virtual environment of its own in a temporary folder (``--venvs`` keeps them for the next
time), and a notebook with one cell of the student's code and one graded cell per check. CPU is that of every
process a command starts, from start to end. Ours is measured twice: on the very same submissions, where
starting is most of it, and on a class of ``--class``, which is what it is made for; nbgrader is measured
student by student and on all at once. Scores are compared: whoever grades faster must come to the same.
A peer takes some ten wall seconds a submission, longer on a busy machine; CPU is hardly touched by that.
"""

import argparse
import contextlib
import csv
import io
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[2]
sys.path[:0] = [str(ROOT), str(HERE)]

import here  # noqa: E402

from course.authoring.exercises.grading import (  # noqa: E402
    accepted_sources,
    mistakes_of,
    solution_path,
    source_of,
)
from course.catalog.load import Catalog  # noqa: E402

#: What the checks need beside the peer itself.
NEEDED = ["numpy", "msgspec", "pymunk", "pytest", "ipykernel"]
PACKAGES = {"nbgrader": ["nbgrader", *NEEDED], "otter": ["otter-grader", *NEEDED]}
#: Wall seconds after which a command is given up; none has taken a tenth of it.
PATIENCE_S = 1800
INSTALL_S = 600
#: What each is to cost, in units of ours.
TARGETS = {"nbgrader one by one": 90, "nbgrader whole class": 20, "otter run": 60}
Scores = dict[str, float]


class NotMeasuredError(Exception):
    """Why a peer cannot be measured here, as a sentence."""


def cpu(command: list[str], folder: Path, **environment: str) -> tuple[float, str]:
    """CPU seconds of a command with all it starts, and what it printed."""
    bare = {name: value for name, value in os.environ.items() if not name.startswith(("PYTEST_", "JUPYTER"))}
    paths = {"PYTHONPATH": os.pathsep.join([str(ROOT), str(HERE)]), "PYDEVD_DISABLE_FILE_VALIDATION": "1"}
    before = os.times()
    try:
        done = subprocess.run(
            command, cwd=folder, env={**bare, **paths, **environment}, capture_output=True, text=True,
            check=False, timeout=PATIENCE_S,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise NotMeasuredError(f"{' '.join(command[:4])} was not done after {PATIENCE_S} s.") from None
    after = os.times()
    words = done.stdout + done.stderr
    if done.returncode:
        raise NotMeasuredError(f"{' '.join(command[:4])} ended with {done.returncode}: {words[-600:]}")
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return spent, words


def submissions(exercise: Any, catalog: Catalog, count: int) -> dict[str, str]:
    """Student to source: the model solution, accepted variants and mutants, taking turns."""
    sources = [solution_path(catalog, exercise).read_text("utf-8")]
    right = (source.decode() for source in accepted_sources(catalog, exercise).values())
    wrong = (source_of(catalog, exercise, one).decode() for one in mistakes_of(catalog, exercise).wrong)
    for pair in zip(right, wrong, strict=False):
        sources += pair
    return {
        f"student-{number:04}": f"{sources[number % len(sources)]}\n# {number}\n" for number in range(count)
    }


def ours(exercise: Any, sources: dict[str, str], scratch: Path) -> tuple[float, Scores]:
    """`course grade run` with one grader."""
    folder = scratch / "class"
    for student, source in sources.items():
        (folder / student).mkdir(parents=True)
        (folder / student / exercise.module).write_text(source, "utf-8")
    run = [sys.executable, "-m", "course", "grade", "run", str(folder), "--out", str(scratch / "out")]
    spent, _ = cpu([*run, "--exercise", exercise.id, "--seed", str(here.SEED), "--quiet"], scratch)
    with (scratch / "out" / "grades.csv").open(encoding="utf-8-sig", newline="") as file:
        scores = {row["student"]: float(row["score"]) for row in csv.DictReader(file)}
    return spent / len(sources), scores


def install(peer: str, packages: list[str], folder: Path) -> Path:
    """The folder of a peer's programs, installed now if they are not there."""
    programs = folder / peer / ("Scripts" if os.name == "nt" else "bin")
    if not (programs / peer).exists():
        try:
            for command in (
                [sys.executable, "-m", "venv", str(folder / peer)],
                [str(programs / "python"), "-m", "pip", "install", "-q", *packages],
            ):
                done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=INSTALL_S)
                if done.returncode:
                    last = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
                    raise NotMeasuredError(f"{peer} cannot be installed here: {last}")
        except subprocess.TimeoutExpired:
            raise NotMeasuredError(f"{peer} is not installed after {INSTALL_S} s") from None
    return programs


# -- nbgrader -----------------------------------------------------------------------------------------------


def notebook(cells: list[dict[str, Any]]) -> str:
    """A notebook of code cells."""
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    code: dict[str, Any] = {"cell_type": "code", "execution_count": None, "outputs": [], "metadata": {}}
    made = [code | {"id": f"cell-{number}"} | cell for number, cell in enumerate(cells)]
    return json.dumps({"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5})


NBGRADER_CONFIG = "c = get_config()\nc.CourseDirectory.course_id = 'c'\n"


def nbgrader_cell(name: str, source: str, points: float | None) -> dict[str, Any]:
    graded = points is not None
    marks: dict[str, Any] = {"schema_version": 3, "grade_id": name, "grade": graded, "task": False}
    marks |= {"solution": not graded, "locked": graded} | ({"points": points} if graded else {})
    return {"source": source, "metadata": {"nbgrader": marks}}


def nbgrader(
    exercise: Any, sources: dict[str, str], venv: Path, scratch: Path
) -> dict[str, tuple[float, Scores]]:
    """`nbgrader autograde`, for each student and for all."""
    tests = [
        nbgrader_cell(name, f"import here\nhere.run({exercise.id!r}, {name!r}, dict(globals()))", most)
        for name, most in here.points(exercise.id).items()
    ]

    def written(path: Path, source: str) -> None:
        path.parent.mkdir(parents=True)
        path.write_text(notebook([nbgrader_cell("solution", source, None), *tests]), "utf-8")

    found: dict[str, tuple[float, Scores]] = {}
    for way in ("one by one", "whole class"):
        course = scratch / way.replace(" ", "-")
        written(course / "source" / "ps1" / "work.ipynb", "### BEGIN SOLUTION\npass\n### END SOLUTION")
        (course / "nbgrader_config.py").write_text(NBGRADER_CONFIG, "utf-8")
        program = str(venv / "nbgrader")
        path = f"{venv}{os.pathsep}{os.environ['PATH']}"
        cpu([program, "generate_assignment", "ps1"], course, PATH=path)
        for student, source in sources.items():
            written(course / "submitted" / student / "ps1" / "work.ipynb", source)
        command = [program, "autograde", "ps1"]
        asked = (
            [[*command, "--student", student] for student in sources] if way == "one by one" else [command]
        )
        spent = sum(cpu(one, course, PATH=path)[0] for one in asked)
        cpu([program, "export"], course, PATH=path)
        with (course / "grades.csv").open(encoding="utf-8", newline="") as file:
            scores = {row["student_id"]: float(row["score"]) for row in csv.DictReader(file)}
        found[f"nbgrader {way}"] = (spent / len(sources), scores)
    return found


# -- otter --------------------------------------------------------------------------------------------------


#: Makes autograder.zip of the tests in a folder.
OTTER_GENERATE = (
    "generate", "-t", "tests", "-c", "otter_config.json", "--no-environment", "-o", "autograder.zip",
)  # fmt: skip


def otter_test(folder: Path, name: str, code: str, points: float, *, hidden: bool = False) -> None:
    """Write a test, and how otter is to run those of the folder."""
    case = {"code": code, "hidden": hidden, "locked": False}
    suite = {"cases": [case], "scored": True, "setup": "", "teardown": "", "type": "doctest"}
    test = {"name": name, "points": points, "suites": [suite]}
    (folder / "tests").mkdir(parents=True, exist_ok=True)
    (folder / "tests" / f"{name}.py").write_text(f"OK_FORMAT = True\n\ntest = {test!r}\n", "utf-8")
    (folder / "otter_config.json").write_text('{"pdf": false, "points_possible": null}', "utf-8")


def otter(
    exercise: Any, sources: dict[str, str], venv: Path, scratch: Path
) -> dict[str, tuple[float, Scores]]:
    """`otter run`, for each student."""
    for name, most in here.points(exercise.id).items():
        code = f">>> import here\n>>> here.run({exercise.id!r}, {name!r}, dict(globals()))"
        otter_test(scratch, name, code, most)
    path = f"{venv}{os.pathsep}{os.environ['PATH']}"
    program = str(venv / "otter")
    cpu([program, *OTTER_GENERATE], scratch, PATH=path)
    spent, scores = 0.0, {}
    for student, source in sources.items():
        place = scratch / student
        place.mkdir()
        (place / "work.ipynb").write_text(notebook([{"source": source}]), "utf-8")
        command = [program, "run", "work.ipynb", "-a", str(scratch / "autograder.zip"), "-o", str(place)]
        spent += cpu(command, place, PATH=path)[0]
        results = json.loads((place / "results.json").read_text("utf-8"))
        scores[student] = sum(float(test.get("score") or 0) for test in results["tests"])
    return {"otter run": (spent / len(sources), scores)}


PEERS: dict[str, Callable[..., dict[str, tuple[float, Scores]]]] = {"nbgrader": nbgrader, "otter": otter}


def differences(found: Scores, due: Scores) -> str:
    """A sentence on whose score is another one."""
    other = [
        f"{name} {found.get(name)} for {due[name]}"
        for name in due
        if abs(found.get(name, -1) - due[name]) > 0.01
    ]
    return "the same scores" if not other else f"other scores: {'; '.join(other[:3])} ({len(other)} in all)"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="?", default="integrators")
    parser.add_argument("--submissions", type=int, default=8)
    parser.add_argument("--class", dest="students", type=int, default=96)
    parser.add_argument("--only", choices=sorted(PEERS), action="append")
    parser.add_argument("--venvs", type=Path, help="folder to keep the peers' environments in")
    options = parser.parse_args()
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(line_buffering=True)  # it takes minutes: each line is seen when it is known
    catalog = Catalog()
    exercise = catalog.exercise(options.exercise)
    load = (
        f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors" if hasattr(os, "getloadavg") else ""
    )
    print(f"{exercise.id}: {len(here.points(exercise.id))} checks, {options.submissions} submissions; {load}")
    with contextlib.ExitStack() as stack:
        scratch = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="peers-")))
        venvs = (options.venvs or scratch / "venvs").absolute()
        sources = submissions(exercise, catalog, options.submissions)
        for name in ("same", "class", *PEERS):
            (scratch / name).mkdir()
        same, due = ours(exercise, sources, scratch / "same")
        mine, _ = ours(exercise, submissions(exercise, catalog, options.students), scratch / "class")
        print(
            f"  ours, {options.submissions} submissions      {same:7.3f} s of CPU each, most of it starting"
        )
        print(f"  ours, a class of {options.students:<5} {mine:7.3f} s of CPU each")
        for peer in options.only or PEERS:
            try:
                venv = install(peer, PACKAGES[peer], venvs)
                measured = PEERS[peer](exercise, sources, venv, scratch / peer)
            except NotMeasuredError as reason:
                print(f"  {peer}: not measured. {' '.join(str(reason).split())}")
                continue
            for name, (spent, scores) in measured.items():
                print(
                    f"  {name:22} {spent:7.3f} s of CPU each: {spent / mine:.0f} times ours (target"
                    f" {TARGETS[name]}), {spent / same:.0f} times ours at the same {options.submissions};"
                    f" {differences(scores, due)}"
                )


if __name__ == "__main__":
    main()
