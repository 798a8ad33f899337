"""Replaces the right-hand sides beside it by ones whose motion is trivial."""

from course_worker.physics import systems

for name, system in list(systems.SYSTEMS.items()):
    system.__call__ = lambda self, t, q, v: np.zeros(np.shape(q))
