"""Forces add up, then they are gone."""


def final_speed(mass, force, h, n):
    """Speed after n steps from rest under a constant force.

    Args:
        mass: kg.
        force: N, the same in every step.
        h: length of a step, s.
        n: number of steps.

    Returns:
        float, m/s.
    """
    speed = 0.0
    summed = 0.0
    for _ in range(n):
        summed += force  # whatever pushes in this step adds its force
        speed += h * summed / mass
    return speed
