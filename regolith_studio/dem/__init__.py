"""The angle of repose (sections 2.6 and 3.3): the case, its engines, its evaluation. SI units."""
