"""A submission judged: what a run decides once, the session, and the words of the verdict."""
