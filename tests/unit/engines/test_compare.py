"""A comparison measures what it can, remembers it, and says and draws only what its rows show."""

import math
from typing import ClassVar

import msgspec
import pytest

from course.engines import compare as module
from course.engines import reference
from course.engines.compare import LADDER, QUICK_LADDER, Request, compare
from course.engines.findings import chaos, defaults, findings, fingerprints, phases, same_algorithm, slope
from course.engines.registry import Availability
from course.engines.results import Machine, Reference, Row
from course.figures import engines as drawn
from course.figures.style import house_style


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


# -- what its rows show ----------------------------------------------------------------------------------


def row(engine, scenario, value, setting="tuned", samples=(), **details):
    return Row(
        samples=samples,
        engine=engine,
        scenario=scenario,
        setting=setting,
        dt=1 / 240,
        status="ok",
        value=value,
        details=details,
    )


def swings(engine, *ends, setting="tuned"):
    return row(engine, "double-pendulum", 1.0, setting, at_the_end_percent=list(ends))


def test_the_free_fall_names_the_velocity_that_moves_a_body():
    said = fingerprints(
        [
            row("mujoco", "free-fall", 0.5, steps=200),
            row("pymunk", "free-fall", -0.5, steps=200),
            row("rapier", "free-fall", 0.125, steps=200),
            row("dart", "free-fall", 0.5, steps=200),
            row("pybullet", "free-fall", -4.7, steps=200),
        ]
    )
    assert "The new one: MuJoCo and DART" in said
    assert "the old one: pymunk (2-D)" in said
    assert "the new one in each of 4 substeps: Rapier" in said
    assert "Bullet 3" not in said


def test_engines_agree_only_if_every_start_does():
    same = [swings("mujoco", 4.4, 9.2), swings("dart", 4.4, 9.2), swings("physx", 4.5, 9.2)]
    assert same_algorithm(same).endswith("in MuJoCo and DART.")
    assert same_algorithm([swings("mujoco", 4.4, 9.2), swings("dart", 4.4, 9.3)]) == ""
    assert same_algorithm([swings("mujoco"), swings("dart")]) == ""


def test_an_engine_as_it_comes_may_agree_with_another_one_well_set():
    said = same_algorithm([swings("mujoco", 4.4, setting="default"), swings("pybullet", 4.4)])
    assert said.endswith("in MuJoCo and Bullet 3.")


def test_defaults_count_where_options_moved_one_engine_beyond_all():
    rows = [
        row("mujoco", "bounce", 0.0, "default"),
        row("mujoco", "bounce", 0.25),
        row("ode", "bounce", 0.247, "default"),
        row("ode", "bounce", 0.247),
        row("mujoco", "slide", 0.0, "default"),
        row("mujoco", "slide", 0.0),
        row("ode", "slide", 1.0, "default"),
        row("ode", "slide", 1.0),
    ]
    assert "in 1 of 2 scenarios (bounce)" in defaults(rows)
    assert defaults(rows[4:]) == ""
    assert defaults(rows[:2]) == ""


def test_a_move_within_the_range_of_the_phases_is_not_called_an_option_s():
    still = [row(e, "bounce", 0.25, s) for e in ("ode", "dart") for s in ("default", "tuned")]
    moved = [
        row("mujoco", "bounce", 0.1, "default", samples=(0.05, 0.24)),
        row("mujoco", "bounce", 0.25, samples=(0.23, 0.27)),
    ]
    assert defaults([*still, *moved]) == ""
    apart = [row("mujoco", "bounce", 0.1, "default", samples=(0.05, 0.18)), moved[1]]
    assert "in 1 of 1 scenarios (bounce)" in defaults([*still, *apart])
    # Well-set engines lie as far apart as their phases reach.
    wide = [row("bullet", "bounce", 0.25, s, samples=(0.1, 0.4)) for s in ("default", "tuned")]
    assert defaults([*still, *apart, *wide]) == ""


def test_the_widest_impact_is_named_with_its_range_and_narrow_ones_are_not():
    rows = [
        row("bullet", "bounce", 0.25, samples=(0.14, 0.41)),
        row("ode", "bounce", 0.25, samples=(0.24, 0.26)),
        row("ode", "small-drop", 5.0, samples=(4.0, 6.0)),
    ]
    assert "Bullet 2.84 gives between 0.1400 and 0.4100 m in bounce" in phases(rows)
    assert "ODE gives between 4.00 and 6.00 mm in small-drop" in phases(rows[1:])
    assert phases([row("ode", "bounce", 0.25, samples=(0.249, 0.251))]) == ""
    assert phases([row("ode", "bounce", 0.25)]) == ""


def test_chaos_quotes_the_widest_engine_and_keeps_quiet_about_small_ones():
    assert "DART" in chaos([swings("dart", -9.6, 9.2), swings("mujoco", -1.0, 1.0)])
    assert "between -9.6 and +9.2 %" in chaos([swings("dart", -9.6, 9.2)])
    assert chaos([swings("mujoco", 0.0, 1e-5)]) == ""


def test_rows_without_a_value_say_nothing():
    failed = Row(engine="ode", scenario="free-fall", setting="tuned", dt=1 / 240, status="crash")
    assert findings([failed]) == ()


@pytest.mark.parametrize("order", [1, 2, 4])
def test_the_slope_is_the_order(order):
    points = [(dt, 3e6 * dt**order * 1e-3) for dt in (1 / 60, 1 / 120, 1 / 240, 1 / 480)]
    assert slope(points, single=False) == pytest.approx(order)


def test_round_off_has_no_slope():
    points = [(0.1, 1e-7), (0.05, 1e-7), (0.025, 1e-7)]
    assert slope(points, single=True) is None
    assert slope(points, single=False) == pytest.approx(0.0)


def test_the_steps_name_every_engine_and_only_mujoco_s_pendulum_is_of_order_four():
    with house_style():
        figure = drawn._steps(reference.load().rows)
    said = [text.get_text() for axes in figure.axes for text in axes.texts]
    for name in ("pymunk", "ODE", "Bullet 2.84", "Rapier", "PhysX", "Bullet 3", "DART"):
        assert any(name in words for words in said)
    assert [words for words in said if "order 4.0" in words] == ["MuJoCo: order 4.0"]
    # Of its pendulum a smaller step gives a larger error: no order is claimed.
    assert "Rapier" in said


def inside(figure):
    """The texts of a figure that stick out of it, or out of it and into the next panel."""
    figure.canvas.draw()
    size = figure.bbox
    out = []
    for axes in figure.axes:
        for text in axes.texts:
            box = text.get_window_extent()
            next_panel = min((o.bbox.x0 for o in figure.axes if o.bbox.x0 > axes.bbox.x0), default=size.x1)
            if box.x0 < 0 or box.x1 > next_panel or box.y0 < axes.bbox.y0 or box.y1 > size.y1:
                out.append(text.get_text())
    return out


@pytest.mark.parametrize("ladder", [LADDER, QUICK_LADDER])
@pytest.mark.parametrize("tests", [("free-fall",), ("pendulum",), ("free-fall", "pendulum")])
def test_no_name_of_the_steps_is_cut(ladder, tests):
    rows = [
        row
        for row in reference.load().rows
        if row.scenario in tests and any(math.isclose(row.dt, dt) for dt in ladder)
    ]
    with house_style():
        assert inside(drawn._steps(rows)) == []


def test_of_the_figures_those_are_drawn_for_which_the_rows_suffice():
    rows = reference.load().rows
    pendulum = [row for row in rows if row.scenario == "pendulum"]
    one_engine = [row for row in rows if row.engine == "dart" and row.scenario in ("boxes", "stack")]
    failed = [msgspec.structs.replace(row, status="crash", value=None) for row in rows]
    single = [row for row in pendulum if row.dt == 1 / 240]
    figures = [list(drawn.render(given, "png")) for given in (pendulum, one_engine, failed, single)]
    assert figures == [["steps"], ["speed"], [], []]
