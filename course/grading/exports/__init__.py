"""Exports of a gradebook: each format reads the same ``Results``, and writes its whole file or none."""
