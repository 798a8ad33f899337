"""Exports of a gradebook: each format reads the same ``Results``, and writes its whole file or none.

Each raises UsageError where it lacks something that was not given, such as a roster or an id, and
MissingCapabilityError where students are missing in the roster, a zero was not looked at, or a file cannot be
written.
"""
