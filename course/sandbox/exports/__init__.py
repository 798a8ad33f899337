"""Scenes exported as worlds for other engines.

``mjcf`` is for MuJoCo; ``sdf`` is for Gazebo, with ``sdf_joints`` for what holds its bodies and
``gazebo_start`` for the file that lies beside a world with velocities; ``common`` is shared by both.
"""
