"""Judging the form of ``engine_facts``: what is there, where it is from, and when it held."""

from __future__ import annotations

import collections
import datetime
import math
import re
import weakref
from typing import Any

from course.scoring import kit

named = kit.words("engine-comparison")

TASK = "engine_facts"
ENGINES = ("ode", "bullet", "physx", "mujoco")
FIELDS = ("licence", "language", "default_integrator", "default_step_s", "used_by")
KEYS = ("engine", "field", "value", "source", "as_of")
INTEGRATORS = ("explicit_euler", "semi_implicit_euler", "velocity_verlet", "rk4", "implicit_euler")

_ADDRESS = re.compile(r"https?://[A-Za-z0-9-]+(\.[A-Za-z0-9-]+)+(:\d+)?([/?#]\S*)?")
_DATE = re.compile(r"\d{4}-\d{2}-\d{2}")

_KEPT: weakref.WeakKeyDictionary[Any, Any] = weakref.WeakKeyDictionary()


def entries(submission: Any) -> list[dict[str, Any]]:
    """What ``engine_facts()`` returned: a list of dicts with the five keys. It is asked once, and once again.

    Raises:
        CheckFailed: it is no such list.
    """
    if submission not in _KEPT:
        _KEPT[submission] = submission.call_each(TASK, [(), ()])
    listed, again = (kit.as_list(told, "the list of facts") for told in _KEPT[submission])
    if len(again) != len(listed):
        kit.fail(
            "A second call of engine_facts returns another number of entries.",
            help="Make a new list in every call: one that is kept may be filled again, or used up.",
            diagnose=named("GROWS_WITH_EACH_CALL"),
            expected=len(listed),
            actual=len(again),
        )
    return [kit.as_record(entry, KEYS, "an entry") for entry in listed]


def by_pair(listed: list[dict[str, Any]]) -> dict[tuple[str, str], dict[str, Any]]:
    """Entries by engine and field; the first one where there are two."""
    found: dict[tuple[str, str], dict[str, Any]] = {}
    for entry in listed:
        found.setdefault((str(entry["engine"]), str(entry["field"])), entry)
    return found


def expect_complete(listed: list[dict[str, Any]]) -> None:
    """Each pair of engine and field once, no other, each value of its kind."""
    pairs = [
        (kit.as_text(entry["engine"], "an engine"), kit.as_text(entry["field"], "a field"))
        for entry in listed
    ]
    for engine, field in pairs:
        if engine not in ENGINES or field not in FIELDS:
            kit.fail(
                "An entry is about an engine or a field that the README does not list.",
                help=f"The engines are {', '.join(ENGINES)}; the fields are {', '.join(FIELDS)}.",
                actual=[engine, field],
            )
    _expect_different(listed)
    for pair in ((engine, field) for engine in ENGINES for field in FIELDS):
        if pairs.count(pair) != 1:
            if pairs.count(pair) == 0:
                expect_pair(listed, pair)
            kit.fail(
                "The list has more than one entry for a pair.",
                diagnose=named("PAIR_TWICE"),
                expected="one entry",
                actual={"/".join(pair): pairs.count(pair)},
            )
    for entry in listed:
        _expect_kind(entry)


def _expect_kind(entry: dict[str, Any]) -> None:
    """The value has the type that its field asks for."""
    field, value = entry["field"], entry["value"]
    name = f"the {field} of {entry['engine']}"
    if field == "used_by":
        names = kit.as_list(value, name)
        if not names or not all(isinstance(item, str) and item.strip() for item in names):
            kit.fail(f"The {field} of an engine is not a list of names.", help=_USED_BY, actual=value)
    elif field == "default_step_s":
        if value is not None and not 0 < step_of(value, name) < math.inf:
            kit.fail("A default step is not a positive number of seconds.", help=_STEP, actual=value)
    else:
        text = kit.as_text(value, name)
        if field == "default_integrator" and text.strip().lower() not in INTEGRATORS:
            kit.fail(
                "A default integrator is not one of those that the README lists.",
                help=f"Use one of {', '.join(INTEGRATORS)}.",
                actual=text,
            )


def step_of(value: Any, name: str) -> float:
    """A default step that is given, as a number."""
    if isinstance(value, str):
        kit.fail(
            f"{name[0].upper()}{name[1:]} is a text, and neither a number nor None.",
            help="Leave the quotation marks out: a step is 0.01 or None, not '0.01' or 'None'.",
            actual=repr(value),
        )
    return float(kit.as_number(value, name))


_USED_BY = "Give a list with at least one project that runs on this engine, by its own name."
_STEP = "Give the step in seconds, or None where the engine has none of its own."


def _expect_different(listed: list[dict[str, Any]]) -> None:
    """The entries are not all the same."""
    if len(listed) > 1 and all(str(entry) == str(listed[0]) for entry in listed):
        kit.fail(
            "All entries are the same.",
            help="There are four engines and five fields: twenty entries, one for each pair.",
            diagnose=named("ENTRIES_ALL_ONE"),
            actual={f"{listed[0]['engine']}/{listed[0]['field']}": len(listed)},
        )


def expect_pair(listed: list[dict[str, Any]], pair: tuple[str, str]) -> dict[str, Any]:
    """The entry for an engine and a field, the first one where there are two.

    Raises:
        CheckFailed: there is none. Where another pair has more than one, that is told, too.
    """
    found = by_pair(listed)
    if pair not in found:
        _expect_different(listed)
        again = len(found) < len(listed)
        counts = collections.Counter((str(entry["engine"]), str(entry["field"])) for entry in listed)
        most = max(counts, key=counts.__getitem__, default=pair)
        kit.fail(
            "An entry is missing.",
            diagnose=named("PAIR_TWICE_AND_MISSING" if again else "PAIR_MISSING"),
            expected="one entry",
            actual={"/".join(pair): 0} | ({"/".join(most): counts[most]} if again else {}),
        )
    return found[pair]


def expect_sources(listed: list[dict[str, Any]]) -> None:
    """Every entry names an address and a day; all twenty pairs are there."""
    for engine in ENGINES:
        for field in FIELDS:
            expect_pair(listed, (engine, field))
    for entry in listed:
        about = {"engine": entry["engine"], "field": entry["field"]}
        source = kit.as_text(entry["source"], "a source")
        if not _ADDRESS.fullmatch(source.strip()):
            kit.fail(
                "The source of a fact is not accepted as a web address.",
                diagnose=named("SOURCE_NOT_A_URL"),
                input=about,
                actual=source,
            )
        day = date_of(entry)
        if day is None or day.year < 2001:
            kit.fail(
                "A fact has no valid date.",
                diagnose=named("NOT_A_DATE"),
                input=about,
                actual=entry["as_of"],
            )
        # A day's grace: the date line runs between a student and the grader.
        if day > datetime.datetime.now(tz=datetime.UTC).date() + datetime.timedelta(days=1):
            kit.fail(
                "The date of a fact lies in the future.",
                diagnose=named("DATE_AHEAD"),
                input=about,
                actual=entry["as_of"],
            )


def date_of(entry: dict[str, Any]) -> datetime.date | None:
    """The day of an entry, or None if it is no calendar date of the form YYYY-MM-DD."""
    text = entry["as_of"]
    if not isinstance(text, str) or not _DATE.fullmatch(text):
        return None
    try:
        return datetime.date.fromisoformat(text)
    except ValueError:
        return None
