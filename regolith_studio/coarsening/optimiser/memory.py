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
from regolith_studio.coarsening.optimiser.followed_boxes import BoxMemory, box_memory
from regolith_studio.geometry.arrays import FloatArray, IntArray

N_ROWS = N_FIXED + MAX_BOXES


class Steps(NamedTuple):
    """Memory of the steps, for n half-spaces and k rays.

    The metric approximates the inverse of the Lagrangian's second derivative, (3 n, 3 n). Of shape (3 n,) are
    the gradients of the overlap at both bodies, the step, all of it with its corrections, and the change of
    the Lagrangian's gradient. Rows are (22, 3 n), their products with the metric (23, 3 n) with the
    gradient's last; residuals to slopes (22,). `diagonal` (3 n,) is that of the first metric, `curvature` (n,
    3, 3) the second derivative of the overlap with each plane alone; each ray leaves the polyhedron at a
    radius, through a plane.
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
    """All memory of descents with n half-spaces.

    Counts of steps, checks and boxes; the terms' residuals and the boxes' axes (8, 3, 3) at the end.
    """

    one: Body
    two: Body
    scratch: BodyScratch
    boxes: BoxMemory
    steps: Steps
    counts: IntArray
    residuals: FloatArray
    frames: FloatArray


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
    boxes, counts = box_memory(n_facets, 2 * n), np.zeros(3, np.int64)
    return Memory(
        empty_body(n, one),
        empty_body(n, two),
        body_scratch(n),
        boxes,
        steps,
        counts,
        np.zeros(N_TERMS),
        np.empty((MAX_BOXES, 3, 3)),
    )
