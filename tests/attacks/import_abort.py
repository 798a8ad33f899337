"""Aborts while it is loaded, hoping for a core dump."""

import os

os.abort()
