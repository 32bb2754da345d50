"""The exact method: descriptors met to 1e-6 as constraints, overlap as the objective."""
