"""Files that a stranger may have made end in the errors that readers know, soon and in little memory."""

import os
import sqlite3
import time
import tomllib
from contextlib import closing
from pathlib import Path

import pytest

from course.strangers import in_utf8, no_programs, read_bytes, toml


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("x = " + "[" * 5_000 + "]" * 5_000, "Nested too deeply"),
        ("x = " + "{a = " * 5_000 + "1" + "}" * 5_000, "Nested too deeply"),
        ("x = " + "[" * 60 + "]" * 60, "Nested too deeply"),
        ("y = 1\n" + "a." * 20_000 + "a = 1", "Nested too deeply (at line 2, column 1)"),
        ("[" + "a." * 20_000 + "a]", "Nested too deeply (at line 1, column 1)"),
        ("x = {" + "'a' . " * 20_000 + "a = 1}", "Nested too deeply (at line 1, column 1)"),
        ("x = " + "9" * 5_000, "A whole number has more than 64 bits"),
        ("x = [{y = 0x" + "f" * 5_000 + "}]", "A whole number has more than 64 bits"),
        ("x = 9223372036854775808", "A whole number has more than 64 bits"),
        ("#" * 1_100_000, "It is larger than 1 MB"),
        ("x = ", "Invalid value"),
    ],
)
def test_toml_that_no_person_writes_is_no_toml(text, why):
    begun = time.process_time()
    with pytest.raises(tomllib.TOMLDecodeError) as caught:
        toml(text)
    assert str(caught.value).startswith(why)
    assert time.process_time() - begun < 1.0


def test_toml_that_a_person_writes_is_read_as_python_reads_it():
    text = (
        'a.b.c = 1\n[t."x.y"]\nz = [[1, -9223372036854775808], {u = nan}]\nw = """\n' + "a.b." * 5 + '"""\n'
    )
    assert str(toml(text)) == str(tomllib.loads(text))


def test_only_an_ordinary_file_is_read_and_no_more_of_it_than_was_meant(tmp_path):
    (tmp_path / "file").write_bytes(b"x" * 100)
    (tmp_path / "link").symlink_to("file")
    assert read_bytes(tmp_path / "link", 100) == b"x" * 100
    os.mkfifo(tmp_path / "pipe")
    for path, why in (
        (tmp_path / "file", "larger"),
        (tmp_path / "pipe", "no file"),
        (tmp_path, "directory"),
        (tmp_path / "none", "No such"),
        (Path("/dev/zero"), "no file"),
    ):
        with pytest.raises(OSError, match=why) as caught:
            read_bytes(path, 99)
        assert caught.value.strerror


def test_what_a_shell_hands_over_is_read():
    reading, writing = os.pipe()
    os.write(writing, b"handed over")
    os.close(writing)
    try:
        assert read_bytes(Path(f"/dev/fd/{reading}")) == b"handed over"
    finally:
        os.close(reading)


_ENDLESS = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i FROM n"
_PLAIN = "CREATE TABLE t (x TEXT NOT NULL, y REAL, PRIMARY KEY (x)) WITHOUT ROWID"


@pytest.mark.parametrize(
    "statement",
    [
        f"CREATE VIEW v AS {_ENDLESS}",
        "CREATE VIEW v AS SELECT 1",
        f"CREATE TRIGGER g BEFORE INSERT ON t BEGIN SELECT count(*) FROM ({_ENDLESS}); END",
        "CREATE TABLE u (x, y AS (zeroblob(x)))",
        "CREATE TABLE u (x DEFAULT (zeroblob(900000000)))",
        "CREATE TABLE u (x CHECK (x > 0))",
        "CREATE INDEX i ON t (hex(x))",
        "CREATE INDEX i ON t (x) WHERE x > 0",
        "CREATE VIRTUAL TABLE f USING fts5(x)",
    ],
)
def test_a_database_that_computes_is_refused_and_the_same_without_that_is_read(statement):
    with closing(sqlite3.connect(":memory:")) as database:
        database.execute(_PLAIN)
        database.execute("CREATE INDEX plain ON t (y, x)")
        no_programs(database, millions=1)
        database.execute(statement)
        with pytest.raises(sqlite3.DatabaseError, match="the course does not make"):
            no_programs(database, millions=1)


def test_what_has_no_end_is_stopped():
    with closing(sqlite3.connect(":memory:")) as database:
        no_programs(database, millions=2)
        with pytest.raises(sqlite3.OperationalError, match="interrupted"):
            database.execute(f"SELECT count(*) FROM ({_ENDLESS})")


@pytest.mark.parametrize("claimed", ["punycode", "idna", "base64", "no_such", "utf-16"])
def test_an_encoding_that_a_module_only_claims_leaves_its_bytes_readable(claimed):
    """Some codecs raise other errors than those of a byte that cannot be decoded."""
    source = f"# coding: {claimed}\nx = 1  # ##\n".encode()
    assert b"x = 1" in in_utf8(source)
