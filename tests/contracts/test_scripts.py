"""docs/scripts.md is right: its exit codes are those of the errors, and what it shows can be run."""

import re
from pathlib import Path

from course import errors
from course.cli.frame.replies import reply_types
from course.cli.setup.making import KINDS
from course.cli.work.verdict import FORMATS
from course.grading.running.run import Summary

TEXT = (Path(__file__).parents[2] / "docs" / "scripts.md").read_text("utf-8")


def test_the_exit_codes_are_those_of_the_program():
    kinds = (kind for kind in vars(errors).values() if isinstance(kind, type))
    known = {kind.exit_code for kind in kinds if issubclass(kind, errors.CourseError)}
    known |= {0, 1, Summary(unrecognised=["a file"]).exit_code, errors.INTERRUPTED}
    assert {int(code) for code in re.findall(r"^\| (\d+) \|", TEXT, re.MULTILINE)} == known


def test_schemas_kinds_and_formats_are_those_that_there_are():
    assert {f"course.{name}/1" for name in re.findall(r'"course\.(\w+)/1"', TEXT)} <= set(reply_types())
    shown = re.findall(r"^\| `(\w+)` \| `([^`]+)` \|", TEXT, re.MULTILINE)
    assert shown == [(kind, name) for kind, (name, _) in KINDS.items()]
    assert set(re.findall(r"--format (\w+)", TEXT)) - {"jsonl"} == set(FORMATS) - {"text"}
