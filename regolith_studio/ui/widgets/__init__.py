"""Widgets that know nothing of particles: sliders, plots, toasts."""
