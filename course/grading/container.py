"""Gradescope's container: the zip that an instructor uploads there, and what it does with a submission.

The zip holds hidden graders and model solutions, so it is only for the instructor. The same inputs give the
same bytes.

There ``python -m course.grading.container SUBMISSION RESULTS CONFIG`` runs for each submission. The snapshot
beside CONFIG grades, by the same grader process as in a run. It works at the best protection level the
container allows and says which in the output that the instructor sees. A results file is always written: if
the grader fails, it says so and gives no score, so that no student loses points for it.
"""

import hashlib
import io
import json
import sys
import traceback
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.pack import zip_entry
from course.errors import CourseError
from course.extras import CONTAINER, requirement_of
from course.grading.exports.grades import write_bytes
from course.grading.exports.platforms import results_body
from course.grading.exports.selection import Written
from course.grading.gradebook.records import Key, Result
from course.grading.intake.downloads import Place, Student
from course.grading.intake.students import read_student
from course.grading.results.effective import Effective
from course.grading.running.batch import grade_all, without_grading
from course.grading.running.snapshot import Snapshot, Unpacked, frozen
from course.scoring.judging.submission import Terms
from course.scoring.verdict import Problem

#: The graders, beside the configuration.
SNAPSHOT = "graders.zip"
_PACKAGE = Path(__file__).resolve().parents[1]
#: The content of a wheel, which the snapshot has.
_CONTENT = {"content", "lessons", "__pycache__"}

_SETUP = """#!/usr/bin/env bash
# Runs once, as root, when Gradescope builds the image.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
apt-get update
apt-get install -y --no-install-recommends bubblewrap ca-certificates
python=""
recent='import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))'
for candidate in python3.14 python3.13 python3.12 python3.11 python3; do
  if command -v "$candidate" >/dev/null && "$candidate" -c "$recent"; then
    python="$candidate"
    break
  fi
done
if [ -z "$python" ]; then
  for version in 3.13 3.12 3.11; do
    if apt-get install -y --no-install-recommends "python$version" "python$version-venv"; then
      python="python$version"
      break
    fi
  done
fi
if [ -z "$python" ]; then
  echo "This image has no Python 3.11 or newer; choose a newer base image." >&2
  exit 1
fi
"$python" -m venv /opt/grader
/opt/grader/bin/pip install --no-cache-dir {requirements}
# Students' code runs as another user where it can; it has no business among the graders.
chmod -R go-rwx /autograder/source
"""

_RUN = """#!/usr/bin/env bash
# Runs for every submission.
set -uo pipefail
cd /
unset PYTHONPATH PYTHONSTARTUP COURSE_CONTENT
export PYTHONPATH=/autograder/source
export PYTHONDONTWRITEBYTECODE=1
exec /opt/grader/bin/python -P -m {module} \\
  /autograder/submission /autograder/results/results.json /autograder/source/config.json
"""


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
        try:
            (graded,) = grade_all([entry], terms)
            verdict = entry.told(graded.verdict)
        except CourseError as error:
            problem = Problem(error.code, error.message, error.help)
            verdict = without_grading(entry, "grader_error", problem)
        level = verdict.isolation or "no level"
        print(f"{verdict.exercise}: {verdict.state} at {level}", verdict.error or "")  # noqa: T201
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


def write_autograder(
    path: Path, catalog: Catalog, exercises: Sequence[Exercise], *, seed: int, timeout: float, asked: bool
) -> Written:
    """Write the zip.

    Args:
        seed: of the hidden inputs, together with the submission: equal files meet equal inputs.
        timeout: seconds of CPU time per check.
        asked: the exercises were named, so a missing one is reported.

    Raises:
        MissingCapabilityError: this installation has no hidden graders or no model solutions, or the file
            cannot be written.
    """
    catalog.content.instructors()
    ids = [exercise.id for exercise in exercises]
    snapshot = Snapshot.take(catalog.content, ids)
    terms = {"seed": seed, "timeout": timeout, "at_least": "L1", "graders": snapshot.sha256}
    config = {"exercises": ids, "required": asked, **terms}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as packed:
        wanted = " ".join(f"'{requirement_of(name).text}'" for name in CONTAINER.packages)
        setup = _SETUP.replace("{requirements}", wanted)
        _put(packed, "setup.sh", setup.encode(), executable=True)
        _put(packed, "run_autograder", _RUN.replace("{module}", CONTAINER.module).encode(), executable=True)
        _put(packed, "config.json", json.dumps(config, indent=1).encode())
        _put(packed, SNAPSHOT, snapshot.packed)
        # The program, which reads what was handed in and starts the grader.
        for source in sorted(_PACKAGE.rglob("*")):
            inner = source.relative_to(_PACKAGE)
            if source.is_file() and not _CONTENT.intersection(inner.parts):
                _put(packed, f"course/{inner.as_posix()}", source.read_bytes())
    write_bytes(path, buffer.getvalue())
    notes = [
        "The zip holds hidden graders and model solutions: upload it, and give it to no student.",
        "The container's protection level is in the output that only you see; below L2 a hostile submission "
        "could read the graders, and write its own result.",
    ]
    return Written(paths=[path], rows=len(exercises), notes=notes)


def _put(packed: zipfile.ZipFile, name: str, content: bytes, *, executable: bool = False) -> None:
    packed.writestr(zip_entry(name, 0o755 if executable else 0o644), content, zipfile.ZIP_DEFLATED)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
