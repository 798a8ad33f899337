"""``course lessons`` and ``course lesson``: the list of lessons, and reading one."""
