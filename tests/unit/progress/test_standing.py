"""The record is read once a command, however many questions it answers."""

from __future__ import annotations

import pytest

from course.catalog.load import Catalog
from course.cli.frame import app
from course.errors import IntegrityError
from course.progress.history import Standing
from course.progress.store import Store
from course.progress.workspace import Workspace


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    """A workspace of the course itself with a lesson read and an exercise begun; the current folder."""
    catalog = Catalog()
    made = Workspace.create(tmp_path / "w", catalog.course_id, catalog.version)
    monkeypatch.chdir(made.root)
    first, *_ = catalog.exercises()
    made.store.append("lesson", first.lesson)
    made.store.append("start", first.id)
    made.give(first.place, first.module, first.stub_path.read_bytes())
    return made


def test_the_record_is_read_once(workspace, monkeypatch):
    reads, connection = [], Store._connection
    monkeypatch.setattr(
        Store, "_connection", lambda self, *, create: reads.append(create) or connection(self, create=create)
    )
    for command in ((), ("progress",), ("exercises",), ("lessons",), ("next",), ("go", "--json")):
        reads.clear()
        assert (app.run(command), reads) == (0, [False]), command


def test_an_event_that_somebody_spoilt_costs_those_alone_who_need_it(workspace, monkeypatch):
    monkeypatch.setattr("course.progress.store._now", lambda: "some time")
    workspace.store.append("check", "elsewhere")
    standing = Standing(workspace)
    (name,) = standing.started
    assert standing.is_begun(name)
    assert len(standing.read) == 1
    with pytest.raises(IntegrityError, match="event 3 cannot be read"):
        standing.history("elsewhere")
    with pytest.raises(IntegrityError, match="event 3 cannot be read"):
        assert standing.quiz.best is None


@pytest.mark.parametrize(("data", "read"), [({"version": "1.2.0"}, {"a", "b"}), ({"blocks": 40}, {"a"})])
def test_who_read_a_lesson_before_it_was_parted_has_read_both(workspace, data, read):
    workspace.store.append("lesson", "a", data)
    standing = Standing(workspace, {"b": "a"})
    assert standing.read.keys() & {"a", "b"} == read
    assert {standing.read[name] for name in read} == {standing.read["a"]}
