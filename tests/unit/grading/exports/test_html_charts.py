"""Bars, shares and times of the pages: what is drawn is what was counted."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from course.grading.exports.html_report.pages import (
    duration,
    duration_bins,
    macro,
    mark_of,
    percent,
    score_bins,
    when,
)
from course.grading.results.late import in_days
from tests.unit.grading.pages import Page


@given(
    st.lists(st.floats(0, 120) | st.integers(0, 100).map(float), max_size=60),
    st.sampled_from([2.0, 10.0, 100.0]),
)
def test_every_score_is_in_one_bar(scores: list[float], most: float) -> None:
    bins, each = score_bins(scores, most)
    assert sum(item.count for item in bins) == len(scores)
    assert len(bins) == (most + 1 if each else 10)


def test_whole_scores_of_few_points_have_a_bar_each() -> None:
    bins, each = score_bins([0, 3, 5, 5, 5], 5.0)
    assert each
    assert [(item.label, item.count) for item in bins] == [
        ("0", 1), ("1", 0), ("2", 0), ("3", 1), ("4", 0), ("5", 3),
    ]  # fmt: skip
    assert mark_of(0.8, 5.0, each=True) == 4, "the line stands left of the first score that passes"


def test_a_score_at_the_pass_mark_stands_right_of_its_line() -> None:
    bins, each = score_bins([69.9, 70.0, 100.0], 100.0)
    assert not each
    assert [item.count for item in bins] == [0, 0, 0, 0, 0, 0, 1, 1, 0, 1]
    assert mark_of(0.7, 100.0, each=False) == pytest.approx(7)


@given(st.lists(st.floats(0, 1e4), min_size=1, max_size=50))
def test_every_time_is_in_one_bar(seconds: list[float]) -> None:
    bins = duration_bins(seconds)
    assert sum(item.count for item in bins) == len(seconds)
    assert bins[0].count
    assert bins[-1].count


def test_only_everything_is_a_hundred_percent() -> None:
    shares = [(0, 300), (1, 300), (150, 300), (299, 300), (300, 300), (0, 0)]
    assert [percent(*share) for share in shares] == [
        "0 %", "under 1 %", "50 %", "over 99 %", "100 %", "–",
    ]  # fmt: skip


def test_bars_are_as_high_as_their_counts() -> None:
    bins, _ = score_bins([5.0] * 30 + [95.0] * 10, 100.0)
    page = Page(macro("charts", "histogram", bins, "Scores", "%", last="100", mark=(7.0, "pass mark")))
    heights = [float(item["height"] or 0) for item in page.all("rect")]
    assert heights[0] == pytest.approx(3 * heights[9], rel=1e-3)
    assert set(heights[1:9]) == {0}
    assert page.all("svg")[0]["aria-label"] == "Scores. 0 to under 10 %: 30; 90 to 100 %: 10"
    assert page.faults == []


def test_no_bar_leaves_its_track() -> None:
    drawing = macro(
        "charts",
        "bar_rows",
        [("half", 5, 10), ("more", 15, 10), ("less", -1, 10), ("nothing", 0, 0)],
        "Points",
    )
    widths = [float(found) for found in re.findall(r'width="([\d.]+)" height="10" class="bar"', drawing)]
    assert widths == [180, 360, 0, 0]
    assert "15 of 10" in Page(drawing).pieces


def test_times_are_written_as_a_person_reads_them() -> None:
    assert [duration(value) for value in (0.0004, 0.0123, 0.9, 1.234, 75.0)] == [
        "0.4 ms", "12 ms", "900 ms", "1.23 s", "75 s",
    ]  # fmt: skip
    assert [in_days(value) for value in (1, 900, 900.5, 3_700, 86_400, 87_060, 90_100)] == [
        "1 min", "15 min", "16 min", "1 h 2 min", "1 d", "1 d 11 min", "1 d 1 h 2 min",
    ]  # fmt: skip
    assert when("2026-12-01T23:59:07Z") == "2026-12-01 23:59 UTC"
    assert when("") == ""
