"""An exercise whose diagnoses are data, as its author builds it: what is optional may be missing."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from course.authoring.audit import audit
from course.catalog.load import Catalog
from course.cli.frame.app import run
from course.scoring.checks import collected
from course.scoring.explain.story import read_table, read_words

CODES = ("INTEGER_DIVISION", "LOSES_SIGN")


@pytest.fixture
def halving(mini: Path) -> Path:
    """Its folder for students; it has words and questions, and no hypotheses.py."""
    forget()
    folder = mini / "exercises" / "halving"
    tables = [
        f'[diagnosis.{code}]\nlooks_like = "It is {code}."\nadvice = "Mend it."' for code in codes(mini)
    ]
    (folder / "diagnoses.toml").write_text("format_version = 1\n\n" + "\n\n".join(tables) + "\n")
    (folder / "questions.py").write_text(
        '"""Q."""\n\nQUESTIONS = {"halve": [(7,), (-3,), (0.5,), (-8.0,)]}\n'
    )
    return folder


def codes(mini: Path) -> list[str]:
    catalog = Catalog()
    found = [mutant.diagnosis for mutant in catalog.mutants(catalog.exercise("halving"))]
    return list(dict.fromkeys(found))


def forget() -> None:
    for kept in (collected._load, read_table, read_words):
        kept.cache_clear()


def problems() -> list[str]:
    forget()
    return [f"{one.where}: {one.message} {one.fix}" for one in audit(Catalog(), "halving").problems]


def test_without_hypotheses_everything_is_built_and_right(
    halving: Path, mini: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["author", "build", "halving", "--confusion"]) == 0
    assert "Wrote solutions/halving/confusion.json" in capsys.readouterr().out
    assert problems() == []
    assert run(["author", "build", "halving"]) == 0
    assert "up to date" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("def hypotheses():\n    yield from [1 / 0]\n", 2, "it raises ZeroDivisionError"),
        ("def hypotheses(:\n", 1, "it raises SyntaxError"),
        ("import nothing_of_that_name\n", 1, "nothing_of_that_name"),
        ("def others():\n    yield\n", None, "has no attribute 'hypotheses'"),
        ('def hypotheses():\n    yield "halve"\n', None, "it raises ValueError"),
        ('def hypotheses():\n    yield "halve", ("NO_WORDS",), abs\n', None, "no words for NO_WORDS"),
        (
            'ALSO = 3\n\n\ndef hypotheses():\n    yield "halve", ("INTEGER_DIVISION",), abs\n',
            None,
            "it raises",
        ),
    ],
)
def test_hypotheses_that_cannot_be_used_are_named_and_nothing_is_left_half_made(
    halving: Path, mini: Path, capsys: pytest.CaptureFixture[str], text: str, line: int | None, says: str
) -> None:
    path = mini / "solutions" / "halving" / "hypotheses.py"
    path.write_text(text)
    assert run(["author", "build", "halving", "--confusion"]) == 70
    said = capsys.readouterr().err
    assert says in said
    assert f"hypotheses.py:{line}:" in said or (line is None and "hypotheses.py: " in said)
    assert "A fault in the course, not in your work" not in said
    assert not path.with_name("confusion.json").exists()
    if "ALSO" not in text:
        found = problems()
        assert says in found[0], "before the advice to build what cannot be built"


def test_questions_and_mutants_that_raise_are_named(
    halving: Path, mini: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    questions = halving / "questions.py"
    right = questions.read_text()
    questions.write_text(right + "\n1 / 0\n")
    assert run(["author", "build", "halving"]) == 70
    assert "questions.py:5: it raises ZeroDivisionError" in capsys.readouterr().err
    questions.write_text(right)
    forget()
    mutant = mini / "solutions/halving/mutants/rounds_down.py"
    mutant.write_text(mutant.read_text() + "\n1 / 0\n")
    assert run(["author", "build", "halving"]) == 70
    assert "rounds_down.py: it raises ZeroDivisionError" in capsys.readouterr().err


def test_what_is_out_of_date_comes_after_what_it_follows_from(halving: Path, mini: Path) -> None:
    assert run(["author", "build", "halving", "--confusion"]) == 0
    shutil.copy(halving / "halving.py", mini / "solutions/halving/accepted/unfinished.py")
    (halving / "README.md").write_text("# Halving\n")
    found = problems()
    assert "hypotheses.json" in found[-1]
    assert "README does not show" in " ".join(found[:-1])
