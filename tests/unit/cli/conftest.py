"""The command line, run in this process on the miniature course, with a stand-in for the sandbox."""

import functools
import io
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

import jsonschema
import msgspec
import pytest

from course.cli.frame import app, registry
from course.cli.frame.console import Console, Settings
from course.cli.frame.here import Here
from course.cli.frame.replies import schema_of
from course.cli.loop import Watcher
from course.handed_in import attempts
from course.progress.store import Store
from course.scoring.verdict import CheckResult, Problem, Status, Tolerance, Verdict
from tests.command_line import ROOT, in_process

MINI_COURSE = Path(__file__).resolve().parents[2] / "fixtures" / "mini_course"
make_command = registry._load
#: Asked without importing it, which takes longer than most tests.
needs_jupyterlab = pytest.mark.skipif(
    None in map(find_spec, ("jupyterlab", "ipykernel")), reason="`course open` needs the extra notebook"
)


class Terminal(io.StringIO):
    """Somebody is there."""

    encoding = "utf-8"

    def isatty(self):
        return True


def uncoloured(text):
    return re.sub(r"\x1b\[[0-9;]*m", "", text)


@dataclass
class Said:
    """A text, and what a test asks of it; whatever fails shows the whole of it."""

    out: str

    @property
    def words(self):
        """All of it, however the lines are wrapped."""
        return " ".join(self.out.split())

    @property
    def rows(self):
        """Its lines, without what colours them."""
        return uncoloured(self.out).splitlines()

    def says(self, *words):
        """Each of these stands in it."""
        assert not [one for one in words if one not in self.out], self
        return self

    def says_in_order(self, *words):
        """Each of these stands in it, behind the one before."""
        self.says(*words)
        places = [self.out.index(one) for one in words]
        assert places == sorted(places), self
        return self

    def lacks(self, *words):
        """None of these stands in it."""
        assert not [one for one in words if one in self.out], self
        return self


@dataclass
class Ran(Said):
    """What a command line said, on standard output in the first place, and how it ended."""

    err: str
    code: int

    @property
    def json(self):
        """The one object on standard output; fails if there is anything else."""
        return json.loads(self.out)

    @property
    def last(self):
        """The last of several objects on standard output, a line each."""
        return json.loads(self.out.splitlines()[-1])

    @property
    def error(self):
        """Exit code and the error's own code, of a line with ``--json``."""
        return self.code, self.json["error"]["code"]

    def warns(self, *words):
        """Each of these stands on standard error."""
        assert not [one for one in words if one not in self.err], self
        return self

    def ends(self, code, *said):
        """It ended with this exit code and said each of these, on standard output."""
        assert self.code == code, self
        return self.says(*said)

    def refuses(self, code, *said):
        """It ended with this exit code and said each of these, on standard error."""
        assert self.code == code, self
        return self.warns(*said)


class FakeSession:
    """Grades by reading: a function passes if its body says RIGHT; UNREADABLE makes a file ungradable.

    PRINTS makes it print while it is loaded.
    """

    printed = ""

    def __init__(self, exercise):
        self.exercise = exercise
        self.curves = {}
        self.checks = [
            CheckResult(
                id=f"{task.id}_works",
                title=f"{task.title} works",
                task=task.id,
                status="pass",
                visibility="public",
                points=0,
                max_points=2.0,
            )
            for task in exercise.task
        ]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def grade(self, submission, only=()):
        source = submission.files[self.exercise.module].decode()
        self.printed = "".join(f"row {n}\n" for n in range(9)) if "PRINTS" in source else ""
        common = {"exercise": self.exercise.id, "scope": "public", "isolation": "L1"}
        if "UNREADABLE" in source or "FAULT" in source:
            state = "ungradable" if "UNREADABLE" in source else "grader_error"
            problem = Problem("syntax_error", "Line 1 cannot be read.", "Look at line 1.")
            common |= {"state": state, "error": problem, "checks": ()}
            return Verdict(score=0, max_score=4.0, passed=False, **common)
        results = [self._result(check, source) for check in self.checks]
        results = [result for result in results if not only or result.id in only]
        score, most = sum(r.points for r in results), sum(r.max_points for r in results)
        passed = score >= self.exercise.pass_mark * most
        return Verdict(
            state="graded", score=score, max_score=most, passed=passed, checks=tuple(results),
            warnings=submission.notes, **common,
        )  # fmt: skip

    def _result(self, check, source):
        body = source.partition(f"def {check.task}(")[2].partition("\ndef ")[0]
        if "RIGHT" in body:
            said = "a row\n" if "SAYS" in body else None
            return msgspec.structs.replace(check, status=Status.PASS, points=2.0, stdout=said)
        return msgspec.structs.replace(
            check,
            status=Status.FAIL,
            message="It is not right.",
            help="Write RIGHT.",
            diagnosis="NOT_IMPLEMENTED" if "raise NotImplementedError" in body else "NOT_RIGHT",
            expected=1.00000001,
            actual=float("nan") if "NAN" in body else 1.0,
            units="m",
            input={"h": 0.05},
            tolerance=Tolerance(rel=1e-9, source="closed form"),
            stdout="\x1b[31mprinted\n",
        )


def record(workspace):
    """What a workspace keeps of what was done."""
    return Store(workspace / ".course" / "progress.sqlite")


needs_setpriv = pytest.mark.skipif(shutil.which("setpriv") is None, reason="has no setpriv")


def as_anybody(*words, cwd):
    """Run a line as a process for which permissions count; root reads everything, unless it gives that up."""
    nobody = ["setpriv", "--bounding-set=-dac_override,-dac_read_search", "--inh-caps=-all", "--"]
    return subprocess.run(
        [*(nobody if os.geteuid() == 0 else ()), sys.executable, "-m", "course", *words],
        cwd=cwd, env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


def files_in(root):
    """Every file in a folder, with what it holds."""
    return {path: path.read_bytes() for path in root.rglob("*") if path.is_file()}


@functools.cache
def validator(tag):
    return jsonschema.Draft202012Validator(schema_of(tag))


def keeps_its_schema(out, code):
    """Every reply of every command that these tests run is as its schema says, the last has the exit code."""
    for line in filter(None, out.split("\n")):
        reply = json.loads(line)
        problems = [f"{e.json_path}: {e.message}" for e in validator(reply["schema"]).iter_errors(reply)]
        assert not problems, problems[0][:1000]
    if reply["schema"] != "course.grade/1":  # whose code is that of the work
        assert (reply["exit_code"], reply["ok"]) == (code, code == 0)


@functools.cache
def as_click_knows_it(target, name, entry, mode):
    """A command does not change as it is run; those of ``grade`` take 10 ms to make."""
    return make_command(name, entry, mode)


def loaded(name, entry, mode):
    return as_click_knows_it(registry.find(entry.module, entry.name), name, entry, mode)


@pytest.fixture
def course(monkeypatch, tmp_path, capsys):
    """Run a line as it is typed, and more words as they are, in ``tmp_path`` on the miniature course.

    A fault of the course ends a test that has not said with ``course.faulty`` that it makes one.
    """
    monkeypatch.setenv("COURSE_CONTENT", str(MINI_COURSE))
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / ".cache"))
    monkeypatch.setenv("COLUMNS", "80")
    for name in ("FORCE_COLOR", "NO_COLOR", "TTY_COMPATIBLE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(attempts, "open_session", lambda exercise, catalog: FakeSession(exercise))
    monkeypatch.setattr(registry, "_load", loaded)

    def run(line="", *more):
        words = (*shlex.split(line), *map(str, more))
        capsys.readouterr()
        code = app.run(words)
        captured = capsys.readouterr()
        assert run.faulty or "A fault in the course" not in captured.err, captured.err
        if "--json" in words:
            keeps_its_schema(captured.out, code)
        return Ran(captured.out, captured.err, code)

    run.faulty = False
    return run


@pytest.fixture(scope="module")
def unpacked():
    """The graders of the miniature course as a run unpacks them, once for all runs of a file."""
    from course.catalog.load import Catalog
    from course.catalog.locate import chosen
    from course.grading.running.snapshot import Snapshot, frozen

    with frozen(Snapshot.take(Catalog(chosen(MINI_COURSE)).content)):
        yield


@pytest.fixture(scope="session")
def begun(tmp_path_factory):
    """A workspace of the miniature course with ``doubling`` started, to be copied."""
    folder = tmp_path_factory.mktemp("begun")
    environment = {**os.environ, "COURSE_CONTENT": str(MINI_COURSE), "COURSE_CACHE": str(folder / "cache")}
    for words in (("init", folder / "work"), ("-C", folder / "work", "start", "doubling")):
        assert in_process(*words, env=environment).returncode == 0
    return folder / "work"


@pytest.fixture
def workspace(course, begun, tmp_path, monkeypatch):
    """A workspace with ``doubling`` started; the current folder."""
    root = tmp_path / "my course é"
    shutil.copytree(begun, root)
    monkeypatch.chdir(root)
    return root


@pytest.fixture
def write(workspace):
    """Write a ``doubling.py`` whose functions have these bodies."""

    def save(double="pass", doublings="pass", extra=""):
        path = workspace / "doubling" / "doubling.py"
        path.write_text(
            f"def double(x):\n    '{double}'\n\n\ndef doublings(x, n):\n    '{doublings}'\n{extra}"
        )
        return path

    return save


@pytest.fixture
def watcher(workspace):
    """What waits for saves of ``doubling``."""
    here = Here.load()
    console = Console(Settings(), stdout=io.StringIO(), stderr=io.StringIO())
    return Watcher(console=console, here=here, exercise=here.exercise("doubling"))


@pytest.fixture
def session(watcher):
    """Its session, warm."""
    return attempts.open_session(watcher.exercise, watcher.here.catalog)


@pytest.fixture
def real(course, tmp_path, monkeypatch):
    """A workspace of the real course; the current folder."""
    monkeypatch.delenv("COURSE_CONTENT")
    course("init .").ends(0)
    return tmp_path


@pytest.fixture
def person(course, monkeypatch):
    """Somebody is there and can be asked, unless it is a script that asks."""
    monkeypatch.setattr(Console, "interactive", property(lambda self: not self.json))


@pytest.fixture
def content(course, monkeypatch, tmp_path_factory):
    """A copy of the miniature course, in force; it may be changed."""
    copy = tmp_path_factory.mktemp("content") / "mini"
    shutil.copytree(MINI_COURSE, copy)
    monkeypatch.setenv("COURSE_CONTENT", str(copy))
    return copy


@pytest.fixture
def colourless(course, monkeypatch):
    """A terminal that shows tables and pages, and no colours."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("NO_COLOR", "1")


@pytest.fixture
def students_content(content):
    """The miniature course as a student has it: no solutions, no graders."""
    for path in content.iterdir():
        if path.name not in {"exercises", "lessons"}:
            shutil.rmtree(path)
    return content
