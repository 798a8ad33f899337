"""Notebooks as submissions: the module they stand for, whatever was done to their cells."""

import json

import pytest

from course.catalog.models import Exercise, Task
from course.errors import UngradableError
from course.handed_in.limits import MAX_CODE, MAX_NOTEBOOK
from course.handed_in.notebook import notebook_source

EXERCISE = Exercise(
    format_version=1,
    id="springs",
    title="Springs",
    module="springs.py",
    lesson="springs",
    order=1,
    summary="",
    task=(Task("force", "Force", 5.0), Task("energy", "Energy", 5.0)),
)
SOLUTION = {"course": {"exercise": "springs", "role": "solution", "task": "force"}}
CHECK = {"course": {"exercise": "springs", "role": "check"}}


def code(text, metadata=None, **rest):
    return {"cell_type": "code", "source": text, "metadata": metadata or {}, "outputs": [], **rest}


def notebook(*cells, **rest):
    return json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": cells, **rest}).encode()


def source_of(*cells):
    return notebook_source(notebook(*cells), EXERCISE)


@pytest.mark.parametrize("more", [(), (code("import math"),)])
def test_code_in_a_cell_that_is_no_python_is_named_with_its_first_line(more):
    with pytest.raises(UngradableError) as caught:
        source_of(code("%%writefile springs.py\ndef force(x):\n    return -x\n"), *more)
    message = "the notebook has its code in cell 1, which begins with '%%writefile springs.py':"
    assert message in caught.value.message
    assert caught.value.code == "no_declared_functions"


def run(source):
    """The names that the module defines."""
    names = {}
    exec(compile(source.source, "springs.py", "exec", dont_inherit=True), names)
    return names


FORCE = "def force(k, x):\n    return -k * x"


def test_marked_cells_are_the_module_in_order():
    source = source_of(code("K = 2.0", SOLUTION), code(FORCE, SOLUTION), code("print('experiment')"))
    assert source.source.decode() == f"K = 2.0\n{FORCE}\n"
    assert source.notes == ()


def test_a_cell_that_lost_its_mark_is_known_by_what_it_defines():
    source = source_of(code("x = [1, 2]"), code(FORCE))
    assert run(source)["force"](2.0, 3.0) == -6.0
    assert source.notes == ("Taken for part of the solution by what they define: cell 2.",)


def test_helpers_in_other_cells_count_and_experiments_do_not():
    source = source_of(
        code(
            "import numpy as np\nimport matplotlib.pyplot as plt\nSCALE = 3\nplt.plot([1])\nraise SystemExit"
        ),
        code("TABLE = {}\nTABLE['a'] = SCALE\nunused = TABLE\nprint(force(1, 2))"),
        code("@np.vectorize\ndef helper(x):\n    return x * TABLE['a']"),
        code("def force(k, x):\n    return helper(k) * x", SOLUTION),
    )
    text = source.source.decode()
    for kept in ("import numpy as np", "SCALE = 3", "TABLE['a'] = SCALE", "@np.vectorize"):
        assert kept in text
    for gone in ("matplotlib", "plt.plot", "SystemExit", "unused", "print"):
        assert gone not in text
    assert run(source)["force"](2.0, 3.0) == 18


@pytest.mark.parametrize(
    "statement",
    ["LIST.append(4)", "LIST += [4]", "for i in [4]:\n    LIST.append(i)", "LIST[0] = 4", "del LIST[0]"],
)
def test_a_statement_that_changes_what_is_used_counts(statement):
    source = source_of(code(f"LIST = [1]\n{statement}\nprint('no')"), code("def force():\n    return LIST"))
    assert statement in source.source.decode()
    assert "print" not in source.source.decode()


def test_generated_check_cells_never_count():
    check = "from course.notebooks.magic import points\npoints('springs', 'force')"
    source = source_of(
        code("def force(k, x):\n    return points(k, x)", SOLUTION), code("%course_check springs", CHECK),
        code(check, CHECK),
    )  # fmt: skip
    assert "course" not in source.source.decode()


@pytest.mark.parametrize(
    "experiment", ["x = undefined_name", "k: int = nowhere()", "total = force(1, 2) / 0"]
)
def test_an_experiment_may_use_the_names_of_parameters_and_local_variables(experiment):
    text = (
        "def force(k, x):\n    total = 0\n    for each in [k]:\n        total += each\n    return -total * x"
    )
    source = source_of(code(text, SOLUTION), code(experiment))
    assert run(source)["force"](2, 3) == -6


def test_what_only_inner_functions_and_defaults_use_counts_too():
    source = source_of(
        code("A = 1\nB = 2\nC = 3\nD = 4"),
        code("def force(k=A):\n    def inner():\n        return B\n    return [inner() + C for _ in [k]]"),
    )
    assert run(source)["force"]() == [5]
    assert "D = 4" not in source.source.decode()


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("%matplotlib inline\nK = 1", "\nK = 1"),
        ("!pip install numpy\nK = 1", "\nK = 1"),
        ("files = !ls\nK = 1", "\nK = 1"),
        ("took = %timeit -o 1+1\nK = 1", "\nK = 1"),
        ("force?\nK = 1", "\nK = 1"),
        ("?force\nK = 1", "\nK = 1"),
        ("np.sum??\nK = 1", "\nK = 1"),
        ("%%time\nK = 1", "\nK = 1"),
        ("\n%%capture out\n%time 1\nK = 1", "\n\n\nK = 1"),
        ("K = '''\n%time\n!ls\n'''\n%time 1", "K = '''\n%time\n!ls\n'''\n"),
        ("K = (7\n% 3)\n%time 1", "K = (7\n% 3)\n"),
        ("K = 7 \\\n% 3\n!ls", "K = 7 \\\n% 3\n"),
        ("K = 'it''s' # don't\n!ls", "K = 'it''s' # don't\n"),
        ("K = 7 \\\n  % 3", "K = 7 \\\n  % 3"),
    ],
)
def test_what_is_not_python_is_taken_out_line_by_line(text, left):
    source = source_of(code(text, SOLUTION), code(FORCE, SOLUTION))
    assert source.source.decode() == f"{left}\n{FORCE}\n"


def test_a_magic_within_a_block_takes_nothing_else_with_it():
    block = "if True:\n    %time force(1, 2)\n    K = 1"
    source = source_of(code(block, SOLUTION), code("def force(x):\n    return K * x", SOLUTION))
    assert source.source.decode().startswith("if True:\n    pass\n    K = 1\n")


def test_magics_that_are_written_out_are_taken_out_too():
    text = "get_ipython().run_line_magic(\n    'matplotlib', 'inline'\n)\nget_ipython().system('ls')\n"
    source = source_of(code(text + FORCE, SOLUTION), code("K = 1; get_ipython()", SOLUTION))
    assert source.source.decode() == f"\n\n\n\n{FORCE}\nK = 1; get_ipython()\n"
    assert source.notes[0].startswith("Cell 1, line 1: left out")
    assert source.notes[1].startswith("Cell 1, line 4: left out")


@pytest.mark.parametrize(
    "cells",
    [
        [code(" " * 300_000 + "§")],
        [code("x" + " " * 300_000 + "§")],
        [code(f"a{k} = a{k + 1}") for k in range(1500)] + [code("def energy():\n    return a0")],
        [code("?" * 200_000)],
        [code("'" * 200_001)],
        [code("(" * 200_000)],
    ],
)
def test_no_cell_takes_forever_to_read(cells):
    """Each took minutes or hours where the time grew with the square of the size."""
    assert source_of(*cells, code(FORCE)).source.endswith(f"{FORCE}\n".encode())


def test_more_code_than_anyone_writes_is_refused_and_the_largest_cell_named():
    with pytest.raises(UngradableError) as caught:
        source_of(code(FORCE), code("1\n" * (MAX_CODE // 4)), code("1\n" * (MAX_CODE // 3)))
    assert caught.value.code == "too_large"
    assert "cell 3" in caught.value.message


@pytest.mark.parametrize("text", ["%%bash\nrm -rf /", "%%html\n<b>", "%%writefile a.py\ndef force(): 1"])
def test_cells_of_another_language_are_left_out(text):
    source = source_of(code(text, SOLUTION), code(FORCE, SOLUTION))
    assert source.source.decode() == f"{FORCE}\n"
    assert source.notes[0].startswith("Cell 1, line 1: left out")


def test_a_line_of_the_module_is_a_place_in_the_notebook():
    source = source_of(
        {"cell_type": "markdown", "source": "# Springs", "metadata": {}},
        code("from __future__ import annotations\nK = 1\n", SOLUTION),
        code(FORCE, SOLUTION),
    )
    lines = source.source.decode().split("\n")
    assert lines[0] == "from __future__ import annotations"
    assert source.place(lines.index("K = 1") + 1) == "cell 2, line 2"
    assert source.place(lines.index("    return -k * x") + 1) == "cell 3, line 2"


def test_a_solution_cell_that_is_not_python_spoils_the_module_as_it_would_a_file():
    source = source_of(code("def force(k, x:\n    return 1"), code("def energy(k, x):\n    return 1"))
    with pytest.raises(SyntaxError):
        run(source)


def test_a_notebook_of_format_3_is_read():
    cell = {"cell_type": "code", "input": FORCE, "language": "python", "metadata": {}}
    old = {"nbformat": 3, "metadata": {"name": ""}, "worksheets": [{"cells": [cell]}]}
    assert run(notebook_source(json.dumps(old).encode(), EXERCISE))["force"](1, 1) == -1


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "not_a_notebook"),
        (b"def force(): pass", "not_a_notebook"),
        (b"\xff\xfe\x00", "not_a_notebook"),
        (b'{"cells": []}', "not_a_notebook"),
        (b'{"nbformat": 4, "cells": [17]}', "not_a_notebook"),
        (b'{"nbformat": 4, "cells": ' + b"[" * 100_000, "not_a_notebook"),
        (notebook(code(FORCE, outputs=[])).replace(b"[]", b"[" * 200_000 + b"]" * 200_000), "not_a_notebook"),
        (notebook(code(FORCE)).replace(b"-k", b"-\xff\xfe k"), "not_a_notebook"),
        (notebook(code(FORCE)).replace(b"-k", b"-\\ud800 k"), "not_a_notebook"),
        (notebook(), "no_declared_functions"),
        (notebook(code("x = 1")), "no_declared_functions"),
        (
            notebook(code(FORCE), metadata={"kernelspec": {"language": "julia", "name": "julia"}}),
            "other_kernel",
        ),
        (notebook(code(FORCE), metadata={"language_info": {"name": "R"}}), "other_kernel"),
        (b" " * (MAX_NOTEBOOK + 1), "too_large"),
    ],
)
def test_what_cannot_be_graded_is_refused_with_a_reason(data, reason):
    with pytest.raises(UngradableError) as caught:
        notebook_source(data, EXERCISE)
    assert caught.value.code == reason
    assert caught.value.help


def test_deep_nesting_never_breaks_the_reader():
    for text in ("x = " + "(" * 5000, "x = " + "-" * 50_000 + "1", "x = " + "+".join(["1"] * 50_000)):
        data = notebook(code(text), code(FORCE))
        try:
            notebook_source(data, EXERCISE)
        except UngradableError as refused:
            assert refused.code == "too_deep"  # noqa: PT017 - either is an answer


def test_outputs_may_be_deep_and_ids_the_same():
    data = notebook(code("k = 1", id="same"), code(FORCE, id="same")).replace(b"[]", b"[" * 500 + b"]" * 500)
    assert run(notebook_source(data, EXERCISE))["force"](1, 1) == -1


def test_python_kernels_by_any_name_are_accepted():
    for metadata in ({}, {"kernelspec": {"name": "python3"}}, {"language_info": {"name": "ipython"}}):
        assert run(notebook_source(notebook(code(FORCE), metadata=metadata), EXERCISE))["force"](1, 1) == -1
