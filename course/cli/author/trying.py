"""Whether the commands that a lesson gives to try do something, in a fresh workspace."""

import contextlib
import io
import json
import os
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

#: What a command may end with: 1 is a check of an unfinished exercise.
_FINE = {0, 1}


def refused(commands: Sequence[str]) -> dict[int, str]:
    """The commands that fail, by their place, and what each said.

    They run in this order in a process of their own: the loading of the program is paid for once.
    """
    path = os.pathsep.join(filter(None, (str(Path(__file__).parents[3]), os.environ.get("PYTHONPATH"))))
    environ, line = {**os.environ, "COLUMNS": "80", "PYTHONPATH": path}, [sys.executable, "-m", __name__]
    with tempfile.TemporaryDirectory(prefix="course-try-") as folder:
        asked = json.dumps([folder, *commands])
        done = subprocess.run(
            line, input=asked, env=environ, capture_output=True, check=False, encoding="utf-8"
        )
    if done.returncode:
        return {0: done.stderr.strip()[-500:]}
    return {int(place): said for place, said in json.loads(done.stdout).items()}


def _main() -> None:
    from course.cli.frame.app import run

    folder, *commands = json.load(sys.stdin)
    os.chdir(folder)
    failed: dict[int, str] = {}
    for place, command in enumerate(["course init .", *commands], start=-1):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                program, *words = shlex.split(command)
                code = run(words) if program == "course" else 2
            except ValueError as error:  # quotes that do not end
                program, code = str(error), 2
        none = f"{program}: it is no command of the course"
        said = err.getvalue().strip() or out.getvalue().strip() or none
        if code not in _FINE or "Traceback" in said:
            failed[place] = said.split("\n")[0]
    json.dump(failed, sys.stdout)


if __name__ == "__main__":
    _main()
