"""The sandbox in a browser: a page on this machine, and the world behind it."""
