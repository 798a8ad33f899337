"""Forces add up, then they are gone: the model solution."""


def final_speed(mass, force, h, n):
    """Speed after n steps from rest under a constant force."""
    speed = 0.0
    for _ in range(n):
        summed = 0.0
        summed += force
        speed += h * summed / mass
    return speed
