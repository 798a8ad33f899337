"""Each test in a new process, forked when its file had been collected: ``pytest -p tests.alone FILE``.

A test that is green only beside its neighbours, or red without them, shows itself.
"""

import os
import pickle

import pytest
from _pytest.runner import runtestprotocol


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> bool:
    """The reports of a test come back through a pipe."""
    hook = item.config.hook
    hook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    reader, writer = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.close(reader)
        reports = runtestprotocol(item, log=False, nextitem=None)
        told = [hook.pytest_report_to_serializable(config=item.config, report=one) for one in reports]
        with os.fdopen(writer, "wb") as pipe:
            pickle.dump(told, pipe)
        os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as pipe:
        data = pipe.read()
    os.waitpid(pid, 0)
    if data:
        read = hook.pytest_report_from_serializable
        reports = [read(config=item.config, data=one) for one in pickle.loads(data)]
    else:
        reports = [pytest.TestReport(item.nodeid, item.location, {}, "failed", "its process ended", "call")]
    for report in reports:
        hook.pytest_runtest_logreport(report=report)
    hook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True
