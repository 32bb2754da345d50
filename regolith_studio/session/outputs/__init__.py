"""Result files, as the command line, recipes and the window write them."""
