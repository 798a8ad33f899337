"""What CONTRIBUTING.md shows an author works: every example is run, and every name of the kit has one."""

import re
import shutil
import textwrap
from pathlib import Path

import pytest

from course.authoring.exercises.diagnosis import build
from course.catalog.load import Catalog
from course.figures import contact, registry
from course.figures.looks import faults
from course.scoring import kit
from course.scoring.checks.collected import words as known_words
from course.scoring.judging.session import GradingSession, report_of
from course.scoring.judging.submission import Submission
from course.scoring.verdict import Status

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
FUNCTIONS = ("double", "doublings", "describe", "step", "push", "strength", "table")
#: Gives what none of the checks wants, whatever it is asked.
WRONG = "\n".join(
    f"def {name}(*args):\n    return {'args[0] * args[0]' if name == 'double' else 'None'}\n"
    for name in FUNCTIONS
)


def blocks(kind):
    """The blocks of one kind, in order."""
    return re.findall(rf"^```python {kind}\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


def checks():
    """The examples as a file of checks, each with the markers that the page leaves out."""
    parts = ["import numpy as np\nimport pytest\n\nfrom course.scoring import kit\n", *blocks("top")]
    parts += [block.replace('@pytest.mark.requires("other_check")', "#") for block in blocks("check")]
    for number, body in enumerate(blocks("example")):
        parts.append(
            f'@pytest.mark.task("double")\n@pytest.mark.points(1)\n'
            f'def test_example_{number}(submission):\n    """Example {number}"""\n'
            + textwrap.indent(body, "    ")
        )
    return "\n\n".join(parts)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A course with the exercise that the page is about."""
    root = tmp_path_factory.mktemp("growth")
    shutil.copytree(ROOT / "tests" / "fixtures" / "mini_course", root, dirs_exist_ok=True)
    folder = root / "exercises" / "growth"
    shutil.copytree(root / "exercises" / "halving", folder)
    (folder / "checks.py").write_text(checks())
    (folder / "checking").mkdir()
    diagnosis = "from course.scoring import kit\n\n" + blocks("diagnosis")[0]
    (folder / "checking" / "diagnosis.py").write_text(diagnosis)
    (folder / "report.py").write_text("from course.scoring import kit\n\n" + blocks("report")[0])
    (folder / "exercise.toml").write_text(
        'format_version = 1\nid = "growth"\ntitle = "Growth"\nmodule = "growth.py"\norder = 9\n'
        'lesson = "half-as-much"\nsummary = "It grows."\n[[task]]\nid = "double"\ntitle = "D"\npoints = 9\n'
    )
    return root


@pytest.fixture
def growth(written, monkeypatch):
    """That course, in use."""
    monkeypatch.setenv("COURSE_CONTENT", str(written))
    return Catalog()


def graded(catalog, source):
    exercise = catalog.exercise("growth")
    with GradingSession(exercise, catalog, scope="public") as session:
        verdict = session.grade(Submission({exercise.module: source.encode()}))
    return {check.id: check for check in verdict.checks}


def test_every_example_passes_on_the_submission_that_the_page_shows(growth):
    found = graded(growth, blocks("submission")[0])
    assert len(found) == 1 + len(blocks("example"))
    assert {name: check.message for name, check in found.items() if check.status is not Status.PASS} == {}


def test_every_example_can_fail_and_the_diagnosis_is_found(growth):
    found = graded(growth, WRONG)
    assert [name for name, check in found.items() if check.status is Status.PASS] == []
    assert [name for name, check in found.items() if check.status is Status.GRADER_ERROR] == []
    assert found["double_of_three"].diagnosis == "SQUARES_INSTEAD"


@pytest.fixture
def known(growth):
    """The same exercise, with its words and wrong programs as data."""
    student, instructor = (growth.content.root / part / "growth" for part in ("exercises", "solutions"))
    instructor.mkdir()
    (instructor / "growth.py").write_text(blocks("submission")[0])
    (student / "questions.py").write_text(blocks("questions")[0])
    imported = "from course.authoring.mistakes import Mistakes\n"
    (instructor / "mistakes.py").write_text(imported + blocks("mistakes")[0])
    yield growth
    shutil.rmtree(instructor)
    for name in ("questions.py", "diagnoses.json"):
        (student / name).unlink(missing_ok=True)


def test_a_wrong_program_that_is_known_by_its_answers_is_told_the_words_of_its_code(known):
    """And not those of the function that looks for the mistake, which are others."""
    assert build(known, known.exercise("growth"))
    source = blocks("submission")[0] + "\ndef double(x):\n    return x * abs(x)\n"
    found = graded(known, source)
    without = next(f"example_{n}" for n, body in enumerate(blocks("example")) if '("double", [' in body)
    for name in ("double_of_three", without):  # the second has no such function
        assert found[name].diagnosis == "SQUARES_INSTEAD"
        assert found[name].message.endswith(known_words("growth")("SQUARES_INSTEAD").looks_like)


def test_the_figure_of_the_page_can_be_drawn_and_read(tmp_path, monkeypatch):
    (source,) = blocks("figure")
    module = {}
    exec(source, module)
    monkeypatch.setitem(registry.FIGURES, "contact-bounce", ("contact", "bounce"))
    monkeypatch.setattr(contact, "bounce", module["bounce"], raising=False)
    (fault,) = faults("contact-bounce", tmp_path)
    assert "has no picture to be compared with" in fault.problem
    assert "course author pictures contact-bounce" in TEXT


def test_the_report_shows_both_sections(growth):
    source = Submission({"growth.py": blocks("submission")[0].encode()})
    made = report_of(growth.exercise("growth"), growth, source)
    assert [section.title for section in made.sections] == ["Once", "Often"]
    assert made.sections[0].rows == (("1.5", "3"),)


def test_every_name_of_the_kit_is_on_the_page():
    code = "\n".join(re.findall(r"^```python \w+\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL))
    named = set(re.findall(r"kit\.(\w+)", TEXT))
    assert named - set(kit.__all__) == set()
    assert set(kit.__all__) - named == set()
    # What is used with others is told in a sentence; whatever stands alone has an example that is run.
    told = {"Words", "fail", "finding_for", "in_range", "known_answers", "reference", "sibling", "words"}
    types = {name for name in kit.__all__ if name[0].isupper()} - {
        "Diagnosis",
        "Problem",
        "Report",
        "Section",
    }
    assert set(kit.__all__) - set(re.findall(r"kit\.(\w+)", code)) <= told | types
