"""``course engines``: what is here, what is missing, and a comparison that says where each number is from."""

import contextlib
import csv
import re
from types import SimpleNamespace

import pytest

from course.cli.engines import best_rows
from course.engines import compare as comparing
from course.engines import reference
from course.engines.registry import ENGINES, Availability
from course.engines.results import Row
from course.engines.scenarios import SCENARIOS

MISSING = "pip install 'mujoco>=4.0'"


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """Where what one of these tests measures is kept for the others."""
    return tmp_path_factory.mktemp("measured")


@pytest.fixture
def bare(course, monkeypatch, measured):
    """The command line on a machine without any extra: pymunk is there, and nothing else."""
    monkeypatch.setenv("COURSE_CACHE", str(measured))

    def available(info):
        if info.id == "pymunk":
            return Availability("7.3.1")
        if info.id == "pybullet":
            return Availability(None, "pybullet has no wheel for Python 3.13 on Linux x86_64")
        return Availability(None, "not installed", MISSING)

    monkeypatch.setattr(comparing, "availability", available)
    return course


def test_list_names_engines_with_licence_and_the_command_that_installs_them(bare):
    ran = bare("engines list --plain").ends(
        0,
        "pymunk: pymunk (2-D); pymunk 7.3.1; MIT; ",
        "mujoco: MuJoCo; not installed; Apache-2.0; ",
        f"not installed: {MISSING}",
        "pybullet has no wheel for Python 3.13 on Linux x86_64.",
    )
    for name in SCENARIOS:
        assert re.search(rf"^\s+{name}: ", ran.out, re.MULTILINE)
    body = bare("engines list --json").json
    assert body["schema"] == "course.engines-list/1"
    engines = {engine["id"]: engine for engine in body["engines"]}
    assert list(engines) == list(ENGINES)
    assert engines["pymunk"]["usable"]
    assert (engines["mujoco"]["version"], engines["mujoco"]["command"]) == (None, MISSING)
    wall = next(scenario for scenario in body["scenarios"] if scenario["id"] == "thin-wall")
    assert wall["truth"] == "inf"


def test_without_extras_pymunk_is_measured_and_the_rest_is_labelled_reference(bare):
    ran = bare("engines compare --scenario bounce --plain").ends(
        0,
        "phases of a step. Truth: 0.25 m.",
        "Engine: pymunk (2-D); As it comes: 0.2454 m (0.239 to 0.252); Well set",
        f"MuJoCo: not installed: {MISSING}",
        f"Rows marked reference were not measured here: {reference.load().label}.",
    )
    assert re.search(r"Engine: MuJoCo, reference; As it comes: 0.0000 m; Well set: 0.2\d+ m", ran.out)
    assert not re.search(r"reference; .*best", ran.out)


def test_the_rows_of_a_scenario_say_the_best_in_words(bare, monkeypatch):
    monkeypatch.setattr(comparing, "availability", lambda info: Availability("1"))
    replies = {"pymunk": -0.5, "mujoco": 0.25, "ode": 3.0}

    @contextlib.contextmanager
    def stand_in(engine):
        def ask(job, seconds=0):
            if engine == "dart":
                return {"status": "crash", "message": "It was ended by SIGABRT."}
            value = replies.get(engine, 5.0)
            if job["setting"] != "tuned":
                return {"status": "ok", "value": value, "details": {}, "options": {}, "why": []}
            return {"status": "ok", "value": value + 0.1, "details": {}, "options": {"a": 1}, "why": ["b"]}

        yield SimpleNamespace(ask=ask)

    monkeypatch.setattr(comparing, "EngineProcess", stand_in)
    bare("engines compare --scenario clash --plain").ends(
        0,
        "Engine: MuJoCo; As it comes: +0.250 % best; Well set: +0.350 % best\n",
        "Engine: pymunk (2-D); As it comes: -0.500 %; Well set: -0.400 %\n",
        "Engine: DART; As it comes: crashed",
        "DART crashed in clash (default): It was ended by SIGABRT.",
    )


def row(engine, value, *samples, origin="measured"):
    return Row(
        engine=engine, scenario="bounce", setting="default", dt=1 / 240, status="ok", value=value,
        samples=samples, origin=origin,
    )  # fmt: skip


def test_nothing_that_can_run_is_exit_code_4_with_the_reference_shown(bare):
    line = "engines compare --engine mujoco --scenario bounce"
    bare(line, "--plain").ends(4, "MuJoCo, reference", "No engine could be run on this machine.")
    assert bare(line, "--json").ends(4).json["schema"] == "course.engines/1"


def test_compare_as_json_holds_every_number_and_where_it_is_from(bare, monkeypatch, tmp_path):
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "cache"))
    line = "engines compare --scenario bounce --engine pymunk --engine mujoco --json"
    ran = bare(line)
    assert "A bounce" in ran.err, "words go to the other stream"
    body, rows = ran.json, ran.json["rows"]
    each = (
        ("pymunk", "measured", "ok"),
        ("mujoco", "measured", "not_installed"),
        ("mujoco", "reference", "ok"),
    )
    told = [(row["engine"], row["origin"], row["status"]) for row in rows]
    assert told == [one for one in each for _setting in range(2)]
    assert rows[0]["truth"] == 0.25
    assert rows[0]["error"] == pytest.approx(rows[0]["value"] - 0.25)
    assert rows[1]["options"] == {"collision_slop": 1e-4}
    assert len(rows[1]["why"]) == 1
    assert body["reference"]["measured"] == reference.load().measured
    assert bare(line).json["rows"][0]["origin"] == "cached"
    assert bare(line, "--fresh").json["rows"][0]["origin"] == "measured"


def test_steps_are_taken_as_numbers_or_fractions(bare):
    line = "engines compare --engine pymunk --scenario free-fall --dt 1/100 --dt 0.005"
    assert {row["dt"] for row in bare(line, "--json").json["rows"]} == {0.005, 0.01}
    bare(line, "--plain").says("Step: 1/200 s")


@pytest.mark.parametrize(
    ("word", "code", "error"),
    [(f"--dt={step}", 2, "bad_step") for step in ("0", "-1", "1/0", "nan", "tea", "1/10", "1e-9", "1/2/3")]
    + [("--engine=newton", 5, "engine_not_found"), ("--scenario=tea", 5, "scenario_not_found")],
)
def test_a_step_that_is_none_and_unknown_names_are_refused(bare, word, code, error):
    assert bare("engines compare", word, "--json").error == (code, error)


def test_csv_has_a_line_for_every_row_and_every_digit(bare, tmp_path):
    words = "engines compare --engine pymunk --scenario thin-wall --scenario bounce"
    ran = bare(words, "--csv", "all.csv", "--json")
    with (tmp_path / "all.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(ran.json["rows"]) == 4
    assert float(rows[0]["value"]) == ran.json["rows"][0]["value"]
    assert {row["truth"] for row in rows} == {"0.25", "inf"}


def test_plot_writes_what_the_rows_suffice_for_and_says_what_they_do_not(bare, tmp_path):
    words = "engines compare --engine pymunk --quick"
    ran = bare(words, "--scenario", "free-fall", "--plot", "f.svg", "--json")
    assert [plot["path"] for plot in ran.json["plots"]] == [str(tmp_path / "f-steps.svg")]
    assert (tmp_path / "f-steps.svg").read_bytes().startswith(b"<?xml")
    bare(words, "--scenario", "bounce", "--plot", "g.png", "--plain").ends(0, "No figure: ")
    assert not list(tmp_path.glob("g*"))


def test_a_file_of_the_wrong_kind_is_refused_before_anything_is_measured(bare, monkeypatch):
    monkeypatch.setattr(comparing, "compare", lambda *_: pytest.fail("measured"))
    assert bare("engines compare --plot f.gif").code == 2
    assert bare("engines compare --csv f.txt").code == 2


def test_repetitions_show_their_spread_only_where_there_is_one_and_several_runs_their_range(bare):
    line = "engines compare --engine pymunk --scenario bounce --scenario slide"
    words = (*line.split(), "--repeat", "2")
    ran = bare(*words, "--plain").lacks("±")
    assert re.search(r"As it comes: 0.2454 m \(0.239 to 0.252\); Well set", ran.out)
    assert re.search(r"Engine: pymunk \(2-D\); As it comes: -6e-13 %; Well set", ran.out)
    rows = {(row["scenario"], row["setting"]): row for row in bare(*words, "--json").json["rows"]}
    assert len(rows["bounce", "default"]["samples"]) == 64
    assert rows["slide", "default"]["samples"] == []
    assert bare("engines compare --repeat 0").code == 2


@pytest.mark.usefixtures("colourless")
@pytest.mark.parametrize("columns", [60, 120])
def test_no_line_is_wider_than_the_window(bare, monkeypatch, columns):
    monkeypatch.setenv("COLUMNS", str(columns))
    lines = bare("engines compare --scenario bounce --scenario mass-ratio").rows
    assert max(map(len, lines)) <= columns
    # In a narrow window a cell may be broken between words, and loses none.
    assert {"2.84,", "reference"} <= {word for line in lines for word in line.split()}


def test_the_reference_is_never_the_best_ties_all_are_and_what_a_phase_could_change_makes_no_rank():
    rows = [row("pymunk", 0.26), row("ode", 0.24), row("dart", 0.3), row("physx", 0.25, origin="reference")]
    best = best_rows(rows)
    assert [id(one) in best for one in rows] == [True, True, False, False]
    # Alone in its column nobody is the best of anything.
    assert not best_rows([row("pymunk", 0.25), row("ode", 0.25, origin="reference")])
    sharp, near, far = row("physx", 0.2503, 0.2483, 0.2523), row("dart", 0.2511), row("ode", 0.2425)
    assert best_rows([sharp, near, far]) == {id(sharp), id(near)}
    # A wide range of its own does not make an engine best.
    wide = row("bullet", 0.3095, 0.148, 0.418)
    assert best_rows([sharp, wide]) == {id(sharp)}
