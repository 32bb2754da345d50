"""Runners: who drives a job. Threads, locks and ``except Exception`` live here and nowhere else."""
