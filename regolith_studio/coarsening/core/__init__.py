"""Compiled kernels of the coarsening: plain functions of arrays, each testable against its ``py_func``.

Polyhedra are half-spaces <n_i, x> <= h_i with the origin inside; everything is in the unit of the
normalised particle (volume 1, centroid at the origin). A change of the planes is described per plane by
the speed w_i(x) at which the plane moves outward at its point x, linear in x; the derivative of any
quantity is then a *charge* (weight and first moment about a pivot) on each plane, an array (n, 4).
"""
