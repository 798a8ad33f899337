"""``course engines``: real engines on this machine, put through tests whose answers are known."""
