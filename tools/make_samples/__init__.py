"""The synthetic samples that ship with the program: ``python -m tools.make_samples FOLDER``."""
