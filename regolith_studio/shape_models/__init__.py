"""Stochastic models of particle shape: fitted to a sample, they draw virtual particles (2.3, 3.1)."""
