"""Figures of studies, drawn by matplotlib and written as PNG and SVG; imported when figures are wanted."""
