"""Random hostile input for every reader of a stranger's bytes, for as long as it is told.

    python tests/benchmarks/fuzz/run.py notebooks zips frames scenes returns [--minutes 12] [--seed 1]
    python tests/benchmarks/fuzz/run.py zips --seed 1 --number 4711     one input again, with its traceback

Input n of a seed is always the same. A fault is whatever the reader has no word for: an exception it does not
announce, a process that ended, more than five seconds of CPU for an input of some kilobytes. Prints how many
inputs there were, what became of them, and of each fault the number and the last line; exit code 1 if there
is one.

    notebooks   read as a submission and for the names of functions, in the process that reads them
    zips        the same of archives, their quiz record and their members
    frames      what a worker sends, to the grader's end of a connection
    scenes      a scene's file, and twenty steps of the world in it
    returns     functions of every exercise with results spoilt in one or two ways, through the real graders
    documents   late policies, markers, answers, class lists, times, worksheets, Gradescope's file, records
                of a sandbox and of progress, packs of solutions, gradebooks, sources with a declared encoding
"""

import argparse
import contextlib
import math
import socket
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

sys.path[:0] = [str(Path(__file__).resolve().parents[3]), str(Path(__file__).resolve().parent)]

import inputs  # noqa: E402
import msgspec  # noqa: E402

from course.authoring.exercises.grading import solution_path  # noqa: E402
from course.catalog.models import Exercise, Task  # noqa: E402
from course.catalog.pack import pack_bytes, read_pack  # noqa: E402
from course.errors import CourseError  # noqa: E402
from course.grading.gradebook.book import Gradebook  # noqa: E402
from course.grading.gradebook.records import Decision, SubmittedAt  # noqa: E402
from course.grading.intake.archives import Reader, RefusedError  # noqa: E402
from course.grading.intake.downloads import class_list  # noqa: E402
from course.grading.intake.students import submission_from  # noqa: E402
from course.grading.results.late import read_policy, read_times  # noqa: E402
from course.grading.results.roster import read_roster  # noqa: E402
from course.grading.running.folder import open_results  # noqa: E402
from course.isolation.failures import StudentFailure  # noqa: E402
from course.isolation.levels import Deadline  # noqa: E402
from course.isolation.session import Connection, LoadRefusedError  # noqa: E402
from course.progress.store import Store  # noqa: E402
from course.progress.workspace import Workspace  # noqa: E402
from course.quizzing.answers import read_answers  # noqa: E402
from course.sandbox.runs import recording  # noqa: E402
from course.sandbox.scene.loading import choose  # noqa: E402
from course.sandbox.world.world import World  # noqa: E402
from course.scoring.judging.session import GradingSession  # noqa: E402
from course.scoring.judging.submission import Submission, Terms  # noqa: E402
from tests.contracts.boundary import test_broken_functions as spoiling  # noqa: E402
from tests.unit.isolation.test_connection import LOADED, READY, Liar  # noqa: E402

#: CPU seconds of this process for one input: a thousand times what an ordinary one takes.
SLOW_S = 5.0
DOUBLING = Exercise(
    format_version=1, id="doubling", title="Doubling", module="doubling.py", lesson="doubling", order=1,
    summary="", task=(Task("double", "Double", 5.0), Task("doublings", "Doublings", 5.0)),
)  # fmt: skip
FUNCTIONS = ("double", "doublings")


class FaultError(Exception):
    """What must not be."""


@cache
def _reader() -> Reader:
    return Reader()


def _asked(ask: Callable[[], Any]) -> str:
    """What a question to the process that reads came to; it must not end by an input this small."""
    servant = _reader()._servant
    process = servant._process or servant._start()
    try:
        ask()
    except RefusedError as refused:
        if servant._process is not process or refused.problem.code == "unreadable":
            raise FaultError(refused.problem.message) from None
        if not refused.problem.message.isprintable():
            raise FaultError(f"not printable: {refused.problem.message!r}") from None
        return refused.problem.code
    return "read"


def notebooks(chance: inputs.Chance, folder: Path) -> str:
    path = folder / "doubling.ipynb"
    path.write_bytes(inputs.notebook(chance))
    _asked(lambda: _reader().outlines(path, (), FUNCTIONS))
    return _asked(lambda: _module_of(path))


def _module_of(path: Path) -> None:
    source, record = _reader().notebook(path.read_bytes(), DOUBLING, path.name)
    source.decode()
    if len(record) > 256 << 10:
        raise FaultError("a record of more than 256 KB")


def zips(chance: inputs.Chance, folder: Path) -> str:
    path = folder / chance.choice(("work.zip", "w\udce9rk\n.zip"))
    path.write_bytes(inputs.archive(chance))
    _asked(lambda: _reader().quiz_in(path))
    _asked(lambda: _reader().member(path, chance.choice(inputs.NAMES)))
    found: list[Any] = []
    _asked(lambda: found.extend(_reader().outlines(path, (), FUNCTIONS)))
    for member, *_ in found:
        _asked(lambda member=member: submission_from(DOUBLING, path, member))  # type: ignore[misc]
    told = _asked(lambda: _notes_of(path))
    path.unlink()
    return told


def _notes_of(path: Path) -> None:
    held = _reader().module_in(path, DOUBLING)
    if held is not None and not all(note.isprintable() for note in held.notes):
        raise FaultError(f"not printable: {held.notes!r}")


def frames(chance: inputs.Chance, folder: Path) -> str:
    liar = Liar(READY, LOADED, *inputs.frames(chance), lambda end: end.shutdown(socket.SHUT_WR))
    connection = Connection(liar, {"w.py": b"def f(x): ...\n"}, "w.py", Deadline(20.0))  # type: ignore[arg-type]
    lent = lambda *values, **named: len(values) + len(named)  # noqa: E731
    calls: tuple[Callable[[], Any], ...] = (
        lambda: connection.call("f", lent, 1.0),
        lambda: connection.inspect("f", lent),
        lambda: connection.march("f", [[lent, [0.0], [0.0], 0.0, 0.1, 3]]),
        lambda: connection.each("g", [[lent], [2.0]]),
        lambda: connection.fold("g", 0.0, [[lent]], None),
    )
    try:
        chance.choice(calls)()
    except (StudentFailure, LoadRefusedError) as failure:
        return failure.kind if isinstance(failure, StudentFailure) else failure.stage
    finally:
        connection.close()
        liar._thread.join()  # or its last word goes to whatever has the number of its socket next
    return "a value"


def scenes(chance: inputs.Chance, folder: Path) -> str:
    name, content = inputs.scene(chance)
    path = folder / f"{name}.toml"
    path.write_bytes(content)
    try:
        chosen = choose(str(path))
        world = World(chosen.scene, chosen.settings)
        world.step(20)
        world.snapshot()
    except CourseError as error:
        if not (error.message and f"{error.message}{error.help}".replace("\n", "").isprintable()):
            raise FaultError(f"no words: {error.message!r}") from None
        return type(error).__name__
    return "run"


_SESSIONS: dict[str, GradingSession] = {}


def _session(exercise: Exercise) -> GradingSession:
    if exercise.id not in _SESSIONS:
        terms = Terms(timeout=10.0)
        _SESSIONS[exercise.id] = GradingSession(exercise, spoiling.CATALOG, scope="full", terms=terms)
    return _SESSIONS[exercise.id]


def returns(chance: inputs.Chance, folder: Path) -> str:
    exercise = chance.choice(spoiling.CATALOG.exercises())
    session = _session(exercise)
    source = solution_path(spoiling.CATALOG, exercise).read_text("utf-8")
    tasks = chance.sample([task.id for task in exercise.task], chance.choice((1, min(2, len(exercise.task)))))
    for task in tasks:
        way, part, when = (
            chance.choice(list(kind)) for kind in (spoiling.SPOILT, spoiling.PARTS, spoiling.TIMES)
        )
        source = spoiling.spoilt(source, task, way, part, when)
    check = chance.choice([check.id for check in session.checks if check.task in tasks])
    verdict = session.grade(Submission({exercise.module: source.encode()}), only=[check])
    msgspec.msgpack.encode(verdict)
    statuses = {found.id: str(found.status) for found in verdict.checks}
    if verdict.state != "graded" or "grader_error" in statuses.values():
        raise FaultError(f"{exercise.id} {check}: {verdict.state} {verdict.error} {statuses}")
    return statuses.get(check, "none")


@cache
def _right() -> dict[str, bytes]:
    """A right document of each kind, by the file's name."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as scratch:
        record, book = Path(scratch) / "progress.sqlite", Path(scratch) / "gradebook.sqlite"
        for number in range(40):
            Store(record).append("check", "doubling", {"score": number, "of": 10, "words": "é" * number})
        with Gradebook(book, create=True, writing=True) as made:
            made.begin_run("run", {"snapshot": None, "folder": "class"})
            made.set_meta(seed="1", roster='[{"student": "ada"}]', without_work='["bob"]')
            made.add_times([SubmittedAt("ada", "doubling", "", "list", 1.0)])
            made.note(Decision("", "", "override", "ada", "doubling", "why", "1", "2"))
        heads = "Identifier,Full name,Grade,Last modified (submission),Last modified (grade)\n"
        pack = {"doubling": {"doubling.py": b"def double(x):\n    return 2 * x\n"}}
        return {
            "late.toml": b'format_version = 1\npercent_per_day = 10\n[[deadline]]\nexercise = "*"\n'
            b"due = 2026-12-01T23:59:00+01:00\n",
            "course.toml": b'format_version = 1\n[course]\nid = "physics-sim"\nversion = "1.2.0"\n',
            "answers.toml": b'seed = 42\n[answers]\nwhy-simulate = "b"\n',
            "answers.json": b'{"seed": 42, "answers": {"why-simulate": "b"}}',
            "class.csv": b"student,name,email,extension_days\nada,Ada,ada@uni.example,2\n",
            "times.csv": b"student,exercise,submitted_at\nada,doubling,2026-12-01T12:00:00Z\n",
            "sheet.csv": f"{heads}Participant 1,Ada,,-,-\n".encode(),
            "submission_metadata.yml": b"submission_1: &a\n  :submitters:\n  - {:name: Ada, :sid: '1'}\n"
            b"  :created_at: 2026-11-01 10:00:00 Z\nsubmission_2: *a\n",
            "run.jsonl": b'{"kind": "head", "form": "course.sandbox-recording/1"}\n{"kind": "end"}\n',
            "solutions.coursepack": pack_bytes("physics-sim", "1.2.0", pack),
            "progress.sqlite": record.read_bytes(),
            "gradebook.sqlite": book.read_bytes(),
            "doubling.py": b"# coding: latin-1\ndef double(x):\n    return 2 * x\n",
        }


def _book(path: Path) -> object:
    with open_results(path.parent) as results:
        results.verify()
        return list(results.all()), results.book.runs(), results.book.journal()


_READERS: dict[str, Callable[[Path], object]] = {
    "late.toml": read_policy,
    "course.toml": lambda path: Workspace.read(path.parent),
    "answers.toml": read_answers,
    "answers.json": read_answers,
    "class.csv": read_roster,
    "times.csv": read_times,
    "sheet.csv": read_times,
    "submission_metadata.yml": lambda path: class_list(path.parent, "gradescope"),
    "run.jsonl": recording.read,
    "solutions.coursepack": read_pack,
    "progress.sqlite": lambda path: (Store(path).repair(), Store(path).events()),
    "gradebook.sqlite": _book,
    "doubling.py": lambda path: submission_from(DOUBLING, path),
}


def documents(chance: inputs.Chance, folder: Path) -> str:
    name, right = chance.choice(list(_right().items()))
    content = right
    for _ in range(chance.choice((1, 1, 2, 3))):
        content = inputs.damaged(chance, content)
    with tempfile.TemporaryDirectory(dir=folder) as own:
        path = Path(own) / name
        path.write_bytes(content)
        (path.parent / "submission_1").mkdir()
        try:
            _READERS[name](path)
        except (CourseError, RefusedError) as error:
            said = error.message if isinstance(error, CourseError) else error.problem.message
            if not said.replace("\n", "").isprintable():
                raise FaultError(f"not printable: {said!r}") from None
            return f"{name} {type(error).__name__}"
    return f"{name} read"


KINDS = {made.__name__: made for made in (notebooks, zips, frames, scenes, returns, documents)}


def run(kind: str, seed: int, numbers: range, end: float = math.inf) -> tuple[Counter[str], dict[int, str]]:
    """What became of the inputs until the time is up, and the faults by number."""
    outcomes: Counter[str] = Counter()
    faults: dict[int, str] = {}
    with tempfile.TemporaryDirectory(prefix="fuzz-") as scratch, contextlib.ExitStack() as open_still:
        open_still.callback(_closed)
        for number in numbers:
            if time.monotonic() > end:
                break
            begun = time.process_time()
            try:
                outcomes[KINDS[kind](inputs.Chance(f"{seed} {number}"), Path(scratch))] += 1
                if time.process_time() - begun > SLOW_S:
                    raise FaultError(f"{time.process_time() - begun:.1f} s of CPU")
            except Exception as error:
                faults[number] = traceback.format_exc() if len(numbers) == 1 else _last(error)
                print(f"  {kind} {number}: {faults[number]}", flush=True)
    return outcomes, faults


def _closed() -> None:
    """End the processes that were started; the next input starts them again."""
    _reader().close()
    while _SESSIONS:
        _SESSIONS.popitem()[1].close()


def _last(error: Exception) -> str:
    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {str(error)[:300]!a} ({Path(where.filename).name}:{where.lineno})"


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", nargs="+", choices=list(KINDS))
    parser.add_argument("--minutes", type=float, default=12.0, help="wall time for each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--number", type=int, help="this input alone, with the whole traceback")
    options = parser.parse_args()
    numbers = range(options.number, options.number + 1) if options.number is not None else range(10**9)
    bad = 0
    for kind in options.kind:
        begun, cpu = time.monotonic(), time.process_time()
        outcomes, faults = run(kind, options.seed, numbers, begun + 60 * options.minutes)
        many = ", ".join(f"{name} {count}" for name, count in outcomes.most_common())
        print(
            f"{kind}: {sum(outcomes.values()) + len(faults)} inputs of seed {options.seed} in"
            f" {time.monotonic() - begun:.0f} s ({time.process_time() - cpu:.0f} s of CPU here),"
            f" {len(faults)} faults; {many}",
            flush=True,
        )
        bad += len(faults)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
