"""The house rules hold: style, types, and imports that go down only. One test command runs them all."""

import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.turns import lines_of, listed, of_other_days, times_in

ROOT = Path(__file__).parents[2]
_LINT_IMPORTS = "import sys; from importlinter.cli import lint_imports_command as run; sys.exit(run())"


def _run(*command):
    return subprocess.run(
        [sys.executable, *command], cwd=ROOT, capture_output=True, text=True, check=False, timeout=300
    )


@pytest.mark.parametrize(
    "command",
    [
        ("-m", "ruff", "check", "--output-format", "concise", "."),
        ("-m", "ruff", "format", "--check", "--quiet", "."),
        ("-m", "mypy"),
        ("-P", "-c", _LINT_IMPORTS, "--no-cache"),
    ],
    ids=["ruff check", "ruff format", "mypy", "import-linter"],
)
def test_the_repository_passes(command: tuple[str, ...]) -> None:
    done = _run(*command)
    assert done.returncode == 0, f"{done.stdout[-4000:]}\n{done.stderr[-1000:]}"


@pytest.mark.parametrize(
    "script",
    [
        path.relative_to(ROOT).as_posix()
        for path in sorted((ROOT / "tests" / "benchmarks").rglob("*.py"))
        if "\nfrom tests." in path.read_text("utf-8")
    ],
)
def test_a_script_starts_beside_a_package_that_installs_tests_of_its_own(script, tmp_path):
    """As the engine `dartpy` does: its `tests` stood in for ours, which was no package."""
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "__init__.py").touch()
    begun = f"import sys; sys.path.append({str(tmp_path)!r}); sys.argv[1:] = ['--help']"
    run = f"{begun}; import runpy; runpy.run_path({script!r}, run_name='__main__')"
    done = _run("-P", "-c", run)
    assert done.returncode == 0, done.stderr[-1000:]


_WITHOUT_EXTRAS = """
import sys

# What is None here cannot be imported.
sys.modules |= dict.fromkeys((
    "mujoco", "panda3d", "rapier3d", "sapien", "pybullet", "dartpy", "jupyterlab", "nbclient", "ipykernel",
    "anywidget", "distributed", "cryptography", "rosbags", "starlette", "uvicorn", "websockets",
))
import pytest
sys.exit(pytest.main(["--collect-only", "-q", "-n0", "-p", "no:cacheprovider", "tests"]))
"""


def test_tests_are_collected_without_any_extra():
    """As the README's second command has it; CI installs them all, and would hide such an import."""
    done = _run("-c", _WITHOUT_EXTRAS)
    assert done.returncode == 0, f"{done.stdout[-2000:]}\n{done.stderr[-1000:]}"


def _item(nodeid, long=False):
    return SimpleNamespace(nodeid=nodeid, get_closest_marker=lambda _: long)


def test_what_comes_in_turn_comes_once_in_its_days(monkeypatch):
    monkeypatch.setattr(
        "tests.turns.listed", lambda: {"a::many": (4, 0), "a::one": (4, 1), "a::many[9]": (4, 2)}
    )
    always = [_item("a::other"), _item("a::one_more[1]"), *(_item(f"a::many[{n}]", long=True) for n in "xyz")]
    turns = [*(_item(f"a::many[{n}]") for n in range(10)), _item("a::one")]
    seen = []
    for day in range(363, 367):
        later = of_other_days([*always, *turns], day)
        today = [item for item in turns if item not in later]
        assert not {*map(id, always)} & {*map(id, later)}
        assert 2 <= len(today) <= 4
        seen += today
    assert sorted(map(id, seen)) == sorted(map(id, turns))


def test_the_list_of_what_comes_in_turn_says_what_takes_longest():
    many = {f"a::many[{n}]": 0.5 for n in range(40)}
    one_of_them = {"a::f[x]": 9.0, "a::f[y]": 0.2, "a::f[z]": 0.2}
    times = {**many, **one_of_them, "a::quick": 0.2, "a::long": 30.0}
    assert lines_of(times) == ["8 a::long", "10 a::many", "8 a::f[x]"]


def test_times_are_those_of_the_tests_in_a_file_that_pytest_wrote(tmp_path):
    (tmp_path / "test_it.py").write_text("import time\ndef test_a(): time.sleep(0.2)\ndef test_b(): pass\n")
    done = _run("-m", "pytest", "-q", "--rootdir", tmp_path, "--junitxml", tmp_path / "it.xml", tmp_path)
    assert done.returncode == 0, done.stdout
    times = times_in([str(tmp_path / "it.xml")])
    assert {name.partition("::")[2] for name in times} == {"test_a", "test_b"}
    assert all(name.startswith("test_it.py::") for name in times)
    assert min(times, key=lambda name: times[name]) == "test_it.py::test_b"


def test_what_comes_in_turn_is_there():
    """A test that has another name runs every time, and a run takes longer than it says."""
    there = {name.partition("[")[0] for name in listed()}
    for path, function in (name.split("::") for name in sorted(there)):
        assert f"def {function}(" in (ROOT / path).read_text("utf-8"), f"{path}::{function}"
