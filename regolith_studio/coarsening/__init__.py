"""Coarsening: convex polyhedra with few facets that keep what matters of a particle (section 2.4)."""
