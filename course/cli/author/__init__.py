"""``course author``: write lessons and exercises, and prove that they are right. Needs a checkout."""
