"""Every kind of document that the course reads, made hostile, given to the command that reads it.

A command may take such a document, or end in a few words that name the file; it takes a second of CPU more
than with a right one at most, stays below 200 MB, and what is wrong is never "a fault in the course". Each
of DOORS has a file, the syntax whose documents are tried there, and the command that reads it.
"""

import json
import os
import shutil
import subprocess
import sys
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import pytest

from course.grading.gradebook.file import SEAL, TABLES, open_file, release, row_into, seal
from tests.command_line import in_process
from tests.contracts.boundary.documents import ENDLESS, SPECIAL, SYNTAXES, Made, as_view, sql
from tests.unit.grading.made import put

ROOT = Path(__file__).resolve().parents[3]
MINI = ROOT / "tests" / "fixtures" / "mini_course"
#: CPU seconds beyond the right document; to salvage is to try every byte as a row.
MORE_S = {"gradebook-salvaged": 5.0}
MOST_KB = 200 << 10
#: Exit codes with which a command may end over a document: it was taken (0, 1, 6), or it says what is wrong.
TAKEN, REFUSED = {0, 1, 6}, {2, 3, 4, 5, 7}

_SOURCE = "def double(x):\n    return 2 * x\n\n\ndef doublings(x, n):\n    return [x] * n\n"
_NOTEBOOK = json.dumps(
    {
        "nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": {"language": "python"}},
        "cells": [{"cell_type": "code", "id": "a", "metadata": {}, "outputs": [], "execution_count": None,
                   "source": _SOURCE}],
    }
)  # fmt: skip
#: The right documents, but for those that a command makes.
RIGHT = {
    "my.toml": (ROOT / "course" / "sandbox" / "scenes" / "box-stack.toml").read_text("utf-8"),
    "late.toml": """\
format_version = 1
percent_per_day = 10
trust = ["list"]

[[deadline]]
exercise = "*"
due = 2026-12-01T23:59:00+01:00

[[extension]]
student = "ada"
exercise = "*"
days = 2
""",
    "class.csv": """\
student,name,email,extension_days
ada,Ada Lovelace,ada@uni.example,2
bob,Bob,bob@uni.example,1
""",
    "times.csv": "student,exercise,submitted_at\nada,doubling,2026-12-02T12:00:00Z\n",
    "sheet.csv": """\
Identifier,Full name,Email address,Status,Grade,Maximum Grade,Last modified (submission),\
Last modified (grade),Feedback comments
Participant 1,ada,ada@uni.example,Submitted,,100.00,-,-,
Participant 2,bob,bob@uni.example,Submitted,,100.00,-,-,
""",
    "canvas.csv": """\
Student,ID,SIS User ID,SIS Login ID,Section,doubling (4711)
    Points Possible,,,,,10
ada,1,,ada,A,
bob,2,,bob,A,
""",
    "my.ipynb": _NOTEBOOK,
    "scheduler.json": '{"type": "Scheduler", "address": "tcp://127.0.0.1:9"}',
    "a.toml": 'format_version = 1\nseed = 42\n[answers]\nnumerical-integration = "b"\n',
    "a.json": '{"seed": 42, "answers": {"numerical-integration": "b"}}',
    "content/quiz/numerical-integration.toml": (ROOT / "quiz" / "numerical-integration.toml").read_text(
        "utf-8"
    ),
    "class/ada/doubling.py": _SOURCE,
    "class/bob/doubling.py": _SOURCE,
    "class2/ada/doubling.ipynb": _NOTEBOOK,
    "gradescope/submission_900/doubling.py": _SOURCE,
    "gradescope/submission_metadata.yml": """\
submission_900:
  :submitters:
  - :name: Ada Lovelace
    :sid: '1'
    :email: ada@uni.example
  :created_at: 2026-11-01 10:00:00 Z
""",
}


@dataclass(frozen=True)
class Door:
    """A file that a command reads.

    Attributes:
        file: where it lies, below the folder of the tests.
        syntax: the documents, by their syntax; the right one lies there already.
        words: the command line.
        other: documents for this file alone.
    """

    file: str
    syntax: str
    words: tuple[str, ...]
    other: tuple[tuple[str, Made], ...] = ()

    @property
    def documents(self):
        return {**SYNTAXES[self.syntax], **SPECIAL, **dict(self.other)}


def _forged(table, column, text):
    """A gradebook in which every row has another content there, and every digest is right again."""

    def change(book):
        names = TABLES[table]
        rows = [list(row) for row in book.execute(f"SELECT {', '.join(names)} FROM {table}")]
        if not rows and table in _ROWS:
            rows = [list(_ROWS[table])]
        for row in rows:
            if row[0] != SEAL:
                row[names.index(column)] = text
                book.execute(row_into(table, "INSERT OR REPLACE"), row)

    return _sealed_again(change)


def _fact(name, text):
    return _sealed_again(lambda book: book.execute(row_into("meta", "INSERT OR REPLACE"), (name, text)))


def _sealed_again(change):
    def make(path):
        with closing(open_file(path, writing=True)) as book:
            change(book)
            seal(book)
            release(book)

    return make


_ROWS = {
    "students": ("ada", "{}"),
    "found": ("ada", "doubling", "{}"),
    "journal": (1, "2026-01-01T00:00:00Z", "me", "override", "ada", "doubling", "why", "1", "2"),
    "times": ("ada", "doubling", "0", "list", 1.0),
}
_DEEP = "[" * 5000 + "]" * 5000
_ODD = {"none": "", "deep": _DEEP, "list": "[1]", "number": "9" * 5000, "object": '{"a": 1}', "nan": "NaN"}
_COUNT = f"SELECT count(*) FROM ({ENDLESS} SELECT i FROM n)"


def _view(table):
    return as_view(table, ", ".join(f"i AS {name}" for name in (*TABLES[table], "row_sha256")))


_BOOKS = (
    *((f"view-{table}", _view(table)) for table in TABLES),
    ("triggers", sql(*(f"CREATE TRIGGER t_{of} BEFORE INSERT ON {of} BEGIN {_COUNT}; END" for of in TABLES))),
    *(
        (f"{table}-{column}-{name}", _forged(table, column, text))
        for table, column in (
            ("runs", "options"), ("students", "identity"), ("found", "listed"), ("results", "verdict"),
            ("journal", "after"), ("journal", "before"), ("exercises", "max_points"), ("times", "at"),
            ("submissions", "files"), ("runs", "started_at"), ("results", "seed"),
        )
        for name, text in _ODD.items()
    ),
    *(
        (f"meta-{fact}-{name}", _fact(fact, text))
        for fact in ("seed", "roster", "late_policy", "without_work", "looked", "course", "version")
        for name, text in _ODD.items()
    ),
)  # fmt: skip


def _book(*words):
    return Door("out/gradebook.sqlite", "sqlite", words, other=_BOOKS)


_LATE = ("grade", "late", "out", "--dry-run")
_WORK = "ws/.course/progress.sqlite"
DOORS = {
    "scene": Door("my.toml", "toml", ("sandbox", "export", "my.toml", "--format", "mjcf")),
    "scene-run": Door("my.toml", "toml", ("sandbox", "play", "my.toml", "--headless", "--duration", "0.1")),
    "policy": Door("late.toml", "toml", (*_LATE, "--policy", "late.toml")),
    "marker": Door("ws/course.toml", "toml", ("-C", "ws", "progress")),
    "answers": Door("a.toml", "toml", ("-C", "ws", "quiz", "take", "--answers", "../a.toml")),
    "answers-json": Door("a.json", "json", ("-C", "ws", "quiz", "take", "--answers", "../a.json")),
    "recording": Door("run.jsonl", "json", ("sandbox", "replay", "run.jsonl")),
    "notebook": Door("my.ipynb", "json", ("notebook", "check", "my.ipynb", "--exercise", "doubling")),
    "notebook-updated": Door("nb/exercises/doubling.ipynb", "json", ("notebook", "update", "--out", "nb")),
    "notebook-submitted": Door("ws/doubling/doubling.ipynb", "json", ("-C", "ws", "submit")),
    "work": Door("ws/doubling/doubling.py", "python", ("-C", "ws", "check", "doubling")),
    "work-diff": Door("ws/doubling/doubling.py", "python", ("-C", "ws", "diff", "doubling")),
    "work-submitted": Door("ws/doubling/doubling.py", "python", ("-C", "ws", "submit")),
    "given": Door("ws/.course/given/doubling/doubling.py", "python", ("-C", "ws", "diff", "doubling")),
    "roster": Door("class.csv", "csv", (*_LATE, "--roster", "class.csv")),
    "times": Door("times.csv", "csv", (*_LATE, "--times", "times.csv")),
    "times-of-moodle": Door(
        "sheet.csv", "csv",
        (*_LATE, "--policy", "late.toml", "--times", "sheet.csv", "--exercise", "doubling"),
    ),
    "worksheet": Door(
        "sheet.csv", "csv",
        ("grade", "export", "out", "--format", "moodle-worksheet", "--roster", "sheet.csv", "--exercise",
         "doubling", "--partial", "-o", "filled.csv"),
    ),
    "canvas": Door(
        "canvas.csv", "csv",
        ("grade", "export", "out", "--format", "canvas", "--roster", "canvas.csv", "--assignment",
         "doubling=4711", "--partial", "-o", "filled.csv"),
    ),
    "metadata": Door(
        "gradescope/submission_metadata.yml", "yaml",
        ("grade", "run", "gradescope", "--out", "new", "--exercise", "doubling"),
    ),
    "scheduler": Door(
        "scheduler.json", "json",
        ("grade", "run", "class", "--out", "new", "--exercise", "doubling", "--scheduler", "scheduler.json"),
    ),
    "coursepack": Door("ws/solutions.coursepack", "zip", ("-C", "ws", "solution", "doubling")),
    "submission.py": Door("class/ada/doubling.py", "python", ("grade", "run", "class", "--out", "new")),
    "submission.ipynb": Door("class2/ada/doubling.ipynb", "json", ("grade", "run", "class2", "--out", "new")),
    "submission.zip": Door("class3/ada/work.zip", "zip", ("grade", "run", "class3", "--out", "new")),
    "progress": Door(_WORK, "events", ("-C", "ws", "progress")),
    "progress-next": Door(_WORK, "events", ("-C", "ws", "next")),
    "progress-repaired": Door(_WORK, "events", ("-C", "ws", "doctor", "--repair")),
    "gradebook": _book("grade", "log", "out"),
    "gradebook-explained": _book("grade", "explain", "out", "ada", "doubling"),
    "gradebook-exported": _book("grade", "export", "out", "-o", "new.csv"),
    "gradebook-assigned": _book("grade", "assign", "out"),
    "gradebook-late": _book("grade", "late", "out"),
    "gradebook-regraded": _book("grade", "rerun", "out", "--dry-run", "--all"),
    "gradebook-similar": _book("grade", "similar", "out"),
    "gradebook-salvaged": _book("grade", "salvage", "out", "--to", "new"),
    "exercise": Door("content/exercises/doubling/exercise.toml", "toml", ("exercises",)),
    "syllabus": Door("content/lessons/syllabus.toml", "toml", ("lessons",)),
    "quiz-question": Door(
        "content/quiz/numerical-integration.toml", "toml", ("-C", "ws", "quiz", "take", "--questions"),
    ),
}  # fmt: skip
#: Of these a fault is one of the course, and its author's: exit code 70 with the file and the line.
CONTENT = {"exercise", "syllabus", "quiz-question"}
#: What cannot stand there: such a file is looked for, and not named by anybody.
LOOKED_FOR = {
    "submission.py", "submission.ipynb", "submission.zip", "coursepack", "marker", "notebook-submitted",
    "notebook-updated", "work", "work-diff", "work-submitted", "given", "metadata",
    "quiz-question", "progress", "progress-next", "progress-repaired",
}  # fmt: skip


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    """A folder with a right document of each kind."""
    at = tmp_path_factory.mktemp("place")
    shutil.copytree(MINI, at / "content")
    (at / "content" / "exercises" / "doubling" / "checking").mkdir(exist_ok=True)
    for student in ("ada", "bob"):
        (at / "class3" / student).mkdir(parents=True)
    for name, text in RIGHT.items():
        put(at / name, text.encode())
    environment = _environment(at)

    def ran(*words, code=0):
        done = in_process(*words, cwd=at, env=environment)
        assert done.returncode == code, done.stderr

    ran("sandbox", "play", "box-stack", "--headless", "--duration", "0.2", "--record", "run.jsonl")
    ran("grade", "run", "class", "--out", "out", "--exercise", "doubling")
    ran("notebook", "build", "doubling", "--out", "nb")
    ran("init", "ws")
    ran("-C", "ws", "start", "doubling")
    ran("-C", "ws", "check", "doubling", code=1)
    ran("-C", "ws", "hint", "doubling")
    shutil.copy(MINI / "solutions" / "doubling" / "doubling.py", at / "ws" / "doubling")
    ran("-C", "ws", "check", "doubling")
    ran("-C", "ws", "submit")
    (packed,) = (at / "ws").glob("*.zip")
    packed.rename(at / "class3" / "ada" / "work.zip")
    ran("author", "pack", "--solutions", "doubling", "-o", "ws/solutions.coursepack")
    (at / "ws" / "doubling" / "doubling.ipynb").write_text(_NOTEBOOK)
    return at


def _environment(at):
    kept = {name: value for name, value in os.environ.items() if not name.startswith("COURSE_")}
    paths = os.pathsep.join(filter(None, [str(ROOT), kept.get("PYTHONPATH", "")]))
    ours = {"COURSE_CONTENT": str(at / "content"), "COURSE_CACHE": str(at / "cache"), "COLUMNS": "200"}
    return {**kept, **ours, "PYTHONPATH": paths}


@dataclass(frozen=True)
class Ended:
    """How a process ended: exit code (or minus the signal), what it said, CPU seconds, and kilobytes."""

    code: int
    said: str
    cpu: float
    most: int


#: Starts a command within limits, and says how it ended. It is a process of its own, for a child's memory is
#: counted from what its parent had.
_LAUNCHER = """
import json, os, resource, signal, sys, time
pid = os.fork()
if not pid:
    resource.setrlimit(resource.RLIMIT_CPU, (30, resource.RLIM_INFINITY))
    resource.setrlimit(resource.RLIMIT_DATA, (3 << 30, resource.RLIM_INFINITY))
    os.setsid()
    os.execv(sys.executable, [sys.executable, "-m", "course", *sys.argv[2:]])
signal.signal(signal.SIGALRM, lambda *_: os.killpg(pid, signal.SIGKILL))
signal.alarm(30)
_, status, used = os.wait4(pid, 0)
told = os.waitstatus_to_exitcode(status), used.ru_utime + used.ru_stime, used.ru_maxrss
os.write(int(sys.argv[1]), json.dumps(told).encode())
"""


def measured(words, at):
    reading, writing = os.pipe()
    with open(reading, "rb") as told:  # noqa: PTH123 - of an open descriptor
        done = subprocess.run(
            [sys.executable, "-S", "-c", _LAUNCHER, str(writing), *words],
            cwd=at, env=_environment(at), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, pass_fds=[writing], check=True,
        )  # fmt: skip
        os.close(writing)
        code, cpu, most = json.loads(told.read())
    return Ended(code, done.stdout.decode("utf-8", "replace"), cpu, most)


@pytest.fixture(scope="module")
def right(place, tmp_path_factory):
    """What a command takes with the right document, by door."""
    known = {}

    def ended(name):
        if name not in known:
            at = tmp_path_factory.mktemp("right") / "place"
            shutil.copytree(place, at)
            known[name] = measured(DOORS[name].words, at)
        return known[name]

    return ended


def _cases():
    """Each document at each door; in an ordinary run one at each, the doors' turns going round."""
    found = []
    for turn, (name, door) in enumerate(DOORS.items()):
        documents = list(door.documents)
        chosen = documents[(7 * turn) % len(documents)]
        found += [
            pytest.param(name, one, id=f"{name}-{one}"[:80], marks=() if one == chosen else pytest.mark.soak)
            for one in documents
        ]
    return found


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.soak) for name in DOORS if name != "scheduler"]
)
def test_the_right_document_is_taken(right, name):
    assert right(name).code in TAKEN, right(name).said


@pytest.mark.parametrize(("name", "document"), _cases())
def test_a_hostile_document_is_taken_or_refused_in_words(place, right, tmp_path, name, document):
    if document == "unreadable" and os.geteuid() == 0:
        pytest.skip("root reads everything")
    door, at = DOORS[name], tmp_path / "place"
    shutil.copytree(place, at)
    door.documents[document](at / door.file)
    ended = measured(door.words, at)
    shown = f"{ended.code} after {ended.cpu:.1f} s of CPU, {ended.most >> 10} MB: {ended.said[:1500]}"
    assert "Traceback" not in ended.said, shown
    if name in CONTENT and ended.code == 70:
        assert Path(door.file).name in ended.said, shown
    else:
        assert ended.code in TAKEN | REFUSED, shown
        assert "fault in the course" not in ended.said, shown
    if ended.code in REFUSED and name not in LOOKED_FOR:
        assert Path(door.file).name in ended.said or Path(door.file).parent.name in ended.said, shown
    if ended.code in REFUSED:
        assert len(ended.said) < 2_000, shown
        assert len(ended.said.splitlines()) < 20, shown
    assert not set(ended.said) & set("\x00\x1b\x07\u202e\ud800"), shown
    assert ended.most < max(MOST_KB, right(name).most * 1.3), shown
    assert ended.cpu < right(name).cpu + MORE_S.get(name, 1.0), shown
