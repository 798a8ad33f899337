"""The program around the commands: its line, its screen, its replies, the files it writes, its crashes."""
