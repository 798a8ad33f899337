"""Writes the tables of docs/engines.md from the measurements and from the options, so that none is typed.

    python tests/benchmarks/engines_pages.py            write the blocks between the markers
    python tests/benchmarks/engines_pages.py --check    say whether they are what they should be

A block stands between ``<!-- made: NAME -->`` and ``<!-- end -->``. The whole chain, after a change of an
engine, a scenario or an option: engines_settings.py, engines_reference.py, engines_direct/compare.py --write,
this one, and ``course.authoring.lessons.cells.update_outputs`` for the lesson.
"""

import argparse
import json
import math
import re
import sys
from pathlib import Path

from course.cli.engines import number
from course.engines import base, reference
from course.engines.registry import ENGINES
from course.engines.results import DEFAULT, TUNED
from course.engines.scenarios import SCENARIOS

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "engines.md"
DIRECT = ROOT / "tests" / "benchmarks" / "engines_direct" / "results.json"
_BLOCK = re.compile(r"(<!-- made: (\w+) -->\n).*?(<!-- end -->)", re.DOTALL)


def main() -> int:
    """Write or check."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    old = PAGE.read_text(encoding="utf-8")
    new = made(old)
    if arguments.check:
        print("The page is as it should be." if new == old else "The page differs from the measurements.")
        return int(new != old)
    PAGE.write_text(new, encoding="utf-8")
    return 0


def made(page: str) -> str:
    """The page with every block made anew."""
    makers = {"results": results, "well_set": well_set, "options": options, "direct": direct}
    return _BLOCK.sub(lambda found: f"{found[1]}\n{makers[found[2]]()}\n{found[3]}", page)


def results() -> str:
    """Every scenario and engine of the reference, as it comes and well set."""
    shipped = reference.load()
    lines = [f"Reference: {shipped.label}.", ""]
    for scenario in SCENARIOS.values():
        truth = _truth(scenario)
        lines += [f"**{scenario.title}** (`{scenario.id}`): {scenario.quantity}; {truth}.", ""]
        lines += ["| engine | as it comes | well set |", "|:--|:--|:--|"]
        for engine, info in ENGINES.items():
            cells = [_cell(scenario, engine, setting) for setting in (DEFAULT, TUNED)]
            if cells[0]:
                same = not reference.row(engine, scenario.id, TUNED).options
                lines.append(f"| {info.name} | {cells[0]} | {'the same' if same else cells[1]} |")
        lines.append("")
    return "\n".join(lines)


def _truth(scenario):
    if scenario.truth is None:
        return "nothing is right or wrong"
    if math.isinf(scenario.truth):
        return "the more, the better"
    return f"right is {scenario.truth:g}{'' if scenario.unit == '1' else ' ' + scenario.unit}"


def _cell(scenario, engine, setting):
    try:
        row = reference.row(engine, scenario.id, setting)
    except LookupError:
        return ""
    assert row.value is not None
    text = number(scenario, row.value)
    if row.highest - row.lowest >= 10.0**-scenario.digits:
        text += f" ({number(scenario, row.lowest)} to {number(scenario, row.highest)})"
    return text


def well_set() -> str:
    """What is set where, of how many combinations."""
    lines = ["| engine | scenario | set | tried |", "|:--|:--|:--|--:|"]
    for engine, chosen in base.choices().items():
        by_options: dict[tuple[str, int], list[str]] = {}
        for scenario, choice in chosen.items():
            words = ", ".join(f"`{key}` {value}" for key, value in choice.options.items()) or "nothing"
            by_options.setdefault((words, choice.tried), []).append(scenario)
        for (words, tried), scenarios in by_options.items():
            if words != "nothing" or tried > 1:
                lines.append(f"| {ENGINES[engine].name} | {', '.join(scenarios)} | {words} | {tried} |")
    return "\n".join([*lines, ""])


def options() -> str:
    """Every option that an engine offers for the tests: those that are tried, and those that are left."""
    lines = []
    for engine, info in ENGINES.items():
        listed = base.options_of(engine)
        lines += [f"**{info.name}**, [documentation]({listed.documented})", ""]
        lines += ["| option | default | what it does | tried |", "|:--|:--|:--|:--|"]
        for one in listed.option:
            tried = "; ".join(
                f"{topic}: {', '.join(str(value) for value in values)}"
                for topic, values in one.values.items()
            )
            name = f"[{one.name}]({one.source})" if one.source else one.name
            lines.append(f"| `{one.key}`: {name} | {one.default} | {one.does} | {tried} |")
        for left in listed.left:
            name = f"[{left.name}]({left.source})" if left.source else left.name
            lines.append(f"| {name} | | {left.does} | left alone |")
        lines.append("")
    return "\n".join(lines)


def direct() -> str:
    """What the direct scripts found, beside the course: how much is the same, and each of the rest."""
    sys.path.insert(0, str(DIRECT.parent))
    try:
        import compare
    finally:
        sys.path.pop(0)
    lines = ["| engine | scenario | setting | direct | course | |", "|:--|:--|:--|:--|:--|:--|"]
    same = []
    for engine, found in json.loads(DIRECT.read_text(encoding="utf-8")).items():
        judged = [compare.judged(engine, line) for line in found]
        same.append(f"{ENGINES[engine].name} {sum(verdict == 'same' for verdict, _row in judged)}")
        for line, (verdict, row) in zip(found, judged, strict=True):
            if verdict == "same":
                continue
            setting = {"default": "as it comes", "tuned": "well set"}.get(line["setting"], line["setting"])
            ours = "" if row is None else compare.shown(row.value, row.samples)
            theirs = compare.shown(line["value"], line["samples"])
            lines.append(
                f"| {ENGINES[engine].name} | {line['test']} | {setting} | {theirs} | {ours} | {verdict} |"
            )
    return "\n".join([f"Results that are the same: {', '.join(same)}. The others:\n", *lines, ""])


if __name__ == "__main__":
    sys.exit(main())
