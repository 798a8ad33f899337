"""Clears between adding and using."""


def final_speed(mass, force, h, n):
    speed = 0.0
    for _ in range(n):
        summed = force
        summed = 0.0
        speed += h * summed / mass
    return speed
