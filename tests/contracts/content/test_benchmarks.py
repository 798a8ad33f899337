"""The benchmarks are run by hand, so what they rely on is tested here."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from course.catalog.load import Catalog
from course.scoring.judging.session import Submission
from course.scoring.judging.terms import Terms

if TYPE_CHECKING:
    from types import ModuleType

_BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def seeds() -> ModuleType:
    spec = importlib.util.spec_from_file_location("seeds", _BENCHMARKS / "calibration/seeds.py")
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("here", [True, False])
def test_a_submission_is_graded_with_the_seed_that_was_sown(seeds: ModuleType, here: bool) -> None:
    catalog = Catalog()
    exercise = catalog.exercise("fall-time")
    submission = Submission({exercise.module: exercise.stub_path.read_bytes()})
    with seeds.Seeded(exercise, catalog, scope="full", terms=Terms()) as session:
        session.here = here
        for seed in (3, 1234):
            session.sow(seed)
            loaded = session._load(submission)
            assert loaded.seed == seed
            loaded.close()
