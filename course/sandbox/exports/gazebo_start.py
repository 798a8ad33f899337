"""Gives the models of an exported world the velocities they start with.

A world file of Gazebo Sim cannot do that: it ignores ``<state>`` (gz-sim issue 50), and its velocity
controllers keep a velocity for ever (gz-sim pull request 2265). So each model with a velocity has a plugin
that loads this file, a system in Python for Gazebo Sim 8 (Harmonic) and later. It lies beside the world and
imports nothing of the course.
"""

import importlib
from typing import Any


def _gazebo() -> Any:
    """Gazebo's Python module, whose name carried the version until Gazebo Sim 10."""
    for name in ("gz.sim", "gz.sim10", "gz.sim9", "gz.sim8"):
        try:
            module = importlib.import_module(name)
        except ImportError:
            continue
        if hasattr(module, "Joint"):
            return module
    raise ImportError("start velocities need the Python bindings of Gazebo Sim 8 or later")


class StartVelocities:
    """One model's velocities: the plugin has an element named after each moving joint, m/s or rad/s."""

    def configure(self, entity: Any, sdf: Any, ecm: Any, event_mgr: Any) -> None:
        """Read the velocities and set them: called once, when the model is loaded."""
        del event_mgr
        gazebo = _gazebo()
        model = gazebo.Model(entity)
        self.joints = []
        for name in sdf.get_string("joints").split():
            self.joints.append((gazebo.Joint(model.joint_by_name(ecm, name)), sdf.get_double(name)))
        self._set(ecm)

    def reset(self, info: Any, ecm: Any) -> None:
        """Set them again when the world begins anew."""
        del info
        self._set(ecm)

    def _set(self, ecm: Any) -> None:
        for joint, velocity in self.joints:
            joint.reset_velocity(ecm, [velocity])


def get_system() -> StartVelocities:
    """Gazebo's entry point of a module."""
    return StartVelocities()
