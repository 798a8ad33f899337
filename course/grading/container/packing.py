"""A zip for Gradescope's "Configure Autograder": the course's graders, run there on every submission.

It contains hidden graders and model solutions, so it is only for the instructor. The same inputs give the
same bytes.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

from course.catalog.load import Catalog
from course.catalog.models import Exercise
from course.catalog.pack import zip_entry
from course.extras import CONTAINER, requirement_of
from course.grading.container.inside import SNAPSHOT
from course.grading.exports.grades import write_bytes
from course.grading.exports.selection import Written
from course.grading.running.snapshot import Snapshot

_PACKAGE = Path(__file__).resolve().parents[2]
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
    config = {
        "exercises": ids,
        "required": asked,
        "seed": seed,
        "timeout": timeout,
        "at_least": "L1",
        "graders": snapshot.sha256,
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as packed:
        wanted = " ".join(f"'{requirement_of(name).text}'" for name in CONTAINER.packages)
        setup = _SETUP.replace("{requirements}", wanted)
        _put(packed, "setup.sh", setup.encode(), executable=True)
        _put(packed, "run_autograder", _RUN.replace("{module}", CONTAINER.module).encode(), executable=True)
        _put(packed, "config.json", json.dumps(config, indent=1).encode())
        _put(packed, SNAPSHOT, snapshot.packed)
        for name, source in _package():
            _put(packed, f"course/{name}", source.read_bytes())
    write_bytes(path, buffer.getvalue())
    notes = [
        "The zip holds hidden graders and model solutions: upload it, and give it to no student.",
        "The container's protection level is in the output that only you see; below L2 a hostile submission "
        "could read the graders, and write its own result.",
    ]
    return Written(paths=[path], rows=len(exercises), notes=notes)


def _package() -> Iterator[tuple[str, Path]]:
    """The program, which reads what was handed in and starts the grader: each file's name, and the file."""
    for source in sorted(_PACKAGE.rglob("*")):
        inner = source.relative_to(_PACKAGE)
        if source.is_file() and not _CONTENT.intersection(inner.parts):
            yield inner.as_posix(), source


def _put(packed: zipfile.ZipFile, name: str, content: bytes, *, executable: bool = False) -> None:
    packed.writestr(zip_entry(name, 0o755 if executable else 0o644), content, zipfile.ZIP_DEFLATED)
