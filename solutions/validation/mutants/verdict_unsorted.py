"""Reasons come in the order in which they were found."""

_judged = validate


def validate(sim, real, spec):
    report = _judged(sim, real, spec)
    return {**report, "reasons": report["reasons"][::-1]}
