"""As it stands in the file."""


def landing_time(heights):
    for k, _ in enumerate(heights):
        if k == len(heights) - 1:
            return k * H
    return None
