"""New exercises and lessons: blanks, then a course that passes its audit."""

import pytest

from course.authoring.audit import audit
from course.authoring.scaffold import Function, new_exercise, new_lesson, new_question
from course.catalog.load import Catalog
from course.catalog.reading import BLANK
from course.errors import UsageError

MISTAKES = [
    ("DOUBLES", "It is twice the number.", "Add it once more.", "3 * x", "2 * x"),
    ("SQUARES", "It is the square of the number.", "Add the number three times.", "3 * x", "x * x"),
    ("ADDS_THREE", "Three is added.", "Add the number itself.", "3 * x", "x + 3"),
    ("ONCE_TOO_OFTEN", "It is four times the number.", "Add it once less.", "3 * x", "4 * x"),
]
CHECK = ["Three times two is six", "", "round-off", "The result is not three times the number.", "Add up."]
SOLVED = {
    "exercises/tripling/exercise.toml": [
        "Tripling", "Three times.", "Three times a number",
        "What is once more than twice?", "Add three times.", "Return 3 * x.",
    ],
    "exercises/tripling/README.md": [
        "Tripling", "gives three times `x`.", "tripling(1.0) is 3.0.", "Nine digits.",
    ],
    "exercises/tripling/tripling.py": ["Tripling.", "Three times ``x``, float."],
    "exercises/tripling/checks.py": CHECK,
    "exercises/tripling/questions.py": [""],
    "graders/tripling/checks.py": CHECK,
    "solutions/tripling/tripling.py": ["Tripling.", "Three times ``x``.", "solved"],
    "solutions/tripling/README.md": ["Three times is twice and once more."],
    "solutions/tripling/mistakes.py": list(MISTAKES[0]),
    "solutions/tripling/accepted/unusual_1.py": ["Adds.", "added"],
    "solutions/tripling/accepted/unusual_2.py": ["Doubles and adds.", "more"],
}  # fmt: skip

#: Lines of the templates that hold code, and what an author makes of them.
CODE = {
    'raise NotImplementedError("solved")': "return 3 * x",
    'raise NotImplementedError("added")': "return x + x + x",
    'raise NotImplementedError("more")': "return 2 * x + x",
    "expected = 1.0": "expected = 3.0",
    "expected = 2.0": "expected = 6.0",
    "  # \n": "\n",
    "    # \n": "",
}


def fill(mini):
    """Fill every blank as an author would, and list the exercise in its lesson."""
    for name, words in SOLVED.items():
        path, left = mini / name, list(words)
        text = BLANK.sub(lambda _, left=left: left.pop(0), path.read_text(encoding="utf-8"))
        assert not left
        for old, new in CODE.items():
            text = text.replace(old, new)
        path.write_text(text, encoding="utf-8")
    more = "".join(
        f'mistakes("{code}", "{looks_like}", "{advice}").edit("tripling", {{"{old}": "{new}"}})\n'
        for code, looks_like, advice, old, new in MISTAKES[1:]
    )
    with (mini / "solutions" / "tripling" / "mistakes.py").open("a", encoding="utf-8") as file:
        file.write(more)
    lesson = mini / "lessons" / "half-as-much.md"
    lesson.write_text(lesson.read_text().replace('["halving"]', '["halving", "tripling"]'))


def contents(folder):
    return {str(path): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_a_question_that_raises_is_named_with_its_line(mini):
    new_exercise(Catalog(), "tripling")
    fill(mini)
    solution = mini / "solutions" / "tripling" / "tripling.py"
    called = "    if callable(x):\n        x = x(1.0)\n    return 3 * x"
    solution.write_text(solution.read_text("utf-8").replace("    return 3 * x", called), "utf-8")
    asked = mini / "exercises" / "tripling" / "questions.py"
    asked.write_text('QUESTIONS = {\n    "tripling": [\n        (lambda t: t / 0,),\n    ]\n}\n', "utf-8")
    problems = audit(Catalog(), "tripling", grade=lambda _: ()).problems
    assert "exercises/tripling/questions.py:3" in [one.where for one in problems], problems


def test_the_audit_names_every_blank_with_its_line(mini):
    files = new_exercise(Catalog(), "tripling")
    expected = {
        (str(path.relative_to(mini)), number)
        for path in files
        for number, line in enumerate(path.read_text().split("\n"), start=1)
        if "<<FILL IN" in line
    }
    report = audit(Catalog(), "tripling")
    assert {(p.file, p.line) for p in report.problems} == expected
    assert {p.code for p in report.problems} == {"blank"}
    assert {file for file, _ in expected} == set(SOLVED)
    assert report.graded == 0


def test_a_name_of_several_words_becomes_a_module(mini):
    files = new_exercise(Catalog(), "three-times-as-much")
    assert mini / "exercises" / "three-times-as-much" / "three_times_as_much.py" in files
    assert Catalog().exercise("three-times-as-much").module == "three_times_as_much.py"


def test_what_is_known_of_an_exercise_stands_in_every_file_and_is_no_blank(mini):
    functions = [
        Function.parse("swing_period(length, gravity=9.81)", "gives the period of small swings, s."),
        Function.parse("swings(t)", "gives how often it swings in t."),
    ]
    known = {"title": "Swinging", "summary": "Periods of pendulums.", "lesson": "twice-as-much"}
    files = new_exercise(Catalog(), "swinging", functions, **known)
    exercise = Catalog().read_exercise("swinging")
    assert [task.id for task in exercise.task] == ["swing_period", "swings"]
    texts = {str(path.relative_to(mini)): path.read_text() for path in files}
    for name, text in texts.items():
        if name.endswith(".py"):
            compile(text, name, "exec")
    stub = texts["exercises/swinging/swinging.py"]
    assert stub == (
        '"""Periods of pendulums."""\n\n\n'
        'def swing_period(length, gravity=9.81):\n    """Gives the period of small swings, s."""\n'
        "    raise NotImplementedError\n\n\n"
        'def swings(t):\n    """Gives how often it swings in t."""\n    raise NotImplementedError\n'
    )
    assert 'case = {"length": 1.0, "gravity": 1.5}' in texts["exercises/swinging/checks.py"]
    for name in ("swing_period", "swings"):
        assert texts["solutions/swinging/mistakes.py"].count(f'.edit("{name}", ') == 1
    assert 'lesson = "twice-as-much"' in texts["exercises/swinging/exercise.toml"]
    assert "FILL IN" not in stub


@pytest.mark.parametrize(
    "text", ["", "swing", "swing(", "swing()", "swing(*a)", "swing(a); import os", "a(b):\n x"]
)
def test_what_is_no_signature_is_refused(text):
    with pytest.raises(UsageError, match="not a function"):
        Function.parse(text)


@pytest.mark.parametrize(
    "taken",
    ["exercises/tripling/questions.py", "solutions/tripling/mistakes.py", "graders/tripling/checks.py"],
)
def test_nothing_is_overwritten_and_nothing_half_written(mini, taken):
    (mini / taken).parent.mkdir(parents=True)
    (mini / taken).write_text("mine")
    before = contents(mini)
    with pytest.raises(UsageError, match="nothing is overwritten") as caught:
        new_exercise(Catalog(), "tripling")
    assert caught.value.code == "exists"
    assert contents(mini) == before


@pytest.mark.parametrize("name", ["Tripling", "../x", "checks", "mistakes", "a_b", ""])
def test_a_name_that_cannot_be_used_is_refused(mini, name):
    before = contents(mini)
    with pytest.raises(UsageError):
        new_exercise(Catalog(), name)
    assert contents(mini) == before


def test_a_new_lesson_passes_once_it_is_filled_and_listed(mini, run):
    (path,) = new_lesson(Catalog(), "three-times")
    problems = run().problems
    assert {p.code for p in problems} == {"blank", "syllabus"}
    path.write_text(BLANK.sub("Three times are said here, 2026.", path.read_text()))
    (unknown,) = (p for p in run().problems if p.code == "lesson")
    assert unknown.message == "there is no figure three-times."
    assert "CONTRIBUTING.md" in unknown.help
    path.write_text(path.read_text().replace("figure:three-times", "figure:integrators-order"))
    assert [p.message for p in run("three-times").problems] == ["the syllabus does not list this lesson."]
    syllabus = mini / "lessons" / "syllabus.toml"
    syllabus.write_text(syllabus.read_text().replace('"half-as-much"]', '"half-as-much", "three-times"]'))
    assert run().problems == ()
    with pytest.raises(UsageError, match="nothing is overwritten"):
        new_lesson(Catalog(), "three-times")


def test_a_new_question_passes_once_it_is_filled(mini, run):
    (path,) = new_question(Catalog(), "twice-or-square")
    blanks = [p for p in run().problems if p.code == "blank"]
    assert {p.file for p in blanks} == {"quiz/twice-or-square.toml"}
    texts = iter(range(1000))  # texts of options must differ from each other
    filled = BLANK.sub(lambda _: f"Sentence number {next(texts)} of this question, 2026", path.read_text())
    path.write_text(filled)
    assert [p.message for p in run().problems] == []
    with pytest.raises(UsageError, match="nothing is overwritten"):
        new_question(Catalog(), "twice-or-square")
