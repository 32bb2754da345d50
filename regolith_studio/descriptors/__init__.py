"""Numbers that say what shape a particle has: the catalogue, and how two shapes compare."""
