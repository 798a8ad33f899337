"""ROS 2 bags: what is written is what another reader finds, and what cannot be written says why."""

import math
import sqlite3
import struct
import subprocess
import sys

import numpy as np
import pytest

from course import extras
from course.errors import MissingCapabilityError, UsageError
from course.simulations import bags

needs_rosbags = pytest.mark.skipif(not extras.available("ros"), reason="the extra ros is not installed")

T = np.array([0.0, 0.1, 0.25])
IMU = bags.ImuStream(T, np.array([0.1, -0.2, 0.3]), variance=0.04)
SCAN = bags.ScanStream(T[:2], np.array([[1.0, 2.5, 5.0], [1.5, 5.0, 0.0]]), -0.5, 0.5, 5.0, "laser")
ODOMETRY = bags.OdometryStream(
    T, [0.0, 1.0, 2.0], [0.0, -1.0, 0.5], [0.0, 2.0, -3.0], [0.5, 0.6, 0.7], [0.0, 0.1, 0.2]
)
TRUTH = bags.TruthStream(
    T, [0.0, 1.1, 2.2], [0.0, -0.9, 0.6], [0.0, 2.1, -2.9], [0.5, 0.6, 0.7], [0.0, 0.1, 0.2]
)
ALL = (IMU, SCAN, ODOMETRY, TRUTH)


class Cdr:
    """Little-endian CDR, read field by field as the specification lays it out."""

    def __init__(self, data):
        assert data[:4] == b"\x00\x01\x00\x00"
        self.data, self.at = data[4:], 0

    def take(self, code, count=1):
        size = struct.calcsize(code)
        self.at += -self.at % size
        values = struct.unpack_from(f"<{count}{code}", self.data, self.at)
        self.at += size * count
        return values if count > 1 else values[0]

    def text(self):
        length = self.take("I")
        raw = self.data[self.at : self.at + length]
        self.at += length
        return raw[:-1].decode()

    def header(self):
        return self.take("i"), self.take("I"), self.text()


def of(topic, rows):
    return [row for row in rows if row[0] == topic]


def frames(data):
    """Stamp, parent, child and x, y, heading of each transform of a TFMessage."""
    cdr, found = Cdr(data), []
    for _ in range(cdr.take("I")):
        second, nanosecond, parent = cdr.header()
        child = cdr.text()
        x, y, z, qx, qy, qz, qw = cdr.take("d", 7)
        assert (z, qx, qy) == (0.0, 0.0, 0.0)
        found.append(((second, nanosecond), parent, child, (x, y, 2 * math.atan2(qz, qw))))
    return found


def sqlite_messages(bag):
    with sqlite3.connect(bag / f"{bag.name}.db3") as connection:
        rows = connection.execute(
            "SELECT topics.name, topics.type, messages.timestamp, messages.data FROM messages"
            " JOIN topics ON topics.id = messages.topic_id ORDER BY messages.id"
        ).fetchall()
    connection.close()
    return rows


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A bag of all streams."""
    pytest.importorskip("rosbags", reason="the extra ros is not installed")
    return bags.write_bag(tmp_path_factory.mktemp("written") / "drive", ALL)


def test_an_imu_message_holds_rate_stamp_and_covariances_where_its_definition_says(written):
    rows = of("/imu/data_raw", sqlite_messages(written))
    assert [(name, kind, stamp) for name, kind, stamp, _ in rows] == [
        ("/imu/data_raw", "sensor_msgs/msg/Imu", 10**9 * bags.START_S + stamp)
        for stamp in (0, 100_000_000, 250_000_000)
    ]
    cdr = Cdr(rows[2][3])
    assert cdr.header() == (bags.START_S, 250_000_000, "base_link")
    assert cdr.take("d", 4) == (0.0, 0.0, 0.0, 1.0)
    assert cdr.take("d", 9)[0] == -1.0
    assert cdr.take("d", 3) == (0.0, 0.0, 0.3)
    assert cdr.take("d", 9)[::4] == (bags.UNMEASURED, bags.UNMEASURED, 0.04)
    assert cdr.take("d", 3) == (0.0, 0.0, 0.0)
    assert cdr.take("d", 9)[0] == -1.0
    assert cdr.at == len(cdr.data)


def test_a_scan_message_holds_its_angles_and_infinity_where_nothing_was_hit(written):
    rows = of("/scan", sqlite_messages(written))
    cdr = Cdr(rows[0][3])
    assert cdr.header() == (bags.START_S, 0, "laser")
    assert cdr.take("f", 7) == pytest.approx((-0.5, 0.5, 0.5, 0.0, 0.1, 0.0, 5.0))
    assert cdr.take("f", cdr.take("I")) == (1.0, 2.5, math.inf)
    assert cdr.take("I") == 0


def test_an_odometry_message_holds_pose_and_twist_in_their_frames(written):
    rows = sqlite_messages(written)
    truth = Cdr(of("/ground_truth", rows)[1][3])
    assert truth.header() == (bags.START_S, 100_000_000, "map")
    assert truth.text() == "base_link_true"
    assert truth.take("d", 3) == (1.1, -0.9, 0.0)
    cdr = Cdr(of("/odom", rows)[1][3])
    assert cdr.header() == (bags.START_S, 100_000_000, "odom")
    assert cdr.text() == "base_link"
    assert cdr.take("d", 3) == (1.0, -1.0, 0.0)
    assert cdr.take("d", 4) == pytest.approx((0.0, 0.0, math.sin(1.0), math.cos(1.0)))
    assert cdr.take("d", 36)[14] == bags.PLANAR
    assert cdr.take("d", 6) == (0.6, 0.0, 0.0, 0.0, 0.0, 0.1)


def test_a_bag_holds_its_messages_in_order_of_time(written):
    stamps = [stamp for _, _, stamp, _ in sqlite_messages(written)]
    assert stamps == sorted(stamps)
    assert len(stamps) == 11 + 3 + 1 + 6  # the streams, the clock, a frame that stands and two that move


def test_the_clock_runs_from_after_zero_through_every_stamp(written):
    rows = sqlite_messages(written)
    clock = [
        (stamp, Cdr(data)) for _, kind, stamp, data in of("/clock", rows) if kind == "rosgraph_msgs/msg/Clock"
    ]
    assert [stamp for stamp, _ in clock] == sorted({stamp for _, _, stamp, _ in rows})
    assert all(cdr.take("i") * 10**9 + cdr.take("I") == stamp > 0 for stamp, cdr in clock)


@needs_rosbags
def test_every_scan_finds_its_way_through_the_frames_to_the_map_at_its_own_time(tmp_path):
    scan = bags.ScanStream(T[:2], [[1.0], [1.5]], 0.0, 0.1, 5.0)
    rows = sqlite_messages(bags.write_bag(tmp_path / "drive", [scan, ODOMETRY, TRUTH]))
    ((_, kind, when, data),) = of("/tf_static", rows)
    assert kind == "tf2_msgs/msg/TFMessage"
    assert when == min(stamp for _, _, stamp, _ in rows)
    parents = {child: parent for _, parent, child, _ in frames(data)}
    moving = {}
    for _, _, stamp, message in of("/tf", rows):
        for (second, nanosecond), parent, child, pose in frames(message):
            assert second * 10**9 + nanosecond == stamp
            assert parents.setdefault(child, parent) == parent, "a frame has one parent"
            moving[child, stamp] = pose
    for _, _, stamp, message in of("/scan", rows):
        frame = Cdr(message).header()[2]
        assert (frame, stamp) in moving
        while frame in parents:
            frame = parents[frame]
        assert frame == "map"
    assert moving["base_link", 10**9 * bags.START_S + 100_000_000] == pytest.approx((1.0, -1.0, 2.0))
    assert moving["base_link_true", 10**9 * bags.START_S + 100_000_000] == pytest.approx((1.1, -0.9, 2.1))


def test_the_metadata_are_of_a_version_that_humble_reads_and_keep_static_frames_for_who_comes_later(written):
    from ruamel.yaml import YAML

    text = (written / "metadata.yaml").read_text()
    told = YAML(typ="safe").load(text)["rosbag2_bagfile_information"]
    assert told["version"] == 8
    assert told["storage_identifier"] == "sqlite3"
    assert told["starting_time"]["nanoseconds_since_epoch"] == 10**9 * bags.START_S
    offered = {}
    for topic in told["topics_with_message_count"]:
        quality = topic["topic_metadata"]["offered_qos_profiles"]
        assert isinstance(quality, str), "up to version 8 it is YAML within YAML"
        (offered[topic["topic_metadata"]["name"]],) = YAML(typ="safe").load(quality)
    assert {name for name, quality in offered.items() if quality["durability"] == 1} == {"/tf_static"}
    assert {quality["reliability"] for quality in offered.values()} == {1}


@needs_rosbags
@pytest.mark.parametrize(
    ("given", "frame", "topics"),
    [
        (ALL, "map", {"/scan", "/odom", "/ground_truth"}),
        ((SCAN, ODOMETRY), "odom", {"/scan", "/odom"}),
        ((IMU, SCAN), "base_link", {"/scan"}),
    ],
)
def test_the_view_for_rviz_shows_topics_of_the_bag_in_a_frame_of_the_bag(tmp_path, given, frame, topics):
    from ruamel.yaml import YAML

    bag = bags.write_bag(tmp_path / "drive", given)
    view = YAML(typ="safe").load((bag / bags.VIEW).read_text())["Visualization Manager"]
    assert view["Global Options"]["Fixed Frame"] == frame
    shown = {display["Topic"]["Value"] for display in view["Displays"] if "Topic" in display}
    assert shown == topics <= {name for name, *_ in sqlite_messages(bag)}


def test_the_same_streams_under_the_same_name_are_the_same_bytes(written, tmp_path):
    first, second = written, bags.write_bag(tmp_path / "drive", reversed(ALL))
    names = sorted(file.name for file in first.iterdir())
    assert names == sorted(file.name for file in second.iterdir())
    for name in names:
        assert (first / name).read_bytes() == (second / name).read_bytes(), name


@needs_rosbags
def test_a_bag_is_never_written_over_another(tmp_path):
    bags.write_bag(tmp_path / "drive", [IMU])
    before = (tmp_path / "drive" / "drive.db3").read_bytes()
    with pytest.raises(UsageError, match="exists already"):
        bags.write_bag(tmp_path / "drive", [SCAN])
    assert (tmp_path / "drive" / "drive.db3").read_bytes() == before


@needs_rosbags
def test_a_write_that_fails_leaves_nothing_behind(tmp_path):
    wordy = bags.ImuStream([0.0], [0.0], frame=None)  # a frame that no message can hold
    with pytest.raises(AttributeError):
        bags.write_bag(tmp_path / "drive", [wordy])
    assert list(tmp_path.iterdir()) == []


@needs_rosbags
@pytest.mark.parametrize("given", [[], [IMU, IMU]])
def test_a_bag_takes_one_stream_of_each_kind(tmp_path, given):
    with pytest.raises(UsageError, match="one stream of each kind"):
        bags.write_bag(tmp_path / "drive", given)


def test_without_rosbags_the_error_gives_the_command_that_installs_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rosbags", None)
    with pytest.raises(MissingCapabilityError) as caught:
        bags.write_bag(tmp_path / "drive", [IMU])
    assert "pip install 'rosbags" in caught.value.help


def test_importing_bags_does_not_import_rosbags():
    code = "import sys, course.simulations.bags; sys.exit('rosbags' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_plain_data_become_streams_with_float_arrays():
    plain = {
        "scan": {"t": [0], "ranges": [[1, 2]], "angle_min": -1, "angle_increment": 2, "range_max": 5},
        "imu": {"t": [0, 1], "angular_velocity_z": [1, 2]},
    }
    scan, imu = bags.streams_from(plain)
    assert isinstance(scan, bags.ScanStream)
    assert isinstance(imu, bags.ImuStream)
    assert scan.ranges.dtype == imu.t.dtype == float
    assert isinstance(scan.range_max, float)


@pytest.mark.parametrize(
    ("plain", "words"),
    [
        ({"sonar": {}}, "no stream of kind 'sonar'"),
        ({"imu": {"t": [0.0], "angular_velocity_z": [0.0], "colour": 1}}, "has no colour"),
        ({"imu": {"t": [0.0]}}, "angular_velocity_z"),
        ({"imu": {"t": [0.0, 1.0], "angular_velocity_z": [0.0]}}, "2 times and 1 of"),
        ({"imu": {"t": [1.0, 0.0], "angular_velocity_z": [0.0, 0.0]}}, "ordered"),
        ({"imu": {"t": [-1.0], "angular_velocity_z": [0.0]}}, "from 0 on"),
        ({"imu": {"t": [1e10], "angular_velocity_z": [0.0]}}, "from 0 on"),
        ({"imu": {"t": [math.nan], "angular_velocity_z": [0.0]}}, "not finite"),
        ({"imu": {"t": [0.0], "angular_velocity_z": [[0.0]]}}, "2 dimensions, not 1"),
    ],
)
def test_plain_data_that_are_no_stream_say_why(plain, words):
    with pytest.raises(UsageError, match=words):
        bags.streams_from(plain)
