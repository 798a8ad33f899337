"""As it stands in the file."""


def steps_in(duration, h):
    return int(duration / h)
