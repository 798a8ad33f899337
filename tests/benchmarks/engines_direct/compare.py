"""Direct scripts against the course: one table, every engine, every test that both have.

    python tests/benchmarks/engines_direct/compare.py            run every script, and print the table
    python tests/benchmarks/engines_direct/compare.py --write    and keep the results beside this file

Each ``direct_<engine>.py`` is run in a process of its own. What it finds is held against the measurements
that ship (course/engines/reference.json). Exit code 1 if a pair of results is further apart than its spread.

The verdicts: *same* is a difference of at most 1e-6 of the value; *within spread* one of at most the widest
range over the phases or starts of either side; anything else *differs*.
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

from course.engines import reference
from course.engines.registry import ENGINES
from course.engines.results import Row

HERE = Path(__file__).parent
RESULTS = HERE / "results.json"
SAME = 1e-6
#: Round-off in single precision, in the units of the tests (per cent, m, mm).
NOTHING = 1e-3


def main() -> int:
    """Run, compare, say."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--engine", action="append", choices=list(ENGINES))
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    found = {engine: run(engine) for engine in arguments.engine or ENGINES}
    if arguments.write:
        known = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
        everything = {**known, **found}
        ordered = {engine: everything[engine] for engine in ENGINES if engine in everything}
        RESULTS.write_text(json.dumps(ordered, indent=1) + "\n", encoding="utf-8")
    differing = 0
    for engine, lines in found.items():
        for line in lines:
            verdict, row = judged(engine, line)
            differing += verdict == "differs"
            course = "" if row is None else shown(row.value, row.samples)
            print(
                f"{ENGINES[engine].name:14}{line['test']:12}{line['setting']:42}"
                f"{shown(line['value'], line['samples']):>34}{course:>34}  {verdict}"
            )
    print(f"{differing} results differ by more than their spread.")
    return min(differing, 1)


def run(engine: str) -> list[dict]:
    """What an engine's script prints, line by line."""
    script = HERE / f"direct_{engine}.py"
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"{script.name} ended with {done.returncode}:\n{done.stderr[-2000:]}")
    return [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]


def judged(engine: str, line: dict) -> tuple[str, Row | None]:
    """The verdict, and the row of the course that a direct result belongs to; none for a single option."""
    if line["setting"] not in ("default", "tuned"):
        return "", None
    row = reference.row(engine, line["test"], line["setting"])
    assert row.value is not None
    apart = abs(line["value"] - row.value)
    width = max(max(line["samples"]) - min(line["samples"]), row.highest - row.lowest)
    if apart <= max(SAME * abs(row.value), NOTHING):
        return "same", row
    return ("within spread" if apart <= width else "differs"), row


def shown(value: float, samples) -> str:
    """A value with the range that it comes from."""
    if not samples or max(samples) - min(samples) < NOTHING:
        return f"{value:.4g}"
    return f"{value:.4g} ({min(samples):.4g} to {max(samples):.4g})"


if __name__ == "__main__":
    sys.exit(main())
