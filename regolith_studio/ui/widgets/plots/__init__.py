"""Plots on pyqtgraph: canvas and axes, curves, bars, and their files."""
