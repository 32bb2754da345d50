"""From image data to particles: volumes, extraction of particles, and synthetic samples (section 2.1)."""
