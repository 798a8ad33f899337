"""Runs and what is made of them: measured without a view, recorded and replayed, filmed, put into words."""
