"""A scene as data: what a file may say, its rules and settings, and every body laid out as plain numbers."""
