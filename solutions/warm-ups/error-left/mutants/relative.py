"""Errors are given as shares."""


def error_left(coarse, fine, factor, order):
    return (coarse - fine) / (factor**order - 1) / fine
