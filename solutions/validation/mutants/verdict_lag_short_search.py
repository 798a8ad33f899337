"""A tenth of a second is late enough: the search for the lag ends there."""

MAX_LAG = 0.1  # s
