"""The loop as it stands in the file."""


def final_speed(mass, force, h, n):
    speed = summed = 0.0
    for _ in range(n):
        summed += force
        speed += h * summed / mass
    return speed
