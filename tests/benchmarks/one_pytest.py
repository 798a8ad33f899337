"""The hidden and public checks as one ordinary pytest file over one submission, without protection.

What ``protection.py`` runs as "a pytest process per submission"; COURSE_BENCH_SOURCE names the file.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]


from course.authoring.exercises.grading import LocalSubmission  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.scoring.judging.session import check_files  # noqa: E402

CATALOG = Catalog()
SOURCE = Path(os.environ["COURSE_BENCH_SOURCE"])
EXERCISE = CATALOG.exercise(SOURCE.stem)
for number, (path, _) in enumerate(check_files(EXERCISE, CATALOG, "full")):
    spec = importlib.util.spec_from_file_location(f"checks_{number}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    globals().update({name: value for name, value in vars(module).items() if name.startswith("test_")})


@pytest.fixture(scope="session")
def submission() -> LocalSubmission:
    return LocalSubmission(SOURCE.read_text("utf-8"), 0)


@pytest.fixture
def rng(request: pytest.FixtureRequest) -> np.random.Generator:
    return np.random.default_rng([0, zlib.crc32(request.node.name.encode())])


@pytest.fixture
def draw(rng: np.random.Generator) -> np.random.Generator:
    """Public checks draw their inputs too, as in a grading run."""
    return rng
