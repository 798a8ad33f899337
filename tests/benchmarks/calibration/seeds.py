"""Full marks, and every mutant caught, under every seed.

    python tests/benchmarks/calibration/seeds.py EXERCISE... [--seeds 1000] [--accepted 1000] [--mutants 200]
        [--first 1] [--variant NAME] [--log FILE] [--kept]

A grading of the model solution or of an accepted variant has to give full marks; one of a mutant what
its record says: points of its task only, by the check and with the diagnosis it names. What is not so is
printed with the seed, and the exit code is 1.

The first seed is a grading run: every check, in a worker. With the others the submission runs in this
process, before the checks of the tasks that it does in its own way, where one of them draws; everything
else would come out as with the first seed, or is the model solution's, which has its own turn. What ends
its worker (an endless loop, too much memory) stays in workers, with ten seeds, and so does, with all of them,
what keeps something between two calls, since a second worker is asked about that. What is done is noted in
a file, seeds.jsonl beside this one, and is not done again as long as it holds: full marks are decided by the
checks, what a mutant is told by the known mistakes, the kinds of diagnoses and its entry as well, and neither
by how it is worded. --kept says how much of what is asked for stands there.
"""

import argparse
import hashlib
import json
import re
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

ROOT = Path(__file__).resolve().parents[3]
if __name__ == "__main__":
    sys.path[:0] = [str(ROOT)]

from course.authoring.exercises.diagnosis import code_of, made_from  # noqa: E402
from course.authoring.exercises.grading import (  # noqa: E402
    LocalSubmission,
    accepted_files,
    compose,
    mistakes_of,
    solution_path,
    source_of,
)
from course.authoring.exercises.proofs import caught_by, judge  # noqa: E402
from course.catalog.load import Catalog  # noqa: E402
from course.catalog.models import Exercise  # noqa: E402
from course.scoring.explain.story import OWN_WORDS  # noqa: E402
from course.scoring.judging.session import GradingSession  # noqa: E402
from course.scoring.judging.submission import Submission, Terms  # noqa: E402
from course.scoring.verdict import Status, Verdict  # noqa: E402

LOG = Path(__file__).with_suffix(".jsonl")
#: Seeds without a fault that make an ordinary run take a program's word; `.ci/release` asks for 200.
LEAST = 20
#: Gradings of a program that ends its worker: each takes the whole deadline.
_ENDING = 10


class Program(NamedTuple):
    """What is graded: the tasks it does in its own way, its seeds, and what is wrong with a verdict.

    Attributes:
        declared: what a mutant's entry says must happen to it.
    """

    name: str
    source: bytes
    tasks: frozenset[str]
    seeds: int
    faults: Callable[[Verdict], list[str]]
    declared: bytes = b""


class Seeded(GradingSession):
    """A session in which each grading is a run of its own, with its own seed.

    Attributes:
        here: whether submissions run in this process.
    """

    here = False

    def sow(self, seed: int) -> None:
        """Draw with this seed from here on."""
        self._terms = msgspec.structs.replace(self._terms, seed=seed)

    def checks_of(self, tasks: frozenset[str]) -> list[str]:
        """Ids of the checks of those of the tasks in which a check draws."""
        items = self._checks._items
        drawing = {check.task for check in self.checks if "rng" in items[check.id].fixturenames}  # type: ignore[attr-defined]
        graders = (ROOT / "tests" / "graders" / self.exercise.id).rglob("*.py")
        if any("submission.seed" in path.read_text("utf-8") for path in graders):  # drawn without the fixture
            drawing = {check.task for check in self.checks}
        return [check.id for check in self.checks if check.task in tasks & drawing]

    def _load(self, submission: Submission) -> Any:
        if not self.here:
            return super()._load(submission)
        return LocalSubmission(submission.files[self.exercise.module].decode(), self._terms.seed)


class Log:
    """How many gradings of a program were not as they should be, by what decides it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
        self._done = {tuple(key): wrong for *key, wrong in map(json.loads, lines)}
        right = (key for key, wrong in self._done.items() if wrong == 0)
        self._proven = {tuple(key) for *key, seeds in right if seeds >= LEAST}

    def done(self, *key: Any) -> int | None:
        return self._done.get(key)

    def proves(self, *key: Any) -> bool:
        """Whether a program, by its key but for the number of seeds, was right under ``LEAST`` or more."""
        return key in self._proven

    def knows(self, exercise: Exercise) -> bool:
        return any(key[0] == exercise.id for key in self._done)

    def note(self, *key: Any, wrong: int) -> None:
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps([*key, wrong]) + "\n")


def proven(exercise: Exercise, catalog: Catalog) -> frozenset[bytes]:
    """The variants that, as they and the checks are now, stand in the log without a fault."""
    options = asked([exercise.id])
    log = Log(options.log)
    # An exercise that is on no record need not have all the files that decide about one.
    keys = _keys(exercise, catalog, options) if log.knows(exercise) else ()
    return frozenset(program.source for program, key in keys if "/" in program.name and log.proves(*key[:-1]))


def grade_all(exercise: Exercise, catalog: Catalog, options: argparse.Namespace) -> int:
    """Grade under many seeds; how many gradings were not as they should be."""
    log, wrong = Log(options.log), 0
    # What is asked is whether the answer is right: a machine that does other work too must not cost a mark.
    counts: Counter[tuple[str, bool]] = Counter()
    with Seeded(exercise, catalog, scope="full", terms=Terms(timeout=60.0)) as session:
        for program, key in _keys(exercise, catalog, options):
            short = log.done(*key)
            if options.kept:
                kind = "mutants" if program.name.startswith("mutants/") else "right programs"
                counts[kind, short is not None] += 1
            elif short is None:
                start = time.perf_counter()
                short, graded = grade_one(session, program, options.first)
                log.note(*key, wrong=short)
                what = "caught as declared" if program.name.startswith("mutants/") else "full marks"
                took = (time.perf_counter() - start) / graded
                print(
                    f"{exercise.id} {program.name}: {graded - short} of {graded} {what}, {took:.3f} s each",
                    flush=True,
                )
            wrong += short or 0
    for kind in ("right programs", "mutants") if options.kept else ():
        done, all_of_them = counts[kind, True], counts[kind, True] + counts[kind, False]
        print(f"{exercise.id}: {done} of {all_of_them} {kind}")
    return wrong


def _keys(
    exercise: Exercise, catalog: Catalog, options: argparse.Namespace
) -> Iterator[tuple[Program, tuple[Any, ...]]]:
    """Each program that is asked for, and what its line in the log begins with."""
    told = made_from(catalog, exercise)
    decided = hashlib.sha256(code_of(catalog, exercise)).hexdigest()[:16]
    for program in programs(exercise, catalog, options):
        digest = hashlib.sha256(program.source + program.declared).hexdigest()[:16]
        state = told if program.name.startswith("mutants/") else decided
        yield program, (exercise.id, state, program.name, digest, options.first, program.seeds)


def programs(exercise: Exercise, catalog: Catalog, options: argparse.Namespace) -> Iterator[Program]:
    """The model solution, the accepted variants and the mutants that are asked for."""
    solution, tasks = solution_path(catalog, exercise), frozenset(task.id for task in exercise.task)
    if options.seeds and not options.variant:
        yield Program(solution.name, solution.read_bytes(), tasks, options.seeds, _short_of_full)
    for path in accepted_files(catalog, exercise) if options.accepted else ():
        if not options.variant or path.stem in options.variant:
            own = _own_tasks(solution, path, tasks)
            name = f"accepted/{path.name}"
            yield Program(name, compose(solution, path), own, options.accepted, _short_of_full)
    caught = caught_by(catalog, exercise)
    for mutant in mistakes_of(catalog, exercise).wrong if options.mutants else ():
        if not options.variant or mutant.name in options.variant:
            check = caught.get(mutant.name, "")
            told = lambda verdict, one=mutant, by=check: [fault.message for fault in judge(one, by, verdict)]  # noqa: E731
            source, name = source_of(catalog, exercise, mutant), f"mutants/{mutant.name}"
            declared = msgspec.json.encode((mutant.task, check, mutant.code, mutant.also))
            yield Program(name, source, frozenset({mutant.task}), options.mutants, told, declared)


def grade_one(session: Seeded, program: Program, first: int) -> tuple[int, int]:
    """How many gradings were not as they should be, and how many there were."""
    submission = Submission({session.exercise.module: program.source})
    session.here = False
    session.sow(first)
    verdict = session.grade(submission)
    short = _told(program, first, verdict)
    ends = any(c.status in {Status.TIMEOUT, Status.MEMORY, Status.CRASH} for c in verdict.checks)
    keeps = any(c.diagnosis in OWN_WORDS for c in verdict.checks)
    session.here, checks = not (ends or keeps), session.checks_of(program.tasks)
    count = min(program.seeds, _ENDING) if ends else program.seeds if checks else 1
    for seed in range(first + 1, first + count):
        session.sow(seed)
        short += _told(program, seed, session.grade(submission, only=checks))
    return short, count


def _told(program: Program, seed: int, verdict: Verdict) -> bool:
    """Whether a verdict is not as it should be; prints why."""
    found = program.faults(verdict)
    for fault in found[:3]:
        print(f"  {program.name} seed {seed}: {fault}", flush=True)
    return bool(found)


def _short_of_full(verdict: Verdict) -> list[str]:
    """What keeps a verdict from full marks."""
    if verdict.all_pass:
        return []
    bad = [check for check in verdict.checks if check.status is not Status.PASS]
    return [f"{check.id} {check.status}: {check.message}" for check in bad] or [
        f"{verdict.state}: {verdict.error}"
    ]


def _own_tasks(solution: Path, variant: Path, tasks: frozenset[str]) -> frozenset[str]:
    """The tasks that an accepted variant does in its own way."""
    names = set(re.findall(r"^(?:def |class )?(\w+)(?:\(| = |:)", variant.read_text(encoding="utf-8"), re.M))
    others = set(re.findall(r"^def (\w+)\(", solution.read_text(encoding="utf-8"), re.M)) - tasks
    # One that changes another function of the solution may do every task in its own way.
    return tasks if names & others else frozenset(names & tasks)


def asked(arguments: list[str] | None = None) -> argparse.Namespace:
    """What the command line asks for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("exercise", nargs="+")
    parser.add_argument("--seeds", type=int, default=1000, help="for the model solution")
    parser.add_argument("--accepted", type=int, default=1000, help="for each accepted variant")
    parser.add_argument("--mutants", type=int, default=200, help="for each mutant")
    parser.add_argument("--first", type=int, default=1, help="the first seed")
    parser.add_argument("--variant", action="append", default=[], help="only this one; repeatable")
    parser.add_argument(
        "--log", type=Path, default=LOG, help="what is done is noted here, and not done again"
    )
    parser.add_argument("--kept", action="store_true", help="grade nothing; say how much is noted")
    return parser.parse_args(arguments)


def main() -> int:
    options, catalog = asked(), Catalog()
    wrong = [grade_all(catalog.exercise(name), catalog, options) for name in options.exercise]
    return int(any(wrong))


if __name__ == "__main__":
    sys.exit(main())
