"""A student's whole way, from the wheel: each command as it is typed, each exercise from stub to zip."""

import json
import shutil
import zipfile
from pathlib import Path

import pytest

from course.catalog.load import Catalog
from tests.journeys.conftest import ROOT, in_turn
from tests.journeys.test_line_journey import Lines

CATALOG = Catalog()
EXERCISES = CATALOG.exercises()
WARM_UPS = [CATALOG.exercise(name) for name in CATALOG.warm_up_ids()]


def model(exercise_id):
    exercise = CATALOG.exercise(exercise_id)
    return ROOT / "solutions" / exercise.place / exercise.module


def test_the_first_hour(student, tmp_path):
    """The demonstration, a workspace, the first lesson read to its end with every prediction made."""
    assert "7.32 times its initial value" in student("demo").stdout
    assert "course go" in student("init", "work").stdout
    work = tmp_path / "work"
    first = CATALOG.lesson_ids()[0]
    assert f"Next: course warmup {CATALOG.every_task()[0].id}" in student(cwd=work).stdout
    assert CATALOG.lesson(first).title in student("lesson", cwd=work).stdout
    environment = {**student.environment, "TERM": "xterm-256color"}
    lines = Lines(
        work, "lesson", first, "--plain", "--page", command=student.command, environment=environment
    )
    predicted, said = 0, lines.wait("Your prediction; Enter skips it: ", "Enter goes on: ", "q stops: ")
    while "Enter goes on" in said or "Your prediction" in said:
        asked = said.endswith("Your prediction; Enter skips it: ")
        predicted += asked
        said = lines.type("1" if asked else "")
    lines.close()
    assert predicted, said
    overview = json.loads(student("progress", "--json", cwd=work).stdout)
    assert {lesson["id"]: lesson["read_at"] for lesson in overview["lessons"]}[first]


@pytest.mark.parametrize("shape", [(), ("--plain",)], ids=["fancy", "plain"])
def test_five_tasks_in_a_row_without_leaving_the_loop(student, workspace, shape):
    """One program on one half of the screen; on the other an editor, which only saves."""
    environment = {**student.environment, "TERM": "xterm-256color"}
    lines = Lines(workspace, "go", *shape, command=student.command, environment=environment)
    keys = ("q leave\r\n", "q leave\x1b[0m\r\n")
    five = CATALOG.every_task()[:5]
    for number, task in enumerate(five, start=1):
        said = lines.wait(*keys)
        assert f"Warm-up {number} of {len(WARM_UPS)}: {task.id}" in said
        assert f"Explained in: course lesson {task.lesson}" in said
        module = workspace / task.place / task.module
        module.write_text(f"{module.read_text('utf-8')}\n# saved\n", "utf-8")
        assert "checks pass" in lines.wait(*keys), "the stub does not pass, and the task stays"
        shutil.copy(model(task.id), module)
    assert "Warm-up 6 of" in lines.wait(*keys)
    assert f"Warm-up 5 of {len(WARM_UPS)}" in lines.press("b", *keys)
    assert "Waiting for a save" in lines.press("t", *keys)
    lines.press("q")
    lines.close()
    done = json.loads(student("progress", "--json", cwd=workspace).stdout)["warm_ups"]
    assert [one["id"] for one in done if one["state"] == "done"] == [task.id for task in five]


def test_every_exercise_from_its_stub_to_the_zip(student, workspace):
    assert EXERCISES
    tried = in_turn(EXERCISES, 2)
    for exercise in tried:
        student("start", exercise.id, cwd=workspace)
        failed = json.loads(student("check", exercise.id, "--json", cwd=workspace, code=1).stdout)
        assert failed["score"] == 0, exercise.id
        shutil.copy(model(exercise.id), workspace / exercise.id)
        passed = json.loads(student("check", exercise.id, "--json", cwd=workspace).stdout)
        assert passed["score"] == passed["max_score"] > 0, exercise.id
        has_report = (Path(exercise.folder) / "report.py").is_file()
        student("report", exercise.id, cwd=workspace, code=0 if has_report else 5)
        assert any((workspace / exercise.id / "report").glob("*.png")) == has_report
    reply = json.loads(student("submit", "--json", cwd=workspace).stdout)
    assert len(reply["files"]) == len(tried)
    assert all(file["last_score"] == file["max_score"] > 0 for file in reply["files"])
    assert (reply["left_out"], reply["warnings"]) == ([], [])
    with zipfile.ZipFile(workspace / "physics-sim-submission.zip") as packed:
        for exercise in tried:
            assert packed.read(f"{exercise.id}/{exercise.module}") == model(exercise.id).read_bytes()
    done = json.loads(student("progress", "--json", cwd=workspace).stdout)["exercises"]
    assert [one["state"] for one in done].count("complete") == len(tried)


def test_warm_ups_from_start_to_pass(student, workspace):
    assert len(WARM_UPS) >= 32
    for warm_up in in_turn(WARM_UPS, 3):
        student("start", warm_up.id, cwd=workspace)
        student("check", warm_up.id, cwd=workspace, code=1)
        shutil.copy(model(warm_up.id), workspace / warm_up.place)
        student("check", warm_up.id, cwd=workspace)
    said = student("submit", "--warm-ups", cwd=workspace).stdout
    assert said.count(": 1 ") or "passes" in said


def test_the_sandbox_the_quiz_and_what_was_done(student, workspace):
    played = student("sandbox", "play", "newtons-cradle", "--headless", "--duration", "2", cwd=workspace)
    assert played.stdout
    student("sandbox", "export", "unequal-masses", "--format", "mjcf", "-o", "world.xml", cwd=workspace)
    assert "<mujoco" in (workspace / "world.xml").read_text("utf-8")
    questions = student("quiz", "take", "--seed", "5", "--questions", cwd=workspace).stdout
    form, right = questions[questions.index("format_version = 1") : questions.index("Then: ")], key(5)
    for name, letter in right.items():
        assert f'{name} = ""' in form
        form = form.replace(f'{name} = ""', f'{name} = "{letter}"')
    (workspace / "answers.toml").write_text(form, "utf-8")
    result = json.loads(student("quiz", "take", "--answers", "answers.toml", "--json", cwd=workspace).stdout)
    assert result["score"] == len(right) == 5
    assert "5" in student("quiz", "history", cwd=workspace).stdout
    assert student("progress", cwd=workspace).stdout
    assert student("doctor", cwd=workspace).stdout


def key(seed):
    """The right letters of a drawing of the quiz, which only its bank knows."""
    from course.quizzing.bank import Bank

    posed = Bank.of(CATALOG).pose(seed)
    letters = "abcdefgh"
    return {one.question: letters[[choice.id for choice in one.choices].index(one.key.id)] for one in posed}
