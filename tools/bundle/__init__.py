"""One folder with the program and its own Python, for computers where nothing can be installed."""
