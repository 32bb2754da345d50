"""Memory of a descent, made once for a number of half-spaces."""

from typing import NamedTuple

import numpy as np

from regolith_studio.coarsening.core.parts import Planes, parts_for
from regolith_studio.coarsening.optimiser.body import (
    MAX_BOXES,
    N_FIXED,
    N_TERMS,
    Body,
    BodyScratch,
    body_scratch,
    empty_body,
)
from regolith_studio.coarsening.optimiser.box_check import BoxMemory, box_memory
from regolith_studio.geometry.arrays import FloatArray, IntArray

N_ROWS = N_FIXED + MAX_BOXES


class Rays(NamedTuple):
    """Crossings of rays with the particle, as :class:`regolith_studio.coarsening.target.RayTable`."""

    directions: FloatArray
    first: IntArray
    distance: FloatArray
    sign: FloatArray
    weight: float


class Steps(NamedTuple):
    """Memory of the steps, for n half-spaces and k rays.

    Parameters
    ----------
    metric
        Approximate inverse of the Lagrangian's second derivative, shape (3 n, 3 n).
    gradient, trial_gradient, step, total, change
        Shape (3 n,): of the overlap at both bodies, the step, with its corrections, and of the Lagrangian.
    rows, across
        Rows and their products with the metric, shapes (22, 3 n) and (23, 3 n), the gradient's last.
    residuals, low, high, multipliers, slopes
        Of the rows, shape (22,).
    products, factor
        Shapes (22, 22) and (22, 23).
    diagonal
        Of the metric that a descent begins with, (3 n,).
    radius, plane
        Where each ray leaves the polyhedron, shape (k,).
    charges
        Shape (n, 4).
    curvature
        Second derivatives of the overlap with each plane alone, (n, 3, 3).
    """

    metric: FloatArray
    gradient: FloatArray
    trial_gradient: FloatArray
    step: FloatArray
    total: FloatArray
    change: FloatArray
    rows: FloatArray
    across: FloatArray
    residuals: FloatArray
    low: FloatArray
    high: FloatArray
    multipliers: FloatArray
    slopes: FloatArray
    products: FloatArray
    factor: FloatArray
    diagonal: FloatArray
    radius: FloatArray
    plane: IntArray
    charges: FloatArray
    curvature: FloatArray


class Memory(NamedTuple):
    """All memory of descents with n half-spaces; counts of steps, and the terms' residuals at the end."""

    one: Body
    two: Body
    scratch: BodyScratch
    boxes: BoxMemory
    steps: Steps
    counts: IntArray
    residuals: FloatArray


def memory_for(n: int, n_rays: int, planes: Planes | None = None) -> Memory:
    """Memory for n half-spaces and so many rays; for a union of parts as these planes have."""
    size = 3 * n
    one, two = (None, None) if planes is None else (parts_for(planes), parts_for(planes))
    n_facets = n if planes is None else 4 * n  # of the hull of up to 2 n vertices
    steps = Steps(
        np.empty((size, size)),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros(size),
        np.zeros((N_ROWS, size)),
        np.zeros((N_ROWS + 1, size)),
        np.zeros(N_ROWS),
        np.zeros(N_ROWS),
        np.zeros(N_ROWS),
        np.zeros(N_ROWS),
        np.zeros(N_ROWS),
        np.zeros((N_ROWS, N_ROWS)),
        np.zeros((N_ROWS, N_ROWS + 1)),
        np.zeros(size),
        np.empty(n_rays),
        np.empty(n_rays, np.int64),
        np.empty((n, 4)),
        np.empty((n, 3, 3)),
    )
    boxes, counts = box_memory(n_facets, 2 * n), np.zeros(2, np.int64)
    return Memory(
        empty_body(n, one), empty_body(n, two), body_scratch(n), boxes, steps, counts, np.zeros(N_TERMS)
    )
