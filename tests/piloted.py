"""Programs on the whole screen, played by textual's pilot: a script becomes a test."""

import functools
import inspect


def as_test(script, play):
    """A test of which ``play`` is given the script, and by name what it takes beyond app and pilot."""

    def test(**given):
        play(functools.partial(script, **given), **given)

    test.__name__, test.__module__ = script.__name__, script.__module__
    _, _, *rest = inspect.signature(script).parameters.values()
    test.__signature__ = inspect.Signature(rest)
    return test
