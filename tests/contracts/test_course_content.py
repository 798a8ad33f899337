"""The course that is shipped is right: its own audit says so, and it has what every exercise promises."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from course.authoring.audit import audit
from course.authoring.exercises.kill_table import kill_table
from course.authoring.exercises.variants import accepted_files
from course.catalog.load import Catalog

if TYPE_CHECKING:
    from course.authoring.report import AuditReport
    from course.catalog.models import Exercise

#: What the README promises of every exercise.
LEAST_ACCEPTED = 4
LEAST_MUTANTS = 10


@pytest.fixture(scope="module")
def catalog() -> Catalog:
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("COURSE_CONTENT", raising=False)
        return Catalog()


def exercises() -> list[str]:
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("COURSE_CONTENT", raising=False)
        return list(Catalog().exercise_ids())


@pytest.fixture(scope="module")
def report(catalog: Catalog) -> AuditReport:
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("COURSE_CONTENT", raising=False)
        return audit(catalog)


def test_the_audit_finds_nothing_wrong(report: AuditReport) -> None:
    assert [f"{p.where}: {p.message} {p.fix}" for p in report.problems] == []


def test_the_audit_looked_at_everything(report: AuditReport, catalog: Catalog) -> None:
    assert set(report.lessons) == {path.stem for path in catalog.content.lessons.glob("*.md")}
    assert set(report.exercises) == {
        path.name for path in catalog.content.exercises.iterdir() if path.is_dir()
    }
    variants = sum(
        len(accepted_files(catalog, exercise)) + len(catalog.mutants(exercise))
        for exercise in catalog.exercises()
    )
    assert report.graded == 2 * len(report.exercises) + variants


@pytest.mark.parametrize("exercise_id", exercises())
def test_an_exercise_has_enough_to_prove_its_checks(catalog: Catalog, exercise_id: str) -> None:
    exercise: Exercise = catalog.exercise(exercise_id)
    assert len(accepted_files(catalog, exercise)) >= LEAST_ACCEPTED
    assert len(catalog.mutants(exercise)) >= LEAST_MUTANTS
    diagnoses = {mutant.diagnosis for mutant in catalog.mutants(exercise)}
    assert len(diagnoses) > len(exercise.task) / 2, "diagnoses tell mistakes apart"


@pytest.mark.parametrize("exercise_id", exercises())
def test_a_stub_explains_every_function(catalog: Catalog, exercise_id: str) -> None:
    import ast

    exercise = catalog.exercise(exercise_id)
    tree = ast.parse(exercise.stub_path.read_text(encoding="utf-8"))
    bare = [n.name for n in tree.body if isinstance(n, ast.FunctionDef) and not ast.get_docstring(n)]
    assert bare == []


def test_the_page_of_what_graders_catch_is_up_to_date(catalog: Catalog) -> None:
    page = catalog.content.root / "docs" / "graders.md"
    assert page.read_text(encoding="utf-8") == kill_table(catalog), (
        "run `course author mutants --table docs/graders.md`"
    )
