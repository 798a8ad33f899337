"""A class folder, read as data: platforms' downloads, archives, files, and the owner of each."""
