"""The inverse second derivative that the descent steps with: a first one, and its updates."""

import numpy as np

from regolith_studio.coarsening.core.parts import Parts
from regolith_studio.coarsening.core.scan_lines import ScanLines
from regolith_studio.coarsening.optimiser.body import (
    BODY_VOLUME,
    FIRST_TIE,
    GONE,
    JACCARD,
    N_FIXED,
    SURFACE,
    Body,
)
from regolith_studio.coarsening.optimiser.memory import Rays, Steps
from regolith_studio.geometry.kernels import kernel_noalloc
from regolith_studio.geometry.vectors import along, cross, dot, mixed, row

CURVATURE = 0.03
"""Of the diagonal guess: the inverse second derivative of a facet of unit area."""
SOFTNESS = 0.05
"""Added to second derivatives of a union: hidden facets have none of their own."""
RIDGE, NEAR_SURFACE = 10.0, 1.5
"""Added to those of a convex polyhedron, per area; rays that end within so many times the mean distance of
the two surfaces count for them."""


@kernel_noalloc
def fill_first_metric(
    body: Body, rays: Rays | ScanLines, price: float, held: int, steady: bool, work: Steps
) -> None:
    """A first inverse second derivative, one block a half-space: large facets resist, held ones do not move.

    The rays' exits in `work` are those of this body or of a trial near by. Where small facets hold still, the
    blocks are diagonal guesses.
    """
    n = len(body.offsets)
    floor = max(0.3 * body.numbers[SURFACE] / n, 1e-12)
    work.metric[:, :] = 0.0
    if not steady:
        fill_curvature(body, body.parts, rays, floor, work)
    for i in range(n):
        shift = CURVATURE / max(body.areas[i], floor) / price if i >= held and is_free(i, body.parts) else 0.0
        if steady:
            shift *= min(1.0, body.areas[i] / floor)
        for c in range(3):
            j = 3 * i + c
            work.diagonal[j] = work.metric[j, j] = shift if c == 0 else 3.0 * shift
        if shift > 0.0 and not steady:
            _fill_metric_of_plane(i, price, work)


@kernel_noalloc
def fill_curvature(
    body: Body, parts: Parts | None, rays: Rays | ScanLines, floor: float, work: Steps
) -> None:
    """Fill, for each half-space alone, the second derivative of the Jaccard distance: lines or rays know it.

    Moving a facet by w adds the integral of w^2 over the curve in which it meets the particle's surface. Rays
    that end near the surface stand for the curve: each within a distance of the order of the mean one.
    """
    union = (1.0 + body.numbers[BODY_VOLUME]) / (2.0 - body.numbers[JACCARD])
    curvature = work.curvature
    if parts is None:
        curvature[:, :, :] = 0.0
        width = NEAR_SURFACE * body.numbers[JACCARD] * union / body.numbers[SURFACE]
        for k in range(len(work.radius)):
            r, i = work.radius[k], work.plane[k]
            size, h = 0.0, body.offsets[i]
            for j in range(rays.first[k], rays.first[k + 1]):
                gap = abs(rays.distance[j] - r) * h / r
                if gap < width and rays.sign[j] > 0.0:
                    size += (1.0 - gap / width) / width
            if size > 0.0:
                size *= (2.0 - body.numbers[JACCARD]) / union * rays.weight * r * r * r / h
                at = row(rays.directions, k)
                at = mixed(at, r, row(body.centroids, i), -1.0)
                one = -along(body.tangents[i], 0, at) / body.scales[i]
                two = -along(body.tangents[i], 1, at) / body.scales[i]
                speeds = (1.0, one, two)
                for b in range(3):
                    for c in range(3):
                        curvature[i, b, c] += size * speeds[b] * speeds[c]
        for i in range(len(curvature)):
            least = RIDGE * max(body.areas[i], floor)
            for c in range(3):
                curvature[i, c, c] += least if c == 0 else least / 3.0
    else:
        for i in range(len(curvature)):
            for b in range(3):
                for c in range(3):
                    curvature[i, b, c] = parts.curvature[i, b, c] / union + (SOFTNESS if b == c else 0.0)


@kernel_noalloc
def _fill_metric_of_plane(i: int, price: float, work: Steps) -> None:
    """The inverse second derivative for half-space i alone."""
    block = work.curvature[i]
    one, two, three = row(block, 0), row(block, 1), row(block, 2)
    columns = (cross(two, three), cross(three, one), cross(one, two))
    size = dot(one, columns[0]) * price
    for b in range(3):
        for c in range(3):
            value = columns[0][c] if b == 0 else (columns[1][c] if b == 1 else columns[2][c])
            work.metric[3 * i + c, 3 * i + b] = value / size
        work.diagonal[3 * i + b] = work.metric[3 * i + b, 3 * i + b]


@kernel_noalloc
def is_free(i: int, parts: Parts | None) -> bool:
    """Whether half-space i may move: those between parts that touch may not."""
    free = True
    if parts is not None:
        free = parts.partner[i] < 0
    return free


@kernel_noalloc
def update_metric(here: Body, there: Body, m: int, work: Steps) -> None:
    """BFGS update of the inverse second derivative of the Lagrangian, where its curvature is positive."""
    size = len(work.gradient)
    for j in range(size):
        work.change[j] = work.trial_gradient[j] - work.gradient[j]
    _add_row_changes(here, there, m, work)
    product, squares, changes = 0.0, 0.0, 0.0
    for j in range(size):
        product += work.total[j] * work.change[j]
        squares += work.total[j] * work.total[j]
        changes += work.change[j] * work.change[j]
    if product <= 1e-3 * np.sqrt(squares * changes):
        return
    turned, bend = work.step, 0.0  # the step has done its work
    for j in range(size):
        turned[j] = 0.0
    for i in range(size):
        factor = work.change[i]
        for j in range(size):
            turned[j] += factor * work.metric[i, j]
    for j in range(size):
        bend += work.change[j] * turned[j]
    scale = (1.0 + bend / product) / product
    for i in range(size):
        one, two = work.total[i], turned[i] / product
        for j in range(size):
            work.metric[i, j] += scale * one * work.total[j] - two * work.total[j] - one * turned[j] / product


@kernel_noalloc
def _add_row_changes(here: Body, there: Body, m: int, work: Steps) -> None:
    """Add the multipliers' share of the change of the Lagrangian's gradient."""
    size = len(work.change)
    for r in range(m):
        factor, b = work.multipliers[r], r - N_FIXED + 1
        if factor == 0.0 or FIRST_TIE <= r < N_FIXED:
            continue  # vertices that tie may be others by now
        if r < N_FIXED:
            for j in range(size):
                work.change[j] += factor * (there.rows[r, j] - here.rows[r, j])
        elif there.slack[b] != GONE and here.slack[b] != GONE:
            for j in range(size):
                work.change[j] -= factor * (there.rival_rows[b, j] - here.rival_rows[b, j])
