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

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.append(str(Path(__file__).resolve().parents[1]))


@pytest.fixture(scope="module")
def sandboxes() -> Iterator[None]:
    """For a module whose sessions take their sandboxes over from each other, as a lesson's do."""
    from course.isolation.keeping import kept_sandboxes

    with kept_sandboxes():
        yield


def pytest_xdist_auto_num_workers() -> int:
    """Two more than processors: for a third of its time a worker waits for a process that it started."""
    return (os.cpu_count() or 1) + 2


def pytest_collection_finish() -> None:
    """What was collected is no garbage either."""
    gc.freeze()
