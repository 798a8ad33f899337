"""Clears the sum at the end of the step."""


def final_speed(mass, force, h, n):
    speed = summed = 0.0
    for _ in range(n):
        summed += force
        speed += h * summed / mass
        summed = 0.0
    return speed
