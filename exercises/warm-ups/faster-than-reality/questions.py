"""Calls that tell wrong programs of `faster-than-reality` apart. What they should give is not here."""

QUESTIONS = {
    "real_time_factor": [
        (1000, 0.001, 0.5),
        (24000, 0.0025, 3.1),
        (313, 0.013, 12.7),
    ],
}
