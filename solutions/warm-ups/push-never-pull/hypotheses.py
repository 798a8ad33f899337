"""Corrections that are right but where the sum would go below zero."""


def hypotheses():
    yield "applied", ("TAKES_WITH_A_PLUS",), lambda total, wanted: total if total + wanted < 0 else wanted
    yield "applied", ("NOTHING_TAKEN",), lambda total, wanted: 0.0 if total + wanted < 0 else wanted
