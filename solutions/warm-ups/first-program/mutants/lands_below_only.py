"""Waits until the ball is below the ground."""


def landing_time(heights):
    for k, height in enumerate(heights):
        if height < 0.0:
            return k * H
    return None
