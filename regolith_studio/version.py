"""Version of the program: a module of its own, so that lower layers need not import the package's root."""

__version__ = "0.1.0"
