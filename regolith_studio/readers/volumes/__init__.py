"""Volumes of voxels as the program reads them: what a file holds, all of it, a box, or slab by slab."""
