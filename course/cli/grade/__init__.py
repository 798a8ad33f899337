"""``course grade``: an instructor's commands for a class. They need a checkout."""
