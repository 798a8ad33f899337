"""Courseware that teaches physics simulation for robotics.

Nothing is imported eagerly: ``course --help`` stays fast, and a worker that runs a stranger's code
never finds more of this package than it was given.
"""

__version__ = "2.0.0"

__all__ = ["__version__"]
