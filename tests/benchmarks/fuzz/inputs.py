"""Inputs nobody would hand in, made from a generator of random numbers: the same numbers, the same input."""

import io
import json
import random
import struct
import warnings
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from course.isolation.inside.wire import Codec, Kind


class Chance(random.Random):
    """The numbers of one input, and how wild it is: a tame one gets further in."""

    def __init__(self, seed: str) -> None:
        super().__init__(seed)
        self.wild = self.choice((0.0, 0.01, 0.06, 0.3))

    def tame(self, usual: Any, odd: Any) -> Any:
        """The usual thing, or one of the odd ones."""
        return self.choice(odd) if self.random() < self.wild else usual


SCENES = sorted((Path(__file__).resolve().parents[3] / "course" / "sandbox" / "scenes").glob("*.toml"))

#: Pieces of cells: right ones, what IPython adds, what ends a parser, and what is no text at all.
_CODE = (
    "def double(x):\n    return 2 * x",
    "def doublings(x, n):\n    return [x * 2.0**k for k in range(n + 1)]", "async def double(x): pass",
    "double = lambda x: x", "class double: pass", "import numpy as np", "y += x",
    "from __future__ import annotations", "from __future__ import division\n", "x = y = z = double",
    "del double", "%matplotlib inline", "!ls", "?double", "%%bash\nrm -rf /",
    "%%time\ndef double(x):\n    return x", "%%", "a = %x", "get_ipython().run_line_magic('x', '')",
    "get_ipython()", "x = get_ipython(); y = 1", "return 1", "yield", "'''", '"""', "'\\", "(", "[{", ")",
    "}", "\\\n", "\t", "\r", "\x0c", "\x00", "\u2028", "\u202e", "\ud800", "\ufeff", "é", "𝒹𝑜𝓊𝒷𝓁𝑒 = 1", "#",
    "# coding: utf-7", "0777", "1" * 5000, "f'{f\"{x}\"}'", "f'{", "x" * 300, "lambda: (yield)",
    "match x:\n    case 1: pass", "type X = int", "global double", "nonlocal x", "await x",
    "if 1:\n" + "".join(" " * depth + "if 1:\n" for depth in range(1, 90)) + " " * 90 + "pass",
    "-" * 3000 + "1", "(" * 150 + ")" * 150, "x = " + "[" * 90 + "]" * 90, "x" + ".y" * 3000,
    "x" + "[0]" * 900,
)  # fmt: skip
#: Of these what is text, whatever it does to a parser.
_TAME = tuple(text for text in _CODE if text.isprintable() or "\n" in text)
_ODD: tuple[Any, ...] = (
    None, True, 0, -1, 1.5, 1e308, float("nan"), 2**70, "", "code", [], {}, [[]], "\ud800", "double",
    "x" * 5000, ["def double(x):\n", "    return x"], [1], [None], {"a": {}},
)  # fmt: skip
_KEYS = (
    "cell_type", "source", "input", "metadata", "outputs", "execution_count", "id", "course", "role", "name",
)  # fmt: skip


def notebook(chance: Chance) -> bytes:
    """A notebook, or what is left of one."""
    made = {
        "nbformat": chance.tame(4, _ODD),
        "nbformat_minor": chance.tame(5, _ODD),
        "metadata": chance.tame(
            {"kernelspec": {"language": chance.tame("python", _ODD), "name": "python3"}}, _ODD
        ),
        "cells": [_cell(chance) for _ in range(chance.choice((0, 1, 2, 3, 5, 30)))],
    }
    if chance.random() < 0.1:
        made["worksheets"] = [{"cells": made.pop("cells")}]
    return damaged(
        chance, json.dumps(made, ensure_ascii=chance.random() < 0.5).encode("utf-8", "surrogatepass")
    )


def _cell(chance: Chance) -> Any:
    lines = [chance.tame(chance.choice(_TAME), _CODE) for _ in range(chance.choice((1, 1, 2, 3, 8)))]
    text = chance.choice(("\n", "\n", "\n", "; ", " ", "")).join(lines)
    cell = {
        "cell_type": chance.tame("code", _ODD),
        "source": chance.tame(chance.choice((text, text.splitlines(keepends=True))), _ODD),
        "metadata": chance.tame(
            {"course": {"exercise": "doubling", "role": chance.tame("solution", _ODD)}}, _ODD
        ),
        "outputs": [],
    }
    if chance.random() < chance.wild:
        cell[chance.choice(_KEYS)] = chance.choice(_ODD)
    return cell if chance.random() > chance.wild / 10 else chance.choice(_ODD)


def damaged(chance: Chance, data: bytes) -> bytes:
    """As it is, or with bytes changed, doubled, left out or written over."""
    found = bytearray(data)
    if chance.random() >= 2 * chance.wild or not found:
        return data
    for _ in range(chance.choice((1, 2, 5, 40))):
        at = chance.randrange(len(found) + 1)
        match chance.randrange(4):
            case 0:
                found[at : at + 1] = bytes([chance.randrange(256)])
            case 1:
                found[at:at] = found[at : at + chance.choice((1, 4, 100))]
            case 2:
                del found[at : at + chance.choice((1, 4, 100))]
            case _:
                found[at : at + 4] = struct.pack(
                    "<I", chance.choice((0, 1, 2**31, 2**32 - 1, chance.randrange(2**32)))
                )
    return bytes(found)


NAMES = (
    "doubling.py", "doubling/doubling.py", "doubling.ipynb", "x/y/doubling.py", "x\\doubling.py",
    "Doubling (2).PY", "submission.json", "quiz.json", "../doubling.py", "/doubling.py", "C:\\doubling.py",
    "a/../doubling.py", "doubling.py/", "__MACOSX/doubling.py", ".DS_Store", "a.zip", "\n.py",
    "\u202eyp.gnilbuod", "a\x1b[2J.py", "é.py", "e\u0301.py", "", "x" * 300 + ".py", "./doubling.py",
    "doubling.py ", "con.py", "a\x00.py", "doubling.pyc", "//doubling.py",
)  # fmt: skip
_METHODS = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA)


def archive(chance: Chance) -> bytes:
    """A zip as somebody could make it by hand, or damaged in its headers or its content."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as target:
        for _ in range(chance.choice((0, 1, 1, 2, 3, 6, 25))):
            info = zipfile.ZipInfo(chance.tame(chance.choice(NAMES[:6]), NAMES) or "x", (1980, 1, 1, 0, 0, 0))
            info.external_attr = chance.tame(0o100644, (0, 0o120777, 0o040755, 0o020600)) << 16
            info.create_system = chance.choice((0, 3))
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # two of one name are wanted
                target.writestr(info, _content(chance), chance.choice(_METHODS))
        target.comment = chance.tame(b"", (b"PK\5\6" * 9, b"PK\1\2"))
    return damaged(chance, buffer.getvalue())


def _content(chance: Chance) -> bytes:
    match chance.randrange(4):
        case 0:
            return chance.tame(chance.choice(_TAME), _CODE).encode("utf-8", "surrogatepass")
        case 1:
            return notebook(chance)
        case 2:
            quiz = chance.choice(({"attempts": [{"answers": chance.choice(_ODD)}]}, *_ODD))
            made = {
                "format_version": chance.tame(1, _ODD),
                "files": chance.tame({"doubling.py": "0" * 64}, _ODD),
                "quiz": quiz,
            }
            return damaged(chance, json.dumps(made).encode())
        case _:
            return b"\0" * chance.tame(10, (0, 100_000, 2_000_000))


# -- frames ------------------------------------------------------------------------------------------------

_TAGS = b"NTFifsalrpvdtRcSbLD\0\1\2\xff"


def frames(chance: Chance) -> list[bytes]:
    """What a worker could send after it said that it is ready: right frames, damaged ones, noise."""
    return [_frame(chance) for _ in range(chance.choice((1, 2, 3, 6)))]


def _frame(chance: Chance) -> bytes:
    if chance.random() < 0.15:
        return chance.randbytes(chance.choice((1, 4, 5, 50)))
    if chance.random() < 0.3:
        body = b"".join(
            bytes([chance.choice(_TAGS)])
            + chance.choice((b"", b"\1\0\0\0", b"\xff\xff\xff\xff", chance.randbytes(3)))
            for _ in range(chance.choice((1, 3, 200)))
        )
    else:
        body = damaged(chance, bytes(Codec().encode(Kind.RESULT, _plain(chance, 4))[5:]))
    kind = chance.tame(chance.choice((Kind.RESULT, Kind.RAISED, Kind.CALLBACK)), (*Kind, 0, 99, 255))
    right = chance.random() >= chance.wild
    length = len(body) + 1 if right else chance.choice((0, 1, 2**31, 2**32 - 1, chance.randrange(2**32)))
    return struct.pack("<IB", length, kind) + body


def _plain(chance: Chance, depth: int) -> Any:
    if depth and chance.random() < 0.5:
        inner = [_plain(chance, depth - 1) for _ in range(chance.randrange(5))]
        return inner if chance.random() < 0.5 else dict(zip(_WORDS, inner, strict=False))
    shape = chance.choice(((), (0,), (3,), (2, 0, 2), (1, 1, 1, 1)))
    leaves: tuple[tuple[Any, ...], ...] = (
        (None, True, False),
        (0, -1, 2**63 - 1, -(2**63), chance.randrange(2**40)),
        (0.0, -0.0, float("nan"), float("inf"), 5e-324, chance.random()),
        (*_WORDS, "\n::error::x", "\u202e", "x" * 3000),
        (np.zeros(shape, chance.choice(("<f8", "<i8", "?", "<c16"))),),
        ([chance.random() for _ in range(chance.choice((1, 4, 500)))],),
    )
    return chance.choice(chance.choice(leaves))


#: Fields that messages have, so that some of them are nearly right.
_WORDS = ("stage", "type", "message", "line", "frames", "text", "bases", "f", "g", "")


# -- scenes ------------------------------------------------------------------------------------------------

_VALUES = (
    "0", "-1", "1e308", "-1e308", "5e-324", "nan", "inf", "-inf", "1e400", "99999999999999999999", '""',
    '"x"', "[]", "{}", "true", "[[0, 0], [0, 0]]", "[nan, nan]", "[1e200, 1e200]", "1979-05-27",
    '"9 ** 9 ** 9"', '"{1 / 0}"', '"{x:>9999999}"', '"{" * 200', '"\\u202e"', '"gravity"', "1_000", "0.0",
    "1000000",
)  # fmt: skip


def scene(chance: Chance) -> tuple[str, bytes]:
    """One of the course's scenes with lines changed, doubled, moved or taken out; its id and the file."""
    path = chance.choice(SCENES)
    lines = path.read_text("utf-8").splitlines()
    for _ in range(chance.tame(chance.choice((1, 2)), (3, 4, 15))):
        at = chance.randrange(len(lines))
        key, equals, value = lines[at].partition("=")
        match chance.randrange(6):
            case 0 | 1 | 2 if equals:
                lines[at] = f"{key}= {chance.tame(_scaled(chance, value), _VALUES)}"
            case 3:
                lines.insert(chance.randrange(len(lines)), lines[at])
            case 4:
                del lines[at]
            case _:
                other = chance.choice(SCENES).read_text("utf-8").splitlines()
                lines.insert(at, chance.choice(other))
        if not lines:
            break
    return path.stem, damaged(chance, "\n".join(lines).encode())


def _scaled(chance: Chance, value: str) -> str:
    """A number by another, of any size that a scene may have and some that it may not; the rest as it is."""
    try:
        return repr(float(value) * chance.choice((-1.0, 0.5, 1.1, 3.0, 10.0 ** chance.randint(-12, 12))))
    except ValueError:
        return value.strip()
