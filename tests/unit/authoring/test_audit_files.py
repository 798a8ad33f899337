"""What the audit finds by reading, and how it reads Python without running it."""

import ast
import re
import shutil
from pathlib import Path

import msgspec
import pytest

from course.authoring.audit import audit
from course.authoring.exercises.grading import mistakes_of
from course.authoring.exercises.source import checks_in, foreign_imports, quoted_numbers, signatures
from course.catalog.load import Catalog
from course.errors import ContentError
from tests.unit.authoring.conftest import edit, line_of

TOML = "exercises/doubling/exercise.toml"
README = "exercises/doubling/README.md"
STUB = "exercises/doubling/doubling.py"
CHECKS = "exercises/doubling/checks.py"
GRADERS = "graders/doubling/checks.py"
SOLUTION = "solutions/doubling/doubling.py"
MISTAKES = "solutions/doubling/mistakes.py"
LESSON = "lessons/half-as-much.md"
SYLLABUS = "lessons/syllabus.toml"

GOOD_LINKS = (
    "(#example), [b](lesson:twice-as-much#once), [c](exercise:halving#halving), [d](doubling.py)"
    " and [e](https://example.org/x#y)"
)
FIGURE = "![It falls down to zero](figure:none)\nc\n\nHalf"
PRINTS = "```python\nprint(1 + 1)\n```\n\n```output\n3\n```\n\nHalf of twice"
REQUIRING = 'points(3)\n@pytest.mark.requires("doublings_values")'
DRAWS = "import numpy as np\nimport pytest\n\nRNG = np.random.{}\n"
NO_ADVICE = '"SIGN_LOST", "No sign.", " ")'
OF_ITSELF = "points(1 + 2)\n@pytest.mark.requires('double_of_three')"


@pytest.mark.parametrize(
    ("file", "old", "new", "at", "code", "says"),
    [
        (README, "(lesson:twice-as-much)", "(lesson:thrice)", "lesson:thrice", "link", "does not exist"),
        (README, "(lesson:twice-as-much)", "(#examples)", "#examples", "link", "heading that does not"),
        (README, "(lesson:twice-as-much)", "(lesson:twice-as-much#one)", "#one", "link", "heading that does"),
        (README, "(lesson:twice-as-much)", "(exercise:halving#no)", "#no", "link", "heading that does not"),
        (README, "(lesson:twice-as-much)", "(picture.png)", "picture", "link", "leads to no file"),
        (README, "(lesson:twice-as-much)", "(../halving/README.md)", "../", "link", "leaves its folder"),
        (README, "(lesson:twice-as-much)", "(ftp://x)", "ftp:", "link", "unknown kind"),
        (README, "(lesson:twice-as-much)", GOOD_LINKS, None, "", ""),
        (README, "[the lesson](lesson:twice-as-much)", "a\n![b](c.png)", "c.png", "link", "leads to no file"),
        (LESSON, "(exercise:halving)", "(exercise:thirds)", "exercise:thirds", "link", "does not exist"),
        (LESSON, "Half of twice", "<b>Half</b> of twice", "<b>", "content", "HTML"),
        (LESSON, '["twice-as-much"]', '["later"]', '"later"', "lesson", "does not come before"),
        (LESSON, '["halving"]', '["halving", "no"]', '"no"', "lesson", "no exercise no"),
        (LESSON, '["halving"]', "[]", None, "exercise", "does not name this exercise"),
        (LESSON, "Half of twice", FIGURE, "figure:none", "lesson", "no figure none"),
        (LESSON, "Half of twice", "[a](#the-way-forward)", "#the-way-f", "link", "heading that does not"),
        (LESSON, "Half of twice", PRINTS, "```output", "lesson", "prints"),
        (LESSON, "Half of twice", "[3](=1+1) of twice", "[3]", "lesson", "gives 2"),
        (TOML, 'lesson = "twice-as-much"', 'lesson = "thrice"', "thrice", "exercise", "no lesson thrice"),
        (TOML, "twice-as-much#once", "twice-as-much#twice", "#twice", "link", "heading that does not"),
        (TOML, "twice-as-much#once", "thrice#once", "thrice#once", "link", "does not exist"),
        (TOML, "points = 4", "points = 7", "points = 7", "points", "come to 4, and 7 is"),
        (TOML, "hidden_checks = 2", "hidden_checks = 3", "_checks", "points", "come to 2, and 3 is"),
        (TOML, "hidden_points = 5", "hidden_points = 4", "_points", "points", "come to 5, and 4 is"),
        (TOML, "order = 1", "order = 1\nslow = { no = 0.2 }", "slow = {", "content", "unknown key `slow`"),
        (TOML, "order = 1", "order = 2", None, "exercise", "order 2 too"),
        (TOML, "order = 1", "order = 3", None, "exercise", "lower order, 2, and its lesson comes later"),
        (SYLLABUS, '"half-as-much"', '"half-as-much",\n"thirds"', "thirds", "syllabus", "thirds has no file"),
        (LESSON, '["halving"]', '["halving", "halving"]', "exercises = ", "content", "listed twice"),
        (LESSON, "Half of twice", "## The way back\n\nHalf", None, "lesson", "has the anchor #the-way"),
        (LESSON, "Half of twice", "> **Predict.** Why?\n\nHalf", "Predict", "lesson", "is not answered"),
        (TOML, '    "Return x + x.",\n', "", "hints = [", "hints", "has 2 hints, and needs 3"),
        (TOML, '2 = ["SQUARES', '4 = ["SQUARES', "[task.fits]", "content", "no hint number 4"),
        (README, "`double(x) -> float`", "`double` -> float", None, "readme", "signature double(x)"),
        (README, "## What is checked", "## Checked", None, "readme", "no section `## What is checked`"),
        (README, "## What is checked", "word " * 950 + "\n## What is checked", None, "readme", "at most 900"),
        (README, "## What is checked", "## What is checked\n" + "word " * 501, None, "readme", "at most 500"),
        (STUB, "def double(x)", "def double(y)", None, "signature", "double(y)"),
        (STUB, "def double(x)", "def double(x", "def double", "content", "not valid Python"),
        (STUB, '    """Twice ``x``.', '    x = """Twice ``x``.', "def double", "stub", "no docstring"),
        (STUB, '"""Doubling, once', 'import scipy\n"""Doubling, once', "scipy", "imports", "scipy"),
        (SOLUTION, "import numpy as np", "import numpy as np\nimport course", "course", "imports", "course"),
        (SOLUTION, "def double(x)", "def double(x, y=1)", "def double(", "signature", "double(x, y=1)"),
        (CHECKS, '@pytest.mark.task("double")\n', "", "def test_double_of_three", "check", "has no task"),
        (CHECKS, 'task("double")', 'task("doble")', "def test_double_of_three", "check", "'doble' that"),
        (CHECKS, "@pytest.mark.points(2)\n", "", "def test_double_of_three", "check", "has no points"),
        (CHECKS, "points(2)", "points(-2)", "def test_double_of_three", "check", "no points that"),
        (CHECKS, "points(2)", "points(1 + 2)", None, "points", "come to 5, and 4 is"),
        (CHECKS, "points(2)", OF_ITSELF, "_three(s", "check", "itself"),
        (CHECKS, '    """Twice three is six"""\n', "", "def test_double_of_three", "check", "no title"),
        (GRADERS, 'requires("doublings_length")', 'requires("no")', "def test_doublings_v", "check", "'no'"),
        (CHECKS, "points(3)", REQUIRING, "length(s", "check", "public and requires"),
        (GRADERS, "double_of_negative", "double_of_three", "def test_double_of_three", "check", "twice"),
        (GRADERS, '"Try a negative number by hand."', '"Try -18.5 by hand."', "18.5", "leak", "18.5"),
        (GRADERS, '"Try a negative number by hand."', '"Try 3.0 by hand."', None, "", ""),
        (GRADERS, "import pytest\n", DRAWS.format("default_rng()"), "RNG = ", "draw", "default_rng() draws"),
        (GRADERS, "import pytest\n", DRAWS.format("uniform(1, 2)"), "RNG = ", "draw", "uniform() draws"),
        (GRADERS, "import pytest\n", DRAWS.format("default_rng(5)"), None, "", ""),
        (MISTAKES, '"SIGN_LOST")', NO_ADVICE, "No s", "content", "not what"),
        (MISTAKES, '"x * x"', '"x *"', '"x *"', "content", "is not valid Python"),
        (MISTAKES, '"2.0 * x": "x * x"', '"3.0 * x": "x * x"', "3.0", "content", "'3.0 * x' stands 0 times"),
        (MISTAKES, '{"2.0 * x": "x * x"}', '{"x": "y"}', '"y"', "content", "'x' stands 3 times in double"),
        (MISTAKES, '"double", {"2', '"dubble", {"2', '"dubble"', "content", "has no function dubble"),
        (MISTAKES, '"SIGN_LOST"', '"sign lost"', "sign lost", "content", "'sign lost' is no code"),
        (MISTAKES, '"x * x"', "\"__import__('scipy')\"", None, "", ""),
    ],
)
def test_each_fault_is_found_at_its_line(mini, run, file, old, new, at, code, says):
    """One fault is planted; ``at`` is a text on the line to blame, None where there is none to look for."""
    edit(mini / file, old, new)
    report = run()
    if not code:
        assert report.ok
        return
    found = [p for p in report.problems if p.code == code and says in p.message]
    assert found, [f"{p.where} {p.code} {p.message}" for p in report.problems]
    assert found[0].help
    if at is not None:
        assert (found[0].file, found[0].line) == (file, line_of(mini / file, at))


@pytest.mark.parametrize("file", [README, CHECKS, GRADERS, STUB, SOLUTION, TOML, SYLLABUS])
def test_a_missing_file_is_named(mini, run, file):
    (mini / file).unlink()
    (message,) = [p.message for p in run().problems if (p.file, p.code) == (file, "content")]
    assert "missing" in message


def test_an_exercise_without_mistakes_is_named(mini, run):
    (mini / MISTAKES).unlink()
    said = [p.message for p in run().problems if (p.file, p.code) == (MISTAKES, "mutants")]
    assert any("it has no wrong program" in message for message in said)


def test_an_exercise_folder_without_an_exercise_is_named(mini, only_problem):
    (mini / "exercises" / "thirds").mkdir()
    assert only_problem().file == "exercises/thirds/exercise.toml"


def test_an_exercise_nobody_accepts_variants_of_is_named(mini, only_problem):
    shutil.rmtree(mini / "solutions" / "halving" / "accepted")
    assert "accepted variants: 0, and an exercise of this size has at least 2" in only_problem().message


def drop(path, *texts):
    """Take the mistakes of an exercise out that hold one of the texts."""
    head, *entries = path.read_text().split("\nmistakes(")
    kept = [entry for entry in entries if not any(text in entry for text in texts)]
    assert len(kept) < len(entries)
    path.write_text("\nmistakes(".join([head, *kept]))


def test_an_exercise_with_few_mutants_is_named(mini, run):
    drop(mini / "solutions" / "halving" / "mistakes.py", "round(")
    few, stale = run().problems
    assert few.file == "solutions/halving/mistakes.py"
    assert "mutants: 3, and an exercise of this size has at least 4" in few.message
    assert stale.file == "solutions/halving/record.json"
    assert stale.help == "Run `course author build halving --accept`, and read what it says."


def test_one_diagnosis_for_every_mistake_is_named(mini, run):
    path = mini / MISTAKES
    path.write_text(re.sub(r'mistakes\("\w+"\)', 'mistakes("WRONG")', path.read_text()))
    assert "tell no mistakes apart" in " ".join(p.message for p in run().problems if p.file == MISTAKES)


def test_what_ruff_says_is_said_by_the_rules_of_the_course(mini, run):
    path = mini / CHECKS
    path.write_text(path.read_text().replace("import pytest\n", "import os\nimport pytest\nx  =  1\n"))
    assert run("doubling").ok
    (mini / "pyproject.toml").write_text('[tool.ruff]\nline-length = 110\nlint.select = ["F"]\n')
    found = {(p.where, p.code, p.help) for p in run("doubling").problems}
    assert found == {
        (f"{CHECKS}:{line_of(path, 'import os')}", "style", "Try `ruff check --fix`."),
        (CHECKS, "style", f"Run `ruff format {CHECKS}`."),
    }
    other = "exercises/halving/checks.py"
    edit(mini / other, "import pytest\n", "import os\nimport pytest\n")
    found.add((f"{other}:{line_of(mini / other, 'import os')}", "style", "Try `ruff check --fix`."))
    assert {(p.where, p.code, p.help) for p in run().problems} == found


def test_a_task_that_no_mutant_breaks_is_named(mini, run):
    path = mini / MISTAKES
    drop(path, '"doublings"')
    with path.open("a") as file:  # others of the other task, so that there are enough
        file.write("\n" + 'mistakes("SQUARES_INSTEAD").edit("double", {"2.0 * x": "x * x"})\n' * 4)
    assert "no mutant breaks task doublings" in run().problems[0].message


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("def double(x):\n    return x + x\n", 1, "does not say what is unusual"),
        ('"""Odd."""\n\ndef double(x:\n', 3, "not valid Python"),
        ('"""Odd."""\nfrom __future__ import annotations\n', 2, "not valid Python"),
    ],
)
def test_a_variant_that_cannot_follow_the_solution_is_named(mini, run, text, line, says):
    path = mini / "solutions" / "doubling" / "accepted" / "adds.py"
    path.write_text(text)
    (problem,) = [p for p in run().problems if p.file == "solutions/doubling/accepted/adds.py"]
    assert problem.line == line
    assert says in problem.message


def test_checks_without_markers_are_not_graded(mini, oracle, run):
    edit(mini / CHECKS, "@pytest.mark.points(2)\n", "")
    assert not run().ok
    accepted = (path.name for path in (mini / "solutions" / "halving").glob("accepted/*.py"))
    catalog = Catalog()
    wrong = (one.name for one in mistakes_of(catalog, catalog.exercise("halving")).wrong)
    assert set(oracle.graded) == {"stub", "solution", *accepted, *wrong}


def test_one_exercise_or_lesson_can_be_audited_alone(mini, run):
    edit(mini / TOML, "points = 4", "points = 5")
    exercise, lesson = run("halving"), run("twice-as-much")
    assert (exercise.ok, exercise.lessons, exercise.exercises) == (True, (), ("halving",))
    assert (lesson.ok, lesson.lessons, lesson.exercises) == (True, ("twice-as-much",), ())
    assert not run("doubling").ok


OBJECTIVE = """
[[objective]]
title = "count"
lessons = ["twice-as-much", "half-as-much"]
exercises = ["doubling"]
"""


def test_what_belongs_to_no_objective_is_named_where_it_would_be_added(mini, run):
    syllabus = mini / SYLLABUS
    syllabus.write_text(syllabus.read_text() + OBJECTIVE)
    (problem,) = run("halving").problems
    assert problem.where == f"{SYLLABUS}:{line_of(syllabus, '[[objective]]')}"
    assert "exercise halving belongs to no objective" in problem.message
    syllabus.write_text(
        syllabus.read_text().replace('["doubling"]', '["doubling", "halving", "halving", "no"]')
    )
    found = [p.message for p in run().problems if p.code == "syllabus"]
    assert found == ["halving belongs to an objective above already.", "there is no no among the exercises."]


def test_a_course_with_objectives_has_whole_lessons(mini, run):
    syllabus = mini / SYLLABUS
    syllabus.write_text(syllabus.read_text() + OBJECTIVE)
    said = [p.message for p in run("half-as-much").problems]
    assert "the lesson has no prediction." in said
    assert "a lesson has at least 2 warm-ups, and half-as-much has fewer." in said


def test_minutes_that_do_not_fit_the_text_of_a_lesson_are_named(mini, run):
    syllabus, lesson = mini / SYLLABUS, mini / "lessons" / "half-as-much.md"
    syllabus.write_text(syllabus.read_text() + OBJECTIVE)
    asked = "\n> **Predict.** What is half of six? Of seven?\n\n> **Answer.** Three.\n"
    cell = "\n```python\n" + "x = 1\n" * 100 + "```\n"
    lesson.write_text(lesson.read_text() + "word " * 1200 + "\n" + 2 * asked + cell)  # 12, 3 and 10 minutes
    said = [p for p in run("half-as-much").problems if "minutes" in p.message]
    assert [p.where for p in said] == [f"lessons/half-as-much.md:{line_of(lesson, 'minutes = 2')}"]
    assert said[0].message == "`minutes` is 2; by its words, predictions and code it takes about 25."
    lesson.write_text(lesson.read_text().replace("minutes = 2", "minutes = 30"))
    assert not [p for p in run("half-as-much").problems if "minutes" in p.message]


def test_a_command_of_a_lesson_that_fails_is_named(mini):
    lesson = mini / LESSON
    lesson.write_text(lesson.read_text() + "\n```console\n$ course lessons\n$ course lesson no\n```\n")
    tried = []

    def refused(commands):
        tried.append([*commands])
        return {1: "There is no lesson called 'no'."}

    (problem,) = audit(Catalog(), "half-as-much", refused=refused).problems
    assert tried == [["course lessons", "course lesson no"]]
    assert problem.where == f"{LESSON}:{line_of(lesson, 'course lesson no')}"
    assert problem.message == "`course lesson no` fails in a fresh workspace: There is no lesson called 'no'."


def test_two_exercises_that_share_a_number_or_a_file_are_named(mini, run):
    for name in ("doubling", "halving"):
        path = mini / f"exercises/{name}/exercise.toml"
        text = re.sub(r"^number = .*\n", "", path.read_text(), flags=re.MULTILINE)
        path.write_text(text.replace("order = ", "number = 4\norder = "))
    (problem,) = run("halving").problems
    assert problem.message == "exercise doubling has the number 4 too."
    (mini / "solutions/halving/halving.py").rename(mini / "solutions/halving/doubling.py")
    (mini / "exercises/halving/halving.py").rename(mini / "exercises/halving/doubling.py")
    edit(path, 'module = "halving.py"', 'module = "doubling.py"')
    assert "exercise doubling has the module doubling.py too." in [p.message for p in run("halving").problems]


def test_an_exercise_and_a_warm_up_of_one_id_are_refused_by_every_command(mini):
    shutil.copytree(mini / "exercises/doubling", mini / "exercises/warm-ups/doubling")
    with pytest.raises(ContentError, match=r"warm-ups/doubling: an exercise has this id, too"):
        Catalog().exercise("doubling")
    assert [p.message for p in audit(Catalog()).problems] == ["an exercise has this id, too."]


def test_what_a_handout_is_told_is_declared_and_what_is_declared_is_told(mini, oracle, run):
    def told(verdict):
        checks = tuple(
            msgspec.structs.replace(check, diagnosis="DOUBLES" if check.id == "double_of_three" else None)
            for check in verdict.checks
        )
        return msgspec.structs.replace(verdict, checks=checks)

    oracle.changes["stub"] = told
    (problem,) = [p for p in run("doubling").problems if p.code == "stub"]
    assert problem.where == f"{STUB}:{line_of(mini / STUB, 'def double(')}"
    assert "the untouched stub is told DOUBLES" in problem.message
    edit(mini / TOML, 'id = "double"\n', 'id = "double"\nfault = "DOUBLES"\n')
    assert run("doubling").problems == ()
    edit(mini / TOML, '"DOUBLES"', '"TRIPLES"')
    found = [p.message for p in run("doubling").problems]
    assert "no public check tells the untouched stub TRIPLES." in found


# -- reading Python --------------------------------------------------------------------------------------


def test_signatures_are_compared_without_annotations():
    tree = ast.parse("def f(a: int, *, b: float = 1.0, **kw: str) -> int: ...\nclass C: ...\n")
    assert signatures(tree)["f"].text == "f(a, *, b=1.0, **kw)"
    assert signatures(tree)["f"].annotated == "f(a: int, *, b: float=1.0, **kw: str)"
    assert set(signatures(tree)) == {"f"}


def test_the_last_definition_of_a_function_counts():
    assert signatures(ast.parse("def f(a): ...\ndef f(b): ...\n"))["f"].text == "f(b)"


def test_imports_are_found_wherever_they_stand():
    source = "import os\nimport numpy.linalg\ndef f():\n    from scipy import fft\nfrom . import x\n"
    assert list(foreign_imports(ast.parse(source), ("numpy",))) == [(5, "."), (4, "scipy")]


def test_a_check_is_what_its_markers_say():
    source = (
        "@pytest.mark.task('t')\n@pytest.mark.points(1.5)\n@pytest.mark.requires('a', 'b')\n"
        "def test_x(submission):\n    '''Title\n\n    more'''\n\ndef helper(): ...\n"
    )
    (check,) = checks_in(Path("c.py"), ast.parse(source), hidden=True)
    assert (check.id, check.title, check.line, check.hidden) == ("x", "Title", 4, True)
    assert (check.task, check.points, check.requires) == ("t", 1.5, ("a", "b"))


def test_a_marker_that_is_no_plain_value_is_told_from_a_missing_one():
    source = (
        "@pytest.mark.task(T)\n@pytest.mark.requires(*ALL)\ndef test_x(): ...\n"
        "@pytest.mark.points(1 + 1)\n@pytest.mark.task('t')\ndef test_y(): ...\n"
    )
    x, y = checks_in(Path("c.py"), ast.parse(source), hidden=False)
    assert (x.task, x.points, x.indirect) == (None, None, ("task", "requires"))
    assert (y.task, y.points, y.indirect) == ("t", None, ("points",))


@pytest.mark.parametrize(
    ("call", "numbers"),
    [
        ("kit.fail('off by 0.25')", ["0.25"]),
        ("kit.expect_true(x, 'more than 1e-9')", ["1e-9"]),
        ("kit.expect_close(a, 0.25, message='no', help='yes')", []),
        ("kit.expect_close(a, b, message=f'{a} is not 2.5')", ["2.5"]),
        ("kit.Diagnosis('X', 'about 3.0 of them', 'less')", ["3.0"]),
        ("kit.Diagnosis(code='X', looks_like='l', advice='use 1.5E+3')", ["1.5E+3"]),
        ("kit.expect_close(a, b, source='seen 0.3 to 0.4')", []),
        ("kit.fail('RK4 of order 4, in 2 steps, see v1.2.3')", []),
    ],
)
def test_numbers_in_the_words_of_a_check_are_found(call, numbers):
    assert [number for _, number in quoted_numbers(ast.parse(call))] == numbers
