"""A class folder, read as data: platforms' downloads, archives, files, and whose each of them is."""
