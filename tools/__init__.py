"""Tools for developers of Regolith Studio; not part of the package."""
