"""Measurements of the program against plain ones; ``python -m benchmarks`` runs them all."""
