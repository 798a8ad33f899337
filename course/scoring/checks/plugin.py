"""The pytest side of a check: markers, the fixtures ``submission``, ``rng`` and ``draw``, and light reports.

Checks are ordinary pytest functions. What pytest would print about them is of no use here, so the report
hook keeps the exception and builds no traceback text; the verdict is made from what the exception says.
"""

from __future__ import annotations

import zlib
from collections.abc import Generator
from typing import Any

import numpy as np
import pytest

from course.scoring.remote import RemoteSubmission

MARKERS = (
    "points(n): what the check is worth",
    "task(name): the function whose points these are",
    "requires(*checks): skipped unless these checks passed",
)


class CheckPlugin:
    """Passes the current submission to the checks and records how each check ended.

    Args:
        draws: public checks are to draw their inputs, as in a grading run.
    """

    def __init__(self, *, draws: bool = False) -> None:
        self.draws = draws
        self.submission: RemoteSubmission | None = None
        self.outcome: BaseException | None = None
        self.called = False
        self.refused: BaseException | None = None  # why a file could not be collected

    def pytest_configure(self, config: pytest.Config) -> None:
        for marker in MARKERS:
            config.addinivalue_line("markers", marker)

    @pytest.hookimpl(wrapper=True)
    def pytest_make_collect_report(self) -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
        report = yield
        call: pytest.CallInfo[Any] | None = getattr(report, "call", None)
        if report.failed and call is not None and call.excinfo is not None and self.refused is None:
            self.refused = call.excinfo.value
        return report

    @pytest.fixture(name="submission")
    def _submission(self) -> Any:
        return self.submission

    @pytest.fixture
    def rng(self, request: pytest.FixtureRequest) -> np.random.Generator:
        """Random numbers of this check in this grading run: the same again in a regrade."""
        assert self.submission is not None
        return np.random.default_rng([self.submission.seed, zlib.crc32(request.node.name.encode())])

    @pytest.fixture
    def draw(self, rng: np.random.Generator) -> np.random.Generator | None:
        """``rng`` in a grading run, where public checks draw their inputs too; None at home."""
        return rng if self.draws else None

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> pytest.TestReport:
        if call.excinfo is not None and self.outcome is None:
            self.outcome = call.excinfo.value
        self.called = self.called or call.when == "call"
        return pytest.TestReport(
            item.nodeid,
            item.location,
            {},
            "passed" if call.excinfo is None else "failed",
            None,
            call.when if call.when != "collect" else "call",
            duration=call.duration,
        )
