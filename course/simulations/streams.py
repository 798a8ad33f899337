"""Recordings of a robot's sensors, as plain arrays with units: streams to keep, compare and send.

Frames and signs are those of REP 103: x forward, y left, z up, angles counter-clockwise, SI units. A stream's
time is in seconds from the start of the recording.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from course.errors import UsageError
from course.printable import counted

if TYPE_CHECKING:
    Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ImuStream:
    """A gyroscope about the vertical axis.

    Attributes:
        t: shape (N,), s.
        angular_velocity_z: turn rate, left positive, shape (N,), rad/s.
        variance: of one sample, (rad/s)²; 0 if it is not known.
        frame: where the sensor sits.
    """

    t: Array
    angular_velocity_z: Array
    variance: float = 0.0
    frame: str = "base_link"

    def __post_init__(self) -> None:
        _settle(self, ("angular_velocity_z",))


@dataclass(frozen=True, eq=False)
class ScanStream:
    """A planar laser scanner.

    Attributes:
        t: shape (N,), s: when each scan was taken.
        ranges: shape (N, B), m; ``range_max`` where nothing was hit.
        angle_min: direction of the first beam from straight ahead, rad.
        angle_increment: from each beam to the next, rad.
        range_max: reach, m.
        frame: where the scanner sits.
    """

    t: Array
    ranges: Array
    angle_min: float
    angle_increment: float
    range_max: float
    frame: str = "base_link"

    def __post_init__(self) -> None:
        _settle(self, ("ranges",), dimensions=2)


@dataclass(frozen=True, eq=False)
class OdometryStream:
    """Where the robot believes it is, by its wheels.

    Attributes:
        t: shape (N,), s.
        x, y: position in ``frame``, shape (N,), m.
        heading: from the x axis, shape (N,), rad; not wrapped (a bag keeps it only within one turn).
        speed: forward, shape (N,), m/s.
        turn_rate: shape (N,), rad/s.
        frame, child_frame: the pose is that of ``child_frame`` in ``frame`` (REP 105).
        position_variance, heading_variance: m² and rad²; 0 if they are not known.
    """

    t: Array
    x: Array
    y: Array
    heading: Array
    speed: Array
    turn_rate: Array
    frame: str = "odom"
    child_frame: str = "base_link"
    position_variance: float = 0.0
    heading_variance: float = 0.0

    def __post_init__(self) -> None:
        _settle(self, ("x", "y", "heading", "speed", "turn_rate"))


@dataclass(frozen=True, eq=False)
class TruthStream(OdometryStream):
    """Where the robot truly is, which only a simulation knows; attributes as of ``OdometryStream``.

    It has a frame of its own, because in ROS a frame has one parent and that of ``base_link`` is ``odom``.
    """

    frame: str = "map"
    child_frame: str = "base_link_true"


Stream = ImuStream | ScanStream | OdometryStream  # a TruthStream is an OdometryStream

#: The range of the seconds in a ROS stamp.
_LATEST = 2**31

#: Kind of stream, as plain data name it: its type.
KINDS: dict[str, type[Stream]] = {
    "imu": ImuStream,
    "scan": ScanStream,
    "odometry": OdometryStream,
    "truth": TruthStream,
}


def streams_from(plain: Mapping[str, Mapping[str, Any]]) -> tuple[Stream, ...]:
    """Streams from plain data: ``{"imu": {"t": ..., "angular_velocity_z": ...}, "scan": {...}, ...}``.

    The keys of each kind are the attributes of its type; those with a default may be left out.

    Raises:
        UsageError: a kind or a key does not exist, one is missing, or arrays do not fit together.
    """
    streams = []
    for kind, values in plain.items():
        if kind not in KINDS:
            raise UsageError(
                f"There is no stream of kind {kind!r}.",
                help=f"There are {', '.join(KINDS)}.",
                code="stream_kind",
            )
        names = [field.name for field in fields(KINDS[kind])]
        unknown = sorted(set(values) - set(names))
        if unknown:
            raise UsageError(
                f"A stream of kind {kind!r} has no {', '.join(unknown)}.",
                help=f"It has {', '.join(names)}.",
                code="stream_key",
            )
        try:
            streams.append(KINDS[kind](**values))
        except TypeError as error:
            raise UsageError(
                f"A stream of kind {kind!r} is incomplete: {error}.",
                help=f"It has {', '.join(names)}.",
                code="stream_key",
            ) from None
    return tuple(streams)


def _settle(stream: Stream, names: tuple[str, ...], dimensions: int = 1) -> None:
    """Make the arrays of a stream float arrays that fit together, and its numbers floats.

    Raises:
        UsageError: they do not fit, or times are not finite, not ordered or before the start.
    """
    kind = next(name for name, made in KINDS.items() if made is type(stream))
    t = _array(stream.t, kind, "t", 1)
    if not (np.all(np.isfinite(t)) and np.all(np.diff(t) >= 0) and np.all((t >= 0) & (t < _LATEST))):
        raise UsageError(
            f"The times of the stream {kind!r} are not finite, ordered and from 0 on.",
            help="Give seconds from the start of the recording, in order; a stamp has 31 bits for them.",
            code="stream_times",
        )
    object.__setattr__(stream, "t", t)
    for name in names:
        array = _array(getattr(stream, name), kind, name, dimensions)
        if len(array) != len(t):
            raise UsageError(
                f"The stream {kind!r} has {len(t)} times and {len(array)} of {name}.",
                help="Give one row for each time.",
                code="stream_shape",
            )
        object.__setattr__(stream, name, array)
    for field in fields(stream):
        if field.type == "float":
            object.__setattr__(stream, field.name, float(getattr(stream, field.name)))


def _array(value: Any, kind: str, name: str, dimensions: int) -> Array:
    array = np.array(value, dtype=float)
    if array.ndim != dimensions:
        raise UsageError(
            f"{name} of the stream {kind!r} has {counted(array.ndim, 'dimension')}, not {dimensions}.",
            help="Give one row for each time.",
            code="stream_shape",
        )
    return array
