"""Contact between rigid bodies: where it occurs, what it does, and the models that engines use.

pairs     which bodies may touch, when they meet, how far apart they are and in which direction
impulses  what all contacts do to the bodies at once
models    a ball on a floor in one dimension, under the contact models of engines
"""

from course.physics.contact.pairs import Plane, Surface, meet, meet_plane

__all__ = ["Plane", "Surface", "meet", "meet_plane"]
