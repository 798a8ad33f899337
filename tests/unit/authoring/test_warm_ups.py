"""Warm-ups: what the scaffold writes passes the audit once it is filled, and the audit misses nothing."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest

from course.authoring.audit import audit
from course.authoring.exercises.diagnosis import build
from course.authoring.scaffold import Function, new_warm_up
from course.catalog.load import Catalog
from course.cli.frame.app import run
from course.errors import ContentError, UsageError
from course.scoring.checks import collected
from course.scoring.explain.story import read_table, read_words

WORDS = {
    "exercise.toml": ["Tripling", "the-way-back", "Three times.", "Three times a number"],
    "README.md": ["Tripling", "It is about three.", "gives three times `x`.", "Numbers must agree."],
    "tripling.py": ["Tripling.", "Three times ``x``."],
    "hints.toml": ["What is once more than twice?", "Return 3 * x."],
    "checks.py": ["Three times one is three", "", "exact", "It is not three times the number.", "Count."],
    "questions.py": [""],
    "diagnoses.toml": [],
}
WRONG = {"DOUBLES": "2 * x", "ADDS_THREE": "3 + x", "CUBES": "x**3"}


@pytest.fixture
def tripling(mini: Path) -> Path:
    """A warm-up of the mini course with every blank filled, as an author would."""
    new_warm_up(Catalog(), "tripling", [Function.parse("triple(x)")], lesson="half-as-much")
    student, solutions = mini / "exercises/warm-ups/tripling", mini / "solutions/warm-ups/tripling"
    for name, words in WORDS.items():
        fill(student / name, words)
    checks = (student / "checks.py").read_text()
    (student / "checks.py").write_text(
        checks.replace("expected = 1.0", "expected = 3.0").replace("  # \n", "\n")
    )
    tables = [
        f'[diagnosis.{code}]\nlooks_like = "It is {rule}."\nadvice = "Mend it."'
        for code, rule in WRONG.items()
    ]
    (student / "diagnoses.toml").write_text("format_version = 1\n\n" + "\n\n".join(tables) + "\n")
    (solutions / "tripling.py").write_text('"""Tripling."""\n\n\ndef triple(x):\n    return 3 * x\n')
    for number, rule in ((1, "x + x + x"), (2, "sum([x] * 3)")):
        (solutions / f"accepted/unusual_{number}.py").write_text(
            f'"""Adds."""\n\n\ndef triple(x):\n    return {rule}\n'
        )
    entries = (solutions / "mutants.toml").read_text()
    for number, (code, rule) in enumerate(WRONG.items(), 1):
        (solutions / f"mutants/triple_wrong_{number}.py").write_text(
            f'"""{code}."""\n\n\ndef triple(x):\n    return {rule}\n'
        )
        for word in ("It is right.", code):
            entries = re.sub(r"<<FILL IN[^>]*>>", word, entries, count=1)
    (solutions / "mutants.toml").write_text(entries)
    rebuilt()
    return student


def fill(path: Path, words: list[str]) -> None:
    text = path.read_text()
    for word in words:
        text = re.sub(r"<<FILL IN[^>]*>>", lambda _, word=word: word, text, count=1)
    path.write_text(text)


def rebuilt() -> None:
    catalog = Catalog()
    collected._load.cache_clear()
    build(catalog, catalog.exercise("tripling"))
    read_table.cache_clear()
    read_words.cache_clear()


def problems() -> list[str]:
    return [f"{problem.message}" for problem in audit(Catalog(), "tripling").problems]


def test_a_new_warm_up_passes_the_audit_once_its_blanks_are_filled(tripling: Path) -> None:
    report = audit(Catalog(), "tripling")
    assert [f"{p.where} {p.message} {p.fix}" for p in report.problems] == []
    assert report.graded == 2 + 2 + 3
    catalog = Catalog()
    assert catalog.exercise_ids() == ("doubling", "halving"), "the exercises are what they were"
    assert [one.id for one in catalog.warm_ups("half-as-much")] == ["tripling"]


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("exercise.toml", "the-way-back", "nowhere", "has no section 'nowhere'"),
        ("hints.toml", '"What is once more than twice?", ', "", "has 1 hint, and needs 2"),
        ("README.md", "# Tripling", "Tripling", "the title is missing"),
        ("diagnoses.toml", "[diagnosis.CUBES]", "[diagnosis.FOURTH]", "no words for CUBES"),
    ],
)
def test_the_audit_sees_what_a_warm_up_lacks(
    tripling: Path, file: str, old: str, new: str, said: str
) -> None:
    text = (
        " ".join((tripling / file).read_text().split("\n    "))
        if file == "hints.toml"
        else (tripling / file).read_text()
    )
    assert old in text
    (tripling / file).write_text(text.replace(old, new))
    read_words.cache_clear()
    assert any(said in message for message in problems()), problems()


def test_warm_ups_that_are_not_in_the_order_of_their_sections_are_named(mini: Path, tripling: Path) -> None:
    lesson = mini / "lessons/half-as-much.md"
    lesson.write_text(lesson.read_text() + "\n## And on\n\nOnce more.\n")
    other = tripling.with_name("quadrupling")
    shutil.copytree(tripling, other)
    declared = (other / "exercise.toml").read_text().replace('"tripling"', '"quadrupling"')
    first = re.search(r"^order = (\d+)", declared, re.MULTILINE)
    assert first is not None
    path = tripling / "exercise.toml"
    path.write_text(path.read_text().replace(first[0], "order = 9"))
    for section, wrong in (("and-on", True), ("the-way-back", False), ("", True)):
        text = declared.replace('after = "the-way-back"', f'after = "{section}"')
        (other / "exercise.toml").write_text(text if section else text.replace('after = ""\n', ""))
        said = f"warm-up quadrupling has a lower order, {first[1]}, and its section comes later."
        assert (said in problems()) is wrong


@pytest.mark.parametrize(
    ("folder", "said"),
    [
        ("accepted", "accepted variants: 1, and an exercise of this size has at least 2"),
        ("mutants", "mutants: 2, and an exercise of this size has at least 3"),
    ],
)
def test_the_audit_counts_the_programs_of_a_warm_up(
    tripling: Path, mini: Path, folder: str, said: str
) -> None:
    path = sorted((mini / "solutions/warm-ups/tripling" / folder).iterdir())[-1]
    path.unlink()
    entries = mini / "solutions/warm-ups/tripling/mutants.toml"
    if folder == "mutants":
        entries.write_text(entries.read_text().rpartition("[[mutant]]")[0])
    rebuilt()
    assert any(said in message for message in problems())


def test_a_stale_table_is_refused(tripling: Path) -> None:
    path = tripling / "questions.py"
    path.write_text(path.read_text() + "\n#: Another thought.\n")
    assert any("made from other questions" in message for message in problems())


def test_a_table_that_is_missing_is_named_and_made(
    tripling: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tripling / "hypotheses.json"
    before = table.read_bytes()
    table.unlink()
    read_table.cache_clear()
    assert problems() == ["it is missing."]
    assert run(["author", "build", "tripling"]) == 0
    assert "Wrote exercises/warm-ups/tripling/hypotheses.json" in capsys.readouterr().out
    assert table.read_bytes() == before
    assert problems() == []


def test_questions_that_are_missing_are_named(tripling: Path) -> None:
    (tripling / "questions.py").unlink()
    assert ["what would tell wrong programs apart?" in message for message in problems()] == [True]


def test_a_build_without_questions_says_that_they_are_missing(
    tripling: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tripling / "questions.py").unlink()
    assert run(["author", "build", "tripling"]) == ContentError.exit_code
    assert "questions.py: it is missing" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ('"tripel", ("CUBES",)', "'tripel' is no function of the exercise"),
        ('"triple", ("CUBED",)', "no words for CUBED"),
    ],
)
def test_a_hypothesis_that_fits_nothing_is_named(tripling: Path, mini: Path, program: str, said: str) -> None:
    path = mini / "solutions/warm-ups/tripling/hypotheses.py"
    path.write_text(f"def hypotheses():\n    yield {program}, lambda x: x**3\n")
    with pytest.raises(ContentError, match=said):
        rebuilt()


def test_a_question_about_no_function_is_named(tripling: Path) -> None:
    path = tripling / "questions.py"
    path.write_text(path.read_text().replace('"triple"', '"threefold"'))
    with pytest.raises(ContentError, match=r"questions\.py: 'threefold' is no function of the exercise"):
        rebuilt()


def test_a_code_that_only_a_mutant_names_wants_another_question(tripling: Path) -> None:
    path = tripling / "questions.py"
    path.write_text(re.sub(r"(?s)QUESTIONS = .*", 'QUESTIONS = {"triple": [(0.0,)]}\n', path.read_text()))
    rebuilt()
    assert any("nothing gives the diagnosis CUBES" in message for message in problems()), problems()


def test_words_without_an_entry_are_told_to_have_a_table(tripling: Path) -> None:
    (tripling / "diagnoses.toml").write_text("format_version = 1\n")
    read_words.cache_clear()
    fixes = [problem.fix for problem in audit(Catalog(), "tripling").problems]
    assert fixes == ["Add a table `[diagnosis.NAME]`."]


def test_what_is_true_of_one_run_is_no_cause(tripling: Path) -> None:
    words = tripling / "diagnoses.toml"
    words.write_text(words.read_text().replace("It is 2 * x.", "Here it is 2 * x."))
    read_words.cache_clear()
    assert problems() == ["DOUBLES is about one run, but as a cause it is said by every check of its task."]


def test_a_table_is_the_same_whenever_it_is_built(tripling: Path, mini: Path) -> None:
    """A wrong program with chance of its own answers otherwise each time, so no answer is known of it."""
    wrong = mini / "solutions/warm-ups/tripling/mutants/triple_wrong_3.py"
    wrong.write_text('"""Guesses."""\n\n\ndef triple(x):\n    import random\n    return random.random()\n')
    built = []
    for _ in range(2):
        rebuilt()
        built.append((tripling / "hypotheses.json").read_bytes())
    assert built[0] == built[1]
    rows = read_table(tripling / "hypotheses.json").rows["triple"]
    assert {row.codes for row in rows} == {("DOUBLES",), ("ADDS_THREE",)}


def test_a_warm_up_lies_with_the_warm_ups(tripling: Path) -> None:
    path = tripling / "exercise.toml"
    path.write_text(path.read_text().replace('kind = "warm-up"\n', ""))
    with pytest.raises(ContentError, match="`kind` is exercise, and the folder lies in warm-ups"):
        Catalog().exercise("tripling")


def test_no_exercise_and_warm_up_share_an_id(mini: Path) -> None:
    with pytest.raises(UsageError):
        new_warm_up(Catalog(), "halving", lesson="half-as-much")
