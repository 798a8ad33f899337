"""The course that is shipped is right, as ``course author check`` says: here all but what exercises prove."""

import pytest

from course.authoring.coverage import read_coverage
from course.authoring.exercises import diagnosis
from course.authoring.exercises.diagnosis import as_one, code_of, hypotheses_of, made_from
from course.authoring.exercises.grading import solution_path
from course.authoring.exercises.proofs import Record, Reported, caught_by
from course.authoring.report import Findings
from course.cli.author.commands import is_command
from course.handed_in import limits
from course.ids import WARM_UPS
from course.scoring import kit
from tests.contracts.content.audited import CATALOG, EXERCISES, IN_PART, programs, wrong


def test_the_audit_finds_nothing_wrong_and_looks_at_everything():
    """At a lesson called as an exercise is, where that one is audited."""
    report = IN_PART(without=EXERCISES, is_command=is_command)
    assert wrong(report) == []
    assert {*report.lessons, *EXERCISES} >= {path.stem for path in CATALOG.content.lessons.glob("*.md")}
    folders = [path for path in CATALOG.content.exercises.iterdir() if path.is_dir()]
    folders += (path for path in (CATALOG.content.exercises / WARM_UPS).iterdir() if path.is_dir())
    assert {*report.exercises, *EXERCISES} == {path.name for path in folders} - {WARM_UPS}
    assert set(report.exercises).isdisjoint(EXERCISES)
    assert report.graded == sum(map(programs, report.exercises))


def test_the_table_of_the_chapter_is_as_long_as_the_chapter():
    coverage = read_coverage(CATALOG).value
    assert coverage.source_lines == 394
    # Counted in the chapter.
    counts = {section.kind: len(section.parts) for section in coverage.section}
    assert [counts[kind] for kind in ("objective", "exercise", "question")] == [5, 5, 5]


def test_the_first_warm_up_of_all_is_the_program_with_faults():
    assert CATALOG.warm_ups()[0].id == "first-program"


def test_some_handouts_have_faults_that_are_declared():
    """The audit compares them with what the checks tell the stub."""
    every = (*CATALOG.exercises(), *CATALOG.warm_ups())
    faulty = {one.id for one in every if any(task.fault for task in one.task)}
    assert {"first-program", "collisions"} <= faulty


def test_a_grading_run_opens_the_zip_of_a_student_who_did_everything():
    """`course submit --warm-ups` puts a file for each in, and the manifest."""
    assert len([*CATALOG.exercises(), *CATALOG.warm_ups()]) + 1 <= limits.MAX_FILES


def test_exercises_and_lists_of_them_know_no_warm_ups():
    assert not set(CATALOG.exercise_ids()) & set(CATALOG.warm_up_ids())
    assert not any(exercise.is_warm_up for exercise in CATALOG.exercises())
    assert all(warm_up.is_warm_up for warm_up in CATALOG.warm_ups())


def test_the_program_with_faults_says_what_its_report_remembers():
    """Once the fault that stops it is mended, and nothing else."""
    warm_up = CATALOG.exercise("first-program")
    stub = warm_up.stub_path.read_text(encoding="utf-8")
    with pytest.raises(TypeError):
        _summary(stub)
    running = stub.replace("second[k][0][0] - first[k][0][0]", "second[k][0] - first[k][0]")
    report = kit.companion("first-program", "report")
    assert tuple(how_much for _, how_much in _summary(running)) == report.BEFORE
    model = solution_path(CATALOG, warm_up).read_text(encoding="utf-8")
    after = [how_much for _, how_much in _summary(model)]
    assert [after[0], after[1], after[2]] == list(report.THEORY[:3])
    for said, true in zip(after[3:], report.THEORY[3:], strict=True):
        # Looked for once a step, a collision is off by two steps of 4 cm at most; errors are first order.
        wanted = float(true.removeprefix("about ").split()[0])
        assert float(said.split()[0]) == pytest.approx(wanted, rel=0.12, abs=0.0)


def _summary(source):
    module = {"__name__": "program"}
    exec(compile(source, "program", "exec"), module)
    return module["summary"]()


def test_the_audit_refuses_a_table_with_an_untrue_row_or_one_that_survives(monkeypatch):
    exercise = CATALOG.exercise("integrators")
    rows = [Reported("rk4_step", ("EQUAL_WEIGHTS",), said, 1) for said in ("STAGES_NOT_CHAINED", "survives")]
    record = Record(
        made_from=made_from(CATALOG, exercise),
        caught=caught_by(CATALOG, exercise),
        rows={"public": (), "full": tuple(rows)},
    )
    monkeypatch.setattr(diagnosis, "read_record", lambda *_: record)
    findings = Findings(CATALOG.content.root)
    diagnosis.audit_diagnoses(CATALOG, exercise, findings)
    assert [problem.message for problem in findings.sorted()] == [
        "rk4_step: no check fails for a program that is said to have EQUAL_WEIGHTS.",
        "rk4_step: programs with EQUAL_WEIGHTS are told STAGES_NOT_CHAINED, which is untrue.",
    ]


def test_what_decides_about_a_program_includes_what_answers_for_it():
    """A reference that draws other engines decides as much as a check; the model solution is a program."""
    exercise = CATALOG.exercise("engine-comparison")
    code = code_of(CATALOG, exercise)
    reference = solution_path(CATALOG, exercise).with_name("lab.py").read_text("utf-8")
    assert "_SHOWN_ALIKE" in reference
    assert b"_SHOWN_ALIKE" in code
    assert "def _linear_damping" in solution_path(CATALOG, exercise).read_text("utf-8")
    assert b"FunctionDef(name='_linear_damping'" not in code


def test_how_a_check_is_worded_decides_about_no_program():
    exercise = CATALOG.exercise("engine-comparison")
    checks = (exercise.readme_path.parent / "checks.py").read_text("utf-8")
    title = next(line for line in checks.splitlines() if line.startswith('    """')).strip(' "')
    assert title.encode() not in code_of(CATALOG, exercise)


@pytest.mark.parametrize("code", ["RETURNS_ARGUMENT", "MUTATES_INPUT"])
def test_the_hint_at_a_loop_that_hands_an_argument_back_is_about_new_rows(code):
    task = CATALOG.exercise("integrators").task_called("integrate")
    given = task.following({code}, ())
    assert "are new" in task.hints[given]


def test_two_changed_terms_that_make_one_known_mistake_are_that_mistake():
    exercise = CATALOG.exercise("integrators")
    for codes, found in (
        (("ENDS_ONLY", "STAGES_NOT_CHAINED"), ("RK4_IS_HEUN",)),
        (("EQUAL_WEIGHTS", "WRONG_SIGN"), ("EQUAL_WEIGHTS", "WRONG_SIGN")),
    ):
        program = next(item for item in hypotheses_of(CATALOG, exercise) if item[:2] == ("rk4_step", codes))
        assert as_one(exercise, program)[:2] == ("rk4_step", found)
