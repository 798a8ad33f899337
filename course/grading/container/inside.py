"""Inside Gradescope's container: grade the submission and write ``results.json``.

Run as ``python -m course.grading.container.inside SUBMISSION RESULTS CONFIG``. The snapshot that lies beside
CONFIG grades, by the same grader process as in a run. It works at the best protection level the container
allows and says which in the output that the instructor sees. A results file is always written: if the grader
fails, it says so and gives no score, so that no student loses points for it.
"""

from __future__ import annotations

import hashlib
import json
import sys
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any

from course.errors import CourseError
from course.grading.exports.grades import write_bytes
from course.grading.exports.platforms import results_body
from course.grading.gradebook.records import Key, Result
from course.grading.intake.downloads import Place, Student
from course.grading.intake.students import read_student
from course.grading.results.effective import Effective
from course.grading.running.batch import grade_all, without_grading
from course.grading.running.snapshot import Snapshot, frozen
from course.scoring.judging.submission import Terms
from course.scoring.verdict import Problem

if TYPE_CHECKING:
    from course.grading.intake.students import Entry
    from course.grading.running.snapshot import Unpacked
    from course.scoring.verdict import Verdict

#: The graders, beside the configuration.
SNAPSHOT = "graders.zip"


def main(arguments: list[str]) -> int:
    """Grade one submission; the exit code is 0 unless no results file could be written."""
    submission, results, config = (Path(argument) for argument in arguments)
    try:
        told = json.loads(config.read_text("utf-8"))
        snapshot = Snapshot.of(config.with_name(SNAPSHOT).read_bytes(), told["graders"])
        with frozen(snapshot) as graders:
            body = grade(submission, told, graders)
    except Exception:  # noqa: BLE001 - the boundary: Gradescope shows nothing without a results file
        traceback.print_exc()
        body = _our_fault()
    write_bytes(results, json.dumps(body, indent=1, allow_nan=False).encode())
    return 0


def _our_fault() -> dict[str, Any]:
    """No score and no test: Gradescope then asks the instructor to look."""
    words = "A fault of the grader, not of yours, kept this from being graded. It can be run again."
    return {"output": words, "output_format": "text", "visibility": "visible", "stdout_visibility": "hidden"}


def grade(folder: Path, config: dict[str, Any], graders: Unpacked) -> dict[str, Any]:
    """The body of ``results.json`` for the submission in a folder.

    Args:
        config: exercises (ids), required (whether each must be there), seed, timeout (s), at_least.

    Hidden inputs follow from the seed and what was handed in. The total is shown at once and a student may
    hand in as often as they like: with the same inputs each time, files that differ in one comparison would
    read them out.
    """
    exercises = [graders.catalog.exercise(name) for name in config["exercises"]]
    student = Student("submission", Place(folder))
    found: list[Effective] = []
    for entry in read_student(student, exercises, required=bool(config["required"])):
        if entry.submission is None and entry.problem is None:
            continue
        drawn = hashlib.sha256(f"{config['seed']} {entry.sha256}".encode()).digest()
        seed = int.from_bytes(drawn[:8]) >> 1
        terms = Terms(None, config["at_least"], config["timeout"], seed, graders.snapshot.sha256)
        verdict = _judged(entry, terms)
        _log(verdict)
        key = Key("submission", entry.exercise.id, entry.sha256, graders.version(entry.exercise.id), seed)
        score = None if verdict.state == "grader_error" else verdict.score
        found.append(Effective(Result(key, verdict), score, verdict.max_score, verdict.passed))
    if any(effective.score is None for effective in found):
        return _our_fault()
    body = results_body(found)
    if not found:
        names = ", ".join(f"{exercise.id}/{exercise.module}" for exercise in exercises)
        body["output"] = (
            f"Nothing to grade was found. This assignment takes {names}, or the zip of `course submit`."
        )
    return body


def _judged(entry: Entry, terms: Terms) -> Verdict:
    try:
        (graded,) = grade_all([entry], terms)
    except CourseError as error:
        return without_grading(entry, "grader_error", Problem(error.code, error.message, error.help))
    return entry.told(graded.verdict)


def _log(verdict: Verdict) -> None:
    """A line that only the instructor sees."""
    level = verdict.isolation or "no level"
    print(f"{verdict.exercise}: {verdict.state} at {level}", verdict.error or "")  # noqa: T201


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
