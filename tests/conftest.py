"""Makes the tests independent of how pytest is started, and spends no time on what no test needs.

They import what they share (``tests.contracts.boundary.levels``) from the checkout, which goes last on the
path: a package that is installed is still the one under test. And Ctrl-C reaches the programs they start,
even if pytest itself was started in the background, where a shell has it ignored.
"""

import gc
import os
import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

# Thousands of tests, and what they import, stay to the end. Looking through them for garbage every 700
# objects, as Python does of itself, was a fourteenth of a run; ``course`` looks as seldom.
gc.set_threshold(50_000, 20, 20)
# Beside JupyterLab, jsonschema compiles the grammar of a format for a second; no test checks a format.
sys.modules.setdefault("rfc3987_syntax", None)

# What an example takes says how busy the machine is.
settings.register_profile("course", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("course")

# The matrices here are small: a second thread for their products, in each of several workers, only waits.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.append(str(Path(__file__).resolve().parents[1]))


@pytest.fixture(scope="module")
def sandboxes() -> Iterator[None]:
    """For a module whose sessions take their sandboxes over from each other, as a lesson's do."""
    from course.isolation.keeping import kept_sandboxes

    with kept_sandboxes():
        yield


def _settings() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name.startswith("COURSE_")}


_AT_THE_START = _settings()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """No test meets the settings of another: a course that is left chosen makes "every exercise" two."""
    left = _settings()
    if left != _AT_THE_START:
        for name in left.keys() | _AT_THE_START.keys():
            os.environ.pop(name, None)
        os.environ.update(_AT_THE_START)
        pytest.fail(f"A fixture leaves {left} behind after its test.")


def pytest_xdist_auto_num_workers() -> int:
    """Two more than processors: for a third of its time a worker waits for a process that it started."""
    return (os.cpu_count() or 1) + 2


def pytest_configure(config: pytest.Config) -> None:
    """Each worker begins to collect at another file, so that most of what it imports is compiled already."""
    worker = getattr(config, "workerinput", None)
    if worker and config.args_source is pytest.Config.ArgsSource.TESTPATHS:
        tests, skipped = config.rootpath / "tests", set(config.getini("norecursedirs"))
        files = [path.relative_to(tests) for path in sorted(tests.rglob("test_*.py"))]
        files = [tests / path for path in files if not skipped & set(path.parts)]
        number = int(worker["workerid"].removeprefix("gw"))
        first = number * len(files) // worker["workercount"]
        config.args = [str(path) for path in files[first:] + files[:first]]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """And all of them end with the same tests in the same order."""
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: item.path)  # keeps the order within a file


def pytest_collection_finish() -> None:
    """What was collected is no garbage either."""
    gc.freeze()
