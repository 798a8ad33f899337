"""Hostile documents by syntax, each made from a right one of its format; and what is no document at all."""

import io
import json
import os
import sqlite3
import stat
import warnings
import zipfile
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

#: Puts a document at a path; is given the right one, which lies there already.
Made = Callable[[Path], None]

_DEEP, _LONG = 5_000, 2_000_000
_DIGITS = "9" * 5_000


def _bytes(change: Callable[[bytes], bytes]) -> Made:
    def make(path: Path) -> None:
        path.write_bytes(change(path.read_bytes()))

    return make


def _raw(text: str | bytes) -> bytes:
    return text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass")


def _with(more: str | bytes) -> Made:
    """The right document with more at its end."""
    return _bytes(lambda right: right + _raw(more))


def _instead(text: str | bytes) -> Made:
    return _bytes(lambda _: _raw(text))


def _text(change: Callable[[str], str]) -> Made:
    return _bytes(lambda right: _raw(change(right.decode())))


#: Of every text: how it is encoded, and where it ends.
TEXT: dict[str, Made] = {
    "empty": _instead(b""),
    "nul": _bytes(lambda right: right[:20] + b"\0" + right[20:]),
    "only-nul": _instead(b"\0" * 10_000),
    "bom": _bytes(lambda right: b"\xef\xbb\xbf" + right),
    "two-boms": _bytes(lambda right: b"\xef\xbb\xbf\xef\xbb\xbf" + right),
    "utf-16": _bytes(lambda right: right.decode().encode("utf-16")),
    "utf-16-odd": _bytes(lambda right: right.decode().encode("utf-16")[:-1]),
    "utf-32": _bytes(lambda right: right.decode().encode("utf-32")),
    "latin-1": _with(b"\xe9\xff"),
    "lone-surrogate": _with(b"\xed\xa0\x80"),
    "truncated": _bytes(lambda right: right[: len(right) // 2]),
    "controls": _with(b"\x1b[2J\x07\x7f\r\x0b"),
    "noise": _instead(bytes(range(256)) * 40),
    "long-line": _with(b"x" * _LONG),
    "many-lines": _with(b"\n" * _LONG),
    "larger-than-any": _instead(b"x" * 25_000_000),
}

_TOML: dict[str, str] = {
    "deep-list": f"\nx = {'[' * _DEEP}{']' * _DEEP}\n",
    "deep-list-open": f"\nx = {'[' * _DEEP}",
    "deep-table": f"\nx = {'{a=' * _DEEP}1{'}' * _DEEP}\n",
    "deep-60": f"\nx = {'[' * 60}{']' * 60}\n",
    "dotted-key": f"\n{'a.' * 20_000}a = 1\n",
    "dotted-header": f"\n[{'a.' * 20_000}a]\n",
    "dotted-inside": f"\nx = {{ {'a.' * 20_000}a = 1 }}\n",
    "many-headers": "\n" + "".join(f"[h{n}]\n" for n in range(20_000)),
    "huge-integer": f"\nx = {_DIGITS}\n",
    "huge-hex": f"\nx = 0x{'f' * 5_000}\n",
    "huge-binary": f"\nx = 0b{'1' * 20_000}\n",
    "huge-float": f"\nx = {_DIGITS}.0e{_DIGITS}\n",
    "not-finite": "\nx = [nan, inf, -inf]\n",
    "huge-string": f'\nx = "{"y" * 900_000}"\n',
    "escaped-surrogate": '\nx = "\\ud800"\n',
    "date": "\nx = 9999-12-31T23:59:60Z\ny = 2026-02-30\n",
    "duplicate": "\nx = 1\nx = 2\n",
    "quotes": '\nx = """' + '"' * 5 + "\n",
}
TOML: dict[str, Made] = {
    **TEXT,
    **{name: _with(text) for name, text in _TOML.items()},
    **{
        f"first-{name}": _text(lambda right, text=text: text.lstrip() + right) for name, text in _TOML.items()
    },
    "version-huge-hex": _text(
        lambda right: right.replace("format_version = 1", f"format_version = 0x{'f' * 5_000}")
    ),
    "version-huge": _text(lambda right: right.replace("format_version = 1", f"format_version = {_DIGITS}")),
    "version-text": _text(lambda right: right.replace("format_version = 1", 'format_version = "1"')),
    "version-true": _text(lambda right: right.replace("format_version = 1", "format_version = true")),
    "version-newer": _text(lambda right: right.replace("format_version = 1", f"format_version = {2**62}")),
}


def values(text: str) -> str:
    """A TOML text with every value an odd one, in turn."""
    odd = [
        "nan",
        "-inf",
        "true",
        '""',
        "[]",
        "{}",
        f"{2**63 - 1}",
        "-1",
        "1979-05-27",
        "[[[1]]]",
        '"\\u202e"',
    ]
    rows = text.splitlines()
    for number, row in enumerate(rows):
        if "=" in row and not row.startswith(("format_version", "#")):
            rows[number] = f"{row.partition('=')[0]}= {odd[number % len(odd)]}"
    return "\n".join(rows) + "\n"


TOML["odd-values"] = _text(values)

_JSON: dict[str, str] = {
    "deep-list": "[" * _DEEP + "]" * _DEEP,
    "deep-open": "[" * 100_000,
    "deep-object": '{"a":' * _DEEP + "1" + "}" * _DEEP,
    "huge-integer": _DIGITS,
    "minus-huge": f"-{_DIGITS}",
    "huge-float": "1e999",
    "not-finite": "[NaN, Infinity, -Infinity]",
    "surrogate": '"\\ud800"',
    "huge-string": json.dumps("y" * _LONG),
    "duplicate": '{"a": 1, "a": 2}',
    "null": "null",
    "text": '"text"',
    "list": "[1, 2]",
    "empty-object": "{}",
    "many": "[" + "1," * 200_000 + "1]",
}


def _inside(text: str) -> Made:
    """The right document, an object, with a member more."""
    return _text(lambda right: right.rstrip().removesuffix("}") + f', "more": {text}}}\n')


def _first(text: str) -> Made:
    """The right document with another value of its first key; of several lines, the first has it."""

    def change(right: str) -> str:
        whole, end = json.JSONDecoder().raw_decode(right)
        key, *others = whole
        rest = "".join(f", {json.dumps(name)}: {json.dumps(whole[name])}" for name in others)
        return f"{{{json.dumps(key)}: {text}{rest}}}{right[end:]}"

    return _text(change)


JSON: dict[str, Made] = {
    **TEXT,
    **{f"all-{name}": _instead(text) for name, text in _JSON.items()},
    **{f"more-{name}": _inside(text) for name, text in _JSON.items()},
    **{f"first-{name}": _first(text) for name, text in _JSON.items()},
}

CSV: dict[str, Made] = {
    **TEXT,
    "open-quote": _with('"open,1,2\n' + "row,1,2\n" * 50_000),
    "quotes": _with('"""",""a"",\n'),
    "huge-cell": _with(f"{'y' * 500_000},1,2\n"),
    "many-cells": _with("x," * 100_000 + "\n"),
    "many-rows": _with("x,y,2026-01-01T00:00:00Z\n" * 50_000),
    "no-cells": _with(",,,,\n,\n"),
    "only-quotes": _instead('"' * 10_001),
    "heading-twice": _text(lambda right: right.split("\n", 1)[0].split(",")[0] + "," + right),
    "headings-only": _text(lambda right: right.split("\n", 1)[0] + "\n"),
    "huge-number": _text(lambda right: right.replace("2", _DIGITS).replace("1", "NaN")),
    "infinite": _text(lambda right: right.replace("2", "inf").replace("1", "-1e999")),
    "carriage-returns": _text(lambda right: right.replace("\n", "\r")),
    "superscripts": _text(lambda right: right.replace("2", "²").replace("1", "①")),
    "escapes": _with('\x1b[31m,\u202eabc,"=cmd()"\n'),
}

_LAUGHS = "a: &a [x,x,x,x,x,x,x,x,x]\n" + "".join(
    f"{chr(98 + n)}: &{chr(98 + n)} [{','.join([f'*{chr(97 + n)}'] * 9)}]\n" for n in range(12)
)
YAML: dict[str, Made] = {
    **TEXT,
    "laughs": _bytes(lambda right: _LAUGHS.encode() + right),
    "laughs-as-a-name": _bytes(lambda right: _LAUGHS.encode() + right.replace(b"Ada Lovelace", b"*m")),
    "circle": _with("x: &x [*x]\ny: &y {y: *y}\n"),
    "circle-as-a-name": _text(lambda right: "x: &x [*x]\n" + right.replace("Ada Lovelace", "*x")),
    "merge-circle": _with("x: &x\n  <<: *x\n"),
    "merges": _with("m: &m {a: 1}\n" + "n: {<<: [" + "*m," * 5_000 + "*m]}\n"),
    "deep-list": _with("x: " + "[" * _DEEP + "]" * _DEEP + "\n"),
    "deep-open": _with("x: " + "[" * 100_000),
    "deep-block": _with("x:\n" + "".join(" " * n + "-\n" for n in range(1, 1_000))),
    "huge-integer": _with(f"x: {_DIGITS}\n"),
    "huge-base-60": _with("x: " + "59:" * _DEEP + "59\n"),
    "not-finite": _with("x: [.nan, .inf, -.inf]\n"),
    "python": _with('x: !!python/object/apply:os.system ["true"]\n'),
    "binary": _with("x: !!binary ////\n"),
    "a-date": _with("x: 2026-02-30\n"),
    "duplicate": _bytes(lambda right: right + right),
    "list": _instead("- 1\n- 2\n"),
    "text": _instead("text\n"),
    "two-documents": _bytes(lambda right: right + b"---\n" + right),
    "odd-keys": _with("? [a, b]\n: 1\n1: 2\nnull: 3\n"),
    "undefined": _with("x: *nowhere\n"),
    "huge-string": _with(f"x: {'y' * _LONG}\n"),
}

PYTHON: dict[str, Made] = {
    **TEXT,
    **{
        f"cookie-{name}": _bytes(lambda right, name=name: f"# coding: {name}\n".encode() + right)
        for name in (
            "rot13", "rot_13", "hex", "hex_codec", "base64", "bz2", "zlib", "uu", "quopri", "idna",
            "punycode",
            "undefined", "unicode_escape", "raw_unicode_escape", "utf-7", "utf-16", "utf-32", "utf-8-sig",
            "latin-1", "cp037", "mbcs", "no-such-codec", "charmap", "../../etc/passwd", "x" * 5_000,
        )
    },
    "bom-and-cookie": _bytes(lambda right: b"\xef\xbb\xbf# coding: latin-1\n" + right),
    "deep-parentheses": _with("\nx = " + "(" * _DEEP + ")" * _DEEP + "\n"),
    "deep-minus": _with("\nx = " + "-" * 50_000 + "1\n"),
    "deep-attributes": _with("\nx = x" + ".y" * 20_000 + "\n"),
    "huge-integer": _with(f"\nx = {_DIGITS}\n"),
    "deep-blocks": _with("\n" + "".join(" " * n + "if 1:\n" for n in range(150))),
}  # fmt: skip


def _zip(*members: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(buffer, "w", method) as archive:
        warnings.simplefilter("ignore")  # two of one name are wanted
        for name, content in members:
            archive.writestr(zipfile.ZipInfo(name), content, method)
    return buffer.getvalue()


def _repacked(change: Callable[[str, bytes], list[tuple[str, bytes]]]) -> Made:
    """The members of the right archive, each changed."""

    def make(right: bytes) -> bytes:
        with zipfile.ZipFile(io.BytesIO(right)) as archive:
            held = [(name, archive.read(name)) for name in archive.namelist()]
        return _zip(*(member for name, content in held for member in change(name, content)))

    return _bytes(make)


def _of_json(change: Callable[[Path], None]) -> Made:
    """The right archive with its JSON changed as a document of its own."""

    def make(path: Path) -> None:
        part = path.with_name(path.name + ".json")

        def changed(name: str, content: bytes) -> list[tuple[str, bytes]]:
            if not name.endswith(".json"):
                return [(name, content)]
            part.write_bytes(content)
            change(part)
            return [(name, part.read_bytes())]

        _repacked(changed)(path)
        part.unlink(missing_ok=True)

    return make


def _patched(old: bytes, new: bytes) -> Made:
    return _bytes(lambda right: right.replace(old, new))


_BOMB = b"\0" * 100_000_000
ZIP: dict[str, Made] = {
    **{name: made for name, made in TEXT.items() if not name.startswith("utf") and name != "lone-surrogate"},
    "bomb": _repacked(lambda name, content: [(name, _BOMB)]),
    "bomb-beside": _bytes(lambda right: _zip(("doubling.py", _BOMB))),
    "bombs": _bytes(lambda right: _zip(*((f"{n}.py", b"\0" * 2_000_000) for n in range(200)))),
    "many": _bytes(lambda right: _zip(*((f"{n}.py", b"") for n in range(60_000)))),
    "deep": _bytes(lambda right: _zip(("doubling.py", b"x = 1\n"), ("a/" * 30_000 + "x.md", b""))),
    "nested": _bytes(lambda right: _zip(("a.zip", _zip(("b.zip", right))))),
    "climbing": _repacked(lambda name, content: [("../" + name, content), ("/" + name, content)]),
    "twice": _repacked(lambda name, content: [(name, content), (name, content)]),
    "encrypted": _patched(b"PK\1\2\x14\3\x14\0\0\0", b"PK\1\2\x14\3\x14\0\1\0"),
    "odd-method": _patched(b"PK\1\2\x14\3\x14\0\0\0\x08\0", b"PK\1\2\x14\3\x14\0\0\0\x63\0"),
    "comment": _with("PK\5\6" * 5_000),
    "tar": _instead(b"\x1f\x8b" + b"\0" * 500),
    **{f"json-{name}": _of_json(made) for name, made in JSON.items() if name != "larger-than-any"},
}

_VALUES = {"null": "null", "number": "-1", "text": '"x"', "list": "[1]", "object": '{"a":{}}'}
ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n)"


def sql(*statements: str) -> Made:
    def make(path: Path) -> None:
        with closing(sqlite3.connect(path)) as database:
            for name in ("event_is_never_changed", "event_is_never_removed"):
                database.execute(f"DROP TRIGGER IF EXISTS {name}")
            for statement in statements:
                database.execute(statement)
            database.commit()

    return make


def as_view(table: str, columns: str) -> Made:
    """A table that is an endless view."""
    return sql(f"DROP TABLE {table}", f"CREATE VIEW {table} AS {ENDLESS} SELECT {columns} FROM n")


def _schema(change: str) -> Made:
    return sql("PRAGMA writable_schema = ON", change)


SQLITE: dict[str, Made] = {
    **{name: made for name, made in TEXT.items() if not name.startswith("utf") and name != "lone-surrogate"},
    "head-only": _bytes(lambda right: right[:100]),
    "pages-lost": _bytes(lambda right: right[:4096]),
    "pages-swapped": _bytes(lambda right: right[:4096] + right[8192:] + right[4096:8192]),
    "noise-within": _bytes(lambda right: right[:5000] + bytes(range(256)) * 20 + right[10_120:]),
    "computing-table": _schema(
        "UPDATE sqlite_schema SET sql = replace(sql, 'NOT NULL', 'AS (zeroblob(900000000)) ')"
        " WHERE type = 'table'"
    ),
    "virtual": sql("CREATE VIRTUAL TABLE v USING fts5(x)"),
    "broken-schema": _schema("UPDATE sqlite_schema SET sql = 'CREATE nonsense'"),
    "circular-schema": _schema("UPDATE sqlite_schema SET rootpage = 1"),
}
EVENTS: dict[str, Made] = {
    **SQLITE,
    "endless-view": as_view(
        "event",
        "i AS id, '2026-01-01T00:00:00+00:00' AS at, 'check' AS kind, '' AS subject, '{}' AS data",
    ),
    "endless-trigger": sql(
        "CREATE TRIGGER t BEFORE INSERT ON event BEGIN"
        f" SELECT count(*) FROM ({ENDLESS} SELECT i FROM n); END"
    ),
    "computed-index": sql("CREATE INDEX i ON event (hex(zeroblob(1000000)))"),
    "huge-event": sql("UPDATE event SET data = hex(zeroblob(30000000))"),
    "blobs": sql("UPDATE event SET data = x'00', at = x'00', kind = x'00', subject = x'00'"),
    "numbers": sql("UPDATE event SET data = 1e999, at = 1, kind = 2, subject = 3"),
    "odd-time": sql("UPDATE event SET at = '9999-99-99T99:99'"),
    "no-zone": sql("UPDATE event SET at = '2026-01-01T00:00:00'"),
    "edge-of-time": sql("UPDATE event SET at = '0001-01-01T00:00:00+23:59'"),
    "newer": sql("PRAGMA user_version = 2147483647"),
    "negative": sql("PRAGMA user_version = -1"),
    **{
        f"data-{name}": sql("UPDATE event SET data = '" + text.replace("'", "''") + "'")
        for name, text in _JSON.items()
        if name != "many"
    },
    **{
        f"values-{name}": sql(
            f"UPDATE event SET data = (SELECT json_group_object(key, json('{text}')) FROM json_each(data))"
        )
        for name, text in _VALUES.items()
    },
    **{
        f"kind-{name}": sql(f"UPDATE event SET kind = '{name}'")
        for name in ("check", "hint", "lesson", "place", "solution", "quiz", "prediction", "cell", "bookmark",
                     "submit", "update", "reset", "start")
    },
}  # fmt: skip

SYNTAXES: dict[str, dict[str, Made]] = {
    "toml": TOML, "json": JSON, "csv": CSV, "yaml": YAML, "zip": ZIP, "python": PYTHON, "events": EVENTS,
    "sqlite": SQLITE,
}  # fmt: skip


def _instead_of_it(make: Callable[[Path], object]) -> Made:
    """Not the right document, but what is made in its place."""

    def made(path: Path) -> None:
        path.unlink(missing_ok=True)
        make(path)

    return made


#: What may stand where a file is expected.
SPECIAL: dict[str, Made] = {
    "missing": _instead_of_it(lambda _: None),
    "folder": _instead_of_it(Path.mkdir),
    "pipe": _instead_of_it(os.mkfifo),
    "endless-device": _instead_of_it(lambda path: path.symlink_to("/dev/zero")),
    "empty-device": _instead_of_it(lambda path: path.symlink_to("/dev/null")),
    "link-to-itself": _instead_of_it(lambda path: path.symlink_to(path.name)),
    "link-to-nothing": _instead_of_it(lambda path: path.symlink_to("nowhere")),
    "socket": _instead_of_it(lambda path: os.mknod(path, stat.S_IFSOCK | 0o600)),
    "unreadable": lambda path: path.chmod(0),
}
