"""Makes course/engines/reference.json, the measurement that ships: every engine in every scenario, here.

    python tests/benchmarks/engines_reference.py            measure, and write the file
    python tests/benchmarks/engines_reference.py --compare   measure again, and say what differs from the file

Needs all extras (engines, physx, bullet, dart). Rates are those of the machine; everything else
is meant to come out the same wherever the same wheels are installed.
"""

import argparse
import datetime
import math
import sys
from pathlib import Path

import msgspec

from course.engines import reference
from course.engines.compare import Request, compare
from course.engines.results import Comparison
from course.engines.scenarios import BOXES

FILE = Path(__file__).parents[2] / "course" / "engines" / "reference.json"


def main() -> int:
    """Measure, then write or compare."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--compare", action="store_true")
    parser.add_argument("--scenario", action="append", help="measure only this one, keep the other rows")
    parser.add_argument("--quick", action="store_true", help="only to see whether it works; never written")
    arguments = parser.parse_args()
    comparison = compare(
        Request(scenarios=tuple(arguments.scenario or ()), fresh=True, quick=arguments.quick),
        lambda done, total, what: print(f"\r{done}/{total} {what:40}", end="", file=sys.stderr),
    )
    print(file=sys.stderr)
    failed = [row for row in comparison.rows if not row.ok and row.status != "not_applicable"]
    for row in failed:
        print(f"{row.engine} {row.scenario} {row.setting}: {row.status} {row.message}")
    if arguments.compare or arguments.quick:
        return _differences(comparison)
    if failed:
        print("Nothing written: the reference holds every engine, or it is none.")
        return 1
    if arguments.scenario:
        kept = [row for row in reference.load().rows if row.scenario not in arguments.scenario]
        # The rows that are kept pass through `encoded` as if they had been measured now.
        kept = [msgspec.structs.replace(row, origin="cached") for row in kept]
        comparison = msgspec.structs.replace(comparison, rows=(*kept, *comparison.rows))
    FILE.write_bytes(reference.encoded(comparison, datetime.datetime.now(datetime.UTC).date().isoformat()))
    print(f"{FILE.name}: {sum(row.ok for row in comparison.rows)} values")
    return 0


def _differences(comparison: Comparison) -> int:
    known = {row.place: row.value for row in reference.load().rows}
    differing = 0
    for row in comparison.rows:
        old = known.get(row.place)
        if not row.ok or row.scenario == BOXES or row.value is None or old is None:
            continue
        if not math.isclose(row.value, old, rel_tol=1e-9, abs_tol=1e-12):
            differing += 1
            print(
                f"{row.engine:9} {row.scenario:16} {row.setting:8} dt {row.dt:.6f}  {old!r} -> {row.value!r}"
            )
    print(f"{differing} values differ from the reference.")
    return min(differing, 1)


if __name__ == "__main__":
    sys.exit(main())
