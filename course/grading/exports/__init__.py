"""Exports of a gradebook: every format reads the same ``Results`` and writes a file whole or not at all."""
