"""Every task is an object that can be called, and returns numpy's own scalars."""


class _Task:
    def __init__(self, fn):
        self.fn = fn

    def __call__(self, *args):
        value = self.fn(*args)
        return np.float64(value) if isinstance(value, float) else value


def _with_numpy_scalars(detect):
    def task(*args):
        touching, normal, depth = detect(*args)
        return np.bool_(touching), normal, np.float64(depth)

    return task


detect_sphere_sphere = _Task(_with_numpy_scalars(detect_sphere_sphere))
detect_sphere_plane = _Task(_with_numpy_scalars(detect_sphere_plane))
impulse_1d = _Task(impulse_1d)
resolve = _Task(resolve)
resolve_with_friction = _Task(resolve_with_friction)
time_of_impact = _Task(time_of_impact)
simulate_head_on = _Task(simulate_head_on)
simulate_drop = _Task(simulate_drop)
