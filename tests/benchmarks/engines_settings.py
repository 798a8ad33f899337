"""Chooses how each engine is well set for each scenario, and writes course/engines/well_set.json.

    python tests/benchmarks/engines_settings.py                  try every combination, and write the file
    python tests/benchmarks/engines_settings.py --engine ode     one engine; --scenario: one scenario
    python tests/benchmarks/engines_settings.py --compare         try again, and say what would be chosen now

The rule is in course/engines/base.py; the values that are tried are in course/engines/options. Needs all
extras. It takes about ten minutes of one processor. After it, tests/benchmarks/engines_reference.py has to
measure again.
"""

import argparse
import json
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from course.engines import base
from course.engines.compare import EngineProcess
from course.engines.registry import ENGINES
from course.engines.scenarios import BOXES, DT, SCENARIOS, Scenario

FILE = Path(__file__).parents[2] / "course" / "engines" / "well_set.json"
#: The hundred boxes are stepped as the stack is, so that rate and movement belong to one setting.
SAME_AS = {BOXES: "stack"}
#: For one measurement, s.
DEADLINE_S = 120.0
#: Errors that differ by less than this share, or by less than half of the last digit shown, are equal.
EQUAL = 0.01


def main() -> int:
    """Choose, then write or compare."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--engine", action="append", choices=list(ENGINES))
    parser.add_argument("--scenario", action="append", choices=list(SCENARIOS))
    parser.add_argument("--compare", action="store_true")
    arguments = parser.parse_args()
    names = arguments.engine or list(ENGINES)
    with ThreadPoolExecutor(max_workers=2) as pool:
        wanted = set(arguments.scenario or SCENARIOS)
        found = dict(zip(names, pool.map(lambda name: _of_engine(name, wanted), names), strict=True))
    known = json.loads(FILE.read_text(encoding="utf-8"))
    if arguments.compare:
        differing = [(engine, name) for engine in names for name in found[engine]
                     if known.get(engine, {}).get(name) != found[engine][name]]  # fmt: skip
        for engine, name in differing:
            print(engine, name, known.get(engine, {}).get(name), "->", found[engine][name])
        print(f"{len(differing)} choices differ.")
        return min(len(differing), 1)
    ordered = {
        engine: {name: {**known.get(engine, {}), **found.get(engine, {})}[name] for name in SCENARIOS}
        for engine in ENGINES
    }
    FILE.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")
    return 0


def _of_engine(engine: str, wanted: set[str]) -> dict[str, Any]:
    chosen: dict[str, Any] = {}
    for scenario in SCENARIOS.values():
        if scenario.id in SAME_AS and SAME_AS[scenario.id] in chosen:
            chosen[scenario.id] = dict(chosen[SAME_AS[scenario.id]])
        if scenario.id in SAME_AS or scenario.id not in wanted:
            continue
        tried = list(base.candidates(engine, scenario.id))
        results = [(_error(engine, scenario, options), options) for options in tried]
        best, options = _best(scenario, results)
        chosen[scenario.id] = {"options": options, "tried": len(tried)}
        print(f"{engine:9} {scenario.id:16} {results[0][0]:12.6g} -> {best:12.6g}  of {len(tried):2} "
              f"{options}", file=sys.stderr, flush=True)  # fmt: skip
    return chosen


def _error(engine: str, scenario: Scenario, options: dict[str, Any]) -> float:
    """How far from the truth the engine is with these options; infinite where it gives nothing."""
    job = {"do": "measure", "scenario": scenario.id, "setting": "default", "dt": DT, "quick": False}
    # A process of its own: what one combination leaves behind, or dies of, is no matter of the next one's.
    with EngineProcess(engine) as process:
        reply = process.ask({**job, "options": options}, DEADLINE_S)
    if reply["status"] != "ok":
        return float("inf")
    return -reply["value"] if scenario.better == "large" else abs(reply["value"] - (scenario.truth or 0.0))


def _best(scenario: Scenario, results: list[tuple[float, dict[str, Any]]]) -> tuple[float, dict[str, Any]]:
    """The least error; among equals the combination that sets least, then the first."""
    least = min(error for error, _ in results)
    slack = max(EQUAL * abs(least), 0.5 * 10.0**-scenario.digits)
    equal = [
        (len(options), place) for place, (error, options) in enumerate(results) if error <= least + slack
    ]
    return results[min(equal)[1]]


if __name__ == "__main__":
    sys.exit(main())
