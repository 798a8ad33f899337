"""Every reply has a JSON Schema, and a reply that breaks its own is caught."""

import contextlib
import json
import math
import re
import shutil
from pathlib import Path

import jsonschema
import msgspec
import pytest

from course.cli.frame import replies
from course.cli.frame.console import encode
from course.cli.frame.replies import Backup, Bare, FileReply, reply_types, schema_of
from course.cli.work.hinting import Hint
from course.handed_in import attempts
from course.scoring.judging.session import GradingSession
from tests.unit.cli.conftest import MINI_COURSE, needs_jupyterlab

#: Before a command has run, and imported more.
LISTED = list(reply_types())


def broken(document, reply):
    return [error.message for error in jsonschema.Draft202012Validator(document).iter_errors(reply)]


@pytest.mark.parametrize("tag", LISTED)
def test_a_schema_is_one(tag):
    document = schema_of(tag)
    jsonschema.Draft202012Validator.check_schema(document)
    assert document["$id"] == tag


def test_a_schema_accepts_its_reply_an_error_and_nothing_else():
    """Not the reply of another command either, even that of a check where a watch ends with one."""
    document = schema_of("course.hint/1")
    given = {"exercise": "a", "given": True, "reason": "", "task": None, "hint": None, "message": ""}
    reply = msgspec.json.decode(encode(Hint(**given, next=replies.NextStep("b"))))
    assert not broken(document, reply)
    assert not broken(document, {**reply, "added": 1}), "a field may be added within a version"
    assert broken(document, {key: value for key, value in reply.items() if key != "given"})
    assert broken(document, {**reply, "given": "yes"})
    assert broken(document, {**reply, "schema": "course.check/1"})
    for other in (
        replies.ErrorReply(
            schema="course.hint/1", exit_code=2, error=replies.ErrorBody(code="x", message="y")
        ),
        Bare(schema="course.hint/1", ok=True, exit_code=0),
    ):
        assert not broken(document, msgspec.json.decode(encode(other)))
    error = {"schema": "course.check/1", "ok": False, "exit_code": 2, "error": {"code": "x", "message": "y"}}
    assert not broken(schema_of("course.check/1"), error)
    assert broken(schema_of("course.watch/1"), error)
    assert broken(schema_of("course.check/1"), {**error, "schema": "course.watch/1"})


def test_numbers_that_json_has_not_are_words_and_in_the_schema():
    class Measured(replies.Envelope, tag="course.measured/1", frozen=True, kw_only=True):
        value: float
        more: tuple = ()

    document = schema_of("course.measured/1")
    for value in (1.5, math.nan, -math.inf):
        assert not broken(document, msgspec.json.decode(encode(Measured(value=value))))
    assert broken(document, {"schema": "course.measured/1", "value": "many"})
    many = Measured(value=1, more=(math.nan, {"a": math.inf}, (-math.inf, 1.5, True, None)))
    assert b'"more":["nan",{"a":"inf"},["-inf",1.5,true,null]]' in encode(many)


#: Lines that answer with every kind of reply there is, in an order in which each has something to say. A
#: student's, on the real course, and an instructor's and an author's on a copy of the miniature one.
STUDENT = """
--version
check --help
init .
start integrators
lessons
lesson why-simulate
exercises
warmup
next
go

check integrators
check --all
watch integrators
hint integrators
diff integrators
progress
solution integrators
start first-program
report first-program
start sim-to-real
check sim-to-real
reflect sim-to-real
quiz take --questions
quiz take --answers answers.toml
quiz review
quiz history
notebook build integrators
notebook check integrators/integrators.ipynb
open integrators
sim list
sim run free-fall
sim run --all
engines list
engines compare --engine pymunk --scenario bounce --dt 0.01
sandbox list
sandbox play head-on --headless --duration 1 --record run.jsonl
sandbox replay run.jsonl
sandbox export head-on --format mjcf -o world.xml
submit
reset integrators --yes
update
doctor
bug
schema
schema hint
author coverage
author pictures --check
no-such-command
"""
OTHERS = """
grade run class --exercise doubling --out out --isolation process
grade explain out ada doubling
grade export out --format csv
grade late out --clear
grade assign out
grade log out
grade rerun out --dry-run
grade similar out
grade salvage out --to new
author check halving
author mutants halving
author build halving
author new lesson three-times
author pack --solutions doubling -o released.coursepack
"""


def _stand_in_for_what_waits(monkeypatch):
    """A watch ends at once, what `course open` starts is there, no film is made, and one engine is here."""
    from course.cli import loop
    from course.cli.author import pictures
    from course.engines import compare
    from course.engines.registry import Availability
    from course.notebooks import server

    def ended(*_):
        yield ""
        raise KeyboardInterrupt

    monkeypatch.setattr(loop, "saves", ended)
    here = {"pymunk": Availability("7"), "mujoco": Availability(None, "not installed", "pip install mujoco")}
    monkeypatch.setattr(compare, "availability", lambda one: here.get(one.id, here["mujoco"]))
    monkeypatch.setattr(pictures, "PICTURES", {"sandbox.gif": (lambda: b"another film", bytes)})
    lab = server.Lab("http://localhost:8888/lab?token=1", None)
    monkeypatch.setattr(server, "started", lambda *_: contextlib.nullcontext(lab))
    monkeypatch.setattr(server.Lab, "wait", lambda _: 0)


@needs_jupyterlab
@pytest.mark.usefixtures("sandboxes")
def test_every_reply_of_every_command_keeps_its_schema(course, tmp_path, monkeypatch):
    """``course`` holds each of them against its schema; here is one of each kind."""
    _stand_in_for_what_waits(monkeypatch)
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "cache"))
    answered, failed = {}, []

    def answer(line):
        ran = course(*line.split(), "--json")
        for row in ran.out.splitlines():
            reply = json.loads(row)
            if reply.get("error") and line != "no-such-command":
                failed.append((line, reply["error"]))
            answered[reply["schema"]] = line
        return ran

    monkeypatch.delenv("COURSE_CONTENT")
    (tmp_path / "mine").mkdir()
    monkeypatch.chdir(tmp_path / "mine")
    for line in STUDENT.strip("\n").split("\n"):
        ran = answer(line)
        if line.startswith("start ") and "first" not in line:
            (stub,) = Path(line.split()[1]).glob("*.py")
            stub.write_text(
                re.sub(r"raise NotImplementedError.*", "return 'RIGHT'", stub.read_text("utf-8")), "utf-8"
            )
        if line.endswith("--questions"):
            Path("answers.toml").write_text(ran.json["template"].replace('= ""', '= "a"'), "utf-8")
    with monkeypatch.context() as real:
        real.setattr(
            attempts, "open_session", lambda one, catalog: GradingSession(one, catalog, scope="public")
        )
        answer("demo")
    shutil.copytree(MINI_COURSE, tmp_path / "mini")
    monkeypatch.setenv("COURSE_CONTENT", str(tmp_path / "mini"))
    (tmp_path / "class" / "ada").mkdir(parents=True)
    right = MINI_COURSE / "solutions" / "doubling" / "doubling.py"
    shutil.copy(right, tmp_path / "class" / "ada" / "doubling.py")
    monkeypatch.chdir(tmp_path)
    for line in OTHERS.strip("\n").split("\n"):
        answer(line)
    assert failed == []
    assert set(answered) == set(LISTED)


def test_the_command_lists_and_prints(course):
    listed = course("schema --json").json["schemas"]
    assert listed == list(reply_types())
    assert msgspec.json.decode(course("schema hint").out) == schema_of("course.hint/1")
    assert course("schema course.hint/1 --json").json["document"] == schema_of("course.hint/1")
    assert course("schema hin --json").error == (5, "schema_not_found")


def test_a_reply_takes_a_field_from_the_first_object_that_has_it():
    first, second = FileReply("first", "kept"), Backup("second", "copy")
    assert replies.filled(Backup, first, second) == Backup("first", "copy")
