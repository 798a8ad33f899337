"""Judging a submission: the terms of a run, the session, and the words of the verdict."""
