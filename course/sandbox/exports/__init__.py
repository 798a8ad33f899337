"""Scenes written as worlds of other engines."""
