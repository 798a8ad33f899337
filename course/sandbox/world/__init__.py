"""A scene that runs: fixed steps, one stream of events, an account of energy and momentum, and hands."""
