"""Runs to keep: unseen and measured, recorded and replayed, filmed, described in sentences."""
