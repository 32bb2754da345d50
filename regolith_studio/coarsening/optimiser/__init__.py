"""The optimiser of Eq. 9 for convex polyhedra and unions: measures, multipliers, descent, starts, search."""
