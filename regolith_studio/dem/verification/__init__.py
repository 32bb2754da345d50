"""Verification of an engine: measured lines with bands that were set before the first run."""
