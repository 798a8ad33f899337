"""``course notebook``: the course in Jupyter."""
