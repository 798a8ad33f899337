"""The house rules hold: style, types, and imports that go down only. One test command runs them all."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
_LINT_IMPORTS = "import sys; from importlinter.cli import lint_imports_command as run; sys.exit(run())"


def _run(*command: str, cwd: Path = ROOT) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *command], cwd=cwd, capture_output=True, text=True, check=False, timeout=300
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


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The package alone, with its rules, to break."""
    folder = tmp_path_factory.mktemp("floors")
    shutil.copytree(ROOT / "course", folder / "course", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


@pytest.mark.parametrize(
    ("module", "planted", "contract"),
    [
        (
            "catalog/locate.py",
            "import course.cli.frame.console",
            "Floors: imports go down only BROKEN",
        ),
        ("physics/systems.py", "import course.scoring.verdict", "Floors: imports go down only BROKEN"),
        ("catalog/pack.py", "import course.isolation.inside.wire", "Floors: imports go down only BROKEN"),
        ("authoring/report.py", "import typer", "Only the command line knows typer BROKEN"),
        ("isolation/inside/worker.py", "import course.errors", "imports nothing of the course BROKEN"),
    ],
)
def test_a_planted_violation_is_caught(copy: Path, module: str, planted: str, contract: str) -> None:
    path = copy / "course" / module
    before = path.read_text(encoding="utf-8")
    try:
        path.write_text(f"{before}\n{planted}\n", encoding="utf-8")
        # -P keeps this folder's package from being shadowed by, or from shadowing, the installed one.
        code = f"import sys; sys.path.insert(0, {str(copy)!r}); {_LINT_IMPORTS}"
        done = _run("-P", "-c", code, "--no-cache", cwd=copy)
    finally:
        path.write_text(before, encoding="utf-8")
    assert done.returncode != 0
    assert contract in done.stdout


def test_the_copy_is_clean_until_something_is_planted(copy: Path) -> None:
    """Otherwise the test above would pass for any reason."""
    code = f"import sys; sys.path.insert(0, {str(copy)!r}); {_LINT_IMPORTS}"
    done = _run("-P", "-c", code, "--no-cache", cwd=copy)
    assert done.returncode == 0, done.stdout
