"""The quadratic model of a step: an inverse second derivative, and multipliers that the loss pays for.

The price that the loss pays for each term bounds its multiplier. A step d from a point with gradient g,
inverse second derivative M, residuals c and their rows R minimises

    <g, d> + d M^-1 d / (2 t) + sum of rho_r(c_r + <R_r, d>),    rho_r(u) = max(low_r u, high_r u),

whose dual is, with D = R M R' and q = R M g, the least of

    t/2 l' D l + l' (t q - c),    low_r <= l_r <= high_r.

A multiplier inside its bounds means that the term is met to first order, one at a bound that the price does
not pay for it (an exact penalty; Fletcher 1987, section 14.3). t < 1 shortens the step.
"""

import numpy as np

from regolith_studio.coarsening.core.line_overlap import ScanLines
from regolith_studio.coarsening.core.overlap import RayTable
from regolith_studio.coarsening.core.parts import Parts
from regolith_studio.coarsening.optimiser.body import (
    BODY_VOLUME,
    FIRST_TIE,
    GONE,
    JACCARD,
    N_FIXED,
    SURFACE,
    Body,
)
from regolith_studio.coarsening.optimiser.memory import Steps
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import along, cross, dot, mixed, row

CURVATURE = 0.03
"""Of the diagonal guess: the inverse second derivative of a facet of unit area."""
SOFTNESS = 0.05
"""Added to second derivatives of a union: hidden facets have none of their own."""
RIDGE, NEAR_SURFACE = 10.0, 1.5
"""Added to those of a convex polyhedron, per area; rays that end within so many times the mean distance of
the two surfaces count for them."""


@inner_kernel
def fill_first_metric(
    body: Body, rays: RayTable | ScanLines, price: float, held: int, steady: bool, work: Steps
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


@inner_kernel
def fill_curvature(
    body: Body, parts: Parts | None, rays: RayTable | ScanLines, floor: float, work: Steps
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


@inner_kernel
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


@inner_kernel
def is_free(i: int, parts: Parts | None) -> bool:
    """Whether half-space i may move: those between parts that touch may not."""
    free = True
    if parts is not None:
        free = parts.partner[i] < 0
    return free


@inner_kernel
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


@inner_kernel
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


SWEEPS = 6
"""Of coordinate descent between two exact solutions for the multipliers inside their bounds."""
ROUNDS = 40
DEPENDENT = 1e-13
"""Added to the diagonal, relative to it: terms may depend on each other, as AR on both edges."""


@inner_kernel
def fill_multipliers(
    products: FloatArray,
    slopes: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    share: float,
    factor: FloatArray,
    multipliers: FloatArray,
) -> None:
    """Bring the multipliers (m,) of a step from those nearby, 0 for example, to their values.

    They follow from D (m, m), q (m,), c (m,), their bounds low <= 0 <= high (both 0 where the loss has no
    such term) and t, the share; `factor` (m, m + 1) is scratch.
    """
    for _ in range(ROUNDS):
        for _ in range(SWEEPS):
            if _sweep(products, slopes, residuals, low, high, share, multipliers) < 1e-12:
                return
        _solve_free(products, slopes, residuals, low, high, share, factor, multipliers)


@inner_kernel
def _sweep(
    products: FloatArray,
    slopes: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    share: float,
    multipliers: FloatArray,
) -> float:
    """One round of coordinate descent; the largest change."""
    largest = 0.0
    for r in range(len(residuals)):
        diagonal = share * products[r, r]
        if low[r] == high[r] or not diagonal > 0.0:
            continue
        slope = share * slopes[r] - residuals[r]
        for s in range(len(residuals)):
            if multipliers[s] != 0.0:
                slope += share * products[r, s] * multipliers[s]
        value = min(high[r], max(low[r], multipliers[r] - slope / (diagonal * (1.0 + DEPENDENT))))
        largest = max(largest, abs(value - multipliers[r]))
        multipliers[r] = value
    return largest


@inner_kernel
def _solve_free(
    products: FloatArray,
    slopes: FloatArray,
    residuals: FloatArray,
    low: FloatArray,
    high: FloatArray,
    share: float,
    factor: FloatArray,
    multipliers: FloatArray,
) -> None:
    """Go from the multipliers towards those that are best for the ones inside their bounds, up to a bound.

    They stay where the value of the dual would rise: rows that depend on each other may have no best ones.
    The system has rows for these only, often five of twenty.
    """
    m, count = len(residuals), 0
    for r in range(m):
        count += low[r] < multipliers[r] < high[r]
    i = 0
    for r in range(m):
        if not low[r] < multipliers[r] < high[r]:
            continue
        j, right = 0, residuals[r] - share * slopes[r]
        for s in range(m):
            if low[s] < multipliers[s] < high[s]:
                factor[i, j] = share * products[r, s]
                j += 1
            else:
                right -= share * products[r, s] * multipliers[s]
        factor[i, count] = right
        i += 1
    if not solve_in_place(factor[:count, : count + 1]):
        return
    part, i = 1.0, 0
    for r in range(m):
        if low[r] < multipliers[r] < high[r]:
            factor[i, count] -= multipliers[r]
            way = factor[i, count]
            room = high[r] - multipliers[r] if way > 0.0 else low[r] - multipliers[r]
            if abs(room) < part * abs(way):
                part = room / way
            i += 1
    rise, i = 0.0, 0
    for r in range(m):
        if not low[r] < multipliers[r] < high[r]:
            continue
        j, pull = 0, share * slopes[r] - residuals[r]
        for s in range(m):
            there = multipliers[s]
            if low[s] < multipliers[s] < high[s]:
                there += 0.5 * part * factor[j, count]
                j += 1
            pull += share * products[r, s] * there
        rise += factor[i, count] * pull
        i += 1
    if rise < 0.0:
        i = 0
        for r in range(m):
            if low[r] < multipliers[r] < high[r]:
                value = multipliers[r] + part * factor[i, count]
                multipliers[r] = min(high[r], max(low[r], value))
                i += 1


@inner_kernel
def solve_in_place(system: FloatArray) -> bool:
    """Solve a symmetric positive semidefinite system (m, m + 1), the right-hand side last, by Cholesky.

    The solution takes the place of the right-hand side. A pivot that vanishes to rounding is a row that
    depends on those before it; its unknown becomes 0. False where the matrix is not positive semidefinite.
    """
    m = len(system)
    for k in range(m):
        pivot = system[k, k]
        for i in range(k):
            pivot -= system[k, i] * system[k, i]
        if pivot < -1e-9 * abs(system[k, k]):
            return False
        depends = pivot <= DEPENDENT * 10.0 * system[k, k]
        root = np.inf if depends else np.sqrt(pivot)
        for j in range(k + 1, m):
            value = system[j, k]
            for i in range(k):
                value -= system[j, i] * system[k, i]
            system[j, k] = value / root
        value = system[k, m]
        for i in range(k):
            value -= system[k, i] * system[i, m]
        system[k, k], system[k, m] = root, value / root
    for k in range(m - 1, -1, -1):
        value = system[k, m]
        for j in range(k + 1, m):
            value -= system[j, k] * system[j, m]
        system[k, m] = value / system[k, k]
    return True
