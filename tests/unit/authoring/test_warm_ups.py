"""Warm-ups: what the scaffold writes passes the audit once it is filled, and the audit misses nothing."""

import json
import re
import shutil

import pytest

from course.authoring.audit import audit
from course.authoring.exercises.diagnosis import build
from course.authoring.scaffold import Function, new_exercise
from course.catalog.load import Catalog
from course.cli.frame.app import run
from course.errors import ContentError, UsageError
from course.scoring.explain.story import read_table, table_path
from tests.unit.authoring.conftest import edit, forget

WORDS = {
    "exercise.toml": [
        *("Tripling", "the-way-back", "Three times.", "Three times a number"),
        *("What is once more than twice?", "Return 3 * x."),
    ],
    "README.md": ["Tripling", "It is about three.", "gives three times `x`.", "Numbers must agree."],
    "tripling.py": ["Tripling.", "Three times ``x``."],
    "checks.py": ["Three times one is three", "", "It is not three times the number.", "Count.", ""],
}
WRONG = {"DOUBLES": "2 * x", "ADDS_THREE": "3 + x", "CUBES": "x**3"}


@pytest.fixture
def tripling(mini):
    """A warm-up of the mini course with every blank filled, as an author would."""
    new_exercise(Catalog(), "tripling", [Function.parse("triple(x)")], lesson="half-as-much", warm_up=True)
    student, solutions = mini / "exercises/warm-ups/tripling", mini / "solutions/warm-ups/tripling"
    for name, words in WORDS.items():
        fill(student / name, words)
    checks = (student / "checks.py").read_text()
    assert "[((1.0,), 1.0)]" in checks
    (student / "checks.py").write_text(re.sub(r" *# \n", "", checks.replace("(1.0,), 1.0", "(1.0,), 3.0")))
    (solutions / "tripling.py").write_text('"""Tripling."""\n\n\ndef triple(x):\n    return 3 * x\n')
    entry = 'mistakes(\n    "{}",\n    "It is {}.",\n    "Mend it.",\n).edit("triple", {{"3 * x": "{}"}})\n'
    more = "".join(entry.format(code, rule, rule) for code, rule in [*WRONG.items()][1:])
    fill(
        mistakes(mini),
        ["DOUBLES", "It is 2 * x.", "Mend it.", "3 * x", "2 * x", "Adds.", "adds", "Sums.", "sums"],
    )
    edit(mistakes(mini), "\nmistakes.accept(", f"{more}\nmistakes.accept(")
    text = mistakes(mini).read_text()
    for name, rule in (("adds", "x + x + x"), ("sums", "sum([x] * 3)")):
        text = text.replace(f'raise NotImplementedError("{name}")', f"return {rule}")
    mistakes(mini).write_text(text)
    rebuilt()
    return student


def mistakes(mini):
    return mini / "solutions/warm-ups/tripling/mistakes.py"


def fill(path, words):
    text = path.read_text()
    for word in words:
        text = re.sub(r"<<FILL IN[^>]*>>", lambda _, word=word: word, text, count=1)
    path.write_text(text)


def rebuilt():
    catalog = Catalog()
    forget()
    build(catalog, catalog.exercise("tripling"))
    forget()


def problems():
    """What the audit says by reading alone."""
    return [one.message for one in audit(Catalog(), "tripling", grade=lambda _: ()).problems]


def test_a_new_warm_up_passes_the_audit_once_its_blanks_are_filled(tripling):
    report = audit(Catalog(), "tripling")
    assert [f"{p.where} {p.message} {p.help}" for p in report.problems] == []
    assert report.graded == 2 + 2 + 3
    catalog = Catalog()
    assert catalog.exercise_ids() == ("doubling", "halving"), "the exercises are what they were"
    assert [one.id for one in catalog.warm_ups("half-as-much")] == ["tripling"]


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("exercise.toml", "the-way-back", "nowhere", "has no section 'nowhere'"),
        ("exercise.toml", '    "What is once more than twice?",\n', "", "has 1 hint, and needs 2"),
        ("README.md", "# Tripling", "Tripling", "the title is missing"),
    ],
)
def test_the_audit_sees_what_a_warm_up_lacks(tripling, file, old, new, said):
    edit(tripling / file, old, new)
    assert any(said in message for message in problems()), problems()


def test_warm_ups_that_are_not_in_the_order_of_their_sections_are_named(mini, tripling):
    lesson = mini / "lessons/half-as-much.md"
    lesson.write_text(lesson.read_text() + "\n## And on\n\nOnce more.\n")
    other = tripling.with_name("quadrupling")
    shutil.copytree(tripling, other)
    declared = (other / "exercise.toml").read_text().replace('"tripling"', '"quadrupling"')
    first = re.search(r"^order = (\d+)", declared, re.MULTILINE)
    path = tripling / "exercise.toml"
    path.write_text(path.read_text().replace(first[0], "order = 9"))
    for section, wrong in (("and-on", True), ("the-way-back", False), ("", True)):
        text = declared.replace('after = "the-way-back"', f'after = "{section}"')
        (other / "exercise.toml").write_text(text if section else text.replace('after = ""\n', ""))
        said = f"warm-up quadrupling has a lower order, {first[1]}, and its section comes later."
        assert (said in problems()) is wrong


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("mistakes.accept(", "accepted variants: 1, and an exercise of this size has at least 2"),
        ('mistakes(\n    "CUBES"', "mutants: 2, and an exercise of this size has at least 3"),
    ],
)
def test_the_audit_counts_the_programs_of_a_warm_up(tripling, mini, entry, said):
    above, _, after = mistakes(mini).read_text().rpartition(entry)
    mistakes(mini).write_text(above + "".join(after.partition("\nmistakes")[1:]))
    rebuilt()
    assert any(said in message for message in problems())


def test_a_stale_table_is_refused(tripling):
    path = tripling / "checks.py"
    path.write_text(path.read_text() + "\n#: Another thought.\n")
    assert any("made from other questions" in message for message in problems())


def test_a_table_that_is_missing_is_named_and_made(tripling, capsys):
    table = table_path(tripling)
    before = table.read_bytes()
    table.unlink()
    forget()
    assert problems() == ["it has nothing on tripling."]
    assert run(["author", "build", "tripling"]) == 0
    assert "Wrote exercises/warm-ups/diagnoses.json" in capsys.readouterr().out
    assert table.read_bytes() == before
    assert problems() == []


def test_warm_ups_share_a_table_that_forgets_those_that_are_gone(tripling):
    path = table_path(tripling)
    assert path == tripling.parent / "diagnoses.json"
    tables = json.loads(path.read_bytes())
    (tripling.parent / "other").mkdir()
    tables |= {"other": tables["tripling"], "gone": tables["tripling"]}
    path.write_text(json.dumps(tables))
    edit(tripling / "checks.py", "Count.", "Count again.")
    rebuilt()
    built = json.loads(path.read_bytes())
    assert sorted(built) == ["other", "tripling"]
    assert built["other"] == tables["other"], "it is not built anew"
    assert built["tripling"]["made_from"] != tables["tripling"]["made_from"]


def test_questions_that_are_missing_are_named(tripling):
    edit(tripling / "checks.py", "QUESTIONS", "ANSWERS")
    assert ["what would tell wrong programs apart?" in message for message in problems()] == [True]


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ('"tripel", ("CUBES",)', "'tripel' is no function of the exercise"),
        ('"triple", ("CUBED",)', "no words for CUBED"),
    ],
)
def test_a_hypothesis_that_fits_nothing_is_named(tripling, mini, program, said):
    more = f"\n\n@mistakes.more\ndef others():\n    yield {program}, lambda x: x**3\n"
    mistakes(mini).write_text(mistakes(mini).read_text() + more)
    with pytest.raises(ContentError, match=said):
        rebuilt()


def test_a_question_about_no_function_is_named(tripling):
    edit(tripling / "checks.py", '    "triple": [', '    "threefold": [')
    with pytest.raises(ContentError, match=r"checks\.py: 'threefold' is no function of the exercise"):
        rebuilt()


def test_a_code_that_only_a_mutant_names_wants_another_question(tripling):
    path = tripling / "checks.py"
    path.write_text(re.sub(r"(?s)QUESTIONS = .*", 'QUESTIONS = {"triple": [(0.0,)]}\n', path.read_text()))
    rebuilt()
    assert any("nothing gives the diagnosis CUBES" in message for message in problems()), problems()


def test_what_is_true_of_one_run_is_no_cause(tripling, mini):
    edit(mistakes(mini), "It is 2 * x.", "Here it is 2 * x.")
    rebuilt()
    assert problems() == ["DOUBLES is about one run, but as a cause it is said by every check of its task."]


def test_a_table_is_the_same_whenever_it_is_built(tripling, mini):
    """A wrong program with chance of its own answers otherwise each time, so no answer is known of it."""
    edit(mistakes(mini), 'x**3"', "__import__('random').random()\"")
    built = []
    for _ in range(2):
        rebuilt()
        built.append(table_path(tripling).read_bytes())
    assert built[0] == built[1]
    table = read_table(tripling)
    assert {row.codes for row in table.rows["triple"]} == {("DOUBLES",), ("ADDS_THREE",)}


def test_a_warm_up_lies_with_the_warm_ups(tripling):
    path = tripling / "exercise.toml"
    path.write_text(path.read_text().replace('kind = "warm-up"\n', ""))
    with pytest.raises(ContentError, match="`kind` is exercise, and the folder lies in warm-ups"):
        Catalog().exercise("tripling")


def test_no_exercise_and_warm_up_share_an_id(mini):
    with pytest.raises(UsageError):
        new_exercise(Catalog(), "halving", lesson="half-as-much", warm_up=True)
