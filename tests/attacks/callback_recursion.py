"""Returns a function that calls back into itself across the grader."""

def compose(f, g, x):
    def again(y):
        return f(again)

    return f(again)


def scale(values, factor):
    return values
