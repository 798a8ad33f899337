"""How engines are set for a test, by two rules that are the same for all of them.

*As it comes*: every option keeps the value that the installed package gives it. Only what defines the test is
set: the step (one call advances by exactly one), gravity, shapes, masses and inertias, the start, and the
values that the engine's rule for two materials needs. Three things are switched off everywhere, because with
them the test would measure something else: sleeping, motors that hold joints, and contacts between the bodies
of a chain.

*Well set*: an engine's options are listed in ``options/<engine>.toml``, each with what it does, the
documentation it was read from, and the values worth trying for a topic; those left alone are listed as well.
Of all combinations, including the defaults, the one whose mean over the phases of a step is closest to the
truth is used; of equally good ones, the one that changes the fewest options. No engine's solver gets more
than ``BUDGET`` iterations a step, and all have the same step. So no engine is worse well set than as it
comes, and none is judged by options that were not tried. ``tests/benchmarks/engines_settings.py`` makes the
choice and writes ``well_set.json``.
"""

from __future__ import annotations

import functools
import itertools
import tomllib
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import msgspec

from course.engines.base import AS_IT_COMES, Tuning

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = [
    "BUDGET",
    "TOPICS",
    "Choice",
    "Option",
    "Options",
    "UnusedOption",
    "candidates",
    "choices",
    "options_of",
    "tuning",
]  # fmt: skip

#: The largest number of iterations that a solver may get in a step.
BUDGET = 100
#: The topic of each scenario; only the options of this topic are tried in it.
TOPICS = {
    "free-fall": "motion",
    "pendulum": "joint",
    "double-pendulum": "joint",
    "long-step": "joint",
    "clash": "impact",
    "bounce": "impact",
    "small-drop": "impact",
    "slide": "friction",
    "stick": "friction",
    "diagonal": "friction",
    "stack": "pile",
    "mass-ratio": "pile",
    "thin-wall": "sweep",
    "boxes": "pile",
}


class Option(msgspec.Struct, frozen=True, kw_only=True):
    """One option that may be set.

    Attributes:
        key: its name in the adapter's ``build``.
        name: its name in the engine.
        default: its value in the package, in words.
        does: its effect.
        source: where that was read; empty for the engine's ``documented``.
        values: those tried, by topic (``try`` in the file).
    """

    key: str
    name: str
    default: str
    does: str
    source: str = ""
    values: dict[str, list[Any]] = msgspec.field(name="try", default_factory=dict)


class UnusedOption(msgspec.Struct, frozen=True, kw_only=True):
    """One option that keeps its default in every test."""

    name: str
    does: str
    source: str = ""


class Options(msgspec.Struct, frozen=True, kw_only=True):
    """The options of one engine."""

    documented: str
    option: tuple[Option, ...] = ()
    left: tuple[UnusedOption, ...] = ()


class Choice(msgspec.Struct, frozen=True, kw_only=True):
    """The settings chosen for one engine in one scenario, and the number of combinations tried."""

    options: dict[str, Any]
    tried: int


@functools.cache
def options_of(engine: str) -> Options:
    """The options of an engine, as its file lists them."""
    path = files("course").joinpath("engines", "options", f"{engine}.toml")
    return msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8")), Options)


@functools.cache
def choices() -> dict[str, dict[str, Choice]]:
    """The chosen settings, by engine and scenario."""
    path = files("course").joinpath("engines", "well_set.json")
    return msgspec.json.decode(path.read_bytes(), type=dict[str, dict[str, Choice]])


def candidates(engine: str, scenario: str) -> Iterator[dict[str, Any]]:
    """Every combination of the values worth trying, the defaults first."""
    topic = TOPICS[scenario]
    axes = [
        [{}, *({option.key: value} for value in option.values[topic])]
        for option in options_of(engine).option
        if topic in option.values
    ]
    for parts in itertools.product(*axes):
        yield {key: value for part in parts for key, value in part.items()}


def tuning(engine: str, scenario: str) -> Tuning:
    """The options of an engine well set for a scenario, each with what it does."""
    chosen = choices().get(engine, {}).get(scenario)
    if chosen is None or not chosen.options:
        return AS_IT_COMES
    known = {option.key: option for option in options_of(engine).option}
    why = tuple(
        f"{key} {value} instead of {known[key].default}: {known[key].does}."
        for key, value in chosen.options.items()
    )
    return Tuning(chosen.options, why)
