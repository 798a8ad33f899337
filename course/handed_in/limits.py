"""What a grading run takes: the files, how large they may be, and the zip that ``course submit`` writes.

What a student is told at home and what a grading run refuses are read from here, so they cannot differ.
"""

from pathlib import Path

from course.errors import UngradableError, UsageError

#: The suffixes of files with a student's functions, and of all that can be handed in.
SOURCES = (".py", ".ipynb")
HANDED_IN = (*SOURCES, ".zip")

#: The largest module, in bytes.
MAX_FILE = 1 << 20
#: The most code in all cells of a notebook together, in characters: the limit of a module.
MAX_CODE = MAX_FILE
#: The largest notebook, in bytes. Pictures in outputs make notebooks large; they are skipped, but they have
#: to be read past.
MAX_NOTEBOOK = 32 << 20
#: Code cells; the longest notebooks that people write have some hundreds.
MAX_CELLS = 2000

#: Files in an archive; of a course's own there are some forty.
MAX_FILES = 500
#: The longest path of a file in an archive, in characters, and the most folders above it. The longest that
#: programs make, in environments, have some 250 and 30.
MAX_PATH, MAX_DEEP = 1000, 100
#: All of an archive that may be read, in bytes; an environment or a report beside it does not count, and the
#: archive itself may be larger.
MAX_UNPACKED = 5 << 20
MAX_ARCHIVE = 300 << 20
#: What is decompressed of all tar archives of one student together, in bytes.
MAX_STREAMED = 100 << 20
#: The member that says what an archive holds, and the version of its form.
MANIFEST = "submission.json"
FORMAT_VERSION = 1


def must_fit(size: int, what: str) -> None:
    """Refuse a module of more than ``MAX_FILE`` bytes."""
    if size > MAX_FILE:
        fix = "Keep data out of it; the exercise needs none."
        raise UngradableError(f"{what} larger than {MAX_FILE:,} bytes.", help=fix, code="too_large")


def read_notebook(path: Path) -> bytes:
    try:
        if not path.is_file():
            raise UsageError(f"{path} is not a file.", help="Name a notebook.", code="not_a_file")
        if path.stat().st_size > MAX_NOTEBOOK:
            message = f"{path} is larger than {MAX_NOTEBOOK >> 20} MB."
            raise UsageError(message, help="Clear its outputs and save it.", code="too_large")
        return path.read_bytes()
    except OSError as error:
        message = f"{path} cannot be read ({error.strerror or error})."
        raise UsageError(message, help="Check its permissions.") from error
