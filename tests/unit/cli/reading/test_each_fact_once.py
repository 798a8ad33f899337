"""For who listens: what a student meets with ``--plain`` says each sentence once."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

from course.authoring.exercises.grading import solution_path
from course.cli.frame import app
from course.cli.reading.lesson import sentences
from tests.unit.cli.reading.conftest import CATALOG

EXERCISE = "integrators"
#: Code, output and tables are as they are: a cell of a table may say what another says.
_VERBATIM = re.compile(r"^(Python code|It prints|Text|Table), \d+ ")
#: A formula may come back; and four functions may each pass a check of the same name.
_MAY_COME_BACK = ("Formula: ", "pass: ")
#: Fewer words are a label, such as "diagnosis: TIMEOUT".
_WORDS = 5
WRONG = """

def explicit_euler_step(accel, t, q, v, h):
    v = v + h * accel(t, q, v)
    return q + h * v, v


def integrate(*_):
    return 1
"""


def repeated(text: str) -> list[str]:
    """Sentences that are there more than once."""
    said: Counter[str] = Counter()
    verbatim = False
    for line in text.splitlines():
        verbatim = verbatim or bool(_VERBATIM.match(line))
        if not verbatim and not line.strip().startswith(_MAY_COME_BACK):
            said.update(one for one in sentences(line.strip()) if len(one.split()) >= _WORDS)
        verbatim = verbatim and not line.startswith("End of ")
    return [one for one, count in said.items() if count > 1]


def test_a_sentence_that_is_said_twice_is_found() -> None:
    once = "The energy grows by four per cent."
    code = "Python code, 1 lines:\nx = 1  # the energy grows by itself\nEnd of python code\n"
    assert repeated(f"{once}\n{code}{code}") == []
    assert repeated(f"{once}\nMore of it here. {once}\n") == [once]


def heard(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    capsys.readouterr()
    app.run((*words, "--plain"))
    said = capsys.readouterr()
    assert "\x1b" not in said.out
    return said.out + said.err


@pytest.mark.usefixtures("sandboxes")
def test_the_way_through_an_exercise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Started, failed, hinted at, mended, looked back at."""
    assert app.run(("init", str(tmp_path / "mine"))) == 0
    monkeypatch.chdir(tmp_path / "mine")
    path = tmp_path / "mine" / EXERCISE / f"{EXERCISE}.py"
    right = solution_path(CATALOG, CATALOG.exercise(EXERCISE)).read_text("utf-8")
    steps: list[tuple[str, ...]] = [("start", EXERCISE), ("check", EXERCISE), ("hint", EXERCISE)]
    steps += [("exercises",), ("lessons",), ("warmup",), ("next",), (), ("progress",)]
    found = {words: repeated(heard(capsys, *words)) for words in steps}
    for wrong in (WRONG, ""):
        path.write_text(right + wrong, "utf-8")
        for words in (
            ("check", EXERCISE),
            ("check", EXERCISE, "--verbose"),
            ("hint", EXERCISE),
            ("progress",),
        ):
            found[(*words, f"wrong: {bool(wrong)}")] = repeated(heard(capsys, *words))
    # Two objectives may have the same evidence.
    found[()] = [one for one in found[()] if not one.startswith("lessons read: ")]
    assert {words: twice for words, twice in found.items() if twice} == {}
