"""Running a lesson's code and holding its text to it; what a lesson must have, and what it must not."""

import re
from pathlib import Path

import pytest

from course.authoring.lessons.cells import as_written, run_lesson, update_outputs
from course.authoring.lessons.lint import rules_broken
from course.catalog.markdown import parse_lesson
from course.errors import ContentError

HEAD = "+++\nid = 'a'\n+++\n\n"


def lesson(folder, body):
    path = folder / "a.md"
    path.write_text(HEAD + body, encoding="utf-8")
    return path


def test_cells_share_one_namespace_and_run_in_order(tmp_path):
    body = "```python\nx = 2\n```\n\ntext\n\n```python\nprint(x + 2)\n```\n\n```output\n4\n```\n"
    first, second = run_lesson(lesson(tmp_path, body)).cells
    assert (first.printed, first.agrees) == (None, True)
    assert (second.printed, second.agrees) == ("4", True)


@pytest.mark.parametrize(
    "body",
    [
        "```python\nprint(4)\n```\n\n```output\n5\n```\n",
        "```python\nprint(4)\n```\n",
        "```python hidden\nprint(4)\n```\n",
    ],
)
def test_a_cell_that_prints_something_else_does_not_agree(tmp_path, body):
    (run,) = run_lesson(lesson(tmp_path, body)).cells
    assert not run.agrees


def test_outputs_are_rewritten_added_and_removed_and_nothing_else_changes(tmp_path):
    body = (
        "One.\n\n```python\nprint(1)\n```\n\n```output\nold\nlines\n```\n\n"
        "Two.\n\n```python\nprint('a\\nb')\n```\n\nThree.\n\n```python\nx = 1\n```\n\n```output\ngone\n```\n"
    )
    path = lesson(tmp_path, body)
    assert update_outputs(path) == 3
    assert path.read_text(encoding="utf-8").startswith(
        HEAD + "One.\n\n```python\nprint(1)\n```\n\n```output\n1\n```"
    )
    assert all(run.agrees for run in run_lesson(path).cells)
    before = path.read_text(encoding="utf-8")
    assert update_outputs(path) == 0
    assert path.read_text(encoding="utf-8") == before


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("```python\nx = 1\nx / 0\n```\n", "a.md:7: the code cell raises ZeroDivisionError"),
        ("```python\nx = = 1\n```\n", "a.md:6: the code cell raises SyntaxError"),
        ("It is [1](=nothing).\n", "a.md:5: [1](=nothing) raises NameError"),
    ],
)
def test_what_raises_is_named_by_its_line(tmp_path, body, said):
    with pytest.raises(ContentError, match=re.escape(said)):
        run_lesson(lesson(tmp_path, body))


@pytest.mark.parametrize(
    ("text", "agrees"),
    [("0.333", True), ("0.3333", True), ("0.334", False), ("0.3 m", True), ("0.33333 %", True), ("3", False)],
)
def test_a_quoted_number_agrees_to_the_digits_it_is_written_with(tmp_path, text, agrees):
    run = run_lesson(lesson(tmp_path, f"It is [{text}](=x).\n\n```python\nx = 1 / 3\n```\n"))
    assert [value.agrees for value in run.values] == [agrees]


def test_a_longer_number_does_not_agree_with_a_shorter_one_it_begins_with(tmp_path):
    (value,) = run_lesson(lesson(tmp_path, "It is [10](=1).\n")).values
    assert not value.agrees


@pytest.mark.parametrize(
    ("value", "text", "written"),
    [
        (0.08903, "0.0890", "0.0890"),
        (4.39e8, "4.4e8", "4.4e8"),
        (1.0e-14, "1e-14", "1e-14"),
        (180000.0, "180,000", "180,000"),
        (-0.0981, "-0.0981 m", "-0.0981"),
        (-0.0981, "−0.0981", "−0.0981"),
        (0.5, "+0.5", "+0.5"),
        ("left", "left", "left"),
    ],
)
def test_a_value_is_written_in_the_form_its_author_chose(value, text, written):
    assert as_written(value, text) == written


# -- rules ------------------------------------------------------------------------------------------------

ANSWER = "> **Answer.** That."
SOURCE = "- A. Author, 123 pages, 2003 ([paper](https://example.org))."
ANSWERED_TOO_EARLY = "> **Predict.** What?\n\n> **Answer.** A.\n\n## Two"
GOOD = f"""
> **Myth.** A.

> **Fact.** B.

> **Analogy.** C.

## Before you start

- Numbers.

## Worked example: one

> **Predict.** What?

```python
x = 29.5
```

![Two lines that cross at one](figure:lines)
They cross at [1](=1), 12 times in 2005, with 29.5 of [these](exercise:one).

{ANSWER}

## Try it

```console
$ course lessons
```

## What to do next

Read [on](lesson:two#here).

## Sources

{SOURCE}
"""


def lint(text):
    blocks = parse_lesson(text, Path("a.md"))
    return rules_broken(blocks, figures=["lines"])


def test_a_lesson_with_everything_has_no_findings():
    assert lint(GOOD) == []


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        ("> **Myth.** A.", "", "the lesson has no myth"),
        ("> **Analogy.** C.", "", "the lesson has no analogy"),
        ("## Worked example: one", "## One", "no section begins 'worked example'"),
        ("## Before you start", "## Start", "no section begins 'before you start'"),
        ("```console\n$ course lessons\n```", "x", "the lesson has no command to try"),
        (SOURCE, "x", "the lesson has no list of sources"),
        ("x = 29.5", "x = 29", "29.5 is produced by no code"),
        ("> **Predict.** What?", ANSWERED_TOO_EARLY, "a figure without a prediction"),
        (ANSWER, "", "a prediction that is not answered"),
        (ANSWER, f"> **Predict.** And?\n\n{ANSWER}", "a prediction that is not answered"),
        ("figure:lines", "figure:line", "there is no figure line"),
        ("[1](=1)", "1", "the lesson has no number that its code gives"),
        ("([paper](https://example.org))", "", "the source 'A. Author, 123 pages, 2003 .' has no address"),
        ("[1](=1)", "[1](=2 - 1)", "a value link that Markdown does not read as one"),
        ("[1](=1)", "[1](<=2 - 1)", "a value link that Markdown does not read as one"),
        ("12 times", "13 times", "13 is produced by no code"),
        ("12 times", "0.5 times", "0.5 is produced by no code"),
        ("x = 29.5", f"x = 29.5  # {'-' * 50}", "code 62 columns wide"),
    ],
)
def test_what_is_missing_or_wrong_is_found(old, new, problem):
    assert old in GOOD
    assert [finding.problem for finding in lint(GOOD.replace(old, new))] == [problem]


def test_a_cell_that_is_no_python_is_left_to_where_it_is_run():
    assert lint(GOOD.replace("x = 29.5", "x = 29.5 if")) == lint(GOOD.replace("x = 29.5", "x = 0"))


def test_a_run_needs_a_prediction_and_a_cell_that_shows_nothing_does_not():
    text = "## One\n\n```python\nprint(4)\n```\n\n```output\n4\n```\n"
    assert "a run without a prediction" in [finding.problem for finding in lint(text)]
    silent = "## One\n\n```python\nx = 4\n```\n"
    assert "a run without a prediction" not in [finding.problem for finding in lint(silent)]


def test_a_value_link_may_be_quoted_as_code():
    assert lint(GOOD.replace("12 times", "`[1](=2 - 1)` 12 times")) == []


def test_an_unanswered_prediction_at_the_very_end_is_found():
    assert "a prediction that is not answered" in [
        finding.problem for finding in lint("> **Predict.** What?")
    ]


def test_a_prediction_that_quotes_a_number_of_an_answer_above_it_is_found():
    again = (
        "> **Answer.** It is [5](=2+3).\n\n## Two\n\n> **Predict.** And at [5](=2+3)?\n\n> **Answer.** No."
    )
    (found,) = lint(GOOD.replace(ANSWER, again))
    assert found.problem == "the prediction quotes 5, which an answer above it gives away"


def test_a_course_without_objectives_is_not_held_to_the_parts_of_a_lesson():
    blocks = parse_lesson("## One\n\nWord.\n", Path("a.md"))
    assert rules_broken(blocks, figures=[], whole=False) == []
    assert len(rules_broken(blocks, figures=[])) > 10
