"""An author's whole way, on a course of its own: what is new is written, filled in, proved and put to use."""

import json
import math
import re
import shutil
from dataclasses import replace
from itertools import count

import pytest

from course.catalog.reading import BLANK
from tests.journeys.conftest import ROOT, Way, results
from tests.unit.authoring.test_scaffold import fill as fill_tripling

MINI = ROOT / "tests" / "fixtures" / "mini_course"
SCENE = ROOT / "course" / "authoring" / "templates" / "scene.toml.tmpl"
#: What an author writes into the blanks of a warm-up, file by file and from top to bottom.
THIRD = {
    "exercises/warm-ups/first-third": {
        "exercise.toml": ["the-way-back", "A third", "What times three gives x?", "Return x / 3."],
        "README.md": ["Three thirds are one.", "gives a third of `x`.", "Nine digits have to be right."],
        "first_third.py": ["A third of ``x``, float."],
        "checks.py": [
            "A third of one is one over three",
            "one over three, to twelve digits",
            "The result is not a third of the number.",
            "Divide by three.",
            "any number but zero",
        ],
    },
    "solutions/warm-ups/first-third": {
        "first_third.py": ["A third of ``x``.", "return x / 3"],
        "mistakes.py": [
            *("HALVES", "The results are halves of the numbers.", "Divide by three, not by two."),
            *("x / 3", "x / 2"),
            *("Multiplies.", "return x * (1 / 3)"),
            *("Takes two thirds away.", "return x - 2 * x / 3"),
        ],
    },
}  # fmt: skip
#: The mistakes that its author adds below the one that is there.
MORE = """
mistakes(
    "TRIPLES", "The results are three times the numbers.", "Divide instead of multiplying."
).edit("third", {"x / 3": "3 * x"})
mistakes(
    "KEEPS", "The results are the numbers themselves.", "Divide what you return by three."
).edit("third", {"x / 3": "x"})
"""


@pytest.fixture
def mini(tmp_path):
    """The folder of a course that may be written to: a copy."""
    return shutil.copytree(MINI, tmp_path / "mini")


@pytest.fixture
def author(instructor, mini):
    """Commands of its author, who has a checkout of the program."""
    return replace(instructor, environment={**instructor.environment, "COURSE_CONTENT": str(mini)})


def put(path, old, new):
    text = path.read_text("utf-8")
    assert text.count(old) == 1, f"{path} has {old!r} {text.count(old)} times"
    path.write_text(text.replace(old, new), "utf-8")


def fill(path, words):
    text = BLANK.sub(words, path.read_text("utf-8"))
    path.write_text(re.sub(r'raise NotImplementedError\("(.*)"\)', r"\1", text), "utf-8")


def test_a_new_exercise_is_proved_and_a_class_is_graded_with_it(author, mini, tmp_path):
    author("author", "new", "exercise", "tripling", "--function", "tripling(x)", "--lesson", "half-as-much")
    fill_tripling(mini)
    hidden = mini / "graders" / "tripling" / "checks.py"
    put(hidden, "points(6)", "points(8)")  # so that there is something to build: all else is in the template
    built = author("author", "build", "tripling", "--accept").stdout
    assert "Wrote exercises/tripling/exercise.toml" in built
    assert "Wrote solutions/tripling/record.json" in built
    proved = author("author", "check", "tripling").stdout
    # The stub, the solution, two that are right and four that are wrong.
    assert "All is well: 0 lessons, 1 exercise" in proved
    assert "2 checks, 8 submissions graded" in proved

    handed_in = {"ada": mini / "solutions", "bea": mini / "exercises"}
    for student, source in handed_in.items():
        (tmp_path / "class" / student / "tripling").mkdir(parents=True)
        shutil.copy(source / "tripling" / "tripling.py", tmp_path / "class" / student / "tripling")
    author("grade", "run", "class", "--out", "out", "--seed", "7", "--exercise", "tripling")
    found = results(tmp_path / "out").values()
    grades = {line["student"]: (line["state"], line["score"], line["max_score"]) for line in found}
    assert grades == {"ada": ("graded", 12, 12), "bea": ("graded", 0, 12)}

    # Where a class is graded there are no solutions; the author's own machine has them, and says so.
    accepted = "solutions/tripling/accepted/unusual_1.py"
    put(hidden, "import pytest\n", "from pathlib import Path\n\nimport pytest\n")
    reads = f'\nADDS = (Path(__file__).parents[2] / "{accepted}").read_text("utf-8")\n'
    put(hidden, "import kit\n", f"import kit\n{reads}")
    at = hidden.read_text("utf-8").split("\n").index(reads.strip()) + 1
    said = author("author", "check", "tripling", code=1).stdout
    assert f"graders/tripling/checks.py:{at}\n  a grader process does not have {accepted}, which" in said
    assert "solutions/tripling/record.json\n" in said  # other checks may catch other programs
    assert "\n2 problems in" in said


def test_a_new_warm_up_is_proved_and_its_words_reach_a_student(author, mini, tmp_path):
    known = ("--function", "third(x)", "--title", "One third", "--summary", "A third of a number.")
    author("author", "new", "warmup", "first-third", "--lesson", "half-as-much", *known)
    for folder, files in THIRD.items():
        for name, words in files.items():
            left = iter(words)
            fill(mini / folder / name, lambda _, left=left: next(left))
            assert not list(left), name
    with (mini / "solutions/warm-ups/first-third/mistakes.py").open("a", encoding="utf-8") as file:
        file.write(MORE)
    checks = mini / "exercises" / "warm-ups" / "first-third" / "checks.py"
    put(checks, "[((1.0,), 1.0)]", "[((1.0,), 1 / 3)]")
    table = "exercises/warm-ups/diagnoses.json"
    assert f"Wrote {table}" in author("author", "build", "first-third").stdout
    assert "1 check, 7 submissions graded" in author("author", "check", "first-third").stdout

    # A student has no solutions: what they read of a mistake comes from what was built.
    given = tmp_path / "given"
    shutil.copytree(mini, given, ignore=shutil.ignore_patterns("solutions", "graders"))
    student = Way(author.command, author.home, {**author.environment, "COURSE_CONTENT": str(given)})
    student("init", "work")
    work = tmp_path / "work"
    assert "One third" in student("lesson", "half-as-much", cwd=work).stdout
    student("start", "first-third", cwd=work)
    mine, solutions = work / "warm-ups/first-third/first_third.py", mini / "solutions/warm-ups/first-third"
    assert "Still to do" in student("check", "first-third", cwd=work, code=1).stdout
    mine.write_text("def third(x):\n    return 3 * x\n", "utf-8")
    assert "three times the numbers" in student("check", "first-third", cwd=work, code=1).stdout
    shutil.copy(solutions / "first_third.py", mine)
    assert "this warm-up is done" in student("check", "first-third", cwd=work).stdout


def sentences(first=1):
    return (f"Sentence {number} of 2026" for number in count(first))


def test_a_new_lesson_and_a_new_question_are_proved_read_and_answered(author, mini, tmp_path):
    author("author", "new", "lesson", "three-times")
    # Their numbers are years: any other number in a lesson is to come from code.
    lesson, words = mini / "lessons" / "three-times.md", sentences(1901)
    fill(lesson, lambda _: next(words))
    put(lesson, "](figure:three-times", " and of no other year](figure:three-times")
    put(lesson, "figure:three-times", "figure:integrators-order")
    put(lesson, "before = []\n", 'before = ["half-as-much"]\n')
    put(mini / "lessons" / "syllabus.toml", '"half-as-much"]', '"half-as-much", "three-times"]')
    author("author", "new", "question", "thrice")
    question, asked = mini / "quiz" / "thrice.toml", sentences()
    # Texts of options must differ from each other; which is right, the test has to know later.
    fill(question, lambda blank: ("Right: " if blank["what"] == "the right answer" else "") + next(asked))
    assert 'lesson = "three-times"' in question.read_text("utf-8")
    # All of it, for only then it is asked whether the syllabus has the lesson.
    assert "All is well: 3 lessons, 2 exercises, 1 quiz question," in author("author", "check").stdout

    shown = author("lesson", "three-times").stdout
    written = re.findall(r"^(?!#).*(Sentence \d+ of 2026)", lesson.read_text("utf-8"), re.MULTILINE)
    assert len(written) == 17
    assert [sentence for sentence in written if sentence not in shown] == []

    author("init", "work")
    posed = author("quiz", "take", "--seed", "5", "--questions", cwd=tmp_path / "work").stdout
    form = posed[posed.index("format_version = 1") : posed.index("Then: ")]
    (right,) = re.findall(r"^  ([a-d]): Right: Sentence", posed, re.MULTILINE)
    for letter, score in (("a" if right != "a" else "b", 0), (right, 1)):
        (tmp_path / "answers.toml").write_text(form.replace('""', f'"{letter}"'), "utf-8")
        take = ("quiz", "take", "--answers", tmp_path / "answers.toml", "--json")
        reply = author(*take, cwd=tmp_path / "work", code=1 - score)
        assert json.loads(reply.stdout)["score"] == score


def test_a_new_scene_runs_and_agrees_with_its_theory(author, tmp_path):
    """From the template itself: `author new scene` would write it into the program's own folder, whichever
    course is chosen, and no test may write into the checkout."""
    scene = tmp_path / "falling.toml"
    text = SCENE.read_text("utf-8").replace("{{ id }}", "falling").replace("{{ order }}", "1")
    scene.write_text(text, "utf-8")
    fill(scene, lambda blank: "From {height} m." if "{height}" in blank["what"] else "A ball falls.")
    played = author("sandbox", "play", scene, "--headless", "--set", "height=2", "--guess", "6.3").stdout
    assert "A ball falls.: 3 s in" in played
    assert "From 2 m." in played
    assert f"theory: {0.8 * math.sqrt(2 * 9.81 * 2):.5f} m/s" in played
    assert "Theory and simulation agree." in played
