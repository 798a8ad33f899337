"""A comparison measures what it can, remembers it, and says what it could not do."""

from typing import ClassVar

import pytest

from course.engines import compare as module
from course.engines import reference
from course.engines.compare import LADDER, Request, compare
from course.engines.registry import Availability
from course.engines.results import Machine, Reference, Row


class Stand:
    """Stands in for every engine's process: a table of replies, and a record of what was asked."""

    replies: ClassVar[dict] = {}
    asked: ClassVar[list] = []

    def __init__(self, engine):
        self.engine = engine

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None

    def ask(self, job, seconds=0):
        Stand.asked.append((self.engine, job["do"], job.get("scenario"), job.get("setting"), job.get("dt")))
        special = Stand.replies.get((self.engine, job["do"], job.get("scenario"))) or Stand.replies.get(
            (self.engine, job["do"], None)
        )
        if special is not None:
            return special(job) if callable(special) else special
        known = {"options": {"n": 1} if job.get("setting") == "tuned" else {}, "why": []}
        if job["do"] == "chunk":
            # The engine takes twice as long as pymunk.
            return {"status": "ok", "seconds": job["steps"] * (1e-3 if self.engine == "pymunk" else 2e-3)}
        return {"status": "ok", "value": 0.5, "details": {}, "contacts": 400, **known}


@pytest.fixture
def stand(monkeypatch, tmp_path):
    """Three engines installed, one not; nothing started for real; a cache of its own."""
    Stand.replies, Stand.asked = {}, []
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path))
    monkeypatch.setattr(module, "EngineProcess", Stand)
    versions = {"pymunk": "7.3", "mujoco": "4.0", "panda3d": "1.10"}

    def available(info):
        if info.package in versions:
            return Availability(versions[info.package])
        return Availability(None, "not installed", f"pip install '{info.package}'")

    monkeypatch.setattr(module, "availability", available)
    shipped = Row(
        engine="physx",
        scenario="bounce",
        setting="default",
        dt=1 / 240,
        status="ok",
        value=0.2,
        origin="reference",
    )
    there = Reference(
        format_version=1, measured="2026-01-02", machine=Machine("Z80", "CP/M", 1, "0"), rows=(shipped,)
    )
    monkeypatch.setattr(reference, "load", lambda: there)
    return versions


def rows(comparison, engine, scenario="bounce"):
    return [row for row in comparison.rows if (row.engine, row.scenario) == (engine, scenario)]


def test_every_engine_is_measured_as_it_comes_and_well_set(stand):
    done = compare(Request(("pymunk", "mujoco"), ("bounce",)))
    assert [(row.engine, row.setting, row.status, row.origin) for row in done.rows] == [
        (engine, setting, "ok", "measured")
        for engine in ("pymunk", "mujoco")
        for setting in ("default", "tuned")
    ]
    assert rows(done, "mujoco")[1].options == {"n": 1}
    assert done.ran
    assert done.reference is None


def test_the_second_time_it_is_remembered_and_fresh_measures_again(stand):
    compare(Request(("mujoco",), ("bounce",)))
    asked = len(Stand.asked)
    again = compare(Request(("mujoco",), ("bounce",)))
    assert len(Stand.asked) == asked
    assert {row.origin for row in again.rows} == {"cached"}
    assert again.ran
    fresh = compare(Request(("mujoco",), ("bounce",), fresh=True))
    assert {row.origin for row in fresh.rows} == {"measured"}


@pytest.mark.parametrize("other", [{"quick": True}, {"repeat": 2}, {"steps": (0.01,)}])
def test_what_was_measured_otherwise_is_not_taken_for_it(stand, other):
    compare(Request(("mujoco",), ("bounce",)))
    done = compare(Request(("mujoco",), ("bounce",), **other))
    assert {row.origin for row in done.rows} == {"measured"}


def test_another_version_another_machine_and_other_code_are_measured_anew(stand, monkeypatch):
    from course.engines import results

    request = Request(("mujoco",), ("bounce",))
    compare(request)
    stand["mujoco"] = "4.1"
    assert {row.origin for row in compare(request).rows} == {"measured"}
    monkeypatch.setattr(module, "this_machine", lambda: Machine("Another", "one", 2, "3.11"))
    assert {row.origin for row in compare(request).rows} == {"measured"}
    monkeypatch.setattr(results, "code_digest", lambda: "other")
    assert {row.origin for row in compare(request).rows} == {"measured"}
    assert {row.origin for row in compare(request).rows} == {"cached"}


@pytest.mark.parametrize("status", ["crash", "deadline", "diverged", "failed"])
def test_one_engine_s_trouble_is_a_row_and_stops_nobody(stand, status):
    Stand.replies = {("mujoco", "measure", "bounce"): {"status": status, "message": "because"}}
    done = compare(Request(("mujoco", "pymunk"), ("bounce", "slide")))
    assert [(row.status, row.message, row.value) for row in rows(done, "mujoco")] == [
        (status, "because", None)
    ] * 2
    assert [row.status for row in rows(done, "mujoco", "slide")] == ["ok"] * 2
    assert [row.status for row in rows(done, "pymunk")] == ["ok"] * 2
    assert done.ran


def test_trouble_is_not_remembered(stand):
    Stand.replies = {("mujoco", "measure", "bounce"): {"status": "crash", "message": "because"}}
    compare(Request(("mujoco",), ("bounce",)))
    Stand.replies = {}
    assert [row.status for row in compare(Request(("mujoco",), ("bounce",))).rows] == ["ok", "ok"]


def test_an_engine_that_cannot_start_is_asked_once_and_every_row_says_why(stand):
    Stand.replies = {("mujoco", "measure", None): {"status": "unavailable", "message": "no libvulkan"}}
    done = compare(Request(("mujoco",), ("bounce", "slide")))
    assert {(row.status, row.message) for row in done.rows} == {("unavailable", "no libvulkan")}
    assert len([ask for ask in Stand.asked if ask[0] == "mujoco"]) == 1
    assert not done.ran


def test_what_is_not_installed_says_so_and_comes_from_the_reference_labelled(stand):
    done = compare(Request(("physx", "pymunk"), ("bounce",)))
    missing = rows(done, "physx")
    assert [(row.status, row.origin) for row in missing] == [
        ("not_installed", "measured"),
        ("not_installed", "measured"),
        ("ok", "reference"),
    ]
    assert done.reference.label == "measured on Z80, 1 core, CP/M, Python 0, 2026-01-02"
    state = next(state for state in done.engines if state.id == "physx")
    assert (state.version, state.command) == (None, "pip install 'sapien'")


def test_the_integrator_s_scenarios_climb_a_ladder_of_steps_unless_told(stand):
    done = compare(Request(("mujoco",), ("free-fall", "bounce")))
    assert sorted({row.dt for row in done.rows if row.scenario == "free-fall"}, reverse=True) == list(LADDER)
    assert {row.dt for row in done.rows if row.scenario == "bounce"} == {1 / 240}
    done = compare(Request(("mujoco",), ("free-fall",), (0.01, 0.002)))
    assert {row.dt for row in done.rows} == {0.01, 0.002}


def test_repetitions_give_the_median_and_the_spread(stand):
    values = iter([1.0, 4.0, 2.0, 0.0, 0.0, 0.0])
    Stand.replies = {
        ("mujoco", "measure", "bounce"): lambda job: {
            "status": "ok",
            "value": next(values),
            "details": {},
            "options": {"n": 1},
            "why": [],
        }
    }
    row = compare(Request(("mujoco",), ("bounce",), repeat=3)).rows[0]
    assert (row.value, row.spread, row.repeats) == (2.0, 3.0, 3)


def test_an_engine_with_nothing_to_set_is_measured_once(stand):
    Stand.replies = {("mujoco", "options", "bounce"): {"status": "ok", "options": {}, "why": []}}
    done = compare(Request(("mujoco",), ("bounce",)))
    assert [row.setting for row in done.rows] == ["default", "tuned"]
    assert [ask[1] for ask in Stand.asked] == ["measure", "options"]


def test_speed_is_a_ratio_to_pymunk_s_stretches_taken_in_turn(stand):
    row = compare(Request(("mujoco",), ("boxes",))).rows[0]
    assert row.value == pytest.approx(0.5)
    assert row.details["steps_per_second"] == pytest.approx(500)
    assert row.details["pymunk_steps_per_second"] == pytest.approx(1000)
    chunks = [ask[0] for ask in Stand.asked if ask[1] == "chunk"][2:]
    assert chunks[:6] == ["pymunk", "mujoco"] * 3


def test_a_crash_while_speed_is_measured_is_a_row(stand):
    Stand.replies = {("mujoco", "chunk", None): {"status": "crash", "message": "SIGSEGV"}}
    done = compare(Request(("mujoco", "pymunk"), ("boxes",)))
    assert [row.status for row in rows(done, "mujoco", "boxes")] == ["crash", "crash"]
    assert [row.status for row in rows(done, "pymunk", "boxes")] == ["ok", "ok"]


def test_progress_counts_to_the_end(stand):
    seen = []
    compare(Request(("mujoco", "pymunk"), ("bounce",)), lambda done, total, what: seen.append((done, total)))
    assert sorted(seen) == [(i, 4) for i in (1, 2, 3, 4)]


def test_a_folder_that_cannot_be_written_costs_only_the_memory(stand, monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("COURSE_CACHE", str(tmp_path / "file"))
    assert compare(Request(("mujoco",), ("bounce",))).ran


def test_a_damaged_memory_is_measured_again(stand, tmp_path):
    request = Request(("mujoco",), ("bounce",))
    compare(request)
    for file in tmp_path.rglob("*.json"):
        file.write_text(file.read_text()[:20])
    assert {row.origin for row in compare(request).rows} == {"measured"}


def test_probing_tells_an_engine_that_is_there_from_one_that_starts(stand):
    from course.engines.registry import ENGINES

    Stand.replies = {("mujoco", "options", None): {"status": "unavailable", "message": "ImportError: libGL"}}
    state = module.state_of(ENGINES["mujoco"], probe=True)
    assert (state.version, state.usable) == ("4.0", False)
    assert state.missing == "installed, but cannot start: ImportError: libGL"
    assert module.state_of(ENGINES["pymunk"], probe=True).usable
    assert not module.state_of(ENGINES["dart"], probe=True).usable
