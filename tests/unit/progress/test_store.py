"""The record of progress: only added to, safe with several writers, and honest about damage."""

import contextlib
import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from course.errors import IntegrityError, MissingCapabilityError
from course.progress.store import SCHEMA_VERSION, Store

ROOT = Path(__file__).resolve().parents[3]

WRITER = """
import sys
from pathlib import Path
from course.progress.store import Store
store = Store(Path(sys.argv[1]))
for number in range(int(sys.argv[2])):
    store.append("check", sys.argv[3], {"number": number, "padding": "x" * 2000})
    print(number, flush=True)
"""


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path / "state" / "progress.sqlite")


def _writer(store, count, subject):
    return subprocess.Popen(
        [sys.executable, "-c", WRITER, str(store.path), str(count), subject],
        stdout=subprocess.PIPE,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )


def _sql(store, statement):
    """Change a record behind its back."""
    with contextlib.closing(sqlite3.connect(store.path)) as database, database:
        database.execute(statement)


def test_events_come_back_by_kind_and_subject_in_the_order_they_were_added(store):
    for event in (("start", "doubling"), ("check", "doubling"), ("check", "halving")):
        store.append(*event)
    assert [event.subject for event in store.events("check")] == ["doubling", "halving"]
    assert [event.kind for event in store.events(subject="doubling")] == ["start", "check"]


def test_asking_an_absent_record_makes_no_file(store):
    assert store.events() == ()
    assert not store.path.exists()


def test_events_cannot_be_changed_or_removed_and_the_journal_works_on_a_network_file_system(store):
    store.append("start", "doubling")
    with contextlib.closing(sqlite3.connect(store.path)) as database:
        for statement in ("DELETE FROM event", "UPDATE event SET kind = 'other'"):
            with pytest.raises(sqlite3.IntegrityError, match="only ever added"):
                database.execute(statement)
        assert database.execute("PRAGMA journal_mode").fetchone() == ("delete",)


def test_a_record_from_a_newer_course_is_refused_and_left_alone(store):
    store.append("start", "doubling")
    _sql(store, f"PRAGMA user_version = {SCHEMA_VERSION + 1}")
    before = store.path.read_bytes()
    for action in (store.events, lambda: store.append("start", "halving"), store.repair):
        with pytest.raises(MissingCapabilityError, match="newer version"):
            action()
    assert store.path.read_bytes() == before


def test_a_damaged_record_is_named_and_not_touched(store):
    store.path.parent.mkdir()
    store.path.write_bytes(b"this is no database, and long enough to be looked at" * 10)
    before = store.path.read_bytes()
    with pytest.raises(IntegrityError, match=r"progress\.sqlite") as caught:
        store.append("start", "doubling")
    assert "doctor --repair" in caught.value.help
    assert store.path.read_bytes() == before


def test_repair_keeps_the_damaged_file_and_carries_over_what_can_still_be_read(store):
    data = [json.dumps({"number": number, "padding": "x" * 500}) for number in range(400)]
    store._add([("2026-11-22T10:00:00+00:00", "check", "doubling", text) for text in data])
    data = bytearray(store.path.read_bytes())
    middle = len(data) // 2
    data[middle : middle + 20000] = b"\xff" * 20000
    store.path.write_bytes(bytes(data))
    with pytest.raises(IntegrityError):
        store.events()
    repair = store.repair()
    numbers = [event.data["number"] for event in store.events()]
    assert repair.carried == len(numbers) > 50
    assert numbers == sorted(numbers)
    assert repair.kept.read_bytes() == data
    assert store.repair() is None, "all is well"


def test_an_event_that_is_not_json_is_damage(store):
    store.append("start", "doubling")
    _sql(store, "INSERT INTO event (at, kind, subject, data) VALUES ('soon', 'check', 'x', '{')")
    with pytest.raises(IntegrityError, match="event 2"):
        store.events()
    assert store.repair().carried == 1


def test_a_writer_waits_for_another_one(store):
    store.append("start", "doubling")
    other = sqlite3.connect(store.path, isolation_level=None, check_same_thread=False)
    other.execute("BEGIN EXCLUSIVE")
    release = threading.Timer(0.3, lambda: other.execute("COMMIT"))
    release.start()
    begin = time.monotonic()
    store.append("check", "doubling")
    assert time.monotonic() - begin > 0.2
    release.join()
    other.close()
    assert len(store.events()) == 2


def test_two_programs_writing_at_once_lose_nothing(store):
    writers = [_writer(store, 15, name) for name in ("watch", "check")]
    for writer in writers:
        writer.communicate(timeout=60)
        assert writer.returncode == 0
    for name in ("watch", "check"):
        assert [event.data["number"] for event in store.events(subject=name)] == list(range(15))


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="there is no kill -9 here")
def test_what_was_written_survives_kill_9_at_any_moment(store):
    seed = random.randrange(1 << 30)
    moments = random.Random(seed)
    promised = 0
    for round_number in range(4):  # at other moments in every run
        writer = _writer(store, 100000, f"round-{round_number}")
        first = writer.stdout.readline()
        time.sleep(moments.uniform(0.0, 0.05))
        writer.kill()
        promised += len(([first] if first else []) + writer.stdout.read().splitlines())
        writer.stdout.close()
        writer.wait()
        store.append("start", "after")
    events = store.events("check")
    assert len(events) >= promised > 0, f"seed {seed}"
    with contextlib.closing(sqlite3.connect(store.path)) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_half_a_surrogate_is_kept_as_a_question_mark(store):
    """A page can send one in a prediction, and a terminal in a cell; it ended what wanted to note it."""
    store.append("prediction", "lesson", {"text": "\ud83d and \U0001f600", "\udce9": 1})
    assert store.events("prediction")[-1].data == {"text": "? and \U0001f600", "?": 1}


def test_a_workspace_that_was_moved_meanwhile_gets_no_second_record_in_its_old_place(tmp_path):
    root = tmp_path / "mine"
    with pytest.raises(MissingCapabilityError, match=r"mine is no longer there: it was moved") as raised:
        Store(root / ".course" / "progress.sqlite").append("start", "doubling")
    assert raised.value.code == "workspace_gone"
    assert not root.exists()


def test_on_a_full_disk_the_advice_is_to_free_some_space(store, monkeypatch):
    store.append("start", "doubling")
    prepare = Store._prepare

    def full(self, database, *, create):
        prepare(self, database, create=create)
        database.execute("PRAGMA max_page_count = 1")

    monkeypatch.setattr(Store, "_prepare", full)
    with pytest.raises(MissingCapabilityError) as raised:
        store.append("check", "doubling", {"padding": "x" * 100_000})
    assert raised.value.help.startswith("Free some space")
