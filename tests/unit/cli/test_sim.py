"""``course sim``: numbers beside theory, files that are kept, refusals with their place and their fix."""

import csv
import re

import pytest

from course.simulations.base import run
from course.simulations.registry import CHAPTER, SIMULATIONS, get


def test_list_names_every_simulation_with_its_question_and_one_with_its_parameters(course):
    ran = course("sim list --plain").ends(0)
    for name in SIMULATIONS:
        assert re.search(rf"^{name}: ", ran.out, re.MULTILINE)
    assert ran.out.count("guess: ") == len(SIMULATIONS)
    assert "Next: course sim list free-fall" in ran.out
    course("sim list free-fall --plain").says(
        "set: height (m, above 0 to 100000, default 10): where the ball starts"
    ).lacks("projectile")


def test_list_as_json_is_typed(course):
    body = course("sim list --json").json
    assert body["schema"] == "course.sim-list/1"
    assert [entry["id"] for entry in body["simulations"]] == list(SIMULATIONS)
    method = next(p for p in body["simulations"][0]["parameters"] if p["name"] == "method")
    assert (method["low"], method["unit"]) == (None, "")
    assert "rk4" in method["choices"]


def test_run_shows_simulated_theory_and_error_with_units_and_quiet_leaves_the_finding(course):
    course("sim run free-fall --plain").ends(
        0,
        "Measured: time to the ground; Simulated: 1.4278 s; Theory: 1.4278 s; Error: ",
        "semi-implicit Euler; Simulated: -9.7181 m; Theory: -9.6200 m; Error: -0.0981 m",
        "The ball reaches the ground after 1.428 s",
    )
    out = course("sim run collision --quiet").out
    assert out.startswith("The surfaces touch at 2.25 s")
    assert out.count("\n") == 1


def test_run_as_json_has_every_number_with_its_unit(course):
    body = course("sim run collision --set restitution=0.5 --json").json
    assert (body["schema"], body["ok"]) == ("course.sim/1", True)
    assert body["settings"]["restitution"] == {"value": 0.5, "unit": "1"}
    contact = body["results"][0]
    assert contact["simulated"] == pytest.approx(2.25)
    assert contact["error"] == pytest.approx(0.0, abs=1e-9)
    assert (contact["unit"], contact["theory"]) == ("s", 2.25)
    assert body["plot"] is None


def test_what_did_not_happen_is_never_on_the_screen_and_nan_in_json(course):
    assert "Simulated: never; Theory: never" in course("sim run free-fall --set duration=1 --plain").out
    body = course("sim run free-fall --set duration=1 --json").json
    assert body["results"][0]["simulated"] == "nan"
    assert body["results"][0]["error"] is None


def test_all_runs_the_introduction_in_order_sums_up_and_writes_a_file_for_each(course, tmp_path):
    titles = ("Free fall", "A throw", "A collision", "Four methods")
    course("sim run --all --plain").ends(0).says_in_order(*titles, "What this showed", "What to take along")
    body = course("sim run --all --json --csv", tmp_path / "run.csv").json
    assert body["schema"] == "course.sim-all/1"
    assert [one["simulation"] for one in body["results"]] == list(CHAPTER)
    assert (len(body["concepts"]), len(body["insights"])) == (6, 4)
    assert sorted(path.name for path in tmp_path.glob("run-*.csv")) == sorted(f"run-{n}.csv" for n in CHAPTER)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("free-fall --set hight=3", ["--set hight=3: ", "has no parameter 'hight'"]),
        ("--all free-fall", ["--all runs all four with their defaults"]),
        ("--all --set step=0.1", ["--all runs all four with their defaults"]),
        ("", ["course sim list", "free-fall, projectile"]),
    ],
)
def test_what_cannot_be_run_is_named_and_exits_2(course, line, said):
    ran = course("sim run", *line.split()).ends(2)
    assert [words for words in said if words not in ran.err] == []
    assert not ran.out


# -- files -------------------------------------------------------------------------------------------------


def test_csv_holds_every_sample_with_units_and_every_digit(course, tmp_path):
    path = tmp_path / "fall.csv"
    ran = course("sim run free-fall --csv", path)
    assert f"Wrote {path}" in ran.out.replace("\n", "")
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0][:3] == ["t [s]", "height [m]", "height_theory [m]"]
    assert len(rows) == 1 + 201
    result = run(get("free-fall"))
    for index, column in enumerate(result.columns):
        assert [float(row[index]) for row in rows[1:]] == column.values.tolist()


@pytest.mark.parametrize(("kind", "magic"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_a_figure_is_written_in_each_format(course, tmp_path, kind, magic):
    path = tmp_path / f"one.{kind}"
    assert course("sim run collision --plot", path).code == 0
    assert path.read_bytes().startswith(magic)


def test_a_file_that_is_replaced_is_kept_beside_it_and_said(course, tmp_path):
    path = tmp_path / "fall.csv"
    path.write_text("mine\n", encoding="utf-8")
    (tmp_path / "fall.old-1.csv").write_text("older\n", encoding="utf-8")
    body = course("sim run free-fall --csv", path, "--json").json
    copy = tmp_path / "fall.old-2.csv"
    assert body["csv"] == {"path": str(path), "backup": {"path": str(path), "backup": str(copy)}}
    assert copy.read_text(encoding="utf-8") == "mine\n"
    assert (tmp_path / "fall.old-1.csv").read_text(encoding="utf-8") == "older\n"
    again = course("sim run free-fall --csv", path, "--json").json
    assert again["csv"]["backup"] is None


def test_inside_a_workspace_the_copy_goes_where_all_backups_are(course, workspace):
    (workspace / "fall.csv").write_text("mine\n", encoding="utf-8")
    assert "it is kept at" in course("sim run free-fall --csv fall.csv").out
    (copy,) = (workspace / ".course" / "backups").rglob("fall.csv")
    assert copy.read_text(encoding="utf-8") == "mine\n"


@pytest.mark.parametrize(
    ("option", "name", "words"),
    [
        ("--plot", "fall.jpg", "must end in .png or .svg or .pdf"),
        ("--csv", "fall.txt", "must end in .csv"),
        ("--plot", "nowhere/fall.png", "there is no folder"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_anything_runs(course, tmp_path, option, name, words):
    ran = course("sim run free-fall", option, tmp_path / name)
    assert ran.refuses(2, f"{option} {tmp_path / name}: ", words).out == ""
