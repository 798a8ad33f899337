"""Generated notebooks run from top to bottom in a fresh kernel, and give the lessons' own numbers."""

import json
from importlib.util import find_spec

import pytest
from nbformat.v4 import new_code_cell

from course.authoring.lessons.cells import as_written
from course.catalog import blocks as b
from course.catalog.load import Catalog
from course.catalog.markdown import read_blocks
from course.notebooks.build import generate
from course.notebooks.server import executed

MISSING = [name for name in ("nbclient", "ipykernel") if find_spec(name) is None]

pytestmark = [
    pytest.mark.soak,
    pytest.mark.skipif(bool(MISSING), reason=f"the extra notebook is not installed: {', '.join(MISSING)}"),
]

CATALOG = Catalog()
#: Makes a connection fail the cell that tries it.
OFFLINE = """\
import socket
def _refused(*_, **__): raise OSError("a lesson asked for the network")
socket.create_connection = socket.getaddrinfo = _refused
"""


def ran(kind, name, more=""):
    """The cells of a notebook after a run; ``more`` is one more cell at its end."""
    (one,) = [made for made in generate(CATALOG, [name]) if made.kind == kind]
    notebook = json.loads(one.data)
    for place, text in ((0, OFFLINE), (len(notebook["cells"]) + 1, more)):
        notebook["cells"].insert(place, new_code_cell(text, id=f"extra-{place}"))
    return json.loads(executed(json.dumps(notebook).encode(), str(one.path)))["cells"]


def printed(cell):
    return "".join("".join(one["text"]) for one in cell["outputs"] if one["output_type"] == "stream")


@pytest.mark.parametrize("name", CATALOG.lesson_ids())
def test_a_lesson_runs_and_its_numbers_are_those_of_its_text(name):
    blocks = read_blocks(CATALOG.content.lessons / f"{name}.md")
    values = [value for _, value in b.walk_inlines(blocks) if isinstance(value, b.Value)]
    expressions = ", ".join(f"({value.expression})" for value in values)
    plain = "lambda v: v if isinstance(v, str) else float(v)"
    cells = ran("lesson", name, f"import json\nprint(json.dumps(list(map({plain}, [{expressions}]))))")
    ours = [cell for cell in cells if cell["metadata"].get("course", {}).get("role") in ("lesson", "hidden")]
    written = [block for block in b.walk_blocks(blocks) if isinstance(block, b.CodeCell)]
    assert len(ours) == len(written)
    for cell, block in zip(ours, written, strict=True):
        assert printed(cell).removesuffix("\n") == (block.output or ""), block.line
    for value, computed in zip(values, json.loads(printed(cells[-1])), strict=True):
        shown = as_written(computed, value.text)
        assert value.text.startswith(shown), (value.line, value.expression, shown)
    tasks = [cell for cell in cells if cell["metadata"].get("course", {}).get("role") == "warm-up"]
    checked = ["".join(cell["outputs"][0]["data"]["text/plain"]) for cell in tasks if "outputs" in cell]
    assert len(checked) == len(CATALOG.warm_ups(name))
    assert not any("this warm-up is done" in said or "all checks pass" in said.lower() for said in checked)
    figures = [cell for cell in cells if cell["metadata"].get("course", {}).get("role") == "figure"]
    assert all("image/png" in cell["outputs"][0]["data"] for cell in figures)


@pytest.mark.parametrize(
    ("kind", "name"),
    [*(("exercise", name) for name in CATALOG.exercise_ids()), ("quiz", "quiz"), ("sandbox", "sandbox")],
)
def test_an_exercise_quiz_or_sandbox_runs(kind, name):
    cells = ran(kind, name)
    shown = [cell for cell in cells if cell.get("outputs")]
    assert shown
    assert not any(one["output_type"] == "error" for cell in shown for one in cell["outputs"])
