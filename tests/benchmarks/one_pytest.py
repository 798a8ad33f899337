"""The hidden and public checks as one ordinary pytest file over one submission, without protection.

What ``protection.py`` runs as "a pytest process per submission"; COURSE_BENCH_SOURCE names the file.
"""

import os
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest

sys.path[:0] = [str(Path(__file__).with_name("peers"))]

import here  # noqa: E402

from course.authoring.exercises.grading import LocalSubmission  # noqa: E402

SOURCE = Path(os.environ["COURSE_BENCH_SOURCE"])
globals().update({f"test_{name}": check for name, check in here.checks(SOURCE.stem).items()})


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
