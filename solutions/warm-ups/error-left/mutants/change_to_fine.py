"""What has changed is what is left."""


def error_left(coarse, fine, factor, order):
    return fine - coarse
