"""A configuration of RViz for the bags of this course: the displays, a view from above, the frame.

It names only what differs from RViz's own defaults.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from course.simulations.streams import OdometryStream, ScanStream, TruthStream

if TYPE_CHECKING:
    from collections.abc import Iterable

    from course.simulations.streams import Stream

__all__ = ["rviz_view"]

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
