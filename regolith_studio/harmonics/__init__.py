"""Particles as radius functions in real spherical harmonics (sections 2.3 and 3.1)."""
