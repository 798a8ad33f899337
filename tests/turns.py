"""Which of many cases an ordinary run tries; the others are tried under ``soak``, or on other days.

What comes in turn stands in ``in_turn.txt``: so many turns, and a test, or a function with all its
cases. Nobody writes it by hand:

    COURSE_TURNS=all pytest --junitxml times.xml && python -m tests.turns times.xml

Several files are taken together, where the tests ran in parts.
"""

import itertools
import math
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

LIST = Path(__file__).with_name("in_turn.txt")
#: What takes less, in seconds, is run every time.
WORTH_IT = 1.0
#: Turns of what takes more, and from how many seconds on it has twice as many. Many cases have so many that
#: a day has two seconds of them, but no more than twelve.
TURNS, LONG, A_DAY, MOST = 4, 5.0, 2.0, 12
#: Decides by what has changed how much it tries.
_ALWAYS = {"tests/contracts/content/test_course_exercises.py::test_the_audit_finds_nothing_wrong"}


def soak_unless(chosen: Iterable[Any], cases: Iterable[Any]) -> list[Any]:
    """The cases as parameters, those marked ``soak`` that are not among the chosen.

    Args:
        cases: values of one parameter, or tuples of several.
    """
    ordinary = list(chosen)

    def parameters(case: Any) -> Any:
        values = case if isinstance(case, tuple) else (case,)
        return pytest.param(*values, marks=() if case in ordinary else pytest.mark.soak)

    return [parameters(case) for case in cases]


@cache
def listed() -> Mapping[str, tuple[int, int]]:
    """For each test or function that comes in turn, how many turns there are and its place in the list."""
    lines = (line.split(" ", 1) for line in LIST.read_text("utf-8").splitlines())
    return {name: (int(turns), place) for place, (turns, name) in enumerate(lines)}


def of_other_days(items: Iterable[pytest.Item], day: int) -> list[pytest.Item]:
    """Those that come in turn, and are not one of this day.

    Long ones (``soak``) have slices of their own, and are left to them.
    """
    later = []
    cases = Counter[str]()
    for item in items:
        function = item.nodeid.partition("[")[0]
        name = item.nodeid if item.nodeid in listed() else function
        if name in listed() and not item.get_closest_marker("soak"):
            turns, place = listed()[name]
            # Neighbours in the list take equally long, and have different days.
            if (place + cases[name] + day) % turns:
                later.append(item)
            cases[name] += 1
    return later


def lines_of(times: Mapping[str, float]) -> list[str]:
    """What comes in turn, the longest first, by what each test took in seconds.

    A case that takes longer than all others of its function stands by itself.
    """
    functions = defaultdict[str, dict[str, float]](dict)
    for test, seconds in times.items():
        functions[test.partition("[")[0]][test] = seconds
    found: list[tuple[float, str, int]] = []
    for function, cases in functions.items():
        longest = max(cases, key=lambda case: cases[case])
        if len(cases) > 1 and cases[longest] >= max(WORTH_IT, sum(cases.values()) / 2):
            found.append((cases.pop(longest), longest, 1))
        found.append((sum(cases.values()), function, len(cases)))
    return [
        f"{_turns(seconds, cases)} {name}"
        for seconds, name, cases in sorted(found, reverse=True)
        if seconds >= WORTH_IT and name not in _ALWAYS
    ]


def _turns(seconds: float, cases: int) -> int:
    if cases > TURNS:
        return min(max(TURNS, math.ceil(seconds / A_DAY)), MOST)
    return TURNS if seconds < LONG else 2 * TURNS


def times_in(files: Iterable[str]) -> dict[str, float]:
    """What each test took, from files that pytest wrote."""
    times = Counter[str]()
    for case in itertools.chain.from_iterable(ElementTree.parse(file).iter("testcase") for file in files):
        path = case.attrib["classname"].replace(".", "/")
        times[f"{path}.py::{case.attrib['name']}"] += float(case.attrib["time"])
    return times


if __name__ == "__main__":
    LIST.write_text("".join(f"{line}\n" for line in lines_of(times_in(sys.argv[1:]))), "utf-8")
