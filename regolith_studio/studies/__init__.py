"""Studies of whole samples: what a chosen l_max and a chosen loss do to the descriptors."""
