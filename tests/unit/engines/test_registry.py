"""What is missing, and the command that installs it, come from the course's own metadata."""

import importlib.metadata
import re
import tomllib
from pathlib import Path

import pytest

from course import extras
from course.engines import reference
from course.engines.registry import ENGINES, availability, get
from course.engines.results import this_machine
from course.engines.scenarios import SCENARIOS
from course.errors import NotFoundError
from course.extras import PARTS, Requirement, requirement_of

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def metadata(monkeypatch):
    lines = [
        "numpy>=2.0",
        "mujoco>=4.0; extra == 'engines'",
        'panda3d>=1.10.16 ; extra == "engines"',
        "pybullet>=3.2.7; (python_version < '3.0') and extra == 'bullet'",
    ]
    monkeypatch.setattr(importlib.metadata, "requires", lambda _name: lines)
    return lines


def nothing(name):
    raise importlib.metadata.PackageNotFoundError(name)


def test_the_command_lists_the_requirement_itself(metadata):
    assert requirement_of("mujoco").command == "pip install 'mujoco>=4.0'"
    assert requirement_of("panda3d") == Requirement("panda3d", ">=1.10.16", "engines")
    assert requirement_of("unheard-of").command == "pip install 'unheard-of'"


def test_a_wheel_that_this_machine_has_not_is_said_instead_of_a_command(metadata, monkeypatch):
    monkeypatch.setattr(importlib.metadata, "version", nothing)
    pybullet = availability(get("pybullet"))
    assert not pybullet.installed
    assert pybullet.command == ""
    assert re.fullmatch(
        r"pybullet has no wheel for Python 3\.\d+\.\d+ on \w+ \w+; there are some where .+", pybullet.missing
    )
    assert availability(get("mujoco")).command == "pip install 'mujoco>=4.0'"


def test_a_checkout_that_was_never_installed_reads_its_own_file(monkeypatch):
    monkeypatch.setattr(importlib.metadata, "requires", nothing)
    assert requirement_of("rapier3d").text.startswith("rapier3d>=")


def test_every_engine_is_in_the_extra_that_it_names():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for info in ENGINES.values():
        lines = project["optional-dependencies"][info.extra] if info.extra else project["dependencies"]
        assert any(re.match(rf"{info.package}\b", line) for line in lines), info.id


def test_an_engine_has_an_adapter_of_its_name():
    folder = ROOT / "course" / "engines" / "adapters"
    assert all((folder / f"{name}.py").is_file() for name in ENGINES)


def test_an_unknown_engine_is_not_found():
    with pytest.raises(NotFoundError) as caught:
        get("newton")
    assert "mujoco" in caught.value.help


def test_the_reference_holds_every_engine_in_every_scenario():
    shipped = reference.load()
    found = {(row.engine, row.scenario, row.setting) for row in shipped.rows}
    wanted = {(e, s, t) for e in ENGINES for s in SCENARIOS for t in ("default", "tuned")}
    assert wanted - found == {("pymunk", "diagonal", "default"), ("pymunk", "diagonal", "tuned")}
    assert {row.origin for row in shipped.rows} == {"reference"}
    assert all(row.ok and row.value is not None for row in shipped.rows)


def test_the_reference_says_when_and_on_what_it_was_measured_and_names_no_machine():
    shipped = reference.load()
    assert shipped.format_version == reference.FORMAT_VERSION
    assert re.fullmatch(r"20\d\d-\d\d-\d\d", shipped.measured)
    assert shipped.machine.cpu
    text = (ROOT / "course" / "engines" / "reference.json").read_text(encoding="utf-8")
    # Sets of versions and values; nothing that looks like a path or a host.
    assert not re.search(r"[\"' ]/(home|root|tmp|usr|work)|\.local\b|@", text)


def test_a_machine_is_described_without_its_name():
    import platform

    words = str(this_machine())
    assert platform.node() not in words
    assert platform.system() in words


def test_a_missing_reference_is_an_empty_one(monkeypatch, tmp_path):
    monkeypatch.setattr(reference, "files", lambda _name: tmp_path)
    reference.load.cache_clear()
    try:
        assert reference.load().rows == ()
    finally:
        reference.load.cache_clear()


def test_a_checkout_file_that_cannot_be_read_leaves_the_bare_name(monkeypatch, metadata):
    metadata.clear()
    monkeypatch.setattr(extras, "_from_checkout", list)
    assert requirement_of("mujoco").text == "mujoco"


def test_every_extra_is_a_part_and_brings_what_the_part_needs():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    optional = project["optional-dependencies"]
    assert set(PARTS) == set(optional) - {"all", "dev"}
    for name, part in PARTS.items():
        distributions = {package.rpartition("=")[2] for package in part.packages}
        assert distributions == {re.match(r"[\w.-]+", line)[0].lower() for line in optional[name]}


@pytest.mark.parametrize(
    ("marker", "group", "applies", "served"),
    [
        ("", "", True, ""),
        ("; extra == 'bullet'", "bullet", True, ""),
        ("; (python_version < '3.0' and sys_platform == 'linux') and extra == 'bullet'", "bullet", False,
         "python_version < '3.0' and sys_platform == 'linux'"),
        ("; python_version < '3.0' and extra == 'bullet'", "bullet", False, "python_version < '3.0'"),
        ("; extra == 'bullet' and python_version < '3.0'", "bullet", False, "python_version < '3.0'"),
        ("; python_version >= '3.0' and extra == 'bullet'", "bullet", True, "python_version >= '3.0'"),
    ],
)  # fmt: skip
def test_a_requirement_says_which_machines_are_served_and_whether_this_one_is(
    metadata, marker, group, applies, served
):
    metadata[:] = [f"x>=1{marker}"]
    found = requirement_of("x")
    assert (found, found.served) == (Requirement("x", ">=1", group, applies), served)
    assert (f"there are some where {served}" in found.unserved) is not applies
