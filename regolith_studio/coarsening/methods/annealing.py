"""The paper's simulated annealing, step by step as printed in section 2.4."""

from collections.abc import Generator
from dataclasses import dataclass, field, fields

import numpy as np

from regolith_studio.coarsening.core.facet_insertion import insert_lost_facets
from regolith_studio.coarsening.decimated_hull import decimated_hull
from regolith_studio.coarsening.loss import Evaluation, LossFunction
from regolith_studio.coarsening.progress import MethodStep, Move
from regolith_studio.coarsening.result import MethodResult
from regolith_studio.coarsening.target import Target
from regolith_studio.coarsening.weights import LossWeights
from regolith_studio.errors import GeometryError, InputError
from regolith_studio.geometry.arrays import FloatArray
from regolith_studio.geometry.half_spaces import HalfSpaces
from regolith_studio.messages import N_

TIE_BREAK = 1e-7
CUT_DEPTH = 0.3
# The step comes to rest where one proposal in nine improves: 1.5 x .949^7.7 = 1.
GROW, SHRINK = 1.5, 0.9**0.5


@dataclass(frozen=True)
class AnnealingSettings:
    """Parameters of the procedure; the defaults are the paper's.

    T(k) = T_0 gamma^k; the standard deviation of a move is `step_factor` times mean |p_i|. Not in the paper:
    the best polyhedron met is the result; the standard deviation follows the share of improving moves;
    half-spaces that bound no facet are put back as small cuts.
    """

    start_temperature: float = field(
        default=0.2, metadata={"label": N_("Start temperature T₀"), "minimum": 0.0, "maximum": 1.0}
    )
    cooling: float = field(default=0.9, metadata={"label": N_("Cooling γ"), "minimum": 0.0, "maximum": 1.0})
    iterations: int = field(
        default=100, metadata={"label": N_("Iterations k_max"), "minimum": 1, "maximum": 1_000_000}
    )
    step_factor: float = field(
        default=1.0, metadata={"label": N_("Step, in mean |p|"), "minimum": 1e-4, "maximum": 10.0}
    )
    best_so_far: bool = field(default=False, metadata={"label": N_("Keep the best so far")})
    adaptive_step: bool = field(default=False, metadata={"label": N_("Adaptive step")})
    facet_repair: bool = field(default=False, metadata={"label": N_("Repair lost facets")})

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            if (
                "minimum" in each.metadata
                and not each.metadata["minimum"] <= value <= each.metadata["maximum"]
            ):
                raise InputError(
                    f"The annealing setting {each.name} must lie between {each.metadata['minimum']:g} and"
                    f" {each.metadata['maximum']:g}, got {value}."
                )

    def acceptance_probability(self, k: int) -> float:
        """T(k) = T_0 gamma^k: the probability of taking a worse polyhedron, however much worse."""
        return self.start_temperature * self.cooling**k


class AnnealingMethod:
    """Simulated annealing of the points p_i (section 2.4).

    For k = 1 .. k_max: pick i at random; draw p_i' from N(p_i, sigma) with sigma = mean |p_i| over the
    present points; take it if the loss (Eq. 9) falls, else with probability T(k) = T_0 gamma^k.

    What the paper leaves open is decided so:

    - N(p, sigma): sigma is the standard deviation of each coordinate. As a variance it would have the unit
      of an area, and the step would depend on the unit of length.
    - T(k) is used as printed, without the loss difference: this is not Metropolis' rule.
    - The last polyhedron is the result, not the best one.
    - A proposal whose half-spaces bound no polyhedron (or one that reaches beyond 40 times the largest
      offset) is refused without asking T(k); the iteration counts.
    - Redundant half-spaces stay among the n points and may come back; the facets reported are the real ones.
    - Planes of the decimated hull that do not hold the centroid inside are replaced by copies of others, a
      little farther out. Many of its planes meet five and six at a corner, so all offsets are moved once by a
      relative 1e-7 at random.
    - The loss is evaluated on the exact minimum-volume box and, for IoU, by 2,000 rays.
    """

    key = "annealing"
    label = N_("Simulated annealing")
    keeps_terms = False
    Settings = AnnealingSettings

    def run(
        self,
        target: Target,
        n_facets: int,
        weights: LossWeights,
        seed: np.random.SeedSequence,
        settings: AnnealingSettings,
        fewer: HalfSpaces | None = None,  # noqa: ARG002
    ) -> Generator[MethodStep, None, MethodResult]:
        """One step an iteration, and step 0 for the start."""
        rng = np.random.default_rng(seed)
        evaluate = LossFunction(target, weights)
        points = _start(target, n_facets, rng)
        now = _judged(evaluate, points)
        if now is None:
            raise GeometryError("The decimated convex hull bounds no polyhedron to start from.")
        yield MethodStep(0, settings.iterations, now.loss, HalfSpaces.from_points(points))
        best, least, history = points, now.loss, [now.loss]
        factor, refused, taken = settings.step_factor, 0, 0
        for k in range(1, settings.iterations + 1):
            i, sigma, proposal = _perturbed(points, factor, rng)
            if settings.facet_repair:
                proposal = _repaired(target, proposal)
            then = _judged(evaluate, proposal)
            # Also where it is not asked, so that each iteration takes as many random numbers.
            drawn, probability = float(rng.random()), settings.acceptance_probability(k)
            lucky = drawn < probability
            better = then is not None and then.loss < now.loss
            changed = then is not None and (better or lucky)
            refused += then is None
            move = Move(i, proposal, sigma, now, then, probability, drawn, changed)
            if then is not None and changed:
                points, now, taken = proposal, then, taken + 1
            if settings.adaptive_step:
                factor = min(factor * (GROW if better else SHRINK), settings.step_factor)
            if now.loss < least:
                best, least = points, now.loss
            history.append(now.loss)
            shown = HalfSpaces.from_points(points) if changed else None
            yield MethodStep(k, settings.iterations, now.loss, shown, move)
        counts = {
            "iterations": float(settings.iterations),
            "accepted": float(taken),
            "refused": float(refused),
        }
        result = best if settings.best_so_far else points
        return MethodResult(HalfSpaces.from_points(result), tuple(history), steps=counts)


def _start(target: Target, n_facets: int, rng: np.random.Generator) -> FloatArray:
    half_spaces = decimated_hull(target, n_facets).half_spaces
    points = half_spaces.points
    if len(points) < n_facets:
        extra = np.arange(n_facets - len(points)) % len(points)
        points = np.vstack([points, points[extra] * (1.0 + 1e-3)])
    ties: FloatArray = 1.0 + TIE_BREAK * rng.uniform(-1.0, 1.0, (len(points), 1))
    return points * ties


def _perturbed(points: FloatArray, factor: float, rng: np.random.Generator) -> tuple[int, float, FloatArray]:
    """Steps 2 and 3: which point is moved, by a normal step of which deviation, and all points then."""
    sigma = factor * float(np.linalg.norm(points, axis=1).mean())
    i = int(rng.integers(len(points)))
    proposal = points.copy()
    proposal[i] = rng.normal(points[i], sigma)
    return i, sigma, proposal


def _judged(evaluate: LossFunction, points: FloatArray) -> Evaluation | None:
    offsets = np.linalg.norm(points, axis=1)
    if not (offsets > 0.0).all():
        return None
    return evaluate(points / offsets[:, None], offsets)


def _repaired(target: Target, points: FloatArray) -> FloatArray:
    """Every half-space with a facet; the points as they were where that cannot be."""
    offsets = np.linalg.norm(points, axis=1)
    rays = target.rays
    normals = points / offsets[:, None]
    cuts, normals, offsets = insert_lost_facets(
        normals, offsets, rays.directions, rays.first, rays.distance, CUT_DEPTH
    )
    return np.asarray(normals * offsets[:, None]) if cuts > 0 else points


METHOD = AnnealingMethod()
