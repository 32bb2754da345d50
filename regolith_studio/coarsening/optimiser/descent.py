"""The one descent of Eq. 9: sequential quadratic programming of an exact penalty, compiled as a whole.

Each step minimises a quadratic model of the overlap with the other terms as kinks (Fletcher 1987, section
14.3): its multipliers are bounded by what the loss pays (:mod:`multipliers`), so that each term is either met
or given up, without a rule. Terms with a multiplier inside its bounds are then brought to zero by
Gauss-Newton steps, and the loss decides. A term that is to be kept exactly has the price LOCK.

Boxes are followed from step to step; the proven search looks for a smaller one every few steps, which is a
rival from then on: a condition that keeps it above the measured box.
"""

import numpy as np

from regolith_studio.coarsening.core.line_overlap import ScanLines, fill_shared_with_lines
from regolith_studio.coarsening.core.overlap import RayTable, add_shared_charges, shared_volume
from regolith_studio.coarsening.core.parts import Parts
from regolith_studio.coarsening.core.polyhedron_measures import add_volume_charges, fill_gradient, fill_moved
from regolith_studio.coarsening.optimiser.body import (
    BODY_VOLUME,
    FIRST_TIE,
    GONE,
    JACCARD,
    LONGEST,
    MIDDLE_LONGEST,
    MIDDLE_SHORTEST,
    N_BOXES,
    N_FIXED,
    N_TERMS,
    RATIO,
    SHORTEST,
    Body,
    BodyScratch,
    Prices,
    copy_boxes,
    fill_body,
    fill_box_terms,
)
from regolith_studio.coarsening.optimiser.followed_boxes import add_box, check_boxes
from regolith_studio.coarsening.optimiser.memory import Memory, Steps
from regolith_studio.coarsening.optimiser.quadratic_model import (
    fill_first_metric,
    fill_multipliers,
    solve_in_place,
    update_metric,
)
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import exits
from regolith_studio.geometry.kernels import inner_kernel, kernel

LOCK = 100.0
"""Price of a term that is kept exactly, in units of the Jaccard distance: multipliers of terms that can be
met stay below 10."""
KEPT = 20.0
"""Terms with a higher price, in units of that of the Jaccard distance, are to be kept."""
CLEARANCE, PRESSING = 2e-4, 1e-4
"""Rivals are brought above the measured box by the first share of its volume, and cost below the second: the
way between them keeps rivals that only come near from deciding over steps."""
CHECK_EVERY, CHECK_SHARE, CHECK_MOVE = 12, 6, 0.02
"""Accepted steps between two searches for smaller boxes: at least so many, and a half-space in so many, as a
search takes longer than a step where there are many; and so long in all, as no box becomes smaller before."""
MET, INEXACT, LEAST_EXACT = 1e-9, 1e-4, 1e-7
"""Residuals of terms at a kink after the corrections of a step, absolute, or as a share of what the step is
to gain: the price of such a residual is a hundredth of that. Never more than the last, as the gain is large
to the end where a sphericity that cannot be met has its price."""
CORRECTIONS = 5
MAX_RADIUS, RESTART_RADIUS, MIN_RADIUS = 0.25, 0.02, 2e-4
SHRINK, GOOD = 0.35, 0.5
MIN_GAIN = 1e-5
"""The descent ends where two steps bring less of the Jaccard distance, whose rays miss 2e-4 of it."""
NEAR_KINK = -0.1
"""Rows of the middle edge and of the next vertex with a larger residual take part in the steps."""
TIED = 1e-3
"""Where corrections lead nowhere, vertices that tie up to this residual are corrected together."""
STEPS, CHECKS, FOLLOWED = 0, 1, 2


@kernel
def descend(
    rays: RayTable | ScanLines,
    prices: Prices,
    start_axes: FloatArray,
    max_steps: int,
    radius: float,
    held: int,
    steady: bool,
    restoring: bool,
    followed: FloatArray,
    normals: FloatArray,
    offsets: FloatArray,
    tangents: FloatArray,
    memory: Memory,
) -> tuple[bool, float, float, float]:
    """Descend from half-spaces, which are replaced by those of the end.

    The axes of the particle's box are those of the box that is measured, where the one that lies like it is
    nearly the least; `followed` (b, 3, 3) are those of the boxes that a descent before followed, the measured
    one first: then another is looked for only after some steps and at the end. A plane moves by `radius` in a
    step at first; the first ones, `held` of them, do not move. Where it is `steady`, small facets hold still,
    so that none is lost; where it is `restoring`, the overlap does not count.

    ``memory.frames`` takes the axes of ``memory.counts[2]`` boxes that are followed at the end,
    ``memory.residuals`` the residuals of the terms; ``memory.one.parts.inner``, if there are parts, holds
    their inner points.

    Returns whether the half-spaces bound a polyhedron, with a box where it needs one, the loss with its
    rivals, the largest residual of a term with the price LOCK, and the Jaccard distance by the rays.
    """
    here, there, scratch, boxes, work, counts, residuals, frames = memory
    here.normals[:], here.offsets[:], here.tangents[:] = normals, offsets, tangents
    here.counts[N_BOXES] = 0
    # not from False on: numba would compile all steps for that constant, too
    needs_box = prices.low[SHORTEST] < prices.high[SHORTEST]
    for r in range(SHORTEST + 1, RATIO + 1):
        needs_box = needs_box or prices.low[r] < prices.high[r]
    if not fill_body(here, prices.wanted, needs_box, scratch):
        return False, np.inf, np.inf, 1.0
    unchecked, check_every = 0, max(CHECK_EVERY, len(offsets) // CHECK_SHARE)
    if needs_box and len(followed) > 0:
        for b in range(len(followed)):
            add_box(here, followed[b], scratch)
        fill_box_terms(here, prices.wanted, scratch)
        unchecked = 1
    elif needs_box:
        check_boxes(here, prices, start_axes, boxes, scratch)
    fill_overlap(here, here.parts, rays, work)
    pull = 0.0 if restoring else prices.overlap
    fill_overlap_gradient(here, here.parts, rays, pull, work, work.gradient)
    fill_first_metric(here, rays, prices.overlap, held, steady, work)
    merit = merit_of(here, prices)
    failures, small, moved = 0, 0, 0.0
    for _ in range(max_steps):
        counts[STEPS] += 1
        gain, length = _step(here, there, rays, prices, pull, needs_box, radius, merit, scratch, work)
        if gain > 0.0:
            here, there = there, here
            for j in range(len(work.gradient)):
                work.gradient[j] = work.trial_gradient[j]
            merit = merit_of(here, prices)
            radius = min(MAX_RADIUS, max(radius, 2.0 * length)) if work.slopes[0] > GOOD else radius
            failures, unchecked, moved = 0, unchecked + 1, moved + length
            small = small + 1 if gain < MIN_GAIN * prices.overlap else 0
        else:
            radius, failures = SHRINK * min(radius, length if length > 0.0 else radius), failures + 1
            if radius < MIN_RADIUS:
                fill_first_metric(here, rays, prices.overlap, held, steady, work)
                radius, failures, small = RESTART_RADIUS, failures + 2, small + (failures > 3)
        done = small >= 2 or failures > 8
        far = unchecked >= check_every and moved >= CHECK_MOVE
        if needs_box and (far or (done and unchecked > 0)):
            unchecked, moved, counts[CHECKS] = 0, 0.0, counts[CHECKS] + 1
            if check_boxes(here, prices, start_axes, boxes, scratch):
                merit, done, small, failures = merit_of(here, prices), False, 0, 0
                radius = max(radius, RESTART_RADIUS)
        if done:
            break
    if needs_box and unchecked > 0 and check_boxes(here, prices, start_axes, boxes, scratch):
        merit = merit_of(here, prices)
    normals[:], offsets[:], tangents[:] = here.normals, here.offsets, here.tangents
    _carry_inner(here.parts, here, memory.one.parts)
    counts[FOLLOWED] = 0
    for b in range(here.counts[N_BOXES]):
        if here.slack[b] != GONE:
            frames[counts[FOLLOWED]] = here.frames[b]
            counts[FOLLOWED] += 1
    worst = 0.0
    for r in range(N_TERMS):
        residuals[r] = here.residuals[r]
        if prices.high[r] > KEPT * prices.overlap:
            worst = max(worst, abs(here.residuals[r]))
    for b in range(1, here.counts[N_BOXES]):
        worst = max(worst, -here.slack[b])
    return True, merit, worst, here.numbers[JACCARD]


@kernel
def fill_overlap(body: Body, parts: Parts | None, rays: RayTable | ScanLines, work: Steps) -> None:
    """Jaccard distance to the particle of unit volume; the rays' exits stay in `work`."""
    if parts is None:
        exits(body.normals, body.offsets, rays.directions, work.radius, work.plane)
        shared = shared_volume(rays.first, rays.distance, rays.sign, rays.weight, work.radius)
    else:
        shared = fill_shared_with_lines(
            body.normals,
            body.offsets,
            body.centroids,
            body.tangents,
            body.scales,
            rays,  # type: ignore[arg-type]
            parts,
        )
    body.numbers[JACCARD] = 1.0 - shared / (1.0 + body.numbers[BODY_VOLUME] - shared)


@inner_kernel
def fill_overlap_gradient(
    body: Body,
    parts: Parts | None,
    rays: RayTable | ScanLines,
    price: float,
    work: Steps,
    gradient: FloatArray,
) -> None:
    """Fill `price` times the derivative of the Jaccard distance, shape (3 n,)."""
    union = (1.0 + body.numbers[BODY_VOLUME]) / (2.0 - body.numbers[JACCARD])
    shared = 1.0 + body.numbers[BODY_VOLUME] - union
    factor, charges = -price * (union + shared) / (union * union), work.charges
    charges[:] = 0.0
    add_volume_charges(body.areas, price * shared / (union * union), charges)
    if parts is None:
        add_shared_charges(
            rays.directions,
            rays.first,
            rays.distance,
            rays.sign,
            rays.weight,
            body.offsets,
            work.radius,
            work.plane,
            body.centroids,
            factor,
            charges,
        )
    else:
        for i in range(len(charges)):
            for c in range(4):
                charges[i, c] += factor * parts.charges[i, c]
    fill_gradient(charges, body.tangents, body.scales, gradient)


@inner_kernel
def merit_of(body: Body, prices: Prices) -> float:
    """The loss as the descent sees it."""
    total = prices.overlap * body.numbers[JACCARD]
    for r in range(N_TERMS):
        total += max(prices.low[r] * body.residuals[r], prices.high[r] * body.residuals[r])
    for b in range(1, body.counts[N_BOXES]):
        total += LOCK * max(0.0, PRESSING - body.slack[b])
    return float(total)


@kernel
def _step(
    here: Body,
    there: Body,
    rays: RayTable | ScanLines,
    prices: Prices,
    pull: float,
    needs_box: bool,
    radius: float,
    merit: float,
    scratch: BodyScratch,
    work: Steps,
) -> tuple[float, float]:
    """Try a step: what it gains, 0 or less where it is refused, and how long it is.

    The overlap pulls with its derivative times `pull`. ``work.slopes[0]`` takes the gain over what the model
    predicts.
    """
    m = gather_rows(here, prices, work)
    fill_products(m, work)
    predicted, length = solve_step(m, radius, work)
    if not predicted > 0.0:
        return 0.0, 0.0
    if not move(here, there, work.step, prices, needs_box, scratch):
        return 0.0, length
    for j in range(len(work.step)):
        work.total[j] = work.step[j]
    tolerance = max(MET, min(INEXACT * predicted, LEAST_EXACT))
    if not correct(there, prices, needs_box, tolerance, scratch, work):
        return 0.0, length
    fill_overlap(there, there.parts, rays, work)
    gain = merit - merit_of(there, prices)
    if gain > 1e-3 * predicted:
        fill_overlap_gradient(there, there.parts, rays, pull, work, work.trial_gradient)
        if pull > 0.0:
            update_metric(here, there, m, work)
        work.slopes[0] = gain / predicted
        return gain, length
    return min(gain, 0.0), length


@inner_kernel
def gather_rows(body: Body, prices: Prices, work: Steps) -> int:
    """Rows of the terms, then those of the rivals: how many. What is not asked for has bounds of 0."""
    m, size = N_FIXED, work.rows.shape[1]
    for r in range(N_FIXED):
        work.low[r], work.high[r] = bounds_of(r, body, prices)
        asked = work.low[r] < work.high[r]
        work.residuals[r] = body.residuals[r] if asked else 0.0
        for j in range(size if asked else 0):
            work.rows[r, j] = body.rows[r, j]
    for b in range(1, body.counts[N_BOXES]):
        work.low[m], work.high[m], work.residuals[m] = 0.0, LOCK, PRESSING - body.slack[b]
        for j in range(size):
            work.rows[m, j] = -body.rival_rows[b, j]
        m += 1
    return m


@inner_kernel
def bounds_of(r: int, body: Body, prices: Prices) -> tuple[float, float]:
    """What the multiplier of a row may be; (0, 0) for one that takes no part."""
    if r < N_TERMS:
        return prices.low[r], prices.high[r]
    if body.counts[N_BOXES] == 0 or body.residuals[r] < NEAR_KINK:
        return 0.0, 0.0
    if r >= FIRST_TIE:
        return 0.0, prices.high[SHORTEST if r < FIRST_TIE + 2 else LONGEST]
    term = LONGEST if r == MIDDLE_LONGEST else (SHORTEST if r == MIDDLE_SHORTEST else RATIO)
    return 0.0, -prices.low[term] if term == SHORTEST else prices.high[term]


@inner_kernel
def fill_products(m: int, work: Steps) -> None:
    """Products of the metric with rows and gradient, and of these with the rows.

    Sums run along the rows of the metric, element by element, so that vectors of any width give the same.
    Most rows take no part and are passed over.
    """
    size = len(work.gradient)
    for r in range(m + 1):
        for j in range(size):
            work.across[r, j] = 0.0
    for i in range(size):
        for r in range(m + 1):
            factor = work.gradient[i] if r == m else (work.rows[r, i] if work.low[r] < work.high[r] else 0.0)
            if factor != 0.0:
                for j in range(size):
                    work.across[r, j] += factor * work.metric[i, j]
    for r in range(m):
        asked = work.low[r] < work.high[r]
        for s in range(m):
            work.products[r, s] = 0.0
            for j in range(size if asked and work.low[s] < work.high[s] else 0):
                work.products[r, s] += work.rows[r, j] * work.across[s, j]
        work.slopes[r] = 0.0
        for j in range(size if asked else 0):
            work.slopes[r] += work.rows[r, j] * work.across[m, j]


@inner_kernel
def solve_step(m: int, radius: float, work: Steps) -> tuple[float, float]:
    """Fill the step, at most as long as `radius`: the decrease that the model predicts, and the length."""
    size, share, length = len(work.gradient), 1.0, 0.0
    for r in range(m):
        work.multipliers[r] = 0.0
    for _ in range(12):
        fill_multipliers(
            work.products[:m, :m],
            work.slopes[:m],
            work.residuals[:m],
            work.low[:m],
            work.high[:m],
            share,
            work.factor[:m, : m + 1],
            work.multipliers[:m],
        )
        for j in range(size):
            work.step[j] = work.across[m, j]
        for r in range(m):
            if work.multipliers[r] != 0.0:
                for j in range(size):
                    work.step[j] += work.multipliers[r] * work.across[r, j]
        length = 0.0
        for j in range(size):
            work.step[j] = -share * work.step[j]
            length = max(length, abs(work.step[j]))
        if not length > radius:
            break
        share *= max(0.1, 0.95 * radius / length)
    predicted = 0.0
    for j in range(size):
        predicted -= 0.5 * work.gradient[j] * work.step[j]
    # g d + d H d / 2 with H d = -t (g + R' l): half of g d less half of the multipliers' share
    for r in range(m):
        after, turn = work.residuals[r], 0.0
        for j in range(size if work.low[r] < work.high[r] else 0):
            turn += work.rows[r, j] * work.step[j]
        after += turn
        before = max(work.low[r] * work.residuals[r], work.high[r] * work.residuals[r])
        predicted += 0.5 * work.multipliers[r] * turn
        predicted += before - max(work.low[r] * after, work.high[r] * after)
    return (predicted, length) if length < np.inf else (0.0, 0.0)


@inner_kernel
def move(
    here: Body, there: Body, step: FloatArray, prices: Prices, needs_box: bool, scratch: BodyScratch
) -> bool:
    """Fill `there` with the polyhedron after a step; False where that is none."""
    fill_moved(
        here.normals,
        here.centroids,
        here.offsets,
        here.tangents,
        here.scales,
        step,
        there.normals,
        there.offsets,
        there.tangents,
    )
    if not _carry_inner(here.parts, there, there.parts):
        return False
    copy_boxes(here, there)
    return fill_body(there, prices.wanted, needs_box, scratch)


@inner_kernel
def _carry_inner(source: Parts | None, there: Body, to: Parts | None) -> bool:
    """Take over the inner points of parts; without parts, whether the origin is inside."""
    if source is None or to is None:
        for i in range(len(there.offsets)):
            if not there.offsets[i] > 0.0:
                return False
    else:
        for j in range(len(to.inner)):
            for c in range(3):
                to.inner[j, c] = source.inner[j, c]
    return True


@inner_kernel
def correct(
    there: Body,
    prices: Prices,
    needs_box: bool,
    tolerance: float,
    scratch: BodyScratch,
    work: Steps,
) -> bool:
    """Bring the terms whose multipliers are inside their bounds to zero; False where that leads nowhere.

    Gauss-Newton steps, least in the diagonal metric; a rival counts where it is below its clearance.
    """
    size, before, tied = len(work.step), np.inf, 0.0
    for _ in range(CORRECTIONS):
        count, worst = _gather_kinks(there, prices, tied, work)
        if worst < tolerance:
            return True
        if worst > before and tied == 0.0 and worst < TIED:
            tied = TIED  # two vertices take turns at the end of an edge
            count, worst = _gather_kinks(there, prices, tied, work)
        elif worst > before or not worst < 0.5:
            return worst <= 2.0 * before and worst < 1e-6
        before = worst
        for r in range(count):
            for s in range(count + 1):
                total = 0.0
                if s < count:
                    for j in range(size):
                        total += work.diagonal[j] * work.across[r, j] * work.across[s, j]
                else:
                    total = work.slopes[r]
                work.factor[r, s] = total
        if not solve_in_place(work.factor[:count, : count + 1]):
            return False
        for j in range(size):
            value = 0.0
            for r in range(count):
                value += work.factor[r, count] * work.across[r, j]
            work.step[j] = -work.diagonal[j] * value
            work.total[j] += work.step[j]
        if not move(there, there, work.step, prices, needs_box, scratch):
            return False
    _, worst = _gather_kinks(there, prices, 0.0, work)
    return worst < 1e-6


@inner_kernel
def _gather_kinks(body: Body, prices: Prices, tied: float, work: Steps) -> tuple[int, float]:
    """Rows of the terms at a kink, in `work.across`, their residuals in `work.slopes`: number and largest.

    Of vertices that nearly tie those count, too, whose residual is above -`tied`.
    """
    count, worst = 0, 0.0
    for r in range(N_FIXED):
        low, high = bounds_of(r, body, prices)
        passed = r >= N_TERMS and high > 0.0 and body.residuals[r] > (-tied if r >= FIRST_TIE else 0.0)
        if low < work.multipliers[r] < high or (passed and work.multipliers[r] < high):
            for j in range(work.across.shape[1]):
                work.across[count, j] = body.rows[r, j]
            work.slopes[count] = body.residuals[r]
            worst = max(worst, abs(body.residuals[r]))
            count += 1
    for b in range(1, body.counts[N_BOXES]):
        held = 0.0 < work.multipliers[N_FIXED + b - 1] < LOCK
        # above a quarter of its clearance a rival that does not press need not be moved
        if (held or body.slack[b] < 0.25 * CLEARANCE) and body.slack[b] != GONE:
            for j in range(work.across.shape[1]):
                work.across[count, j] = -body.rival_rows[b, j]
            work.slopes[count] = CLEARANCE - body.slack[b]
            worst = max(worst, abs(work.slopes[count]))
            count += 1
    return count, worst
