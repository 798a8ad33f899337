"""Scenes exported as worlds for other engines: ``formats`` writes them for MuJoCo and Gazebo.

``gazebo_start`` is the file that lies beside a world for Gazebo with velocities.
"""
