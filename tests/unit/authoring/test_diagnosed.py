"""An exercise with words beside its wrong programs, as its author builds it."""

import json
import shutil

import pytest

from course.authoring.audit import audit
from course.authoring.exercises.grading import grade_sources
from course.catalog.load import Catalog
from course.cli.frame.app import run
from course.scoring.explain.story import read_table
from tests.unit.authoring.conftest import MINI, edit, forget

WORDS = '"INTEGER_DIVISION", "The fraction is lost.", "Use / and not //."'


@pytest.fixture
def halving(mini):
    """Its folder for students; its mistake has words, and there are questions."""
    return with_words(mini)


def with_words(mini):
    folder = mini / "exercises" / "halving"
    (folder / "questions.py").write_text(
        '"""Q."""\n\nQUESTIONS = {"halve": [(7,), (-3,), (0.5,), (-8.0,)]}\n'
    )
    edit(mistakes(mini), '"INTEGER_DIVISION"', WORDS)
    return folder


@pytest.fixture(scope="module")
def accepted_once(tmp_path_factory, sandboxes):
    """A course in which that is built and accepted."""
    course = shutil.copytree(MINI, tmp_path_factory.mktemp("accepted") / "mini")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COURSE_CONTENT", str(course))
        with_words(course)
        assert run(["author", "build", "halving", "--accept"]) == 0
    return course


@pytest.fixture
def accepted(accepted_once, mini):
    """The folder for students of a copy of it."""
    shutil.copytree(accepted_once, mini, dirs_exist_ok=True)
    forget()
    return mini / "exercises" / "halving"


def mistakes(mini):
    return mini / "solutions" / "halving" / "mistakes.py"


def problems(grade=lambda _: ()):
    """What the audit says by reading alone, unless something grades."""
    forget()
    found = audit(Catalog(), "halving", grade=grade).problems
    return [f"{one.where}: {one.message} {one.help}" for one in found]


def test_what_an_author_writes_is_built_and_right(halving, capsys):
    assert run(["author", "build", "halving", "--accept"]) == 0
    out = capsys.readouterr().out
    assert "Wrote exercises/halving/diagnoses.json" in out
    assert "Wrote solutions/halving/record.json" in out
    assert "was by" not in out
    assert problems(grade_sources) == []
    assert run(["author", "build", "halving"]) == 0
    assert "up to date" in capsys.readouterr().out


def test_a_mistake_that_never_ends_is_named_and_prints_nothing(halving, mini, monkeypatch, capsys):
    monkeypatch.setattr("course.authoring.exercises.diagnosis._PATIENCE", 0.5)
    loops = 'mistakes("LOOPS", "It loops.", "End it.").body("halve", "print(1)\\nwhile True: pass")'
    with mistakes(mini).open("a") as file:
        file.write(f"\n{loops}\n")
    for command in (["build", "halving"], ["check", "halving"]):
        assert run(["author", *command]) != 0
        told = " ".join(capsys.readouterr())
        assert "halve: after 0 s LOOPS left the questions unanswered." in told
        assert "mistakes.py:" in told
        assert "\n1\n" not in told


def test_a_question_that_nobody_can_be_asked_is_named(halving):
    edit(halving / "questions.py", "(-3,)", "(-3, 4)")
    assert any("question 2 of halve cannot be asked: too many" in one for one in problems())


def test_questions_say_how_many_programs_with_two_mistakes_are_kept(halving, mini):
    with mistakes(mini).open("a") as file:
        file.write(
            '\nmistakes("SHIFTED", "It is shifted.", "Add nothing.")\n\n\n@mistakes.more\ndef others():\n'
            "    for n in range(1, 9):\n"
            '        yield "halve", ("INTEGER_DIVISION", "SHIFTED"), lambda x, n=n: x // 2 + n\n'
        )
    text, kept = (halving / "questions.py").read_text(), []
    for most in ("", "PAIRS = 4\n", "PAIRS = 1 + 1\n"):  # no two of a length
        (halving / "questions.py").write_text(text + most)
        forget()
        run(["author", "build", "halving"])
        (rows,) = read_table(halving).rows.values()
        kept.append(sum(len(row.codes) == 2 for row in rows))
    assert kept == [8, 4, 2]


def test_a_probe_that_was_loaded_before_knows_a_code_that_is_new(halving, mini):
    """One command loads it with the questions, then writes the words, then grades with both."""
    questions, hidden = halving / "questions.py", mini / "graders" / "halving" / "checks.py"
    edit(questions, '"""Q."""', 'from course.scoring import kit\n\nNAMED = kit.words("halving")')
    edit(hidden, "@pytest", 'named = kit.companion("halving", "questions").NAMED\n\n@pytest')
    edit(hidden, 'diagnose="INTEGER_DIVISION"', 'diagnose=lambda: named("INTEGER_DIVISION")')
    assert run(["author", "build", "halving", "--accept"]) == 0
    record = json.loads((mini / "solutions/halving/record.json").read_text())
    assert record["rows"]["alone"] == [["halve", ["INTEGER_DIVISION"], "INTEGER_DIVISION", 4]]


def test_other_words_ask_for_a_build_and_for_no_other_record(accepted, mini):
    edit(mistakes(mini), "Use / and not //.", "Divide with a single stroke.")
    (stale,) = problems()
    assert stale.startswith("exercises/halving/diagnoses.json: it was made from other questions, mistakes or")
    assert run(["author", "build", "halving"]) == 0
    assert problems() == []
    table = read_table(accepted)
    assert table.words["INTEGER_DIVISION"].advice == "Divide with a single stroke."


def test_a_program_that_lost_its_check_or_its_name_is_printed_before_it_is_accepted(accepted, mini, capsys):
    record = mini / "solutions/halving/record.json"
    kept = json.loads(record.read_text())
    kept["caught"]["halve.INTEGER_DIVISION"] = "an_older_check"
    record.write_text(json.dumps(kept))
    graded = problems(grade_sources)
    assert "is caught by an_older_check on record, and there is no such check" in graded[0]
    edit(mistakes(mini), '"int(x / 2)"', '"[x / 2]"')
    assert run(["author", "build", "halving"]) == 0
    said = "The record of halving is older than its files: course author build halving --accept"
    assert said in " ".join(capsys.readouterr().out.split())
    assert any("record of what wrong programs are told is out of date" in one for one in problems())
    assert run(["author", "build", "halving", "--accept"]) == 0
    out = capsys.readouterr().out
    assert "halve.INTEGER_DIVISION: caught by half_of_odd, and was by an_older_check." in out
    assert "halve.INTEGER_DIVISION.4: told" in out
    assert "not INTEGER_DIVISION." in out
    assert [one for one in problems(grade_sources) if "not as INTEGER_DIVISION" not in one] == []


def test_what_is_lost_with_a_check_is_printed(accepted, mini, capsys):
    """A check names a mistake no longer, no question tells it apart, and a program has become right."""
    edit(mini / "graders/halving/checks.py", '        diagnose="INTEGER_DIVISION",\n', "")
    edit(accepted / "questions.py", "(7,), (-3,), (0.5,), (-8.0,)", "(8,)")
    edit(mistakes(mini), '"round(x / 2)"', '"0.5 * x"')
    assert run(["author", "build", "halving", "--accept"]) == 0
    out = capsys.readouterr().out
    assert "halve.INTEGER_DIVISION.3: caught by no check, and was by half_of_odd." in out
    assert "halve.INTEGER_DIVISION: told nothing, not INTEGER_DIVISION." in out
    assert "halve: INTEGER_DIVISION is no longer named." in out


def test_a_record_that_is_missing_damaged_or_of_other_programs_is_named(accepted, mini):
    record, again = mini / "solutions/halving/record.json", "Run `course author build halving --accept`"
    kept = record.read_bytes()
    record.unlink()
    (missing,) = problems()
    assert missing.startswith(f"solutions/halving/record.json: it is missing. {again}")
    record.write_text("{")
    (damaged,) = problems()
    assert damaged.startswith("solutions/halving/record.json: it cannot be read")
    record.write_bytes(kept.replace(b'"halve.INTEGER_DIVISION.4"', b'"halve.ROUNDED"'))
    (stale,) = problems()
    assert stale.startswith("solutions/halving/record.json: the record of what wrong programs")
    assert again in stale


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("@mistakes.more\ndef others():\n    yield from [1 / 0]\n", 14, "it raises ZeroDivisionError"),
        ("def others(:\n", 12, "it raises SyntaxError"),
        ("import nothing_of_that_name\n", 12, "nothing_of_that_name"),
        ('@mistakes.more\ndef others():\n    yield "halve"\n', None, "it raises ValueError"),
        ('@mistakes.more\ndef o():\n    yield "halve", ("NO_WORDS",), abs\n', None, "no words for NO_WORDS"),
        ('mistakes("INTEGER_DIVISION", "A.", "B.")\n', 12, "INTEGER_DIVISION has words twice"),
        ('mistakes("OTHER", "A.", "B.", kind="guess")\n', 12, "'guess' is none of the kinds cause,"),
        ("mistakes = None\n", 1, "it makes no `mistakes`"),
    ],
)
def test_mistakes_that_cannot_be_used_are_named_and_nothing_is_left_half_made(
    halving, mini, capsys, text, line, says
):
    path = mistakes(mini)
    path.write_text(f"{path.read_text()}\n{text}")
    before = path.with_name("record.json").read_bytes()
    assert run(["author", "build", "halving", "--accept"]) == 70
    said = capsys.readouterr().err
    assert says in said
    assert f"mistakes.py:{line}:" in said or (line is None and "mistakes.py: " in said)
    assert "A fault in the course, not in your work" not in said
    assert path.with_name("record.json").read_bytes() == before
    assert not (halving / "diagnoses.json").exists()
    found = problems()
    assert says in found[0], "before the advice to build what cannot be built"


def test_questions_and_programs_that_raise_are_named(halving, mini, capsys):
    edit(halving / "questions.py", "QUESTIONS", "1 / 0\nQUESTIONS")
    assert run(["author", "build", "halving"]) == 70
    assert "questions.py:3: it raises ZeroDivisionError" in capsys.readouterr().err
    edit(halving / "questions.py", "1 / 0\n", "")
    path = mistakes(mini)
    path.write_text(path.read_text() + 'mistakes("INTEGER_DIVISION").program("halve", "1 / 0")\n')
    forget()
    assert run(["author", "build", "halving"]) == 70
    assert "mistakes.py:11: it raises ZeroDivisionError" in capsys.readouterr().err


def test_what_is_out_of_date_comes_after_what_it_follows_from(accepted, mini):
    shutil.copy(accepted / "halving.py", mini / "solutions/halving/accepted/unfinished.py")
    (accepted / "README.md").write_text("# Halving\n")
    found = problems()
    assert "diagnoses.json" in found[-1]
    assert "README does not show" in " ".join(found[:-1])
