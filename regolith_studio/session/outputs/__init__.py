"""The files that results leave behind; the command line, recipes and the window write them here."""
