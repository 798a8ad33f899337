"""``course engines``: real engines on this machine, in tests with known answers."""
