"""One grader and many exercises: few sessions are open at a time, and verdicts are the same."""

from __future__ import annotations

import pytest

from course.catalog.load import Catalog
from course.grading.running import grader
from course.grading.running.grader import Config, Job
from course.isolation.probe import kept_sandboxes
from course.scoring.judging import session
from course.scoring.judging.submission import Terms

ORDER = ("doubling", "halving", "doubling", "doubling", "halving")


@pytest.mark.parametrize(("most", "opened"), [(1, 4), (2, 2)])
def test_a_grader_closes_its_oldest_session_for_another(
    catalog: Catalog, monkeypatch: pytest.MonkeyPatch, most: int, opened: int
) -> None:
    monkeypatch.setenv("COURSE_CONTENT", str(catalog.content.root))
    monkeypatch.setattr(grader, "_MOST_OPEN", most)
    collected: list[object] = []
    real = session.CollectedChecks
    monkeypatch.setattr(session, "CollectedChecks", lambda *a, **k: collected.append(a) or real(*a, **k))
    one = grader._Grader(Config(Terms(), 0))
    try:
        with kept_sandboxes():
            for exercise in ORDER:
                solution = catalog.content.root / "solutions" / exercise / f"{exercise}.py"
                verdict = one.answer(Job(exercise, {solution.name: solution.read_bytes()})).verdict
                assert verdict is not None
                assert (verdict.exercise, verdict.all_pass) == (exercise, True)
                assert len(one._sessions) <= most
    finally:
        one.close()
    assert len(collected) == opened
