"""The table of rooms in CONTRIBUTING is that of the program; COURSE_UPDATE_GOLDEN=1 writes it anew."""

import ast
import os
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "CONTRIBUTING.md"
HEAD = "| room | files | lines | what it is for |\n|---|---|---|---|\n"
ROW = re.compile(r"\| `(course/[\w/]*)` \| (\d+) \| ([\d,]+) \| (.+) \|")
#: By how much of its lines a room may differ from the table, and by how many in any case.
NEAR, FEW = 0.2, 100


def rooms():
    """By room: its files, their lines, and the first sentence of its face."""
    found = {}
    for face in sorted((ROOT / "course").rglob("__init__.py")):
        files = [path for path in face.parent.glob("*.py") if path != face]
        words = ast.get_docstring(ast.parse(face.read_text("utf-8"))) or ""
        lines = sum(len(path.read_text("utf-8").splitlines()) for path in (*files, face))
        room = face.parent.relative_to(ROOT).as_posix() + "/"
        found[room] = len(files), lines, " ".join(words.split("\n\n")[0].split()).replace("``", "`")
    return found


def table(there):
    rows = (
        f"| `{room}` | {files} | {round(lines, -2):,} | {words} |\n"
        for room, (files, lines, words) in there.items()
    )
    return HEAD + "".join(rows)


def test_the_table_of_rooms_is_that_of_the_program():
    there = rooms()
    text = PAGE.read_text("utf-8")
    if os.environ.get("COURSE_UPDATE_GOLDEN"):
        before, _, rest = text.partition(HEAD)
        text = before + table(there) + rest[rest.index("\n\n") + 1 :]
        PAGE.write_text(text, "utf-8")
    told = {
        room: (int(files), int(lines.replace(",", "")), words)
        for room, files, lines, words in ROW.findall(text)
    }
    assert {room: words for room, (_, _, words) in told.items()} == {
        room: words for room, (_, _, words) in there.items()
    }
    for room, (files, lines, _) in there.items():
        assert abs(told[room][1] - lines) <= max(NEAR * lines, FEW), f"{room} has {lines} lines"
        assert abs(told[room][0] - files) <= 1, f"{room} has {files} files"
    assert all(words.endswith(".") for _, _, words in there.values())
