"""Runs to keep: unseen and measured, recorded and replayed, filmed, told in sentences."""
