"""The course's checks, public and hidden, on functions that are defined in this very process.

What the notebooks of other graders call: they have no worker to call functions in.
"""

import importlib.util
import inspect
import sys
import zlib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[3]), str(Path(__file__).resolve().parents[1])]


from course.authoring.exercises.grading import LocalSubmission  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.scoring.judging.session import check_files  # noqa: E402

SEED = 0


@cache
def checks(exercise: str) -> dict[str, Any]:
    """Check id to test function, in the order they are written in."""
    catalog = Catalog()
    found = {}
    for number, (path, _) in enumerate(check_files(catalog.exercise(exercise), catalog, "full")):
        spec = importlib.util.spec_from_file_location(f"checks_{number}", path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        found |= {name[5:]: fn for name, fn in vars(module).items() if name.startswith("test_")}
    return found


def points(exercise: str) -> dict[str, float]:
    """Check id to points."""
    return {
        name: next(mark.args[0] for mark in fn.pytestmark if mark.name == "points")
        for name, fn in checks(exercise).items()
    }


def run(exercise: str, check: str, namespace: dict[str, Any]) -> None:
    """Run one check on the functions in a namespace; it raises if they fail it."""
    submission = LocalSubmission("", SEED)
    vars(submission._module).update(namespace)
    fn = checks(exercise)[check]
    given: dict[str, Any] = {"submission": submission}
    for name in {"rng", "draw"} & inspect.signature(fn).parameters.keys():
        given[name] = np.random.default_rng([SEED, zlib.crc32(check.encode())])
    fn(**given)
