"""Every task is an object that can be called."""


class _Task:
    def __init__(self, fn):
        self.fn, self.calls = fn, 0

    def __call__(self, *args):
        self.calls += 1
        return self.fn(*args)


explicit_euler_step = _Task(explicit_euler_step)
semi_implicit_euler_step = _Task(semi_implicit_euler_step)
velocity_verlet_step = _Task(velocity_verlet_step)
rk4_step = _Task(rk4_step)
integrate = _Task(integrate)
observed_order = _Task(observed_order)
max_stable_step = _Task(max_stable_step)
