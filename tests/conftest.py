"""Makes the tests independent of how pytest is started, and spends no time on what no test needs.

They import what they share (``tests.contracts.boundary.levels``) from the checkout, which goes last on the
path: a package that is installed is still the one under test. And Ctrl-C reaches the programs they start,
even if pytest itself was started in the background, where a shell has it ignored.
"""

import gc
import os
import re
import signal
import subprocess
import sys
import time
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
    from course.isolation.probe import kept_sandboxes

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
        left_out = [config.invocation_params.dir / path for path in config.getoption("ignore") or ()]
        files = [path for path in files if not any(map(path.is_relative_to, left_out))]
        number = int(worker["workerid"].removeprefix("gw"))
        first = number * len(files) // worker["workercount"]
        config.args = [str(path) for path in files[first:] + files[:first]]


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """And all of them end with the same tests in the same order; of the long ones, those of the day."""
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: item.path)  # keeps the order within a file
    if config.args_source is pytest.Config.ArgsSource.TESTPATHS and os.environ.get("COURSE_TURNS") != "all":
        from tests.turns import of_other_days

        later = of_other_days(items, time.gmtime().tm_yday)
        config.hook.pytest_deselected(items=later)
        items[:] = [item for item in items if item not in set(later)]
    if slice_ := os.environ.get("COURSE_SOAK"):
        number, of = _slice(slice_)
        units = sorted({_unit(item) for item in items if item.get_closest_marker("soak")})
        mine = set(units[number::of])
        later = [item for item in items if item.get_closest_marker("soak") and _unit(item) not in mine]
        config.hook.pytest_deselected(items=later)
        items[:] = [item for item in items if item not in set(later)]


#: All of the long tests within a month, one slice a day.
_SLICES = 30


def _slice(asked: str) -> tuple[int, int]:
    """``today``, or ``3/30`` for one of as many."""
    number, _, of = f"{time.gmtime().tm_yday % _SLICES}/{_SLICES}".partition("/")
    if asked != "today":
        number, _, of = asked.partition("/")
    return int(number), int(of)


def _unit(item: pytest.Item) -> str:
    """What is not cut in two: a test, or a file in which all of them look at what was made once."""
    whole = item.get_closest_marker("xdist_group")
    return str(whole.args[0]) if whole else item.nodeid


def pytest_collection_finish() -> None:
    """What was collected is no garbage either."""
    gc.freeze()


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """What takes hours ran at some commit: says how much has changed since."""
    if config.args_source is not pytest.Config.ArgsSource.TESTPATHS:
        return
    text = (config.rootpath / "docs" / "measured.md").read_text("utf-8")
    commit = re.search(r"^\.ci/release at ([0-9a-f]{7,40})", text, re.MULTILINE)
    proved = ["course", "exercises", "solutions", "quiz", "tests"]
    if not commit:
        terminalreporter.write_line("The long runs (.ci/release) have left no outcome yet.", yellow=True)
        return
    diff = ["git", "diff", "--name-only", commit[1], "--", *proved]
    try:
        changed = subprocess.run(diff, cwd=config.rootpath, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):  # no git here, or not that far back
        return
    if files := changed.stdout.split():
        line = f"Since the long runs (.ci/release) at {commit[1]}, {len(files)} files have changed."
        terminalreporter.write_line(line, yellow=True)
