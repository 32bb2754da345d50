"""Volumes of voxels and the extraction of particle meshes from them (section 2.1)."""
