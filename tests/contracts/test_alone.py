"""Every file of tests, one test at a time in a process of its own.

"Every exercise" was once the two of a miniature course, because a neighbour had left its setting behind.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
_SKIPPED = {"graders", "fixtures", "benchmarks"}
FILES = [
    path
    for path in sorted((ROOT / "tests").rglob("test_*.py"))
    if path != Path(__file__) and not _SKIPPED & set(path.parts)
]


@pytest.mark.soak
@pytest.mark.skipif(os.name == "nt", reason="needs fork")
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem.removeprefix("test_"))
def test_each_test_passes_alone(path):
    """What is under soak has its own turn; 5 is a file in which everything is."""
    command = [sys.executable, "-m", "pytest", "-q", "-n", "0", "-p", "tests.alone", "-p", "no:cacheprovider"]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
    environment.pop("COURSE_SOAK", None)
    ran = subprocess.run(
        [*command, str(path)], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert ran.returncode in (0, 5), ran.stdout[-6000:] + ran.stderr[-2000:]
