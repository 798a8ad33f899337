"""Every wrong program that a warm-up knows of fails a check and is told one of its own mistakes."""

from pathlib import Path

import pytest

from course.authoring.exercises.diagnosis import hypotheses_of, sums_of
from course.authoring.exercises.grading import LocalSubmission, solution_path
from course.catalog.load import Catalog
from course.scoring.checks.collected import CollectedChecks, questions_of
from course.scoring.explain.story import common, matching, read_table
from course.scoring.judging.session import check_files

CATALOG = Catalog()
#: Two mistakes that leave the answers of one: what the one is called is as true.
AS_TRUE = {
    frozenset({"SIGN_TURNED", "OF_THE_COARSE"}): "NEGATIVE_POWER",
    frozenset({"ALWAYS_HALVED", "FIRST_ORDER"}): "THE_CHANGE",
    frozenset({"HALF_TWICE"}): "LANDING_SPEED_ALL_THE_WAY",
    frozenset({"NO_ROOT", "ONCE"}): "HALF_NOT_ROOT",
    frozenset({"ERRORS_WITHOUT_LOGARITHM", "STEPS_WITHOUT_LOGARITHM"}): "NO_LOGARITHM",
    frozenset({"FROM_THE_MEASUREMENT", "AWAY_FROM_THE_SENSOR"}): "SHARES_SWAPPED",
    frozenset({"HALF_MISSING", "ROOT_MISSING"}): "HALF_NOT_ROOT",
    frozenset({"G_MULTIPLIES", "DISTANCE_MULTIPLIES"}): "BRACKETS_MISSING",
    frozenset({"N_NOT_N_MINUS_ONE", "ONE_VALUE_NOT_THE_MEAN"}): "SUM_NOT_DIVIDED",
    frozenset({"DIVIDED_BY_N", "VARIANCE"}): "OF_THE_VARIANCE",
    frozenset({"ERP_KEPT", "CFM_KEPT"}): "KEPT_AS_THEY_ARE",
    frozenset({"CORRECTION_ALONE", "MEASUREMENT_ADDED"}): "BRACKETS_MISSING",
    frozenset({"THICKNESS_TWICE", "TWO_LOOKS"}): "RADIUS_ONCE",
    frozenset({"SUM_WHERE_IT_FITS", "NOTHING_TAKEN"}): "SUM_NOT_CORRECTION",
}


@pytest.mark.parametrize("warm_up", CATALOG.warm_up_ids())
def test_every_known_wrong_program_fails_and_is_told_what_is_wrong(warm_up):
    exercise = CATALOG.exercise(warm_up)
    checks = CollectedChecks(check_files(exercise, CATALOG, "public"), draws=False)
    model = solution_path(CATALOG, exercise).read_text(encoding="utf-8")
    table, questions = read_table(Path(exercise.folder)), questions_of(warm_up)
    assert questions is not None
    for task, codes, function in hypotheses_of(CATALOG, exercise):
        submission = LocalSubmission(model, replaced={task: function})
        outcomes = [checks.run(check, submission) for check in checks.in_order() if check.task == task]
        assert any(outcomes), f"no check fails for {codes}"
        numbers = sums_of(questions, task, function)
        said = common(matching(table, task, numbers[task]))
        assert {*codes, AS_TRUE.get(frozenset(codes))} & {*said}, f"{codes} are told {said}"
    checks.close()
