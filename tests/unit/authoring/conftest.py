"""A copy of the miniature course to break, and a grader that answers without running anything."""

import contextlib
import shutil
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from course.authoring.audit import audit
from course.authoring.exercises.files import declared
from course.authoring.exercises.grading import accepted_files, mistakes_of, solution_path, source_of
from course.authoring.exercises.proofs import caught_by
from course.authoring.exercises.source import CheckSource
from course.authoring.report import AuditReport, AuthorProblem
from course.catalog.load import Catalog
from course.catalog.locate import content
from course.catalog.models import Exercise
from course.errors import ContentError
from course.scoring.checks import collected
from course.scoring.explain.story import forget_tables
from course.scoring.verdict import CheckResult, Status, Verdict, Visibility

MINI = Path(__file__).parents[2] / "fixtures" / "mini_course"


def edit(path: Path, old: str, new: str) -> None:
    """Replace the first ``old`` in a file of the course; it must be there."""
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    forget()


def forget() -> None:
    """What was read of checks and tables before is read anew."""
    collected._load.cache_clear()
    forget_tables()


def line_of(path: Path, text: str) -> int:
    """The line of a file that holds a text."""
    return next(n for n, line in enumerate(path.read_text().split("\n"), start=1) if text in line)


@pytest.fixture
def mini(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, sandboxes: None) -> Path:
    """The folder of a private copy of the miniature course, in use as the course."""
    folder = (tmp_path / "mini").resolve()
    shutil.copytree(MINI, folder)
    monkeypatch.setenv("COURSE_CONTENT", str(folder))
    return folder


class Oracle:
    """Grades as the miniature course means to be graded, by looking at the first words of a file.

    Attributes:
        changes: what to answer differently: file name (of stub, solution or variant) to a function from the
            right verdict to the one to give.
        graded: names of the files that were graded.
    """

    def __init__(self) -> None:
        self.changes: dict[str, Callable[[Verdict], Verdict]] = {}
        self.graded: list[str] = []

    def grade(self, sources: Sequence[tuple[Exercise, bytes]]) -> Iterator[tuple[int, Verdict]]:
        catalog = Catalog()
        exercises = {exercise.id: exercise for exercise, _ in sources}
        names = {id_: self._names(exercise, catalog) for id_, exercise in exercises.items()}
        checks = {id_: declared(catalog, exercise) for id_, exercise in exercises.items()}
        for index, (exercise, source) in enumerate(sources):
            own = names[exercise.id].items()
            name = next((name for text, name in own if source.decode().endswith(text)), "?")
            self.graded.append(name)
            verdict = _verdict(exercise, catalog, checks[exercise.id], name)
            yield index, self.changes.get(name, lambda v: v)(verdict)

    @staticmethod
    def _names(exercise: Exercise, catalog: Catalog) -> dict[str, str]:
        names = {path.read_text("utf-8"): path.name for path in accepted_files(catalog, exercise)}
        for mutant in mistakes_of(catalog, exercise).wrong:
            with contextlib.suppress(ContentError):  # which the audit reports
                names[source_of(catalog, exercise, mutant).decode()] = mutant.name
        names[solution_path(catalog, exercise).read_text("utf-8")] = "solution"
        names[exercise.stub_path.read_text(encoding="utf-8")] = "stub"
        return names


def _verdict(exercise: Exercise, catalog: Catalog, checks: tuple[CheckSource, ...], name: str) -> Verdict:
    mutant = next((m for m in mistakes_of(catalog, exercise).wrong if m.name == name), None)
    caught = caught_by(catalog, exercise).get(name, "")

    def passes(check: CheckSource) -> bool:
        return name != "stub" and not (mutant and check.id == caught)

    results = tuple(
        CheckResult(
            id=check.id,
            title=check.title,
            task=check.task or "",
            status=Status.PASS if passes(check) else Status.FAIL,
            visibility=Visibility.HIDDEN if check.hidden else Visibility.PUBLIC,
            points=(check.points or 0.0) * passes(check),
            max_points=check.points or 0.0,
            diagnosis=mutant.code if mutant and not passes(check) else None,
            message="" if passes(check) else "It is wrong.",
        )
        for check in checks
    )
    score = sum(r.points for r in results)
    most = sum(r.max_points for r in results)
    return Verdict(
        exercise=exercise.id,
        scope="full",
        state="graded",
        score=score,
        max_score=most,
        passed=score >= 0.7 * most,
        checks=results,
        isolation="L3",
    )


@pytest.fixture
def oracle() -> Oracle:
    return Oracle()


@pytest.fixture
def run(mini: Path, oracle: Oracle, monkeypatch: pytest.MonkeyPatch) -> Callable[..., AuditReport]:
    """Audit the copy with the oracle, but for the sandbox's scenes: no course has any of its own."""
    monkeypatch.setattr("course.authoring.audit.scene_ids", lambda: ())
    return lambda only=None: audit(Catalog(content()), only, grade=oracle.grade)


@pytest.fixture
def only_problem(run: Callable[..., AuditReport]) -> Callable[[], AuthorProblem]:
    """Audit the copy; there must be exactly one problem, which is returned."""

    def single() -> AuthorProblem:
        problems = run().problems
        assert len(problems) == 1, [f"{p.where} {p.code} {p.message}" for p in problems]
        return problems[0]

    return single
