"""A hundred hand-ins: where `submit` says all points, a grading run's public part gives all points, too.

Files and notebooks with what students leave in them: trials, drafts, magics, files that are only on their own
disk, functions that never end. A file is worth what its functions are worth; what it says at home is what
counts.
"""

import json

import pytest
from nbformat.v4 import new_code_cell

from course.catalog.load import Catalog
from tests.journeys.conftest import model, notebook, results
from tests.journeys.test_notebook import public

CATALOG = Catalog()
EXERCISES = CATALOG.exercises()

#: What is left in the file above the first function, after it, and at its end.
LEFT = (
    "print(_)",
    "display(3)",
    "assert 1 == 2",
    "import asyncio\nawait asyncio.sleep(0)",
    "x = = 3",
    "%matplotlib inline\n!pip install x",
    "get_ipython().run_line_magic('matplotlib', 'inline')",
    "exit()",
    "import sys\nsys.exit(0)",
    "import os\nos._exit(0)",
    "while True:\n    pass",
    "n = input('n? ')",
    "data = open('data.csv').read()",
    "import time\ntime.sleep(100)",
    "return 5",
    "yield 3",
    "print((1,",
    '"""a note that does not end',
    "import tkinter\ntkinter.Tk()",
    "def r():\n    r()\nr()",
    "x = [0] * 10**11",
    "import matplotlib.pyplot as plt\nplt.plot([1, 2])\nplt.show()",
    "import pandas as pd\npd.DataFrame()",
    "from helpers import *",
    "raise SystemExit",
    "raise KeyboardInterrupt",
    "import numpy as np\nnp.seterr(all='raise')\nnp.random.seed(0)",
    "if __name__ == '__main__':\n    main()",
    "print(undefined_name)",
    "1 / 0",
    "def half(x:\n    return x / 2",
    "class Trial:\n    value = undefined_name",
    "import warnings\nwarnings.simplefilter('error')",
    "<<<<<<< HEAD",
    "for for",
    "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)",
    "import threading\nthreading.Thread(target=print).start()",
    "print('\\ud800')",
    "import gc\ngc.disable()",
    "%%bash\nls",
    "help?",
    "files = !ls",
    "import builtins\nbuiltins.sum = max",
    "global q\nq = 1",
    "T = 1\nT += 1\nassert T == 3",
    "import subprocess\nsubprocess.run(['ls'], check=True)",
    "a, b = 1",
    "lambda: (yield)",
    "\x0c",
    "\x00",
    "def main():\n    import nothing_of_this_name\nmain()",
)
PLACES = ("above", "between", "below")
#: Students, who each hand in every exercise: more than a hundred files.
STUDENTS = 18


def in_a_file(exercise, left, place):
    """The model with these lines in it."""
    lines = model(exercise).split("\n")
    starts = [number for number, line in enumerate(lines) if line.startswith(("def ", "class ", "@"))]
    at = {"above": starts[0], "between": starts[1], "below": len(lines)}[place]
    return "\n".join([*lines[:at], left, "", "", *lines[at:]])


def in_a_notebook(exercise, left, place):
    """The model's notebook with a cell more, or with these lines at the end of a function's cell."""
    made = json.loads(notebook(exercise))
    roles = [cell["metadata"].get("course", {}).get("role") for cell in made["cells"]]
    first = roles.index("solution")
    if place == "between":
        cell = made["cells"][first]
        cell["source"] = f"{''.join(cell['source'])}\n\n{left}"
    else:
        at = first if place == "above" else len(roles)
        made["cells"].insert(at, new_code_cell(left, id="left-in-it"))
    return json.dumps(made).encode()


@pytest.mark.soak
@pytest.mark.xdist_group("as_handed_in")
def test_what_submit_says_is_what_the_run_says(student, instructor, tmp_path):
    said, what = {}, {}
    for number in range(STUDENTS):
        name = f"s{number:02}"
        work = tmp_path / name
        student("init", work)
        for turn, exercise in enumerate(EXERCISES):
            case = number * len(EXERCISES) + turn
            left, place = LEFT[case % len(LEFT)], PLACES[(case // len(LEFT) + turn) % len(PLACES)]
            (work / exercise.id).mkdir()
            path = work / exercise.id / exercise.module
            if (number + turn) % 2:
                path.write_text(in_a_file(exercise, left, place), "utf-8")
            else:
                path.with_suffix(".ipynb").write_bytes(in_a_notebook(exercise, left, place))
            what[name, exercise.id] = (left, place, "file" if (number + turn) % 2 else "notebook")
        (tmp_path / "class" / name).mkdir(parents=True)
        reply = json.loads(
            student("submit", "-o", tmp_path / "class" / name / "mine.zip", "--json", cwd=work).stdout
        )
        for file in reply["files"]:
            said[name, file["path"].partition("/")[0]] = (file["last_score"], file["max_score"])
    instructor("grade", "run", tmp_path / "class", "--out", tmp_path / "out", "-j", "2", code=None)
    found, full = results(tmp_path / "out"), 0
    for about, (score, most) in said.items():
        full += score == most
        given = public(found[about]) if found[about]["checks"] else (0.0, most)
        assert given == (score, most), (about, what[about], found[about]["error"])
    print(f"{full} of {len(said)} with all points by what submit says, and by the run")
    assert len(said) == STUDENTS * len(EXERCISES)
    assert full >= 100
