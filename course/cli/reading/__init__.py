"""``course lessons``, ``lesson`` and ``warmup``: what there is to read and to practise, and reading one."""
