"""ROS 2 bags: what is written is what another reader finds, and what cannot be written says why."""

import contextlib
import math
import sqlite3
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


def messages(bag):
    """By topic what Humble's reader finds in a bag: the type, the time in ns and the message of each."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    found = {}
    with AnyReader([bag], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        for connection, stamp, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found.setdefault(connection.topic, []).append((connection.msgtype, stamp, message))
    return found


def nanoseconds(stamp):
    return 10**9 * stamp.sec + stamp.nanosec


def at(t):
    """A time of a stream, in s, as it is stamped, in ns."""
    return round(10**9 * (bags.START_S + t))


def numbers(message):
    """The fields of a message, in their order."""
    return tuple(value for name, value in vars(message).items() if name != "__msgtype__")


def pose_of(transform):
    """x, y and heading."""
    x, y, z = numbers(transform.translation)
    qx, qy, qz, qw = numbers(transform.rotation)
    assert (z, qx, qy) == (0.0, 0.0, 0.0)
    return x, y, 2 * math.atan2(qz, qw)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """A bag of all streams."""
    pytest.importorskip("rosbags", reason="the extra ros is not installed")
    return bags.write_bag(tmp_path_factory.mktemp("written") / "drive", ALL)


@pytest.fixture(scope="module")
def found(written):
    return messages(written)


def test_an_imu_message_holds_rate_stamp_and_covariances_where_its_definition_says(found):
    rows = found["/imu/data_raw"]
    assert [(kind, stamp) for kind, stamp, _ in rows] == [("sensor_msgs/msg/Imu", at(t)) for t in T]
    imu = rows[2][2]
    assert (nanoseconds(imu.header.stamp), imu.header.frame_id) == (at(0.25), "base_link")
    assert numbers(imu.orientation) == (0.0, 0.0, 0.0, 1.0)
    assert imu.orientation_covariance[0] == -1.0
    assert numbers(imu.angular_velocity) == (0.0, 0.0, 0.3)
    assert imu.angular_velocity_covariance[::4].tolist() == [bags.UNMEASURED, bags.UNMEASURED, 0.04]
    assert numbers(imu.linear_acceleration) == (0.0, 0.0, 0.0)
    assert imu.linear_acceleration_covariance[0] == -1.0


def test_a_scan_message_holds_its_angles_and_infinity_where_nothing_was_hit(found):
    header, *rest, ranges, intensities = numbers(found["/scan"][0][2])
    assert (nanoseconds(header.stamp), header.frame_id) == (at(0.0), "laser")
    assert rest == pytest.approx([-0.5, 0.5, 0.5, 0.0, 0.1, 0.0, 5.0])
    assert (ranges.tolist(), intensities.tolist()) == ([1.0, 2.5, math.inf], [])


def test_an_odometry_message_holds_pose_and_twist_in_their_frames(found):
    truth, odom = (found[topic][1][2] for topic in ("/ground_truth", "/odom"))
    for message, frames in ((truth, ("map", "base_link_true")), (odom, ("odom", "base_link"))):
        assert nanoseconds(message.header.stamp) == at(0.1)
        assert (message.header.frame_id, message.child_frame_id) == frames
    assert numbers(truth.pose.pose.position) == (1.1, -0.9, 0.0)
    assert numbers(odom.pose.pose.position) == (1.0, -1.0, 0.0)
    assert numbers(odom.pose.pose.orientation) == pytest.approx((0.0, 0.0, math.sin(1.0), math.cos(1.0)))
    assert odom.pose.covariance[14] == bags.PLANAR
    assert numbers(odom.twist.twist.linear) == (0.6, 0.0, 0.0)
    assert numbers(odom.twist.twist.angular) == (0.0, 0.0, 0.1)


def test_a_bag_holds_its_messages_in_order_of_time(written):
    with contextlib.closing(sqlite3.connect(written / "drive.db3")) as connection:
        stamps = connection.execute("SELECT timestamp FROM messages ORDER BY id").fetchall()
    assert stamps == sorted(stamps)
    assert len(stamps) == 11 + 3 + 1 + 6  # the streams, the clock, a frame that stands and two that move


def test_the_clock_runs_from_after_zero_through_every_stamp(found):
    assert {kind for kind, _, _ in found["/clock"]} == {"rosgraph_msgs/msg/Clock"}
    stamps = [stamp for _, stamp, _ in found["/clock"]]
    assert stamps == sorted({stamp for rows in found.values() for _, stamp, _ in rows})
    assert [nanoseconds(message.clock) for _, _, message in found["/clock"]] == stamps
    assert stamps[0] > 0


@needs_rosbags
def test_every_scan_finds_its_way_through_the_frames_to_the_map_at_its_own_time(tmp_path):
    scan = bags.ScanStream(T[:2], [[1.0], [1.5]], 0.0, 0.1, 5.0)
    found = messages(bags.write_bag(tmp_path / "drive", [scan, ODOMETRY, TRUTH]))
    ((kind, when, still),) = found["/tf_static"]
    assert kind == "tf2_msgs/msg/TFMessage"
    assert when == min(stamp for rows in found.values() for _, stamp, _ in rows)
    parents = {one.child_frame_id: one.header.frame_id for one in still.transforms}
    moving = {}
    for _, stamp, message in found["/tf"]:
        for one in message.transforms:
            parent, child = one.header.frame_id, one.child_frame_id
            assert nanoseconds(one.header.stamp) == stamp
            assert parents.setdefault(child, parent) == parent, "a frame has one parent"
            moving[child, stamp] = pose_of(one.transform)
    for _, stamp, message in found["/scan"]:
        frame = message.header.frame_id
        assert (frame, stamp) in moving
        while frame in parents:
            frame = parents[frame]
        assert frame == "map"
    assert moving["base_link", at(0.1)] == pytest.approx((1.0, -1.0, 2.0))
    assert moving["base_link_true", at(0.1)] == pytest.approx((1.1, -0.9, 2.1))


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
    assert shown == topics <= messages(bag).keys()


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
