"""The optimiser of Eq. 9: half-spaces measured with derivatives, multipliers, descent, starts and search."""
