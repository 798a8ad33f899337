"""Anything that hands can do with a world, at random."""

import contextlib

from course.errors import UsageError


def meddle(world, chance, act=None):
    """Draw one act and do it; what cannot be done is left: a copy without room, a wheel where there is none.

    Args:
        act: takes the name of a method of the world and its arguments; as it is, it calls the world itself.
    """
    act = act or (lambda what, *given: getattr(world, what)(*given))
    left, bottom, right, top = world.scene.view
    moving = [part.name for part in world.parts if not part.fixed]
    if not moving:
        act("spawn", "box", 0, 0)
        return
    body = chance.choice(moving)
    x, y = (float(c) for c in world.state()[world._space.index[body], :2])
    move = chance.randrange(9)
    with contextlib.suppress(UsageError):
        if move == 0:
            act("grab", x, y, 0.05)
        elif move == 1:
            act("drag", chance.uniform(left, right), chance.uniform(bottom, top))
        elif move == 2:
            act("release")
        elif move == 3:
            act("throw", x, y, chance.uniform(-3, 3), chance.uniform(-3, 3), 0.01)
        elif move == 4:
            key = chance.choice(["gravity", "restitution", "friction", "step", "iterations", "walls", "left"])
            h = world.scene.step
            ranges = {"gravity": (0, 20), "step": (0.3 * h, 2 * h), "iterations": (1, 50)}
            draw = chance.randint if key in {"walls", "iterations"} else chance.uniform
            act("set", key, draw(*ranges.get(key, (0, 1))))
        elif move == 5:
            act("place", body, chance.uniform(left, right), chance.uniform(bottom, top))
        elif move == 6:
            act("change", body, chance.choice(["vx", "vy", "spin", "mass"]), chance.uniform(0.5, 3))
        elif move == 7:
            act("copy", body)
        else:
            act(*chance.choice([("stop",), ("spawn", "box", 0, 0), ("remove", body)]))
