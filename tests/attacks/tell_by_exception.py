"""Carries a hidden argument out in an exception's class, message and notes."""

def scale(values, factor):
    error = type(f"V{factor}", (ValueError,), {})(f"factor {factor}")
    error.add_note(f"{factor}")
    raise error
