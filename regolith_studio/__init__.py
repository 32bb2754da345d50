"""Regolith Studio: from X-ray micro-CT to DEM-ready particles whose geometry is right."""

__version__ = "0.1.0"
