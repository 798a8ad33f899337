"""What a run costs beside the grading: snapshot, backup, roster, digests of rows, files left over.

    python tests/benchmarks/class_overhead.py                        10,000 students, CPU of each part
    python tests/benchmarks/class_overhead.py --submissions 1000

Nothing is graded here: each part is done as a run over so many students does it. What a submission's grading
takes is measured by ``class_run.py`` and ``protection.py``.
"""

import argparse
import os
import sys
import tempfile
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from time import process_time

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from course.catalog.load import Catalog  # noqa: E402
from course.grading.gradebook.book import Gradebook  # noqa: E402
from course.grading.gradebook.file import row_digest  # noqa: E402
from course.grading.gradebook.records import Result  # noqa: E402
from course.grading.gradebook.salvage import back_up  # noqa: E402
from course.grading.intake.downloads import Place  # noqa: E402
from course.grading.intake.students import survey  # noqa: E402
from course.grading.results.effective import Results  # noqa: E402
from course.grading.results.roster import Person, Roster  # noqa: E402
from course.grading.running.snapshot import Snapshot, frozen  # noqa: E402
from course.scoring.judging.session import GradingSession  # noqa: E402
from course.scoring.judging.submission import Submission, Terms  # noqa: E402
from tests.unit.grading.made import key  # noqa: E402

EXERCISE = "integrators"


def main() -> None:
    parser = argparse.ArgumentParser(description="What a run over a class costs beside the grading.")
    parser.add_argument("--submissions", type=int, default=10_000)
    students = parser.parse_args().submissions
    catalog = Catalog()
    exercise = catalog.exercise(EXERCISE)
    assert catalog.content.solutions is not None
    source = (catalog.content.solutions / EXERCISE / exercise.module).read_bytes()
    with GradingSession(exercise, catalog, scope="full", terms=Terms(level="L1")) as session:
        session.grade(Submission({exercise.module: source}))  # the first one fills caches
        begun = cpu()
        for number in range(5):
            verdict = session.grade(Submission({exercise.module: source + b"\n# %d\n" % number}))
        grading = (cpu() - begun) / 5
    parts: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as scratch, ExitStack() as stack:
        begun = cpu()
        graders = stack.enter_context(frozen(Snapshot.take(catalog.content)))
        for item in graders.catalog.exercises():
            graders.version(item.id)
        parts["snapshot taken, unpacked, versions"] = cpu() - begun
        path = Path(scratch) / "gradebook.sqlite"
        with Gradebook(path, create=True, writing=True) as book:
            book.keep_snapshot(graders.snapshot.sha256, graders.snapshot.packed)
            names = [f"student-{number:05}" for number in range(students)]
            for name in names:
                about = replace(key(name, EXERCISE), seed=1)
                book.add(Result(about, verdict), {exercise.module: source + name.encode()})
        begun = cpu()
        body = b"x" * 6000
        for name in names:
            row_digest("results", 1, 1, name, EXERCISE, "0" * 64, "v", 1, "then", body, "0" * 64)
            row_digest("submissions", "0" * 64, body)
        parts["digests of rows"] = cpu() - begun
        with Gradebook(path, writing=True) as book:
            roster = Roster(tuple(Person(name, name) for name in [*names, "absent"]))
            book.set_meta(seed="1", roster=roster.dump())
            begun = cpu()
            results = Results(book)
            assert results.absent() == ["absent"]
            assert results.unmatched(names) == []
            parts["roster read and matched"] = cpu() - begun
        begun = cpu()
        back_up(path)
        parts[f"backup of {path.stat().st_size >> 20} MB"] = cpu() - begun
        place = Path(scratch) / "student"
        place.mkdir()
        (place / exercise.module).write_bytes(source)
        begun = cpu()
        for _ in names:
            survey(Place(place), {(str(place / exercise.module), "")}, [exercise])
        parts["files left over looked for"] = cpu() - begun
    whole = grading * students
    for name, seconds in parts.items():
        print(f"{name:36} {seconds:8.2f} s   {seconds / whole:7.2%} of grading")
    total = sum(parts.values())
    print(f"{'together':36} {total:8.2f} s   {total / whole:7.2%} of {whole:.0f} s (target: at most 2 %)")


def cpu() -> float:
    """Seconds of CPU of this process and its children that ended; a session's worker counts when it does."""
    times = os.times()
    return process_time() + times.children_user + times.children_system


if __name__ == "__main__":
    main()
