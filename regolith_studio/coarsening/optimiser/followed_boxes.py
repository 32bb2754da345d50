"""Boxes that are followed during a descent: the measured one, and rivals that the proven search finds."""

import numpy as np

from regolith_studio.coarsening.core.parts import N_FACES, Parts
from regolith_studio.coarsening.optimiser.body import (
    GONE,
    LONGEST,
    MAX_BOXES,
    N_BOXES,
    N_VERTICES,
    RATIO,
    SHORTEST,
    Body,
    BodyScratch,
    Prices,
    box_volume,
    fill_box_terms,
    is_same_box,
    set_box,
    settle_box,
)
from regolith_studio.coarsening.optimiser.box_check import BoxMemory, find_smaller_box
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import kernel_noalloc

UNDERCUT = 1e-7
"""A box smaller by more becomes a rival."""


@kernel_noalloc
def check_boxes(
    body: Body, prices: Prices, start_axes: FloatArray, memory: BoxMemory, scratch: BodyScratch
) -> bool:
    """Look for a box that is smaller than those that are followed; whether there is one.

    Of a body without boxes the least one is found, and the one that lies as the particle's. The measured box
    is the one that is nearest to the wanted size and to the least.
    """
    n_boxes, known = body.counts[N_BOXES], np.inf
    for b in range(n_boxes):
        if body.slack[b] != GONE:
            known = min(known, box_volume(body, b) * (1.0 - UNDERCUT))
    if not _find_smaller(body, body.parts, known, memory):
        return False
    add_box(body, memory.best.axes, scratch)
    if n_boxes == 0:
        add_box(body, start_axes, scratch)
    choose_box(body, prices)
    fill_box_terms(body, prices.wanted, scratch)
    return True


@kernel_noalloc
def _find_smaller(body: Body, parts: Parts | None, known: float, memory: BoxMemory) -> bool:
    """Whether a box around the body, or the hull of its parts, is smaller than `known`."""
    vertices = body.vertices[: body.counts[N_VERTICES]]
    if parts is None:
        edges = body.edges[: 3 * len(vertices) // 2]
        found = find_smaller_box(vertices, body.normals, edges, known, memory)
    else:
        hull, m = parts.hull, parts.counts[N_FACES]
        found = find_smaller_box(vertices, hull.normals[:m], hull.edges[: 3 * m // 2], known, memory)
    return found


@kernel_noalloc
def add_box(body: Body, axes: FloatArray, scratch: BodyScratch) -> None:
    """Follow the box next to these axes too, unless it is followed; the largest rival may go for it."""
    n_boxes, at = body.counts[N_BOXES], body.counts[N_BOXES]
    for b in range(1, n_boxes):
        if body.slack[b] == GONE:
            at = b
    if at == MAX_BOXES:
        at = 1
        for b in range(2, n_boxes):
            at = b if body.slack[b] > body.slack[at] else at
    for axis in range(3):
        for c in range(3):
            body.frames[at, axis, c] = axes[axis, c]
    settle_box(body, at, scratch)
    set_box(body, at, scratch)
    body.slack[at] = 0.0
    for b in range(n_boxes):
        if b != at and body.slack[b] != GONE and is_same_box(body, b, at):
            body.slack[at] = GONE
    if at == n_boxes and body.slack[at] != GONE:
        body.counts[N_BOXES] += 1


@kernel_noalloc
def choose_box(body: Body, prices: Prices) -> None:
    """Put the box first that is to be measured."""
    least = np.inf
    for b in range(body.counts[N_BOXES]):
        if body.slack[b] != GONE:
            least = min(least, box_volume(body, b))
    nearest, at = np.inf, 0
    for b in range(body.counts[N_BOXES]):
        if body.slack[b] == GONE:
            continue
        short = min(body.extents[b, 0], body.extents[b, 1], body.extents[b, 2])
        long = max(body.extents[b, 0], body.extents[b, 1], body.extents[b, 2])
        off = box_volume(body, b) / least - 1.0
        for r in range(SHORTEST, RATIO + 1):
            if prices.low[r] < prices.high[r]:
                value = short if r == SHORTEST else (long if r == LONGEST else long / short)
                off += abs(value / prices.wanted[r] - 1.0)
        if off < nearest - 1e-9:
            nearest, at = off, b
    if at > 0:
        swap_boxes(body, at)


@kernel_noalloc
def swap_boxes(body: Body, b: int) -> None:
    """Exchange the first box with box `b`."""
    for axis in range(3):
        body.extents[0, axis], body.extents[b, axis] = body.extents[b, axis], body.extents[0, axis]
        for c in range(3):
            frames = body.frames
            frames[0, axis, c], frames[b, axis, c] = frames[b, axis, c], frames[0, axis, c]
    for c in range(body.contacts.shape[1]):
        body.contacts[0, c], body.contacts[b, c] = body.contacts[b, c], body.contacts[0, c]
    for i in range(9):
        for c in range(3):
            planes = body.planes
            planes[0, i, c], planes[b, i, c] = planes[b, i, c], planes[0, i, c]
    body.slack[0] = body.slack[b] = 0.0
