"""Runs that are kept: measured without a picture, recorded and replayed, filmed, described in sentences."""
