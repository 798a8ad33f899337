"""A tiny quiz to break: two questions of two variants, one of them with numbers."""

from pathlib import Path

import pytest

from course.catalog.questions import read_questions
from course.quizzing.bank import Bank

SUM = """\
format_version = 1
id = "sums"
order = 1
title = "Sums"

[misconceptions]
counts-on = "A sum is the next number."
takes-away = "A sum is a difference."

[[variant]]
id = "numbers"
prompt = "What is {a} and {b}?"
source = "computed"
number = [
  { name = "a", values = [10, 20, 30] },
  { name = "b", values = [3.0, 4.5] },
  { name = "total", formula = "a + b", digits = 3 },
  { name = "next", formula = "a + 1" },
  { name = "less", formula = "a - b", digits = 3 },
]
[[variant.option]]
id = "total"
text = "{total} in all"
right = true
explanation = "{a} and {b} are {total}."
[[variant.option]]
id = "next"
text = "{next} in all"
misconception = "counts-on"
explanation = "That is one more than {a}."
[[variant.option]]
id = "less"
text = "{less} in all"
misconception = "takes-away"
explanation = "That is {a} less {b}."
[[variant.option]]
id = "none"
text = "Nothing"
misconception = "takes-away"
explanation = "Neither number is nothing."

[[variant]]
id = "apples"
prompt = "An apple and a pear?"
source = "Somebody 2001"
option = [
  { id = "two-fruits", text = "Two fruits", right = true, explanation = "Both are fruits." },
  { id = "two-apples", text = "Two apples", misconception = "counts-on", explanation = "No apple." },
  { id = "no-fruit", text = "No fruit", misconception = "takes-away", explanation = "Nobody took them." },
  { id = "one-fruit", text = "One fruit", misconception = "takes-away", explanation = "Nobody ate one." },
]
"""

COLOURS = """\
format_version = 1
id = "colours"
order = 2
title = "Colours"

[misconceptions]
by-night = "All is grey."

[[variant]]
id = "grass"
prompt = "What colour is grass?"
source = "Somebody 2001"
option = [
  { id = "green", text = "Green", right = true, explanation = "It is." },
  { id = "grey", text = "Grey", misconception = "by-night", explanation = "By night only." },
  { id = "black", text = "Black", misconception = "by-night", explanation = "By night only." },
  { id = "dark", text = "Dark", misconception = "by-night", explanation = "By night only." },
]

[[variant]]
id = "snow"
prompt = "What colour is snow?"
source = "Somebody 2001"
option = [
  { id = "white", text = "White", right = true, explanation = "It is." },
  { id = "grey", text = "Grey", misconception = "by-night", explanation = "By night only." },
  { id = "black", text = "Black", misconception = "by-night", explanation = "By night only." },
  { id = "dark", text = "Dark", misconception = "by-night", explanation = "By night only." },
]
"""


def _written(folder: Path) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "sums.toml").write_text(SUM, encoding="utf-8")
    (folder / "colours.toml").write_text(COLOURS, encoding="utf-8")
    return folder


@pytest.fixture
def quiz(tmp_path: Path) -> Path:
    """A folder with the two questions."""
    return _written(tmp_path / "quiz")


@pytest.fixture(scope="session")
def bank(tmp_path_factory: pytest.TempPathFactory) -> Bank:
    """The bank of both, from files that nobody changes."""
    return Bank(read_questions(_written(tmp_path_factory.mktemp("quiz"))))
