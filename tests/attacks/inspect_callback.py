"""Takes the functions it is given apart."""

import inspect


def sample(f, points):
    for name in dir(f):
        print(name, repr(getattr(f, name, None))[:200])
    for look in (inspect.getsource, inspect.getclosurevars, inspect.signature, inspect.getfile, vars):
        try:
            print(look(f))
        except BaseException as error:
            print(type(error).__name__)
    return [f.__call__.__self__(x) * 0 for x in points]


def scale(values, factor):
    return values
