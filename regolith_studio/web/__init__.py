"""The three views in a browser or a notebook: a page, a server with a token, and ``show``."""
