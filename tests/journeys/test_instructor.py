"""An instructor's whole term, in a checkout: a class with everyone in it, graded in each way, and after."""

import contextlib
import csv
import io
import json
import os
import shutil
import subprocess
import sys
import zipfile
from importlib import metadata
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from packaging.requirements import Requirement

from course.authoring.exercises.grading import mistakes_of
from course.catalog.load import Catalog
from tests.journeys.conftest import ALL, ROOT, Way, in_turn, model, notebook, results

CATALOG = Catalog()
EXERCISES = CATALOG.exercises()
SOLUTIONS = ROOT / "solutions"
MISSING, RIGHT, LESS, REFUSED = "missing", "right", "less", "refused"
#: A hostile file: it looks for the graders, and ends the process of whoever calls it.
HOSTILE = """
import gc, os, sys
sys.path[:0] = ["/work", "/proc/1/root", os.getcwd()]
found = [o for o in gc.get_objects() if type(o).__name__ in ("GradingSession", "CheckResult")]
assert not found
"""
#: What ``setup.sh`` installs in Gradescope's image.
INSTALLED = ("msgspec", "numpy", "pymunk", "pytest")
DENY = """
import sys
class Absent:
    def find_spec(self, name, *_):
        if name.partition(".")[0] in ABSENT:
            raise ModuleNotFoundError(f"No module named {name!r} in the container", name=name)
sys.meta_path.insert(0, Absent())
"""


def wrong(exercise):
    """The model with one of its known mistakes."""
    first = mistakes_of(CATALOG, exercise).wrong[0]
    return first.composed(model(exercise), SOLUTIONS / exercise.id / exercise.module)


def broken(exercise):
    """One function that is no Python, and a line that raises."""
    name = exercise.task[0].id
    return model(exercise).replace(f"def {name}(", f"def {name}((", 1) + "\nprint(nothing_of_this_name)\n"


#: Each student: what becomes of each exercise, and the file that is handed in for it.
KINDS = {
    "ada": (RIGHT, lambda one: (one.module, model(one))),
    "bea": (RIGHT, lambda one: (one.module.replace(".py", ".ipynb"), notebook(one).decode())),
    "cyd": (LESS, lambda one: (one.module, wrong(one))),
    "dan": (MISSING, lambda _: None),
    "eve": (RIGHT, lambda one: (one.module, model(one) + HOSTILE)),
    "fay": (LESS, lambda one: (one.module, broken(one))),
    "gus": (REFUSED, lambda one: (one.module, "")),
    "hal": (REFUSED, lambda one: (f"{one.module}_final.py", model(one))),
    "ivy": (LESS, lambda one: (one.module, Path(one.stub_path).read_text("utf-8"))),
    "jon": (LESS, lambda one: (one.module, f"{model(one)}\n\ndel {one.task[-1].id}\n")),
}
#: Who stands for the others in a container, where each student is a second, in an ordinary run.
OFTEN = ("bea", "fay")


def hands_in_for(student):
    """What a student hands in: everything; in an ordinary run of most the first exercise and one in turn."""
    if ALL or student == "ada":
        return EXERCISES
    others = EXERCISES[1:]
    day = in_turn(range(len(others)))[0]
    return [EXERCISES[0], others[(day + list(KINDS).index(student)) % len(others)]]


def copied_by_lou():
    """Of what ada hands in."""
    return EXERCISES if ALL else EXERCISES[:1]


@pytest.fixture(scope="module")
def zipped(installed, tmp_path_factory):
    """What a student's own `submit` makes of everything done right, the quiz included."""
    home = tmp_path_factory.mktemp("kim")
    command, says = installed
    student = Way(command, home, {"PATH": os.environ["PATH"], "HOME": str(home), **says})
    student("init", "work")
    for exercise in EXERCISES:
        (home / "work" / exercise.id).mkdir()
        shutil.copy(SOLUTIONS / exercise.id / exercise.module, home / "work" / exercise.id)
    form = student("quiz", "take", "--seed", "5", "--questions", cwd=home / "work").stdout
    form = form[form.index("format_version = 1") : form.index("Then: ")].replace('= ""', '= "a"')
    (home / "work" / "answers.toml").write_text(form, "utf-8")
    ran = subprocess.run(
        [*command, "quiz", "take", "--answers", "answers.toml"],
        cwd=home / "work", env=student.environment, capture_output=True, check=False,
    )  # fmt: skip
    assert ran.returncode in {0, 1}
    student("submit", "-o", home / "mine.zip", cwd=home / "work")
    return home / "mine.zip"


@pytest.fixture(scope="module")
def handed_in(zipped, tmp_path_factory):
    """A class of twelve, and its roster beside it."""
    folder = tmp_path_factory.mktemp("class")
    for student, (_, hands_in) in KINDS.items():
        for exercise in hands_in_for(student):
            work = hands_in(exercise)
            place = folder / "class" / student / exercise.id
            place.mkdir(parents=True)
            if work is not None:
                name, content = work
                (place / name).write_text(content, "utf-8")
    (folder / "class" / "kim").mkdir()
    shutil.copy(zipped, folder / "class" / "kim")
    for exercise in copied_by_lou():
        shutil.copytree(folder / "class" / "ada" / exercise.id, folder / "class" / "lou" / exercise.id)
    students = [*KINDS, "kim", "lou", "max"]
    with (folder / "roster.csv").open("w", encoding="utf-8") as file:
        print("student,name,canvas_id,moodle_key,email", file=file)
        for number, name in enumerate(students, 101):
            print(f"{name},{name.title()} É,{number},{name}.key,{name}@x.org", file=file)
    return folder


def run(instructor, handed_in, out, *how):
    """What a run over the class finds, by student and exercise."""
    instructor(
        "grade", "run", handed_in / "class", "--out", out, "--seed", "7", "--roster",
        handed_in / "roster.csv", *how, code=6,
    )  # fmt: skip
    return results(out)


def scores(found):
    return {about: (line["state"], line["score"]) for about, line in found.items()}


def test_a_term(instructor, handed_in, tmp_path):
    """Every command of `grade` on one class, in the order in which a term needs them."""
    out = tmp_path / "out"
    found = run(instructor, handed_in, out, "-j", "1")
    as_each_deserves(found)
    ways = [("-j", "2"), ("--local-cluster", "2")] if ALL else []
    for number, way in enumerate(ways):
        assert scores(run(instructor, handed_in, tmp_path / f"way{number}", *way)) == scores(found), way

    first = EXERCISES[0].id
    assert "100 of 100, passed" in instructor("grade", "explain", out, "ada", first).stdout
    assert "Nothing was handed in." in instructor("grade", "explain", out, "max", first).stdout
    # Whose file it is, and what was shown in person.
    listed = instructor("grade", "assign", out).stdout
    assert f"{first}/{EXERCISES[0].module}_final.py" in listed
    file = f"{first}/{EXERCISES[0].module}_final.py"
    instructor("grade", "assign", out, "hal", file, "--exercise", first, "--reason", "his file")
    said = instructor("grade", "assign", out, "--accept-names", "--reason", "their files", "-j", "2").stdout
    assert said.count("100 of 100") + said.count("-> 100") == len(hands_in_for("hal")) - 1, said
    instructor("grade", "override", out, "gus", first, "--score", "60", "--reason", "shown in person")
    refused = instructor("grade", "export", out, "--format", "moodle", code=4)
    assert "would get 0" in refused.stderr

    # Late work, regrading, alike.
    (tmp_path / "late.toml").write_text(
        f'format_version = 1\npercent_per_day = 10\n[[deadline]]\nexercise = "{first}"\n'
        "due = 2026-01-01T00:00:00Z\n",
        "utf-8",
    )
    (tmp_path / "times.csv").write_text(
        f"student,exercise,submitted_at\nada,{first},2026-01-01T12:00:00Z\n", "utf-8"
    )
    late = ("grade", "late", out, "--policy", tmp_path / "late.toml", "--times", tmp_path / "times.csv")
    assert "ada" in instructor(*late).stdout
    assert "score: 90 of 100" in instructor("grade", "explain", out, "ada", first).stdout
    instructor("grade", "late", out, "--clear")
    again = ("--all",) if ALL else ()
    assert "0 would change" in instructor("grade", "rerun", out, *again, "--dry-run", "-j", "2").stdout
    alike = instructor("grade", "similar", out, "--exercise", first).stdout
    assert "ada" in alike
    assert "lou" in alike
    assert "shown in person" in instructor("grade", "log", out).stdout

    exported(instructor, handed_in, out)
    salvaged(instructor, out, tmp_path)


def as_each_deserves(found):
    assert EXERCISES
    for exercise in EXERCISES:
        for student, (kind, _) in KINDS.items():
            if exercise not in hands_in_for(student):
                continue
            line = found[student, exercise.id]
            told = (student, exercise.id, line["state"], line["score"], line["error"])
            if kind == RIGHT:
                assert (line["state"], line["score"]) == ("graded", line["max_score"]), told
            elif kind == LESS:
                assert line["state"] == "graded", told
                assert line["score"] < line["max_score"], told
            elif kind == MISSING:
                assert (line["state"], line["score"]) == ("missing", None), told
            else:
                assert (line["state"], line["score"]) == ("ungradable", 0.0), told
        assert found["kim", exercise.id]["score"] == exercise.max_points
        if exercise in copied_by_lou():
            assert found["lou", exercise.id]["score"] == exercise.max_points
        if exercise not in hands_in_for("fay"):
            continue
        # One broken function and one line cost that function: its checks say why, a note tells of the line.
        lost = {check["task"] for check in found["fay", exercise.id]["checks"] if check["points"] == 0}
        assert exercise.task[0].id in lost
        assert found["fay", exercise.id]["warnings"]
    assert found["kim", "quiz"]["state"] == "graded"
    assert {line["isolation"] for line in found.values() if line["isolation"]} == {"L3"}


def exported(instructor, handed_in, out):
    """Every format, read back."""
    ids = [
        word for n, exercise in enumerate(EXERCISES) for word in ("--assignment", f"{exercise.id}={n + 1}")
    ]
    ids += ["--assignment", "quiz=9", "--accept-zeros"]
    for form, more, name in (
        ("csv", [], "grades.csv"),
        ("jsonl", [], "results.jsonl"),
        ("html", [], "report.html"),
        ("junit", [], "junit.xml"),
        ("gradescope", ["--accept-zeros"], "gradescope/index.csv"),
        ("canvas", ids, "canvas.csv"),
        ("moodle", ["--accept-zeros"], "moodle.csv"),
    ):
        instructor("grade", "export", out, "--format", form, *more)
        assert (out / name).stat().st_size > 100, form
    ET.parse(out / "junit.xml")
    rows = list(csv.reader(io.StringIO((out / "canvas.csv").read_text("utf-8-sig"), newline="")))
    ada = next(row for row in rows if row[1] == "101")
    assert [float(cell) for cell in ada[5:11]] == [exercise.max_points for exercise in EXERCISES]
    index = list(csv.DictReader(io.StringIO((out / "gradescope" / "index.csv").read_text("utf-8-sig"))))
    whose = next(row for row in index if (row["student"], row["exercise"]) == ("ada", EXERCISES[0].id))
    assert json.loads((out / "gradescope" / whose["file"]).read_bytes())["score"] == EXERCISES[0].max_points
    sheet = handed_in / "sheet.csv"
    sheet.write_text(
        "Identifier,Full name,Grade,Maximum Grade,Last modified (grade),Feedback comments\n"
        "Participant 1,ada,,100.00,-,\nParticipant 2,bea,55.00,100.00,-,Seen in the oral: fine\n",
        "utf-8",
    )
    said = instructor(
        "grade", "export", out, "--format", "moodle-worksheet", "--roster", sheet, "--exercise",
        EXERCISES[0].id, "--partial", "--accept-zeros",
    ).stdout  # fmt: skip
    assert "Seen in the oral: fine" in said


def salvaged(instructor, out, tmp_path):
    """A page of the gradebook is overwritten; nothing of it is lost, for there are backups."""
    with (out / "gradebook.sqlite").open("r+b") as file:
        file.seek(8192)
        file.write(b"\xff" * 4096)
    assert "damaged" in instructor("grade", "explain", out, "ada", EXERCISES[0].id, code=7).stderr
    instructor("grade", "salvage", out, "--to", tmp_path / "again")
    assert "passed" in instructor("grade", "explain", tmp_path / "again", "ada", EXERCISES[0].id).stdout


@pytest.mark.parametrize("exercise", in_turn(EXERCISES), ids=lambda one: one.id)
def test_the_container_of_an_exercise_scores_as_the_run(instructor, tmp_path, exercise):
    """With the files of the zip and the packages of ``setup.sh``, and nothing else of this machine."""
    instructor(
        "grade", "export", "--format", "gradescope-autograder", "--exercise", exercise.id, "--seed", "7",
        "-o", tmp_path / "autograder.zip",
    )  # fmt: skip
    source = tmp_path / "source"
    with zipfile.ZipFile(tmp_path / "autograder.zip") as packed:
        packed.extractall(source)
    (tmp_path / "deny").mkdir()
    (tmp_path / "deny" / "sitecustomize.py").write_text(f"ABSENT = {absent()!r}\n{DENY}", "utf-8")
    (command,) = [
        line
        for line in (source / "run_autograder").read_text("utf-8").splitlines()
        if line.startswith("exec ")
    ]
    module = command.split(" -m ")[1].split()[0]
    for student, (kind, hands_in) in KINDS.items():
        if kind not in {RIGHT, LESS} or not (ALL or student in OFTEN):
            continue
        name, content = hands_in(exercise)
        submission, written = tmp_path / student, tmp_path / f"{student}.json"
        submission.mkdir()
        (submission / name).write_text(content, "utf-8")
        done = subprocess.run(
            [sys.executable, "-P", "-m", module, submission, written, source / "config.json"],
            env={"PATH": os.environ["PATH"], "PYTHONPATH": f"{source}:{tmp_path / 'deny'}"},
            cwd="/", capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        body = json.loads(written.read_bytes())
        lost = [(test["number"], test["output"]) for test in body["tests"] if test["status"] != "passed"]
        assert (body["score"] == exercise.max_points) == (kind == RIGHT), (student, lost, done.stdout)


def absent():
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
    return {
        module
        for module, owners in modules.items()
        if module != "course" and not {owner.lower().replace("_", "-") for owner in owners} & present
    }
