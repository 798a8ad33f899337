"""The wire carries plain values unchanged, and takes nothing else from a stranger."""

import contextlib
import math
import struct
import tracemalloc
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from course.isolation.inside import wire
from course.isolation.inside.wire import Codec, Kind, Reference, Rhs, Seed, UnsupportedValueError, WireError

_DTYPES = st.sampled_from([np.dtype(name) for name in ("<f8", "<i8", "?", "<c16")])
_SHAPES = hnp.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=4)
_SCALARS = (
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=True)
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=20)
)
_ARRAYS = hnp.arrays(_DTYPES, _SHAPES)
_VALUES = st.recursive(
    _SCALARS | _ARRAYS,
    lambda inner: (
        st.lists(inner, max_size=6)
        | st.dictionaries(st.text("abcé", max_size=3), inner, max_size=4)
        | st.lists(st.floats(), min_size=1, max_size=4)
        | st.lists(st.fixed_dictionaries({"a": inner, "é": st.floats()}), min_size=2, max_size=4)
    ),
    max_leaves=25,
)


class Names:
    """Stands for both sides: callables by number, anything else as it is."""

    def __init__(self):
        self.held = []

    def lower(self, value):
        if isinstance(value, Rhs | Seed):
            return value
        if callable(value):
            self.held.append(value)
            return Reference(len(self.held) - 1, mine=True)
        return None

    def raise_(self, value):
        return self.held[value.number] if isinstance(value, Reference) else value


def _body(value, names=None):
    return Codec(names).encode(Kind.RESULT, value)[5:]


def _same(a, b):
    if isinstance(a, np.ndarray):
        return (
            isinstance(b, np.ndarray)
            and a.dtype == b.dtype
            and a.shape == b.shape
            and a.tobytes() == b.tobytes()
        )
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(_same(a[key], b[key]) for key in a)
    if isinstance(a, list):
        return isinstance(b, list) and len(a) == len(b) and all(map(_same, a, b))
    if isinstance(a, float):
        return isinstance(b, float) and struct.pack("<d", a) == struct.pack("<d", b)
    return type(a) is type(b) and bool(a == b)


@given(_VALUES)
def test_every_plain_value_comes_back_as_it_was(value):
    body = _body(value)
    assert _same(value, Codec().decode(bytes(body)))
    assert _same(value, Codec().decode(memoryview(body)))


@given(
    st.lists(
        st.recursive(
            st.none()
            | st.booleans()
            | st.floats()
            | st.integers(-9, 9)
            | st.text(max_size=5)
            | hnp.arrays(
                st.sampled_from([np.float64, np.int64, np.bool_]),
                hnp.array_shapes(min_dims=0, min_side=0, max_side=2),
            ),
            lambda items: st.lists(items, max_size=5),
            max_leaves=9,
        ),
        max_size=70,
    )
)
def test_the_quick_way_and_the_long_way_agree(value):
    body = _body(value)
    assert _same(value, Codec().decode(body))
    assert _same(value, wire.Reader(body, None, False).take(wire.MAX_DEPTH))


def test_arrays_that_arrive_can_be_written_to_and_are_aligned():
    for value in (np.ones(3), [np.ones(3)], np.ones((2, 2)), np.array([True]), np.ones(1 << 18)):
        found = Codec().decode(_body(value))
        array = found[0] if isinstance(found, list) else found
        array[...] = 0
        assert array.flags.aligned


@pytest.mark.parametrize(
    ("sent", "arrives"),
    [
        ((1, 2.0), [1, 2.0]),
        (np.float32(0.5), 0.5),
        (np.int16(-3), -3),
        (np.bool_(True), True),
        (np.array([1, 2], dtype=np.uint8), np.array([1, 2])),
        (np.array([0.5], dtype=np.float16), np.array([0.5])),
        (np.asfortranarray(np.arange(6.0).reshape(2, 3)), np.arange(6.0).reshape(2, 3)),
        (np.arange(10.0)[::-2], np.arange(10.0)[::-2].copy()),
        (np.array([1.0], dtype=">f8"), np.array([1.0])),
        (1j, np.array(1j)),
        (np.complex64(2), np.array(2 + 0j)),
    ],
)
def test_relatives_of_plain_values_arrive_as_the_plain_value(sent, arrives):
    assert _same(arrives, Codec().decode(_body(sent)))


def test_subclasses_arrive_as_the_value_they_extend():
    class Number(float):
        __eq__ = __ne__ = lambda self, other: True
        __hash__ = None

    class Table(np.ndarray):
        def __array_ufunc__(self, *args, **kwargs):
            return True

    assert type(Codec().decode(_body(Number(2.5)))) is float
    assert type(Codec().decode(_body(np.ones((2, 2)).view(Table)))) is np.ndarray


@pytest.mark.parametrize(
    "value",
    [
        object(),
        {1, 2},
        2**63,
        {1: 2},
        b"bytes in a callback"[:0].decode,
        np.array([None]),
        np.array(["text"]),
        np.zeros(1, dtype="datetime64[s]"),
        np.datetime64(0, "s"),
        np.zeros((1,) * 9),
        "x" * (wire.MAX_VALUE_BYTES + 1),
        [0.0] * 140_000,
        np.broadcast_to(0.0, wire.MAX_ARRAY_BYTES // 8 + 1),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_cannot_cross_is_refused_by_the_sender(value: Any) -> None:
    with pytest.raises(UnsupportedValueError):
        Codec().encode(Kind.RESULT, value)


def test_a_value_that_contains_itself_is_refused_by_the_sender():
    value = []
    value.append(value)
    with pytest.raises(UnsupportedValueError, match="deep"):
        Codec().encode(Kind.RESULT, value)


@pytest.mark.parametrize("names", [None, Names()], ids=["no names", "names"])
@given(body=st.binary(max_size=200))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_arbitrary_bytes_give_a_value_or_a_wire_error(names, body):
    _decode_or_refuse(body, names)


@given(_VALUES, st.data())
def test_a_damaged_frame_gives_a_value_or_a_wire_error(value, data):
    _decode_or_refuse(_damaged(_body(value), data), Names())


@pytest.mark.soak
@settings(max_examples=20_000)
@given(
    st.binary(max_size=2000)
    | st.lists(
        st.sampled_from([b"l\1\0\0\0", b"p", b"s", b"v", b"a\0\1", b"d\1\0\0\0", b"t\1\0\0\0", b"r", b"N"]),
        max_size=300,
    ).map(b"".join),
    _VALUES,
    st.data(),
)
def test_long_run_of_hostile_frames(body, value, data):
    _decode_or_refuse(body, Names())
    _decode_or_refuse(_damaged(_body(value), data), Names())


def _damaged(body, data):
    damaged = bytearray(body)
    for _ in range(data.draw(st.integers(1, 4))):
        if damaged:
            damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(damaged)))
    return bytes(damaged[:cut] if data.draw(st.booleans()) else damaged)


def _decode_or_refuse(body, names):
    try:
        value = Codec(names).decode(body)
    except WireError:
        return
    _expect_plain(value)


def _expect_plain(value):
    assert value is None or type(value) in (bool, int, float, str, list, dict, np.ndarray, Rhs, Seed)
    if isinstance(value, list | dict):
        for item in value.values() if isinstance(value, dict) else value:
            _expect_plain(item)
    if isinstance(value, np.ndarray):
        assert value.dtype in (np.float64, np.int64, np.bool_, np.complex128)
        if value.dtype == np.bool_:
            assert set(value.view(np.uint8).ravel().tolist()) <= {0, 1}


def _u32(number):
    return struct.pack("<I", number)


def _key(text):
    return _u32(len(text)) + text.encode("ascii")


_ONE_NONE, _EMPTY = b"l" + _u32(1) + b"N", b"l" + _u32(0)

_HOSTILE = {
    "nothing": b"",
    "unknown tag": b"?",
    "deep list": (b"l" + _u32(1)) * (wire.MAX_DEPTH + 1) + b"N",
    "deep dict": (b"d" + _u32(1) + _u32(0)) * (wire.MAX_DEPTH + 1) + b"N",
    "systems in systems": b"p" * 5000 + b"N",
    "systems in their parameters": b"p" * 1 + (b"s" + _u32(0) + b"d" + _u32(1) + _u32(0) + b"p") * 3000,
    "more values than bytes": b"l" + _u32(0xFFFFFFFF),
    "too many values": b"l" + _u32(300_000) + b"N" * 300_000,
    "text past the end": b"s" + _u32(10) + b"abc",
    "text that is no UTF-8": b"s" + _u32(2) + b"\xed\xa0",
    "a key twice": b"d" + _u32(2) + (_u32(1) + b"kT") * 2,
    "floats past the end": b"r" + _u32(3) + b"\0" * 16,
    "more floats than bytes": b"l" + _u32(1) + b"r" + _u32(0xFFFFFFFF),
    "too many floats": b"l" + _u32(2) + (b"r" + _u32(110_000) + b"\0" * 880_000) * 2,
    "records without keys": b"t" + _u32(0),
    "records of different lengths": b"t" + _u32(2) + _key("a") + _ONE_NONE + _key("b") + _EMPTY,
    "records with a key twice": b"t" + _u32(2) + (_key("a") + _ONE_NONE) * 2,
    "records from something else than lists": b"t" + _u32(1) + _key("a") + b"d" + _u32(0),
    "records that end early": b"t" + _u32(1) + _key("a"),
    "deep records": (b"t" + _u32(1) + _key("a")) * (wire.MAX_DEPTH + 1) + _EMPTY,
    "array past the end": b"v" + _u32(3) + b"\0" * 16,
    "array of unknown dtype": b"a\x04\x01" + _u32(0),
    "array of nine dimensions": b"a\x00\x09" + _u32(0) * 9,
    "empty array of many rows": b"a\x02\x02" + _u32(1 << 26) + _u32(0),
    "empty arrays of many rows": b"l" + _u32(3) + (b"a\x02\x02" + _u32(100_000) + _u32(0)) * 3,
    "empty array of overflowing shape": b"a\x00\x08" + _u32(0) + _u32(0xFFFFFFFF) * 7,
    "array of 65 MB": b"v" + _u32((65 << 20) // 8),
    "bytes from the worker": b"y" + _u32(1) + b"x",
    "left over": b"NN",
    "a reference that was never given": b"c" + _u32(7),
    "plain values of more than 1 MB": b"l" + _u32(3) + (b"s" + _u32(400_000) + b"a" * 400_000) * 3,
}


@pytest.mark.parametrize("body", _HOSTILE.values(), ids=_HOSTILE.keys())
def test_a_hostile_body_is_a_wire_error(body):
    for same in (body, memoryview(body)):
        with pytest.raises(WireError):
            Codec(Names()).decode(same)


_WIDE = "\U0001f600".encode()
#: Made when they are tried: together they are 430 MB.
_HEAVY = {
    "one array": lambda: b"v" + _u32(1 << 20) + b"\0" * (8 << 20),
    "truth values": lambda: b"a\x02\x01" + _u32(8 << 20) + b"\2" * (8 << 20),
    "text": lambda: b"s" + _u32(64 << 20) + b"a" * (64 << 20),
    "wide text": lambda: b"s" + _u32((60 << 20) + 4) + _WIDE + b"a" * (60 << 20),
    "wide key": lambda: b"d" + _u32(1) + _u32((60 << 20) + 4) + _WIDE + b"a" * (60 << 20) + b"N",
    "many texts": lambda: b"l" + _u32(60) + (b"s" + _u32(1 << 20) + b"a" * (1 << 20)) * 60,
}
#: A tenth of the most that a frame may hold: they take memory in proportion, and tracing is slow.
_TENTHS = {
    "records": lambda: b"t" + _u32(1) + _key("a") + b"l" + _u32(9_900) + b"N" * 9_900,
    "rows": lambda: b"l" + _u32(6_600) + (b"r" + _u32(1) + b"\0" * 8) * 6_600,
    "empty arrays": lambda: b"l" + _u32(19_900) + (b"v" + _u32(0)) * 19_900,
}


@pytest.mark.parametrize("heavy", [*_HEAVY, *_TENTHS])
def test_decoding_never_takes_more_than_70_mb(heavy):
    body, share = (_TENTHS[heavy](), 10) if heavy in _TENTHS else (_HEAVY[heavy](), 1)
    tracemalloc.start()
    try:
        with contextlib.suppress(WireError):
            Codec(Names()).decode(body)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak * share < 70e6


def test_truth_values_are_normalised():
    found = Codec().decode(b"a\x02\x01" + _u32(3) + b"\x00\x02\xff")
    assert found.tolist() == [False, True, True]
    assert found.view(np.uint8).tolist() == [0, 1, 1]


def test_references_systems_and_seeds_pass_through_names():
    names = Names()
    body = _body([math.sin, Rhs("Oscillator", {"omega": 2.0}), Seed(7)], names)
    assert Codec(names).decode(body) == [math.sin, Rhs("Oscillator", {"omega": 2.0}), Seed(7)]
    with pytest.raises(WireError):
        Codec().decode(body)


def test_a_system_at_the_greatest_depth_is_refused_by_both_sides_alike():
    value = Rhs("Oscillator", {"omega": 2.0})
    for depth in range(wire.MAX_DEPTH + 1):
        names = Names()
        try:
            body = _body(value, names)
        except UnsupportedValueError:
            assert depth >= wire.MAX_DEPTH
            break
        Codec(names).decode(body)
        value = [value]


def test_files_cross_as_bytes_to_the_worker_only():
    body = _body([{"a.py": b"\xff\x00"}, "a.py"])
    assert Codec(accept_bytes=True).decode(body) == [{"a.py": b"\xff\x00"}, "a.py"]
    with pytest.raises(WireError):
        Codec().decode(body)
