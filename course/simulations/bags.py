"""A robot's sensor streams as plain arrays with units, and as ROS 2 bags, written without ROS.

Frames and signs are those of REP 103: x forward, y left, z up, angles counter-clockwise, SI units. A stream's
time is in seconds from the start of the recording.

A bag is a folder. One topic a stream, with the names that are usual for them:

    ImuStream       /imu/data_raw   sensor_msgs/msg/Imu         (REP 145: no orientation)
    ScanStream      /scan           sensor_msgs/msg/LaserScan
    OdometryStream  /odom           nav_msgs/msg/Odometry
    TruthStream     /ground_truth   nav_msgs/msg/Odometry

and what a viewer needs to put them in their places: ``/tf`` with the poses of both odometries, ``/tf_static``
with what does not move (``odom`` lies on ``map``), and ``/clock`` at every time at which something happens. A
configuration of RViz that shows them lies in the folder, too.

The messages hold more than the streams:

- Stamps are the stream's times plus ``START_S``, to the nanosecond; a message is logged when it is stamped.
- A range of ``range_max`` means that nothing came back and is written as +inf (REP 117); ranges and angles
  of a LaserScan are 32-bit.
- What is not measured says so: the first element of the covariance of orientation and of acceleration is -1;
  turn rates about x and y have the variance ``UNMEASURED``.
- The robot moves in a plane: z, roll and pitch of an Odometry are 0 with the variance ``PLANAR``. All other
  off-diagonal covariances are 0, and a variance of 0 means that it is not known.

Which ROS reads them: the metadata have version 8, which keeps the quality of service as text. Humble fails on
version 9 ("bad conversion", github.com/ros2/rosbag2/issues/2013), and later releases read what earlier ones
wrote (github.com/ros2/rosbag2/issues/1895). Storage is SQLite, since Humble needs one more package to read
MCAP. ``/tf_static`` is offered as "transient local", without which RViz refuses it
(github.com/ros2/rviz/issues/916).

Writing the same streams to the same name gives the same bytes. This needs the extra ``ros``.
"""

from __future__ import annotations

import math
import shutil
import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from course import extras
from course.errors import UsageError
from course.printable import counted

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Timed:
    """Of every stream: its arrays are float arrays that fit together, its numbers floats."""

    t: Array

    def __post_init__(self) -> None:
        kind = next(name for name, made in KINDS.items() if made is type(self))
        t = _array(self.t, kind, "t")
        if not (np.all(np.isfinite(t)) and np.all(np.diff(t) >= 0) and np.all((t >= 0) & (t < _LATEST))):
            raise UsageError(
                f"The times of the stream {kind!r} are not finite, ordered and from 0 on.",
                help="Give seconds from the start of the recording, in order; a stamp has 31 bits for them.",
                code="stream_times",
            )
        for field in fields(self):
            value = getattr(self, field.name)
            if field.type == "Array":
                value = _array(value, kind, field.name)
                if len(value) != len(t):
                    raise UsageError(
                        f"The stream {kind!r} has {len(t)} times and {len(value)} of {field.name}.",
                        help="Give one row for each time.",
                        code="stream_shape",
                    )
            object.__setattr__(self, field.name, float(value) if field.type == "float" else value)


@dataclass(frozen=True, eq=False)
class ImuStream(_Timed):
    """A gyroscope about the vertical axis.

    Attributes:
        t: shape (N,), s.
        angular_velocity_z: turn rate, left positive, shape (N,), rad/s.
        variance: of one sample, (rad/s)²; 0 if it is not known.
        frame: where the sensor sits.
    """

    angular_velocity_z: Array
    variance: float = 0.0
    frame: str = "base_link"


@dataclass(frozen=True, eq=False)
class ScanStream(_Timed):
    """A planar laser scanner.

    Attributes:
        t: shape (N,), s: when each scan was taken.
        ranges: shape (N, B), m; ``range_max`` where nothing was hit.
        angle_min: direction of the first beam from straight ahead, rad.
        angle_increment: from each beam to the next, rad.
        range_max: reach, m.
        frame: where the scanner sits.
    """

    ranges: Array
    angle_min: float
    angle_increment: float
    range_max: float
    frame: str = "base_link"


@dataclass(frozen=True, eq=False)
class OdometryStream(_Timed):
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

    x: Array
    y: Array
    heading: Array
    speed: Array
    turn_rate: Array
    frame: str = "odom"
    child_frame: str = "base_link"
    position_variance: float = 0.0
    heading_variance: float = 0.0


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
                help=f"Known: {', '.join(KINDS)}.",
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


def _array(value: Any, kind: str, name: str) -> Array:
    array, dimensions = np.array(value, dtype=float), 2 if name == "ranges" else 1
    if array.ndim != dimensions:
        raise UsageError(
            f"{name} of the stream {kind!r} has {counted(array.ndim, 'dimension')}, not {dimensions}.",
            help="Give one row for each time.",
            code="stream_shape",
        )
    return array


# ---
# A configuration of RViz for the bags of this course: the displays, a view from above, the frame.
#
# It names only what differs from RViz's own defaults.


_HEAD = """\
Panels:
  - Class: rviz_common/Displays
    Name: Displays
  - Class: rviz_common/Time
    Name: Time
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/Grid
      Name: Grid
      Enabled: true
      Reference Frame: <Fixed Frame>
    - Class: rviz_default_plugins/TF
      Name: frames
      Enabled: true
      Show Names: true
"""
_SCAN = """\
    - Class: rviz_default_plugins/LaserScan
      Name: laser scanner
      Enabled: true
      Style: Points
      Size (Pixels): 5
      Decay Time: 30
      Color Transformer: FlatColor
      Color: 0; 114; 178
      Topic:
        Value: /scan
        Reliability Policy: Reliable
        Durability Policy: Volatile
"""
_ODOMETRY = """\
    - Class: rviz_default_plugins/Odometry
      Name: {name}
      Enabled: true
      Keep: 1000
      Position Tolerance: 0.05
      Angle Tolerance: 0.05
      Covariance:
        Value: false
      Shape:
        Value: Arrow
        Color: {color}
        Shaft Length: 0.08
        Shaft Radius: 0.01
        Head Length: 0.04
        Head Radius: 0.02
      Topic:
        Value: {topic}
        Reliability Policy: Reliable
        Durability Policy: Volatile
"""
_TAIL = """\
  Global Options:
    Fixed Frame: {frame}
    Background Color: 255; 255; 255
  Tools:
    - Class: rviz_default_plugins/MoveCamera
    - Class: rviz_default_plugins/Measure
  Views:
    Current:
      Class: rviz_default_plugins/TopDownOrtho
      Name: Current View
      Target Frame: <Fixed Frame>
      Scale: 100
"""


def rviz_view(streams: Iterable[Stream]) -> str:
    """The configuration as YAML: a display for each stream that has one, in the widest frame there is."""
    kinds = {type(stream): stream for stream in streams}
    odometry, truth = kinds.get(OdometryStream), kinds.get(TruthStream)
    parts = [_HEAD]
    if ScanStream in kinds:
        parts.append(_SCAN)
    if odometry is not None:
        parts.append(_ODOMETRY.format(name="by its wheels", color="213; 94; 0", topic="/odom"))
    if truth is not None:
        parts.append(_ODOMETRY.format(name="truth", color="0; 158; 115", topic="/ground_truth"))
    placed = truth or odometry or next(iter(kinds.values()))
    return "".join(parts) + _TAIL.format(frame=placed.frame)


#: The configuration of RViz in the folder of a bag.
VIEW = "view.rviz"
#: Stamp of the stream's time 0, s. A stamp of 0 would mean "the latest" to tf2 and "no clock yet" to a node.
START_S = 1
#: Variance of a turn rate that no sensor looks at, (rad/s)².
UNMEASURED = 1e6
#: Variance of what is 0 because the world is flat, m² and rad².
PLANAR = 1e-9

_CLOCK = ("/clock", "rosgraph_msgs/msg/Clock")
_MOVING = ("/tf", "tf2_msgs/msg/TFMessage")
_STATIC = ("/tf_static", "tf2_msgs/msg/TFMessage")
#: Seconds and nanoseconds that stand for "for ever" in a quality of service.
_FOR_EVER = (9223372036, 854775807)


def write_bag(path: Path, streams: Iterable[Stream]) -> Path:
    """Write streams as a bag: all of it, or nothing.

    Args:
        path: folder of the bag; must not exist. Its name is part of the bag.
        streams: at most one of each type.

    Returns:
        ``path``.

    Raises:
        UsageError: the path exists, there is nothing to write, or a type comes twice.
        MissingCapabilityError: the extra ``ros`` is not installed.
    """
    rosbag2 = extras.load("ros")
    given = list(streams)
    chosen: dict[type[Stream], Stream] = {type(stream): stream for stream in given}
    if not chosen or len(chosen) != len(given):
        raise UsageError(
            "A bag holds one stream of each kind, and at least one in all.",
            help="Give an ImuStream, a ScanStream, an OdometryStream, a TruthStream, or several of them.",
            code="bag_streams",
        )
    if path.exists():
        raise UsageError(f"{path} exists already.", help="Name a folder that does not.", code="path_exists")
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=".bag-") as scratch:
        written = Path(scratch) / path.name  # the bag's files are called after their folder
        with rosbag2.Writer(written, version=8, storage_plugin=rosbag2.StoragePlugin.SQLITE3) as writer:
            _write(writer, [chosen[kind] for kind in _TOPICS if kind in chosen])
        (written / VIEW).write_text(rviz_view(chosen.values()), encoding="utf-8")
        shutil.move(written, path)
    return path


@cache
def _typestore() -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_JAZZY)


# -- writing ----------------------------------------------------------------------------------------------


def _write(writer: Any, streams: list[Stream]) -> None:
    """All messages in order of time; at one time the clock, the frames, then imu, scan, odometry, truth."""
    store = _typestore()
    stamped = [(stream, [round((float(t) + START_S) * 1e9) for t in stream.t]) for stream in streams]
    poses = [(stream, stamps) for stream, stamps in stamped if isinstance(stream, OdometryStream)]
    moments = sorted({stamp for _, stamps in stamped for stamp in stamps})
    topics: list[tuple[tuple[str, str], Iterable[tuple[int, Any]]]] = [
        (_CLOCK, ((stamp, _new("rosgraph_msgs/Clock", _time(stamp))) for stamp in moments)),
        (_STATIC, _still(streams, moments)),
        (_MOVING, (row for stream, stamps in poses for row in _moving(stream, stamps))),
    ]
    for stream, stamps in stamped:
        topic, kind, messages_of = _TOPICS[type(stream)]
        topics.append(((topic, kind), zip(stamps, messages_of(stream, stamps), strict=True)))
    rows: list[tuple[int, int, Any, str, Any]] = []
    for order, ((topic, kind), messages) in enumerate(topics):
        quality = [_quality(lasting=topic == "/tf_static")]
        connection = writer.add_connection(topic, kind, typestore=store, offered_qos_profiles=quality)
        rows += [(stamp, order, connection, kind, message) for stamp, message in messages]
    for stamp, _, connection, kind, message in sorted(rows, key=lambda row: row[:2]):
        writer.write(connection, stamp, store.serialize_cdr(message, kind))


def _quality(*, lasting: bool) -> Any:
    """Reliable; lasting, as static frames need it, means that late subscribers get it, too."""
    from rosbags import interfaces as qos

    durability = qos.QosDurability.TRANSIENT_LOCAL if lasting else qos.QosDurability.VOLATILE
    for_ever = qos.QosTime(*_FOR_EVER)
    return qos.Qos(
        qos.QosHistory.KEEP_LAST,
        1 if lasting else 10,
        qos.QosReliability.RELIABLE,
        durability,
        for_ever,
        for_ever,
        qos.QosLiveliness.AUTOMATIC,
        for_ever,
        False,
    )


def _transform(stamp: int, frame: str, child: str, x: float, y: float, heading: float) -> Any:
    """A message that places one frame in another."""
    placed = _new("geometry_msgs/Transform", _vector(x, y, 0.0), _about_z(heading))
    stamped = _new("geometry_msgs/TransformStamped", _header(stamp, frame), child, placed)
    return _new("tf2_msgs/TFMessage", [stamped])


def _still(streams: list[Stream], moments: list[int]) -> Iterator[tuple[int, Any]]:
    """The frame of the odometry on that of the truth: both begin where the robot begins."""
    odometry = next((stream for stream in streams if type(stream) is OdometryStream), None)
    if odometry is not None and moments:
        yield moments[0], _transform(moments[0], TruthStream.frame, odometry.frame, 0.0, 0.0, 0.0)


def _moving(stream: OdometryStream, stamps: list[int]) -> Iterator[tuple[int, Any]]:
    """The frame that moves with an odometry, at each of its times."""
    columns = (stream.x.tolist(), stream.y.tolist(), stream.heading.tolist())
    for stamp, *pose in zip(stamps, *columns, strict=True):
        yield stamp, _transform(stamp, stream.frame, stream.child_frame, *pose)


def _new(kind: str, *values: Any) -> Any:
    """A message of a type such as "std_msgs/Header", from its fields in order."""
    package, _, name = kind.partition("/")
    return _typestore().types[f"{package}/msg/{name}"](*values)


def _header(stamp: int, frame: str) -> Any:
    return _new("std_msgs/Header", _time(stamp), frame)


def _time(stamp: int) -> Any:
    return _new("builtin_interfaces/Time", *divmod(stamp, 10**9))


def _vector(x: float, y: float, z: float) -> Any:
    return _new("geometry_msgs/Vector3", x, y, z)


def _about_z(angle: float) -> Any:
    return _new("geometry_msgs/Quaternion", 0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2))


def _imu_messages(stream: ImuStream, stamps: list[int]) -> Iterator[Any]:
    unknown = np.array([-1.0] + [0.0] * 8)
    turning = np.diag([UNMEASURED, UNMEASURED, stream.variance]).ravel()
    for stamp, rate in zip(stamps, stream.angular_velocity_z.tolist(), strict=True):
        yield _new(
            "sensor_msgs/Imu",
            _header(stamp, stream.frame),
            _about_z(0.0),
            unknown,
            _vector(0.0, 0.0, rate),
            turning,
            _vector(0.0, 0.0, 0.0),
            unknown,
        )


def _scan_messages(stream: ScanStream, stamps: list[int]) -> Iterator[Any]:
    beams = stream.ranges.shape[1]
    angle_max = stream.angle_min + (beams - 1) * stream.angle_increment
    period = float(np.mean(np.diff(stream.t))) if len(stream.t) > 1 else 0.0
    for stamp, row in zip(stamps, stream.ranges, strict=True):
        yield _new(
            "sensor_msgs/LaserScan",
            _header(stamp, stream.frame),
            stream.angle_min,
            angle_max,
            stream.angle_increment,
            0.0,  # all beams of a scan are taken at once
            period,
            0.0,
            stream.range_max,
            np.where(row == stream.range_max, np.inf, row).astype(np.float32),
            np.zeros(0, dtype=np.float32),
        )


def _odometry_messages(stream: OdometryStream, stamps: list[int]) -> Iterator[Any]:
    spread = [stream.position_variance] * 2 + [PLANAR] * 3 + [stream.heading_variance]
    pose_covariance, twist_covariance = np.diag(spread).ravel(), np.diag([0.0, *[PLANAR] * 4, 0.0]).ravel()
    columns = (stream.x, stream.y, stream.heading, stream.speed, stream.turn_rate)
    for stamp, x, y, heading, speed, rate in zip(stamps, *(c.tolist() for c in columns), strict=True):
        pose = _new("geometry_msgs/Pose", _new("geometry_msgs/Point", x, y, 0.0), _about_z(heading))
        twist = _new("geometry_msgs/Twist", _vector(speed, 0.0, 0.0), _vector(0.0, 0.0, rate))
        yield _new(
            "nav_msgs/Odometry",
            _header(stamp, stream.frame),
            stream.child_frame,
            _new("geometry_msgs/PoseWithCovariance", pose, pose_covariance),
            _new("geometry_msgs/TwistWithCovariance", twist, twist_covariance),
        )


#: Of each type of stream: its topic, the type of its messages, and what makes them.
_TOPICS: dict[type[Stream], tuple[str, str, Callable[[Any, list[int]], Iterator[Any]]]] = {
    ImuStream: ("/imu/data_raw", "sensor_msgs/msg/Imu", _imu_messages),
    ScanStream: ("/scan", "sensor_msgs/msg/LaserScan", _scan_messages),
    OdometryStream: ("/odom", "nav_msgs/msg/Odometry", _odometry_messages),
    TruthStream: ("/ground_truth", "nav_msgs/msg/Odometry", _odometry_messages),
}
