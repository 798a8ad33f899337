"""As it stands in the file."""


def run(x, v, a, n):
    states = []
    for _ in range(n):
        v += H * a
        x += H * v
        states.append((x, v))
    return states
