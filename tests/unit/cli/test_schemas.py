"""Every reply has a JSON Schema, and a reply that breaks its own is caught."""

from __future__ import annotations

import ast
from pathlib import Path

import jsonschema
import msgspec
import pytest

import course as package
from course.cli.frame.replies import Bare, Envelope, ErrorBody, ErrorReply, Hint, NextStep, encode
from course.cli.frame.schemas import reply_types, schema_of

CLI = Path(package.__file__).parent / "cli"


def broken(document, reply):
    return [error.message for error in jsonschema.Draft202012Validator(document).iter_errors(reply)]


@pytest.mark.parametrize("tag", list(reply_types()))
def test_a_schema_is_one(tag):
    document = schema_of(reply_types()[tag])
    jsonschema.Draft202012Validator.check_schema(document)
    assert document["$id"] == tag


def test_every_kind_of_reply_that_is_declared_is_listed():
    declared = set()
    for path in CLI.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ClassDef):
                declared |= {
                    word.value.value
                    for word in node.keywords
                    if word.arg == "tag" and isinstance(word.value, ast.Constant)
                }
    assert declared | {"course.grade/1"} == set(reply_types())


def test_a_schema_accepts_its_reply_an_error_and_nothing_else():
    document = schema_of(Hint)
    reply = msgspec.json.decode(
        encode(
            Hint(exercise="a", given=True, reason="", task=None, hint=None, message="", next=NextStep("b"))
        )
    )
    assert not broken(document, reply)
    assert not broken(document, {**reply, "added": 1}), "a field may be added within a version"
    assert broken(document, {key: value for key, value in reply.items() if key != "given"})
    assert broken(document, {**reply, "given": "yes"})
    assert broken(document, {**reply, "schema": "course.check/1"})
    error = ErrorReply(schema="course.hint/1", exit_code=2, error=ErrorBody(code="x", message="y"))
    assert not broken(document, msgspec.json.decode(encode(error)))
    assert not broken(
        document, msgspec.json.decode(encode(Bare(schema="course.hint/1", ok=True, exit_code=0)))
    )


def test_numbers_that_json_has_not_are_in_the_schema():
    class Measured(Envelope, tag="course.measured/1", frozen=True, kw_only=True):
        value: float

    for value in (1.5, float("nan"), float("-inf")):
        assert not broken(schema_of(Measured), msgspec.json.decode(encode(Measured(value=value))))
    assert broken(schema_of(Measured), {"schema": "course.measured/1", "value": "many"})


def test_the_command_lists_and_prints(course):
    listed = course("schema", "--json").json["schemas"]
    assert listed == list(reply_types())
    assert msgspec.json.decode(course("schema", "hint").out) == schema_of(Hint)
    assert course("schema", "course.hint/1", "--json").json["document"] == schema_of(Hint)
    missing = course("schema", "hin", "--json")
    assert (missing.code, missing.json["error"]["code"]) == (5, "schema_not_found")
