"""A scene as data: the file's fields, its rules and settings, and every body as plain numbers."""
