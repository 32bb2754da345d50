"""Runners execute jobs. Threads, locks and ``except Exception`` occur here and nowhere else."""
