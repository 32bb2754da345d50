"""What volume formats share: the header they fill, stored voxels, and the traits of HDF5 and TIFF."""
