"""Sandboxes that one session takes over from another: those of its kind, that still keep a canary in."""

from unittest.mock import Mock, call

import pytest

from course.isolation import probe
from course.isolation.levels import Level
from course.isolation.probe import kept_sandboxes, open_sandbox


def sandbox_for(*arguments, **limits):
    return open_sandbox(*arguments, **limits)[0]


@pytest.fixture
def opened(monkeypatch):
    made = []

    def new(*_, **__):
        made.append(Mock(level=Level.L2, proves=True))
        return made[-1]

    monkeypatch.setattr(probe, "open_spawner", new)
    monkeypatch.setattr(probe, "proves_itself", lambda one: one.proves)
    yield made
    assert {one.close.call_count for one in made} == {1}


def test_one_session_takes_over_from_another_of_its_kind(opened):
    with kept_sandboxes():
        for _ in range(3):
            sandbox = sandbox_for(("numpy",))
            sandbox.spawn()
            sandbox.close()
            sandbox.close()
        assert [one.method_calls for one in opened] == [[call.spawn()] * 3]
        sandbox_for(("numpy", "scipy")).close()
        sandbox_for(("numpy",), at_most=Level.L1).close()
        assert len(opened) == 3
    for _ in range(2):
        sandbox_for(("numpy",)).close()
    assert len(opened) == 5, "none is kept unless that was asked for"


def test_a_session_goes_to_the_processor_on_which_the_sandbox_was_opened(opened):
    with kept_sandboxes():
        first, there = open_sandbox(("numpy",), processor=1)
        first.close()
        second, same = open_sandbox(("numpy",), processor=0)
        assert (there, same, len(opened)) == (1, 1, 1)
        third, other = open_sandbox(("numpy",), processor=0)
        assert (other, len(opened)) == (0, 2)
        second.close()
        third.close()


def test_what_no_longer_proves_itself_is_closed_and_replaced(opened):
    with kept_sandboxes():
        sandbox_for(("numpy",)).close()
        opened[0].proves = False
        sandbox_for(("numpy",)).close()
        assert [one.method_calls for one in opened] == [[call.close()], []]


def test_what_is_still_in_use_at_the_end_is_closed_by_its_session(opened):
    with kept_sandboxes(), kept_sandboxes():
        sandbox = sandbox_for(("numpy",))
    assert opened[0].method_calls == []
    sandbox.close()


def test_one_whose_zygote_was_killed_serves_the_next_all_the_same():
    with kept_sandboxes():
        first = sandbox_for(("numpy",))
        if first.level is Level.L1:
            pytest.skip("at L1 there is no zygote")
        real = first._real
        real._process.kill()
        real._process.wait()
        first.close()
        second = sandbox_for(("numpy",))
        second.spawn().finish()
        second.close()
