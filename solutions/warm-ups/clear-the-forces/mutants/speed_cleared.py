"""Clears the speed as well."""


def final_speed(mass, force, h, n):
    speed = 0.0
    for _ in range(n):
        speed = 0.0
        speed += h * force / mass
    return speed
