"""``course author`` as it is typed."""

import json
import re
from pathlib import Path

import pytest

from course.authoring.scaffold import new_exercise
from course.catalog.load import Catalog
from course.catalog.pack import read_pack
from course.cli.frame.app import run
from course.sandbox.scene.loading import FOLDER, scene_ids
from tests.unit.authoring.conftest import edit


def answer(capsys, *line):
    """Exit code and the one JSON object of a command."""
    code = run([*line, "--json"])
    return code, json.loads(capsys.readouterr().out)


def test_a_right_course_exits_with_zero(mini, capsys):
    assert run(["author", "check"]) == 0
    scenes = len(scene_ids())
    counts = f"2 lessons, 2 exercises, 0 quiz questions, {scenes} scenes, 6 checks, 22 submissions graded"
    assert f"All is well: {counts}" in capsys.readouterr().out


HIDDEN = "the hidden checks come to 1, and 4 is written here."
BUILD = "Run `course author build halving`."


def test_a_problem_is_shown_with_place_and_fix(mini, capsys):
    path = mini / "exercises" / "halving" / "exercise.toml"
    edit(path, "hidden_checks = 1", "hidden_checks = 4")
    assert run(["author", "check", "halving"]) == 1
    out = capsys.readouterr().out.split("\n")
    place = out.index("exercises/halving/exercise.toml:8")
    assert out[place + 1 : place + 3] == [f"  {HIDDEN}", f"  {BUILD}"]
    code, body = answer(capsys, "author", "check", "halving")
    assert (code, body["schema"], body["ok"], body["exit_code"]) == (1, "course.author-check/1", False, 1)
    assert body["course"] == {"id": "mini", "version": "0.1.0"}
    assert body["problems"] == [
        {
            "file": "exercises/halving/exercise.toml",
            "line": 8,
            "code": "points",
            "message": HIDDEN,
            "help": BUILD,
        }
    ]


def test_a_scene_whose_text_has_a_formula_without_a_value_is_reported(mini, tmp_path, monkeypatch, capsys):
    text = (FOLDER / "head-on.toml").read_text("utf-8").replace("{speed}", "{sped}", 1)
    (tmp_path / "head-on.toml").write_text(text, "utf-8")
    monkeypatch.setattr("course.sandbox.scene.loading.FOLDER", tmp_path)
    code, body = answer(capsys, "author", "check", "head-on")
    (problem,) = body["problems"]
    assert (code, body["scenes"], problem["file"]) == (1, ["head-on"], str(tmp_path / "head-on.toml"))
    assert text.split("\n")[problem["line"] - 1].startswith("question = ")
    assert "sped" in problem["message"]


def test_a_new_scene_lies_in_its_course_and_is_checked_and_played_there(mini, capsys):
    code, body = answer(capsys, "author", "new", "scene", "falling")
    assert (code, body["files"]) == (0, ["scenes/falling.toml"])
    assert not (FOLDER / "falling.toml").exists()
    code, body = answer(capsys, "author", "check", "falling")
    assert {(one["file"], one["code"]) for one in body["problems"]} == {("scenes/falling.toml", "blank")}
    assert run(["sandbox", "play", "falling", "--headless"]) == 0
    said = capsys.readouterr().out
    assert "scenes/falling.toml:3: this line and 6 more below are still to be written." in said
    assert "FILL IN" not in said
    assert run(["author", "new", "scene", "falling"]) == run(["author", "new", "scene", "head-on"]) == 2


def test_a_new_scene_lies_where_its_author_is_outside_of_the_checkout(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    try:
        assert run(["author", "new", "scene", "falling"]) == 0
        assert not (FOLDER / "falling.toml").exists()
    finally:
        (FOLDER / "falling.toml").unlink(missing_ok=True)
    assert [path.name for path in tmp_path.iterdir()] == ["falling.toml"]
    assert "then run: course sandbox play falling.toml\n" in capsys.readouterr().out
    assert run(["sandbox", "play", "falling.toml", "--headless"]) == 0


def test_a_scene_whose_run_gives_another_number_than_its_theory_is_named(mini, capsys):
    (mini / "scenes").mkdir()
    text = (FOLDER / "head-on.toml").read_text("utf-8").replace('id = "head-on"', 'id = "head-off"')
    wrong = re.sub(r"^theory = .*$", 'theory = "17"', text, flags=re.MULTILINE)
    (mini / "scenes" / "head-off.toml").write_text(wrong, "utf-8")
    _, body = answer(capsys, "author", "check", "head-on")
    (taken,) = body["problems"]
    assert (taken["file"], taken["message"].split(" has ")[0]) == (
        str(FOLDER / "head-on.toml"),
        "scene head-off",
    )
    _, body = answer(capsys, "author", "check", "head-off")
    (problem,) = body["problems"]
    assert wrong.split("\n")[problem["line"] - 1] == "[prediction]"
    assert problem["message"] == "theory gives 17 m/s, and the run 2."


def test_a_scene_whose_words_leave_out_what_its_answer_depends_on_is_told_the_names_for_it(mini, capsys):
    (mini / "scenes").mkdir()
    text = (FOLDER / "free-fall.toml").read_text("utf-8").replace('"free-fall"', '"fall"')
    plain = re.sub(r"^(question|why) = .*$", r'\1 = "How fast?"', text, flags=re.MULTILINE)
    plain = re.sub(r"^theory = .*$", 'theory = "g * stone.restitution"', plain, flags=re.MULTILINE)
    (mini / "scenes" / "fall.toml").write_text(plain, "utf-8")
    _, body = answer(capsys, "author", "check", "fall")
    told = {
        one["message"].split()[2]: one["help"] for one in body["problems"] if "with another" in one["message"]
    }
    assert told["gravity"] == "Write in one of them a formula in braces with g."
    assert told["restitution"] == "Write in one of them a formula in braces with stone.restitution."


def test_a_scene_called_as_one_of_the_programs_own_is_named(mini, capsys):
    (mini / "scenes").mkdir()
    (mini / "scenes" / "head-on.toml").write_bytes((FOLDER / "head-on.toml").read_bytes())
    _, body = answer(capsys, "author", "check", "head-on")
    assert [one["message"] for one in body["problems"]] == [
        "the program has a scene head-on, which is played instead."
    ]


def test_in_another_checkout_than_the_programs_nothing_is_written(tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("COURSE_CONTENT", raising=False)
    other = tmp_path / "copy"
    for folder in ("course/authoring", "exercises/inside"):
        (other / folder).mkdir(parents=True)
    monkeypatch.chdir(other / "exercises" / "inside")
    code, body = answer(capsys, "author", "new", "scene", "falling")
    assert (code, body["error"]["code"]) == (2, "other_checkout")
    assert f"In {other}, type `python -m course`" in body["error"]["help"]


def test_nothing_is_left_of_content_that_could_not_be_written(mini, monkeypatch):
    """Interrupted half-way: what is there would be in the way of the next attempt."""
    before = {path for path in mini.rglob("*") if path.is_file()}
    opened, times = Path.open, iter(range(5))

    def interrupted(path, *args, **more):
        if "x" in args and next(times) == 4:
            raise KeyboardInterrupt
        return opened(path, *args, **more)

    monkeypatch.setattr(Path, "open", interrupted)
    with pytest.raises(KeyboardInterrupt):
        new_exercise(Catalog(), "tripling")
    assert {path for path in mini.rglob("*") if path.is_file()} == before


def test_mutants_are_listed_and_one_that_survives_exits_with_one(mini, capsys):
    code, body = answer(capsys, "author", "mutants")
    assert (code, body["schema"], len(body["mutants"])) == (0, "course.author-mutants/1", 12)
    assert body["mutants"][0]["diagnosis"] == "SQUARES_INSTEAD"
    edit(mini / "solutions" / "halving" / "mistakes.py", '"x // 2"', '"0.5 * x"')
    assert run(["author", "mutants", "halving"]) == 1
    out = capsys.readouterr().out
    assert "halving: halve.INTEGER_DIVISION.2: breaks halve, loses 1 point" in out
    assert "reads: Half of an odd number has lost its fraction." in out
    assert "survives: every check passes" in out
    assert "4 mutants: 1 not caught" in out


def test_what_follows_from_an_exercise_is_written_and_named(mini, capsys):
    path = mini / "exercises" / "halving" / "exercise.toml"
    right = path.read_text()
    path.write_text(right.replace("hidden_checks = 1", "hidden_checks = 4"))
    code, body = answer(capsys, "author", "build", "halving")
    assert (code, body["files"]) == (0, ["exercises/halving/exercise.toml"])
    assert path.read_text() == right
    assert run(["author", "build"]) == 0
    assert "up to date" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("line", "kind", "file"),
    [
        (["exercise", "tripling"], "exercise", "exercises/tripling/exercise.toml"),
        (
            ["warmup", "tripling", "--lesson", "half-as-much"],
            "warm-up",
            "solutions/warm-ups/tripling/mistakes.py",
        ),
    ],
)
def test_what_is_new_is_written_and_listed(mini, capsys, line, kind, file):
    code, body = answer(capsys, "author", "new", *line)
    assert (code, body["schema"], body["kind"]) == (0, "course.author-new/1", kind)
    assert file in body["files"]
    assert all((mini / name).is_file() for name in body["files"])
    assert run(["author", "new", *line]) == 2
    assert "nothing is overwritten" in capsys.readouterr().err


def test_a_new_lesson_says_in_which_course_it_is_and_where_to_list_it(mini, capsys):
    assert run(["author", "new", "lesson", "three-times"]) == 0
    out = capsys.readouterr().out
    assert f"Wrote lesson three-times in {mini}." in " ".join(out.split())
    assert "syllabus.toml" in out
    assert (mini / "lessons" / "three-times.md").is_file()


def test_a_pack_holds_the_solutions_and_their_prose(mini, tmp_path, capsys):
    output = tmp_path / "s.coursepack"
    line = ["author", "pack", "--solutions", "doubling", "halving", "doubling", "-o", str(output)]
    code, body = answer(capsys, *line)
    assert (code, body["schema"]) == (0, "course.author-pack/1")
    assert body["solutions"] == {"doubling": ["README.md", "doubling.py"], "halving": ["halving.py"]}
    read = read_pack(output)
    assert (read.course_id, read.course_version) == ("mini", "0.1.0")
    for name, files in body["solutions"].items():
        folder = mini / "solutions" / name
        assert read.solutions[name] == {file: (folder / file).read_bytes() for file in files}
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["s.coursepack"]


@pytest.mark.parametrize(
    ("line", "code", "name"),
    [
        (["author", "check", "thirds"], 5, "not_found"),
        (["author", "mutants", "thirds"], 5, "exercise_not_found"),
        (["author", "new", "exercise", "No!"], 2, "invalid_id"),
        (["author", "pack", "-o", "x"], 2, "usage"),
        (["author", "pack", "--solutions", "thirds", "-o", "x"], 5, "exercise_not_found"),
        (["author", "pack", "--solutions", "doubling", "-o", "none/x"], 2, "usage"),
        (["author", "pack", "--solutions", "doubling", "-o", "mine"], 2, "exists"),
        (["author", "pack", "--solutions", "halving", "-o", "x"], 70, "content"),
    ],
)
def test_a_wrong_line_has_its_exit_code(mini, tmp_path, monkeypatch, capsys, line, code, name):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").write_bytes(b"mine")
    (mini / "solutions/halving/halving.py").unlink()
    got, body = answer(capsys, *line)
    assert (got, body["exit_code"], body["error"]["code"]) == (code, code, name)
    assert (tmp_path / "mine").read_bytes() == b"mine"
    assert not (tmp_path / "x").exists()


@pytest.mark.parametrize("folder", ["solutions", "graders"])
def test_a_student_is_told_that_it_needs_a_checkout(mini, capsys, folder):
    (mini / folder).rename(mini / "gone")
    for line in (
        ["check"],
        ["mutants"],
        ["new", "exercise", "thirds"],
        ["new", "lesson", "thirds"],
        ["pack", "--solutions", "doubling", "-o", "x"],
    ):
        got, body = answer(capsys, "author", *line)
        assert (got, body["error"]["code"]) == (4, "needs_checkout"), line
        assert "checkout" in body["error"]["help"]
